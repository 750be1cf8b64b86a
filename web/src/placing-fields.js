// Where the picture lies, in figures: the same as by dragging.

import { freshId, make } from "./dom.js";
import { onUpdate } from "./fields.js";
import { change } from "./state.js";
import { text } from "./strings.js";

const found = { at: [0, 0, 0], dir: [0, 1, 0] }; // as the last run had it: what a box holds that was left empty

/** Say where the picture of a run lies: `place` of figures.json. */
export function showPlace(place) {
    if (place?.centre_mm) found.at = place.centre_mm.map((x) => Number(x.toFixed(1)));
    if (place?.direction) found.dir = place.direction.map((x) => Number(x.toFixed(3)));
}

/** Three number boxes for "x,y,z" of the state; all empty means: it is found. */
export function vectorField(key, words, { step, show, hint }) {
    const name = freshId(key);
    const take = () => {
        const parts = boxes.map((box) => box.value);
        change({ [key]: parts.every((part) => part === "") ? "" : parts.map((part, i) => (part === "" ? found[key][i] : Number(part) || 0)).join() });
    };
    const boxes = ["x", "y", "z"].map((axis) => make("input", { type: "number", step, "aria-label": `${text(words)}: ${axis}`, onchange: take }));
    const row = make("div", { class: "field", role: "group", "aria-labelledby": name },
        make("span", { class: "label", id: name }, text(words)), make("span", { class: "triple" }, boxes), hint ? make("p", { class: "hint" }, text(hint)) : null);
    onUpdate((s) => {
        row.hidden = !show(s);
        const parts = s[key].split(",");
        boxes.forEach((box, k) => {
            box.placeholder = found[key][k];
            if (document.activeElement !== box) box.value = parts[k] ?? "";
        });
    });
    return row;
}
