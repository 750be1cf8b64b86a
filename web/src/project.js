// A project as one file: all that was chosen, with the picture and the model inside (docs/serve.md, "Project files").
//
// JSON with the files' bytes as base64: a person can read what was chosen, and it needs no library. What comes in
// is checked: a file of another kind, or one that lacks something, ends in a sentence and changes nothing.

import * as api from "./api.js";
import { pictureOf } from "./files.js";
import { valuesFrom } from "./state.js";
import { text } from "./strings.js";

const VERSION = 1, SUFFIX = ".jali";

export const isProject = (name) => name.toLowerCase().endsWith(SUFFIX);

async function base64(blob) {
    const reader = new FileReader();
    const read = new Promise((resolve, reject) => {
        reader.onload = () => resolve(reader.result);
        reader.onerror = () => reject(reader.error);
    });
    reader.readAsDataURL(blob);
    const url = await read;
    return url.slice(url.indexOf(",") + 1);
}

function bytesOf(words) {
    const binary = atob(words), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
    return bytes;
}

const packed = async (id, name) => ({ name, base64: await base64(await api.uploaded(id)) });

/** The project as a Blob, and what its file is called. A sample is kept by its name. */
export async function saved(s) {
    const picture = await pictureOf(s), files = {};
    if (!s.sample && s.upload) files.picture = await packed(s.upload, s.uploadName);
    if (s.mesh) files.mesh = await packed(s.mesh, s.meshName);
    const { upload, mesh, ...chosen } = s; // ids are this server's
    const json = JSON.stringify({ jali_project: VERSION, state: chosen, files }, null, 1);
    return { blob: new Blob([json], { type: "application/json" }), name: (picture?.name ?? text("project")).replace(/\.\w+$/, "") + SUFFIX };
}

const refuse = (name, key, values) => { throw new api.Refusal(text(key, { name, ...values })); };

function parsed(name, words) {
    let project;
    try {
        project = JSON.parse(words);
    } catch {
        refuse(name, "projectNoJson");
    }
    if (typeof project?.jali_project !== "number") refuse(name, "projectNone");
    if (project.jali_project !== VERSION) refuse(name, "projectNewer", { version: project.jali_project });
    if (typeof project.state !== "object" || project.state === null) refuse(name, "projectLacks", { what: "state" });
    return project;
}

async function unpacked(name, files, kind) {
    const file = files?.[kind];
    if (typeof file?.base64 !== "string" || file.base64 === "") refuse(name, "projectLacks", { what: `files.${kind}` });
    let bytes;
    try {
        bytes = bytesOf(file.base64);
    } catch {
        refuse(name, "projectBytes", { what: `files.${kind}` });
    }
    return api.upload(new Blob([bytes]));
}

/** What the whole state becomes by a project file. */
export async function opened(file) {
    const { state, files } = parsed(file.name, await file.text());
    const values = valuesFrom(state);
    values.upload = values.sample ? "" : await unpacked(file.name, files, "picture");
    values.mesh = files?.mesh ? await unpacked(file.name, files, "mesh") : "";
    return values;
}
