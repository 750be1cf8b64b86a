// What the user has chosen: one plain object, its history, and its form in the address.

import { editsOf, jsonOf } from "./edits.js";

const MOST_ADDRESS_CHARACTERS = 1500; // of edits: longer ones stay in the state and in project files
export const MOST_COPIES = 60;

export const DEFAULTS = Object.freeze({
    sample: "girih", // "" when the picture is the user's own, and then
    upload: "", uploadName: "", // the server's id of it, and its file's name
    threshold: "auto", window: 0, contrast: 0.2, // auto, local or 1 .. 255; of local: its window in px (0: it chooses), its contrast
    crop: "", // left,top,width,height in the picture's own pixels, before it is turned; "" = all of it
    edits: "", // by hand, as edits.js has them
    invert: false, mirror: false, rotate: 0,
    width: 70, frame: 2, thickness: 4,
    printer: "hori-z500", "phi-e": 0.1, "phi-s": 0.3, "phi-v": 0.5, nudge: false, // "": the three figures; "file":
    profile: "", profileName: "", // a profile of one's own, as JSON, and its file's name
    surface: "plate", radius: 40, height: 120, // "mesh":
    mesh: "", meshName: "", meshHeight: 0, meshUp: "z", meshTurn: 0, // an upload, its file's name; height in mm (0: as it is)
    around: false, repeat: 1, // all around a round shape, so many copies
    place: "auto", at: "", dir: "", // auto, project or wrap; "x,y,z" in mm and as a direction, "" = found
    force: 0, material: "pla",
});

const listeners = new Set();
let now = { ...DEFAULTS };
let past = [];
let future = [];
let lastKey = "";
let lastTime = 0;

export const state = () => now;
export const canUndo = () => past.length > 0;
export const canRedo = () => future.length > 0;
export const onChange = (listener) => listeners.add(listener);

function tell(keys) {
    writeAddress();
    for (const listener of listeners) listener(now, keys);
}

/** Change some values. Quick changes of one value, as a slider makes them, are one step of the history. */
export function change(values) {
    const keys = Object.keys(values).filter((key) => now[key] !== values[key]);
    if (keys.length === 0) return;
    const time = performance.now(), key = keys.join();
    if (key !== lastKey || time - lastTime > 800) past.push(now);
    lastKey = key;
    lastTime = time;
    future = [];
    now = { ...now, ...values };
    tell(keys);
}

function travel(from, to) {
    if (from.length === 0) return;
    to.push(now);
    now = from.pop();
    lastKey = "";
    tell(Object.keys(now));
}

export const undo = () => travel(past, future);
export const redo = () => travel(future, past);

function writeAddress() {
    const parts = new URLSearchParams();
    for (const [key, value] of Object.entries(now)) {
        if (value === DEFAULTS[key] || (key === "edits" && value.length > MOST_ADDRESS_CHARACTERS)) continue;
        parts.set(key, String(value));
    }
    history.replaceState(null, "", `${location.pathname}#${parts}`);
}

/** A whole state from values by name, as texts or not; those of the wrong kind or of no name are left out. */
export function valuesFrom(given) {
    const values = {};
    for (const [key, standard] of Object.entries(DEFAULTS)) {
        const value = Object.hasOwn(given, key) ? given[key] : null, kind = typeof standard;
        if (value === null || typeof value === "object") continue;
        if (kind === "number" && value !== "" && Number.isFinite(Number(value))) values[key] = Number(value);
        if (kind === "boolean") values[key] = String(value) === "true";
        if (kind === "string") values[key] = String(value);
    }
    return { ...DEFAULTS, ...values };
}

/** Take what the address says. */
export function readAddress() {
    now = valuesFrom(Object.fromEntries(new URLSearchParams(location.hash.slice(1))));
}

const SHAPES = {
    plate: () => "plate",
    cylinder: (s) => `cylinder:r=${s.radius},h=${s.height}`,
    vase: (s) => `vase:r=${s.radius},h=${s.height}`,
    cone: (s) => `cone:r=${s.radius},top=${s.radius / 2},h=${s.height}`,
    sphere: (s) => `sphere:r=${s.radius}`,
};

const CLOSED = ["cylinder", "vase", "sphere"]; // once around they meet themselves

export const canGoAround = (s) => CLOSED.includes(s.surface);

/** Whether the picture goes all around: it then has the size that this gives it, and no place, load or edits by hand. */
export const goesAround = (s) => s.around && canGoAround(s);

/** How many copies go around so that they are no higher than the shape; aspect: a picture's height over its width. */
export function copiesAround(s, aspect) {
    const high = s.surface === "sphere" ? 2.2 * s.radius : s.height;
    return Math.max(1, Math.min(MOST_COPIES, Math.ceil((2 * Math.PI * s.radius * aspect) / Math.max(high - 2 * s.frame, 1))));
}

// A model that was uploaded is called so in a job (docs/serve.md), and by its own name on the command line.
function meshSurface(s, name) {
    const words = [["height", s.meshHeight || ""], ["up", s.meshUp === "z" ? "" : s.meshUp], ["turn", s.meshTurn || ""],
        ["texture", s.place === "wrap" ? "no" : ""]]; // laid flat where one drags it, not where a texture would lie
    return [name, words.filter(([, value]) => value !== "").map(([key, value]) => `${key}=${value}`).join()].filter(Boolean).join(":");
}

/** What is done to the picture before anything else, as the command line's options. */
export function pictureOptions(s = now) {
    const out = {};
    for (const key of ["crop", "invert", "mirror", "rotate"]) if (s[key]) out[key] = String(s[key]);
    if (s.threshold !== "auto") out.threshold = s.threshold;
    if (s.threshold === "local" && s.window) out.window = String(s.window);
    if (s.threshold === "local") out.contrast = String(s.contrast);
    return out;
}

/** The command line's options that make this, by name. */
export function options(s = now, meshName = "model.mesh", profileName = "") {
    const out = { ...pictureOptions(s), width: s.width, frame: s.frame, thickness: s.thickness };
    if (s.printer === "file") { if (profileName) out.printer = profileName; }
    else if (s.printer) out.printer = s.printer;
    else for (const key of ["phi-e", "phi-s", "phi-v"]) out[key] = s[key];
    if (s.nudge) out.nudge = 3;
    if (s.surface === "mesh" && s.mesh) out.surface = meshSurface(s, meshName);
    else if (SHAPES[s.surface] && s.surface !== "plate") out.surface = SHAPES[s.surface](s);
    if (goesAround(s)) {
        for (const key of ["width", "nudge"]) delete out[key];
        Object.assign(out, { around: "true" }, s.repeat > 1 ? { repeat: s.repeat } : {});
    } else if (out.surface) {
        if (s.place !== "auto") out.place = s.place;
        for (const key of ["at", "dir"]) if (s[key]) out[key] = s[key];
    }
    if (s.force > 0 && !goesAround(s)) Object.assign(out, { force: s.force, material: s.material });
    return Object.fromEntries(Object.entries(out).map(([key, value]) => [key, String(value)]));
}

/** The profile of one's own as an object; null when there is none, or what the address says is none. */
export function profileOf(s = now) {
    try {
        const profile = JSON.parse(s.profile);
        return typeof profile === "object" ? profile : null;
    } catch {
        return null;
    }
}

/** A job's keys that say what to make of a picture: docs/serve.md, without verb and files. */
export function job(picture, s = now) {
    const edits = goesAround(s) ? null : jsonOf(editsOf(s.edits));
    return { picture: picture.id, name: picture.name, options: options(s), ...(edits ? { edits } : {}),
        ...(s.surface === "mesh" && s.mesh ? { mesh: s.mesh } : {}), ...(s.printer === "file" && profileOf(s) ? { printer: profileOf(s) } : {}) };
}

const quoted = (word) => (/^[\w.,:=/+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/** The same as one line for a shell. */
export function commandLine(picture) {
    const words = ["jali", "carve", quoted(picture)];
    for (const [key, value] of Object.entries(options(now, now.meshName, now.profileName)))
        words.push(value === "true" ? `--${key}` : `--${key} ${quoted(value)}`);
    if (now.edits && !goesAround(now)) words.push("--edits edits.json");
    return [...words, "-o", quoted(picture.replace(/\.\w+$/, "") + ".3mf")].join(" ");
}
