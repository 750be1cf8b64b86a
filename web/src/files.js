// Files that come in: dropped, picked or pasted. What a file is, and what the state becomes by it.

import * as api from "./api.js";
import { run } from "./runs.js";
import { state } from "./state.js";
import { text } from "./strings.js";

export const PICTURES = "image/png,image/jpeg,image/webp,image/svg+xml,.pbm,.pgm,.ppm";
export const PROFILES = ".json,.ini,.gcode";
export const MODELS = ".stl,.obj,.ply,.off,.3mf";
const SVG_PX = 2000, THUMBNAIL_PX = 88;
const samples = new Map(); // name -> the promise of an upload's id
const thumbnails = new Map(); // name -> the promise of a URL
const greys = new Map(); // id of a picture -> the promise of an ImageBitmap

const has = (list, name) => list.split(",").some((suffix) => name.toLowerCase().endsWith(suffix));

// An SVG is drawn here: the program's shut-in processes load no fonts.
async function drawn(blob) {
    const image = new Image();
    image.src = URL.createObjectURL(blob);
    await image.decode();
    const width = image.naturalWidth || 1000, height = image.naturalHeight || 1000, scale = SVG_PX / Math.max(width, height);
    const canvas = new OffscreenCanvas(Math.round(width * scale), Math.round(height * scale));
    const context = canvas.getContext("2d");
    context.fillStyle = "#fff";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    URL.revokeObjectURL(image.src);
    return canvas.convertToBlob({ type: "image/png" });
}

// A slicer's configuration becomes a profile of ours in full, so that it needs no other file.
async function readProfile(file) {
    const name = file.name === "printer.json" ? "profile.json" : file.name; // what the server calls its own
    const id = await run({ picture: await api.upload(file), name, verb: "printer", files: ["printer.json"] }, "printer");
    const profile = await (await api.file(id, "printer.json")).json();
    return { printer: "file", profile: JSON.stringify(profile), profileName: file.name };
}

/** What the state becomes by a file, as values for change(); fails with the program's sentence. */
export async function taken(file) {
    if (has(PROFILES, file.name)) return readProfile(file);
    if (has(MODELS, file.name)) return { surface: "mesh", mesh: await api.upload(file), meshName: file.name, at: "", dir: "" };
    const svg = file.type === "image/svg+xml" || has(".svg", file.name);
    return { sample: "", upload: await api.upload(svg ? await drawn(file) : file), uploadName: file.name, crop: "", edits: "" };
}

/** A small sample to show in the gallery, as a URL. */
export function sampleUrl(name) {
    if (!thumbnails.has(name)) thumbnails.set(name, api.sample(name, THUMBNAIL_PX).then((blob) => URL.createObjectURL(blob)));
    return thumbnails.get(name);
}

function sampleId(name) {
    if (!samples.has(name)) {
        const id = api.sample(name).then((blob) => api.upload(blob));
        id.catch(() => samples.delete(name));
        samples.set(name, id);
    }
    return samples.get(name);
}

/** The picture that the state names, {id, name}, or null. */
export async function pictureOf(s) {
    if (s.sample) return { id: await sampleId(s.sample), name: `${s.sample}.png` };
    return s.upload ? { id: s.upload, name: s.uploadName || text("picture") } : null;
}

/** The whole picture in grey as the program reads it, an ImageBitmap. */
export async function greyOf(picture) {
    if (!greys.has(picture.id)) {
        const grey = run({ picture: picture.id, name: picture.name, verb: "read", files: ["grey.png"] }, "grey")
            .then((id) => api.file(id, "grey.png")).then((answer) => answer.blob()).then((blob) => createImageBitmap(blob));
        grey.catch(() => greys.delete(picture.id));
        greys.clear(); // one is enough
        greys.set(picture.id, grey);
    }
    return greys.get(picture.id);
}

/** The grey levels of the part that is kept: levels.json of docs/cli.md. */
export async function levelsOf(picture, signal) {
    const { crop, invert } = state(), options = { ...(crop ? { crop } : {}), ...(invert ? { invert } : {}) };
    const id = await run({ picture: picture.id, name: picture.name, verb: "read", options, files: ["levels.json"] }, "levels", signal);
    return (await api.file(id, "levels.json", signal)).json();
}

/** Call take(file) for each file that is dropped or pasted anywhere; `cover` shows while one hovers. */
export function listenForFiles(cover, take) {
    addEventListener("dragover", (event) => { event.preventDefault(); cover.hidden = false; });
    addEventListener("dragleave", (event) => { if (!event.relatedTarget) cover.hidden = true; });
    addEventListener("drop", (event) => {
        event.preventDefault();
        cover.hidden = true;
        for (const file of event.dataTransfer.files) take(file);
    });
    addEventListener("paste", (event) => { for (const file of event.clipboardData.files) take(file); });
}
