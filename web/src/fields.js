// The form's controls: each has a label, shows the state, and changes it; every slider has a number box beside it.

import { freshId, make } from "./dom.js";
import { change, state } from "./state.js";
import { text } from "./strings.js";

const updates = []; // each brings one control up to date with the state

export const onUpdate = (update) => updates.push(update);
export const forget = () => { updates.length = 0; };

export function updateFields() {
    for (const update of updates) update(state());
}

const hidable = (row, show) => onUpdate((s) => { row.hidden = show ? !show(s) : false; });

/** A number: `limits` are min, max, step; `toState` and `fromState` where the state keeps something else. */
export function slider(key, words, { unit, show, enabled, toState = Number, fromState = (s) => s[key], ...limits }) {
    const id = freshId(key);
    const set = (event) => {
        const value = Number(event.target.value);
        if (event.target.value !== "" && Number.isFinite(value)) change({ [key]: toState(Math.min(Math.max(value, limits.min), limits.max)) });
    };
    const range = make("input", { type: "range", ...limits, oninput: set, "aria-label": text(words) });
    const box = make("input", { type: "number", id, ...limits, onchange: set, inputmode: "decimal" });
    const pair = make("span", { class: unit ? "pair" : "pair bare" }, range, box, unit ? make("span", { class: "unit" }, text(unit)) : null);
    const row = make("div", { class: "field" }, make("label", { for: id }, text(words)), pair);
    hidable(row, show);
    onUpdate((s) => {
        range.value = fromState(s);
        if (document.activeElement !== box || Number(box.value) !== fromState(s)) box.value = fromState(s);
        range.disabled = box.disabled = enabled ? !enabled(s) : false;
    });
    return row;
}

/** Yes or no; more(checked) gives the values that change with it. */
export function check(key, words, { show, more = () => ({}) } = {}) {
    const box = make("input", { type: "checkbox", onchange: () => change({ [key]: box.checked, ...more(box.checked) }) });
    const row = make("label", { class: "check" }, box, text(words));
    hidable(row, show);
    onUpdate((s) => { box.checked = s[key]; });
    return row;
}

const option = ([value, label]) => make("option", { value }, label);

/** A choice among [value, label], or among groups [name, [[value, label], ...]]. */
export function menu(key, words, choices, { show, set = (value) => change({ [key]: value }), value = (s) => s[key] } = {}) {
    const id = freshId(key);
    const select = make("select", { id, onchange: () => set(select.value) },
        choices.map((choice) => (Array.isArray(choice[1]) ? make("optgroup", { label: choice[0] }, choice[1].map(option)) : option(choice))));
    const row = make("div", { class: "field" }, make("label", { for: id }, text(words)), select);
    hidable(row, show);
    onUpdate((s) => { select.value = value(s); });
    return row;
}

/** A button that opens the file picker. */
export function picker(words, accept, take, main) {
    const input = make("input", { type: "file", class: "hidden-input", id: freshId("file"), accept,
        onchange: () => { for (const file of input.files) take(file); input.value = ""; } });
    return [make("label", { class: main ? "button main" : "button", for: input.id }, text(words)), input];
}

/** Words that follow the state. */
export function note(words, show) {
    const line_ = make("p", { class: "hint" });
    onUpdate((s) => { line_.textContent = words(s); line_.hidden = show ? !show(s) : line_.textContent === ""; });
    return line_;
}

export const group = (words, ...children) => make("fieldset", {}, make("legend", {}, text(words)), ...children);
