// Runs: a job is asked for, followed by its events, and stopped when nobody waits for it any more.

import * as api from "./api.js";

const client = crypto.randomUUID(); // this page, to the server: of each of its kinds of jobs the newest counts

// Start a job and see to `work(id)`; one that is aborted meanwhile ends on the server, too. Not before what was asked
// of it has been taken back here: the answers would be that there is no such job.
async function during(request, kind, signal, work) {
    const id = await api.start({ ...request, client: `${client}-${kind}` });
    try {
        signal?.throwIfAborted();
        return await work(id);
    } catch (error) {
        if (signal?.aborted) api.stop(id);
        throw error;
    }
}

/** Run a job to its end and give its id; tell(stage, fraction) hears how far it is. */
export function run(request, kind, signal, tell = () => {}) {
    return during(request, kind, signal, async (id) => {
        for await (const event of api.events(id, signal)) {
            if (event.type === "progress") tell(event.stage, event.fraction);
            if (event.type === "done") return id;
            if (event.type === "failed") throw new api.Refusal(event.message);
        }
        throw new TypeError("the events ended early");
    });
}

/** Run a job for its files alone: their responses, each as soon as it is made. */
export function filesOf(request, kind, signal) {
    return during(request, kind, signal, (id) => Promise.all(request.files.map((name) => api.fileWhenMade(id, name, signal))));
}

/** One file of a job, as an ImageBitmap. */
export async function bitmapOf(id, name, signal) {
    return createImageBitmap(await (await api.file(id, name, signal)).blob());
}

/** One file of a job, as an ArrayBuffer. */
export const bytesOf = async (id, name, signal) => (await api.file(id, name, signal)).arrayBuffer();

/** Several runs, one after the other in time and each a little later than the one before; a new plan takes the old one's place. */
export class Plan {
    constructor(failed) {
        this.failed = failed;
        this.timers = [];
        this.abort = null;
    }

    /** steps: [[run(signal), after ms], ...] */
    begin(steps) {
        this.end();
        const { signal } = this.abort = new AbortController();
        this.timers = steps.map(([step, after]) => setTimeout(() => step(signal).catch(this.failed), after));
    }

    end() {
        this.abort?.abort();
        this.timers.forEach(clearTimeout);
        this.abort = null;
    }
}
