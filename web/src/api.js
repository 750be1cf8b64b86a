// The server's HTTP interface (docs/serve.md), and nothing else of it.

const BASE = "/api/v1";
const given = takeGiven();
const token = given.token ?? sessionStorage.getItem("jali-token") ?? "";
if (given.token) sessionStorage.setItem("jali-token", given.token);

// What the program put into the address: the token, and the picture of its command line. Both are taken out.
function takeGiven() {
    const parts = new URLSearchParams(location.hash.slice(1)), found = {};
    for (const key of ["token", "picture", "name"]) {
        if (parts.has(key)) found[key] = parts.get(key);
        parts.delete(key);
    }
    history.replaceState(null, "", `${location.pathname}#${parts}`);
    return found;
}

/** The picture that was named on the command line, {id, name}, or null. */
export const givenPicture = () => (given.picture ? { id: given.picture, name: given.name ?? "picture" } : null);

/** What the server refused, with its own sentence. */
export class Refusal extends Error {}

async function call(path, options = {}) {
    const response = await fetch(BASE + path, {
        ...options,
        headers: { ...options.headers, "X-Jali-Token": token },
    });
    if (response.ok) return response;
    const answer = await response.json().catch(() => ({}));
    throw new Refusal(answer.error?.message ?? `${response.status} ${response.statusText}`);
}

export const lists = () => call("/lists").then((r) => r.json());
export const sample = (name, size = 1000) => call(`/samples/${encodeURIComponent(name)}.png?size=${size}`).then((r) => r.blob());

export async function upload(blob, signal) {
    const response = await call("/uploads", {
        method: "POST", body: blob, signal, headers: { "Content-Type": "application/octet-stream" },
    });
    return (await response.json()).id;
}

/** The bytes of an upload again. */
export const uploaded = (id) => call(`/uploads/${id}`).then((r) => r.blob());

export async function start(request, signal) {
    const response = await call("/jobs", {
        method: "POST", body: JSON.stringify(request), signal, headers: { "Content-Type": "application/json" },
    });
    return (await response.json()).id;
}

export const stop = (id) => call(`/jobs/${id}`, { method: "DELETE" }).catch(() => {});
export const file = (id, name, signal) => call(`/jobs/${id}/files/${name}`, { signal });

/** The same as soon as it is made. */
export async function fileWhenMade(id, name, signal) {
    for (;;) {
        const response = await call(`/jobs/${id}/files/${name}?wait=1`, { signal });
        if (response.status !== 202) return response;
        const { state, message } = await response.json();
        if (state === "failed") throw new Refusal(message);
    }
}

/** Read a job's server-sent events until it ends; EventSource could not carry the token. */
export async function* events(id, signal) {
    const response = await call(`/jobs/${id}/events`, { signal });
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let held = "";
    for (;;) {
        const { value, done } = await reader.read();
        if (done) return;
        held += value;
        for (let end; (end = held.indexOf("\n\n")) >= 0; held = held.slice(end + 2)) {
            const event = { type: "message", data: "" };
            for (const line of held.slice(0, end).split("\n")) {
                if (line.startsWith("event:")) event.type = line.slice(6).trim();
                if (line.startsWith("data:")) event.data += line.slice(5).trim();
            }
            if (event.data) yield { type: event.type, ...JSON.parse(event.data) };
        }
    }
}
