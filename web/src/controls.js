// The form: every value has a label, every slider a number box beside it.

import { make, freshId } from "./dom.js";
import { change, state } from "./state.js";
import { text } from "./strings.js";

let found = 128; // the threshold that the last run chose by itself
const updates = []; // each brings one control up to date with the state

function slider(key, words, { min, max, step, unit, show }) {
    const id = freshId(key);
    const set = (event) => {
        const value = Number(event.target.value);
        if (event.target.value !== "" && Number.isFinite(value)) change({ [key]: Math.min(Math.max(value, min), max) });
    };
    const limits = { min, max, step };
    const range = make("input", { type: "range", ...limits, oninput: set, "aria-label": text(words), tabindex: 0 });
    const box = make("input", { type: "number", id, ...limits, onchange: set, inputmode: "decimal" });
    const row = make("div", { class: "field" },
        make("label", { for: id }, text(words)), make("span", { class: "pair" }, range, box, make("span", { class: "unit" }, unit ? text(unit) : "")));
    updates.push((s) => {
        row.hidden = show ? !show(s) : false;
        range.value = s[key];
        if (document.activeElement !== box) box.value = s[key];
    });
    return row;
}

function check(key, words) {
    const box = make("input", { type: "checkbox", onchange: () => change({ [key]: box.checked }) });
    updates.push((s) => { box.checked = s[key]; });
    return make("label", { class: "check" }, box, text(words));
}

function menu(key, words, choices) {
    const id = freshId(key);
    const select = make("select", { id, onchange: () => change({ [key]: select.value }) },
        choices.map(([value, label]) => make("option", { value }, label)));
    updates.push((s) => { select.value = s[key]; });
    return make("div", { class: "field" }, make("label", { for: id }, text(words)), select);
}

function threshold() {
    const id = freshId("threshold");
    const automatic = make("input", { type: "checkbox", onchange: () => change({ threshold: automatic.checked ? "auto" : "128" }) });
    const set = (event) => event.target.value !== "" && change({ threshold: String(Math.min(Math.max(Math.round(event.target.value), 1), 255)) });
    const range = make("input", { type: "range", min: 1, max: 255, oninput: set, "aria-label": text("threshold") });
    const box = make("input", { type: "number", id, min: 1, max: 255, onchange: set });
    updates.push((s) => {
        automatic.checked = s.threshold === "auto";
        range.disabled = box.disabled = automatic.checked;
        range.value = box.value = automatic.checked ? found : s.threshold;
    });
    return make("div", { class: "field" }, make("label", { for: id }, text("threshold")),
        make("span", { class: "pair" }, range, box), make("label", { class: "check" }, automatic, text("auto")));
}

const group = (words, ...children) => make("fieldset", {}, make("legend", {}, text(words)), ...children);

function pictureGroup(lists, takeFile) {
    const input = make("input", { type: "file", class: "hidden-input", id: freshId("picture"),
        accept: "image/png,image/jpeg,image/webp,image/svg+xml,.pbm,.pgm,.ppm",
        onchange: () => input.files[0] && takeFile(input.files[0]) });
    const gallery = make("div", { class: "gallery", role: "group", "aria-label": text("samples") },
        lists.samples.map(({ name, what }) => make("button", { type: "button", title: what, onclick: () => change({ sample: name, upload: "", uploadName: "", crop: "" }), "data-sample": name }, name)));
    updates.push((s) => {
        for (const button of gallery.children) button.setAttribute("aria-pressed", String(button.dataset.sample === s.sample));
    });
    return group("picture",
        make("label", { class: "button wide", for: input.id }, text("choose")), input,
        make("p", { class: "hint" }, text("orDrop")), gallery, threshold(), check("invert", "invert"),
        make("div", { class: "field" }, make("span", { class: "label" }, text("rotate")),
            make("button", { type: "button", onclick: () => change({ rotate: (state().rotate + 90) % 360 }) }, "90°")));
}

function printerGroup(lists) {
    const own = (s) => s.printer === "";
    return group("size",
        slider("width", "width", { min: 10, max: 300, step: 1, unit: "mm" }),
        slider("frame", "frame", { min: 0, max: 20, step: 0.5, unit: "mm" }),
        slider("thickness", "thickness", { min: 0.4, max: 20, step: 0.2, unit: "mm" }),
        menu("printer", "printer", [...lists.printers.map((p) => [p.name, p.name]), ["", text("ownPrinter")]]),
        slider("phi-e", "phi_e", { min: -0.5, max: 1, step: 0.01, unit: "mm", show: own }),
        slider("phi-s", "phi_s", { min: 0.05, max: 3, step: 0.05, unit: "mm", show: own }),
        slider("phi-v", "phi_v", { min: 0.05, max: 3, step: 0.05, unit: "mm", show: own }),
        check("nudge", "nudge"));
}

function surfaceGroup() {
    const round = (s) => s.surface !== "plate";
    return group("surface",
        menu("surface", "surface", ["plate", "cylinder", "vase", "cone", "sphere"].map((name) => [name, text(name)])),
        slider("radius", "radius", { min: 10, max: 150, step: 1, unit: "mm", show: round }),
        slider("height", "height", { min: 20, max: 400, step: 5, unit: "mm", show: (s) => round(s) && s.surface !== "sphere" }));
}

function strengthGroup(lists) {
    return group("strength",
        slider("force", "force", { min: 0, max: 500, step: 5, unit: "newton" }),
        menu("material", "material", lists.materials.map((m) => [m.name, m.name])));
}

/** Fill the form anew, in the language that is set. */
export function showControls(form, lists, takeFile) {
    updates.length = 0;
    form.replaceChildren(pictureGroup(lists, takeFile), printerGroup(lists), surfaceGroup(), strengthGroup(lists));
    updateControls();
}

export function updateControls() {
    for (const update of updates) update(state());
}

/** Show the threshold that a run has found. */
export function showThreshold(level) {
    found = level;
    updateControls();
}
