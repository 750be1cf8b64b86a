// What can be laid over the picture, of which files of a run it is made, and what its colours mean.
//
// Colours are told apart with every common colour blindness by lightness as well as by hue, on light solid and dark void.

import { bytesOf, combined, given, marksOf, plain, tabled } from "./compose.js";

export const SOLID = [239, 233, 223], VOID = [39, 38, 44];
const MISSING = [214, 69, 48], EXCESS = [250, 204, 40], BRIDGE = [42, 120, 180], THICKENED = [112, 176, 214], WIDENED = [200, 90, 160],
    LOST_SOLID = [214, 69, 48], LOST_VOID = [250, 170, 40], CONFLICT = [150, 90, 200];
const REACH_PX = 2; // lines of one pixel are drawn so much wider to each side, to be seen

// By was, is, mark: what the picture and the mask say of a pixel, and the layer of that overlay.
const CHANGES = [VOID, VOID, THICKENED, BRIDGE, WIDENED, WIDENED, SOLID, SOLID];

// By was, lost solid, lost void: either grows over what is beside it.
const LOSSES = [VOID, LOST_VOID, LOST_SOLID, LOST_SOLID, SOLID, LOST_VOID, LOST_SOLID, LOST_SOLID];

async function paintLost({ width, height, input }, layer) {
    const [lost, was] = await Promise.all([layer("lost.png"), layer("input.png")]);
    const solid = combined(lost, was, "multiply"), hollow = combined(lost, solid, "difference");
    return tabled(width, height, [input, ...[solid, hollow].map((marks) => marksOf(marks, width, height, REACH_PX))], LOSSES);
}

const mark = async (layer, name, width, height, reach) => marksOf(await layer(name), width, height, reach);

/** In the order of the menu. paint(pictures, layer) makes a canvas, where layer(name) gives a file of the run as an ImageBitmap;
 *  quick(pictures) one at once, before there is a whole run. */
export const OVERLAYS = [
    { name: "none", words: "overlayNone", keys: [] },
    { name: "change", words: "overlayChange", keys: [["bridge", BRIDGE], ["thickened", THICKENED], ["widened", WIDENED]],
        quick: ({ width, height, input, mask }) => tabled(width, height, [input, mask], [VOID, THICKENED, WIDENED, SOLID]),
        paint: async ({ width, height, input, mask }, layer) => tabled(width, height, [input, mask, await mark(layer, "bridges.png", width, height, 0)], CHANGES) },
    { name: "lost", words: "overlayLost", keys: [["lostSolid", LOST_SOLID], ["lostVoid", LOST_VOID]],
        paint: paintLost },
    { name: "conflict", words: "overlayConflict", keys: [["conflictKey", CONFLICT]],
        paint: async ({ width, height, mask }, layer) => tabled(width, height, [mask, await mark(layer, "conflicts.png", width, height, 1)], [VOID, CONFLICT, SOLID, CONFLICT]) },
    { name: "print", words: "overlayPrint", keys: [],
        paint: async ({ width, height }, layer) => plain(width, height, await mark(layer, "print.png", width, height, 0), VOID, SOLID) },
    { name: "error", words: "overlayError", keys: [["missing", MISSING], ["excess", EXCESS]],
        paint: async ({ width, height }, layer) => given(width, height, bytesOf(await layer("errors.png"), width, height, true)) },
];
