// The first preview: the picture as it will be cut, soon after a slider stops; the whole run refines it.
//
// How:     the same method on a coarser working grid when the full one took long, else on the full one. The files are asked
//          for at once and come when they are made; the picture in black and white only when it is another.
// Reaches: 200 ms for a picture of 1 Mpixel, from the last move of a slider to the drawn canvas (web/bench/preview.mjs).

import { pictureOf } from "./files.js";
import { filesOf } from "./runs.js";
import { job, pictureOptions } from "./state.js";

const COARSE = "4", LONG_MS = 110, SHORT_MS = 35; // working pixels across the narrowest feature; when to take them, and no more
const NOT_SEEN = ["force", "material", "nudge", "thickness"]; // what a picture does not depend on

let coarse = true;
let shown = { key: "", input: null };
const mark = (name) => performance.mark(`preview:${name}`);

/** The pictures of a preview, {input, mask} as ImageBitmaps; null when there is no picture. */
export async function preview(state, signal) {
    const began = performance.now(), picture = await pictureOf(state);
    if (!picture) return null;
    mark("asked");
    const request = job(picture, state), key = JSON.stringify([picture.id, pictureOptions(state)]);
    for (const name of NOT_SEEN) delete request.options[name];
    Object.assign(request.options, { "no-predict": "true" }, coarse ? { grid: COARSE } : {});
    const files = await filesOf({ ...request, verb: "adapt", files: key === shown.key ? ["mask.png"] : ["mask.png", "input.png"] }, "preview", signal);
    const [mask, input] = await Promise.all(files.map(async (file) => createImageBitmap(await file.blob())));
    mark("made");
    shown = { key, input: input ?? shown.input };
    const took = performance.now() - began;
    coarse = coarse ? took > SHORT_MS : took > LONG_MS;
    return { input: shown.input, mask };
}
