// "The smallest size at which nothing is lost": asked of the program, shown as a figure with a button that takes it.

import * as api from "./api.js";
import { make } from "./dom.js";
import { pictureOf } from "./files.js";
import { run } from "./runs.js";
import { change, job, state } from "./state.js";
import { text } from "./strings.js";

// Of a job's options, those that the answer depends on.
const KEPT = ["threshold", "window", "contrast", "invert", "mirror", "rotate", "crop", "frame", "printer", "phi-e", "phi-s", "phi-v"];

export class Smallest {
    constructor(fail) {
        this.fail = fail;
        this.found = null; // {key, width_mm, most} of the last answer
        this.root = make("div", { class: "smallest" });
    }

    async request() {
        const { picture, name, printer, options } = job(await pictureOf(state()));
        const kept = Object.fromEntries(Object.entries(options).filter(([key]) => KEPT.includes(key)));
        return { picture, name, ...(printer ? { printer } : {}), verb: "smallest", options: kept, files: ["smallest.json"] };
    }

    async find() {
        this.abort = new AbortController();
        this.draw();
        try {
            const request = await this.request();
            this.asked = JSON.stringify(request);
            const id = await run(request, "smallest", this.abort.signal, (stage, fraction) => { if (stage === "smallest" && this.bar) this.bar.value = fraction; });
            const { smallest } = await (await api.file(id, "smallest.json")).json();
            this.found = { key: this.asked, width_mm: smallest.width_mm, most_mm: Math.max(...smallest.tried.map((one) => one.width_mm)) };
        } catch (error) {
            this.fail(error);
        } finally {
            this.abort = null;
            this.draw();
        }
    }

    /** What was chosen changed: an answer to another question goes, a search for it ends. */
    async refresh() {
        if (!this.found && !this.abort) return;
        const key = JSON.stringify(await this.request());
        if (this.found && this.found.key !== key) this.found = null;
        if (this.abort && this.asked && this.asked !== key) this.abort.abort();
        this.draw();
    }

    answer() {
        const width = this.found.width_mm && Math.ceil(this.found.width_mm);
        if (!width) return [make("p", { class: "figure-words" }, text("smallestNone", { most: Math.round(this.found.most_mm) }))];
        return [make("p", { class: "figure-words" }, make("strong", {}, `${width} ${text("mm")}`), " ", text("smallestFrom")),
            state().width === width ? make("p", { class: "hint" }, text("smallestIs"))
                : make("button", { type: "button", class: "small", id: "use-smallest", onclick: () => change({ width }) }, text("smallestUse", { width }))];
    }

    draw() {
        const button = (words, id, onclick) => make("button", { type: "button", class: "small", id, onclick }, text(words));
        this.bar = this.abort ? make("progress", { max: 1, "aria-label": text("smallestFind") }) : null;
        this.root.replaceChildren(...(this.abort ? [this.bar, button("cancel", "stop-smallest", () => this.abort.abort())]
            : this.found ? this.answer() : [button("smallestFind", "find-smallest", () => this.find())]));
    }
}
