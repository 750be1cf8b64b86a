// The threshold, over the grey levels that the program counted in the picture as it is cropped.

import { make } from "./dom.js";
import { onUpdate, slider } from "./fields.js";
import { change, state } from "./state.js";
import { text } from "./strings.js";

const LEVELS = 256, HIGH = 64, NS = "http://www.w3.org/2000/svg";
let found = null; // {counts, automatic} of the picture that is chosen
let level = 128; // where the last run put it

const svg = (tag, attributes = {}) => {
    const node = document.createElementNS(NS, tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    return node;
};

const chosen = (s) => (s.threshold === "auto" ? found?.automatic ?? level : s.threshold === "local" ? null : Number(s.threshold));

// Square roots, so that the few greys between two heaps of black and white are seen; one pixel wide steps.
function shape(counts) {
    const most = Math.sqrt(Math.max(...counts, 1));
    return `M0 ${HIGH}` + counts.map((count, v) => `V${(HIGH - (HIGH - 2) * Math.sqrt(count) / most).toFixed(2)}H${v + 1}`).join("") + `V${HIGH}Z`;
}

function histogram() {
    const dark = svg("path", { class: "dark" }), light = svg("path", { class: "light" });
    const automatic = svg("line", { class: "automatic", y1: 0, y2: HIGH }), line = svg("line", { class: "line", y1: 0, y2: HIGH });
    const clips = [svg("rect", { y: 0, height: HIGH, x: 0 }), svg("rect", { y: 0, height: HIGH })];
    const root = svg("svg", { viewBox: `0 0 ${LEVELS} ${HIGH}`, preserveAspectRatio: "none", class: "histogram", role: "img" });
    ["dark", "light"].forEach((name, i) => {
        const clip = svg("clipPath", { id: `levels-${name}` });
        clip.append(clips[i]);
        root.append(clip);
    });
    dark.setAttribute("clip-path", "url(#levels-dark)");
    light.setAttribute("clip-path", "url(#levels-light)");
    root.append(dark, light, automatic, line);
    onUpdate((s) => {
        const counts = found?.counts ?? new Array(LEVELS).fill(0), at = chosen(s) ?? LEVELS;
        for (const path of [dark, light]) path.setAttribute("d", shape(counts));
        clips[0].setAttribute("width", at);
        clips[1].setAttribute("x", at);
        clips[1].setAttribute("width", LEVELS - at);
        for (const [node, x] of [[line, chosen(s)], [automatic, found?.automatic]]) {
            node.style.display = x == null ? "none" : "";
            node.setAttribute("x1", x ?? 0);
            node.setAttribute("x2", x ?? 0);
        }
        const all = counts.reduce((sum, count) => sum + count, 0), white = counts.slice(at).reduce((sum, count) => sum + count, 0);
        root.setAttribute("aria-label", text("levels", { percent: all ? Math.round((100 * white) / all) : 0 }));
    });
    return root;
}

/** How the threshold is chosen, the grey levels, and the level itself. */
export function thresholdField() {
    const ways = make("div", { class: "segments", role: "group", "aria-label": text("threshold") },
        [["auto", "auto"], ["level", "byHand"], ["local", "local"]].map(([way, words]) => make("button", { type: "button", "data-way": way,
            onclick: () => change({ threshold: way === "level" ? String(found?.automatic ?? level) : way }) }, text(words))));
    const way = (s) => (s.threshold === "auto" || s.threshold === "local" ? s.threshold : "level");
    onUpdate((s) => { for (const button of ways.children) button.setAttribute("aria-pressed", String(button.dataset.way === way(s))); });
    return [ways, histogram(),
        slider("threshold", "threshold", { min: 1, max: 255, step: 1, toState: (value) => String(Math.round(value)),
            fromState: (s) => chosen(s) ?? level, show: (s) => s.threshold !== "local" }),
        slider("window", "window", { min: 0, max: 400, step: 1, unit: "px", toState: (value) => (value < 3 ? 0 : Math.round(value)), show: (s) => s.threshold === "local" }),
        slider("contrast", "contrast", { min: 0, max: 1, step: 0.01, show: (s) => s.threshold === "local" })];
}

/** Show the levels of a picture: levels.json of a job (docs/cli.md). */
export function showLevels(json) {
    found = { counts: json.levels, automatic: json.threshold_auto };
}

/** Show the threshold that a run has found. */
export function showThreshold(value) {
    if (state().threshold !== "local") level = value;
}
