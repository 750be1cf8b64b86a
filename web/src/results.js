// The result bar: four promises with a reason each, what prints wrong, what to download.

import { make } from "./dom.js";
import { text } from "./strings.js";

const percent = (share) => (100 * share).toFixed(share < 0.1 ? 2 : 1);
const short = (value) => Number(value.toPrecision(3));

function promise(words, kept, why) {
    const word = kept === null ? "notAsked" : kept ? "kept" : "broken";
    return make("li", { class: `promise ${word}` },
        make("span", { class: "mark", "aria-hidden": "true" }, kept === null ? "–" : kept ? "✓" : "✕"),
        make("span", { class: "what" }, `${text(words)}: ${text(word)}`), make("span", { class: "why" }, why));
}

function promises(f) {
    const p = f.promises, rounds = f.structure?.rounds ?? [], last = rounds[rounds.length - 1];
    return make("ul", { class: "promises" },
        promise("onePiece", p.one_piece, text("onePieceWhy", { pieces: f.input.white_components, bridges: f.connect.bridges })),
        promise("printable", p.printable, text("printableWhy", { solid: short(f.printer.phi_s_mm), hollow: short(f.printer.phi_v_mm) })),
        promise("closed", p.closed, f.mesh ? text("closedWhy", { triangles: f.mesh.triangles.toLocaleString() }) : ""),
        promise("sound", p.sound, last ? text("soundWhy", { stress: short(last.max_stress_mpa), limit: short(f.structure.limit_mpa) }) : ""));
}

function errors(predict) {
    if (!predict) return null;
    const rows = [["errorAsIs", predict.error_rate_input], ["errorConnected", predict.error_rate_connected], ["errorResult", predict.error_rate_result]];
    const most = Math.max(...rows.map(([, rate]) => rate), 1e-9);
    return make("dl", { class: "errors" }, rows.map(([words, rate]) => {
        const bar = make("span", { class: "bar", "aria-hidden": "true" });
        bar.style.width = `${Math.max(2, (100 * rate) / most)}%`;
        return [make("dt", {}, text(words)), make("dd", {}, bar, text("wrong", { percent: percent(rate) }))];
    }));
}

/** Show the figures of a run (docs/json.md) and its files.
 *  download(name) is called for a file that the user wants. */
export function showResults(root, figures, materials, material, download) {
    const grams = (figures.mesh?.volume_mm3 / 1000) * (materials.find((m) => m.name === material)?.density_g_cm3 ?? 1.24);
    root.replaceChildren(
        promises(figures), errors(figures.predict) ?? "",
        figures.mesh ? make("p", { class: "volume" }, text("volume", { volume: short(figures.mesh.volume_mm3 / 1000), weight: short(grams) })) : "",
        make("div", { class: "downloads", role: "group", "aria-label": text("download") },
            [["object.3mf", "3MF"], ["object.stl", "STL"], ["outline.svg", "SVG"], ["outline.dxf", "DXF"], ["mask.png", "PNG"], ["report.html", text("report")]]
                .filter(([name]) => !(figures.surface && /svg|dxf/.test(name)))
                .map(([name, label], i) => make("button", { type: "button", class: i === 0 ? "main" : "", "data-file": name, onclick: () => download(name) },
                    i === 0 ? `${text("download")} ${label}` : label))));
}
