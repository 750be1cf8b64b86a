// What the user has chosen: one plain object, its history, and its form in the address.

export const DEFAULTS = Object.freeze({
    sample: "girih", // "" when the picture is the user's own
    threshold: "auto", invert: false, rotate: 0,
    width: 70, frame: 2, thickness: 4,
    printer: "hori-z500", "phi-e": 0.1, "phi-s": 0.3, "phi-v": 0.5, nudge: false,
    surface: "plate", radius: 40, height: 120,
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
    for (const [key, value] of Object.entries(now)) if (value !== DEFAULTS[key]) parts.set(key, String(value));
    history.replaceState(null, "", `${location.pathname}#${parts}`);
}

/** Take what the address says; values of the wrong kind are left out. */
export function readAddress() {
    const parts = new URLSearchParams(location.hash.slice(1));
    const values = {};
    for (const [key, value] of parts) {
        const kind = typeof DEFAULTS[key];
        if (kind === "number" && Number.isFinite(Number(value))) values[key] = Number(value);
        if (kind === "boolean") values[key] = value === "true";
        if (kind === "string") values[key] = value;
    }
    now = { ...DEFAULTS, ...values };
}

const SHAPES = {
    plate: () => "plate",
    cylinder: (s) => `cylinder:r=${s.radius},h=${s.height}`,
    vase: (s) => `vase:r=${s.radius},h=${s.height}`,
    cone: (s) => `cone:r=${s.radius},top=${s.radius / 2},h=${s.height}`,
    sphere: (s) => `sphere:r=${s.radius}`,
};

/** The command line's options that make this, by name. */
export function options(s = now) {
    const out = { width: s.width, frame: s.frame, thickness: s.thickness };
    if (s.threshold !== "auto") out.threshold = s.threshold;
    if (s.invert) out.invert = true;
    if (s.rotate) out.rotate = s.rotate;
    if (s.printer) out.printer = s.printer;
    else for (const key of ["phi-e", "phi-s", "phi-v"]) out[key] = s[key];
    if (s.nudge) out.nudge = 3;
    if (SHAPES[s.surface] && s.surface !== "plate") out.surface = SHAPES[s.surface](s);
    if (s.force > 0) Object.assign(out, { force: s.force, material: s.material });
    return Object.fromEntries(Object.entries(out).map(([key, value]) => [key, String(value)]));
}

const quoted = (word) => (/^[\w.,:=/+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/** The same as one line for a shell. */
export function commandLine(picture) {
    const words = ["jali", "carve", quoted(picture)];
    for (const [key, value] of Object.entries(options()))
        words.push(value === "true" ? `--${key}` : `--${key} ${quoted(value)}`);
    return [...words, "-o", quoted(picture.replace(/\.\w+$/, "") + ".3mf")].join(" ");
}
