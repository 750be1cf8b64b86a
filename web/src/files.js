// Files that come in: dropped, picked or pasted; which of them is the picture.

import * as api from "./api.js";

const SVG_PX = 2000;
const samples = new Map(); // name -> the promise of an upload's id

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

/** Give a picture to the server: its id. */
export async function uploadPicture(file) {
    return api.upload(file.type === "image/svg+xml" ? await drawn(file) : file);
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
    return s.upload ? { id: s.upload, name: s.uploadName || "picture" } : null;
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
