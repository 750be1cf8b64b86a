// The result bar: four promises with a reason each, what prints wrong and what is lost, facts, what to download.

import { make } from "./dom.js";
import { text } from "./strings.js";

const percent = (share) => (100 * share).toFixed(share < 0.1 ? 2 : 1);
const short = (value) => Number(value.toPrecision(3));
const DOWNLOADS = [["object.3mf", "3MF"], ["object.stl", "STL"], ["outline.svg", "SVG"], ["outline.dxf", "DXF"], ["mask.png", "PNG"], ["report.html", "report"]];

function promise(words, kept, why) {
    const word = kept === null ? "notAsked" : kept ? "kept" : "broken";
    return make("li", { class: `promise ${word}` },
        make("span", { class: "mark", "aria-hidden": "true" }, kept === null ? "–" : kept ? "✓" : "✕"),
        make("span", { class: "what" }, `${text(words)}: ${text(word)}`), make("span", { class: "why" }, why));
}

// --- Why each promise is kept, or is not

function whyOnePiece(f) {
    if (f.promises.one_piece) return text("onePieceWhy", { pieces: f.input.white_components, bridges: f.connect.bridges });
    return text("onePieceNot", { pieces: Math.max(f.mesh?.components ?? 0, f.predict?.result.pieces ?? 0) });
}

function whyPrintable(f) {
    const left = f.adapt.residual, narrow = left.white.A + left.white.B + left.black.A + left.black.B;
    const widths = { solid: short(f.printer.phi_s_mm), hollow: short(f.printer.phi_v_mm) };
    return f.promises.printable ? text("printableWhy", widths) : text("printableNot", { count: narrow, ...widths });
}

function whyClosed(f) {
    if (!f.mesh) return "";
    return f.promises.closed ? text("closedWhy", { triangles: f.mesh.triangles.toLocaleString() }) : text("closedNot", { count: f.mesh.self_intersections });
}

function whySound(f) {
    const s = f.structure, last = s?.rounds.at(-1);
    if (!last) return text("soundHow");
    const stress = text("soundWhy", { stress: short(last.max_stress_mpa), limit: short(s.limit_mpa) });
    if (!s.advice) return stress;
    const { thickness_mm: thick, material, load_share: share } = s.advice;
    return [stress, thick ? text("adviceThickness", { thickness: short(thick) }) : "", material ? text("adviceMaterial", { material }) : "",
        share ? text("adviceLoad", { percent: Math.floor(100 * share) }) : ""].filter(Boolean).join(" ");
}

const promises = (f) => make("ul", { class: "promises" },
    promise("onePiece", f.promises.one_piece, whyOnePiece(f)), promise("printable", f.promises.printable, whyPrintable(f)),
    promise("closed", f.promises.closed, whyClosed(f)), promise("sound", f.promises.sound, whySound(f)));

// --- What the print is like

function errors(predict) {
    if (!predict) return "";
    const rows = [["errorAsIs", predict.error_rate_input], ["errorConnected", predict.error_rate_connected], ["errorResult", predict.error_rate_result]];
    const most = Math.max(...rows.map(([, rate]) => rate), 1e-9);
    return make("section", {}, make("h2", {}, text("errorHead")), make("dl", { class: "errors" }, rows.map(([words, rate], i) => {
        const bar = make("span", { class: i === 2 ? "bar" : "bar before", "aria-hidden": "true" });
        bar.style.width = `${Math.max(2, (100 * rate) / most)}%`;
        return make("div", {}, make("dt", {}, text(words)), make("dd", {}, text("percent", { percent: percent(rate) })), bar);
    })));
}

const sum = (tone) => tone.parts + tone.stretches;

function lost(predict, smallest) {
    const found = predict?.lost, all = found ? sum(found.white) + sum(found.black) : 0;
    const counts = !found ? [] : [["lostParts", found.white.parts], ["lostVoids", found.black.parts],
        ["lostLines", found.white.stretches + found.black.stretches]];
    const what = counts.filter(([, count]) => count > 0).map(([key, count]) => text(key, { count })).join(text("listComma"));
    const words = !found ? "" : all === 0 ? text("lostNothing") : text("lostSome", { what });
    return make("section", {}, make("h2", {}, text("lostHead")), make("p", { class: "figure-words" }, words), smallest);
}

// What edits by hand cost.
function prices(edits) {
    const words = [["left_out", "leftOut"], ["loose", "looseParts"], ["locked_details", "lockedDetails"]];
    return words.filter(([key]) => edits?.[key] > 0).map(([key, sentence]) => make("p", { class: "price" }, text(sentence, { count: edits[key] })));
}

function facts(f, density) {
    const volume = (f.mesh?.volume_mm3 ?? 0) / 1000, rows = [
        ["factSize", `${short(f.size_mm[0])} × ${short(f.size_mm[1])} ${text("mm")}`],
        ["factWeight", text("volume", { volume: short(volume), weight: short(volume * density) })],
        ["factPieces", text("piecesNow", { before: f.input.white_components, dropped: f.connect.pieces_dropped })],
        ["factBridges", f.connect.bridges],
        f.structure ? ["factConnectors", Array.isArray(f.structure.connectors) ? f.structure.connectors.length : f.structure.connectors] : null,
        ["factTime", `${f.seconds.total.toFixed(2)} s`],
    ];
    return make("dl", { class: "facts" }, rows.filter(Boolean).map(([words, value]) => make("div", {}, make("dt", {}, text(words)), make("dd", {}, String(value)))));
}

const downloads = (flat, download) => make("div", { class: "downloads", role: "group", "aria-label": text("download") },
    DOWNLOADS.filter(([name]) => flat || !/svg|dxf/.test(name)).map(([name, label], i) => make("button",
        { type: "button", class: i === 0 ? "main" : "", "data-file": name, onclick: () => download(name) },
        i === 0 ? `${text("download")} ${label}` : label === "report" ? text("report") : label)));

/** Show the figures of a run (docs/json.md) and its files; `smallest` is a node of its own.
 *  download(name) is called for a file that the user wants. */
export function showResults(root, figures, { density, smallest, download }) {
    root.replaceChildren(promises(figures), ...prices(figures.edits), errors(figures.predict), lost(figures.predict, smallest),
        facts(figures, density), downloads(!figures.surface, download));
}
