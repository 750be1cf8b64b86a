// The colours of stress and displacement: what they stand for, in figures.

import { make } from "./dom.js";
import { text } from "./strings.js";

// As jali_map_colour has them (include/jali/map.h): violet to yellow up to the limit, orange to dark red beyond.
const WITHIN = ["rgb(68 1 84)", "rgb(59 82 139)", "rgb(33 145 140)", "rgb(94 201 98)", "rgb(253 231 37)"];
const BEYOND = ["rgb(252 141 40)", "rgb(214 33 32)", "rgb(90 0 12)"];
const BELOW_LIMIT = 0.6; // of the bar, when there is more than the limit

const short = (value) => Number(value.toPrecision(3)).toString();
const stops = (colours, from, to) => colours.map((colour, i) => `${colour} ${100 * (from + ((to - from) * i) / (colours.length - 1))}%`);

/** What a layer shows of a structure (docs/json.md): its unit, largest value, where that is, and the limit. */
export function quantityOf(structure, layer) {
    const last = structure.rounds[structure.rounds.length - 1];
    if (layer === "stress")
        return { unit: "MPa", most: last.max_stress_mpa, at: structure.max_stress_at_mm, limit: structure.limit_mpa };
    return { unit: text("mm"), most: last.max_displacement_mm, at: structure.max_displacement_at_mm, limit: 0 };
}

/** A card with the scale of a layer. */
export function legendOf(structure, layer) {
    const { unit, most, limit } = quantityOf(structure, layer), beyond = limit > 0 && most > limit;
    const top = limit > 0 ? Math.max(limit, most) : most, split = beyond ? BELOW_LIMIT : 1;
    const bar = make("div", { class: "scale", "aria-hidden": "true" });
    bar.style.background = `linear-gradient(to right, ${[...stops(WITHIN, 0, split), ...(beyond ? stops(BEYOND, split, 1) : [])].join()})`;
    const tick = (share, value, kind = "") => {
        const mark = make("span", { class: `tick ${kind}` }, value);
        mark.style.left = `${100 * share}%`;
        return mark;
    };
    const ticks = [tick(0, "0", "first")];
    if (beyond) ticks.push(tick(split, short(limit), "limit"), tick(1, short(top), "last"));
    else ticks.push(tick(0.5, short(top / 2)), tick(1, short(top), limit > 0 ? "last limit" : "last"));
    return make("div", { class: "card scale-card" },
        make("p", {}, text(layer === "stress" ? "stressIn" : "displacementIn", { unit })),
        bar, make("div", { class: "ticks" }, ticks),
        make("p", { class: beyond ? "bad" : "" }, layer === "stress"
            ? text(beyond ? "aboveLimit" : "belowLimit", { most: short(most), limit: short(limit), unit })
            : text("largestMove", { most: short(most), unit })));
}
