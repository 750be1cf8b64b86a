// How far a run is: the stage's name, a bar, and the button that stops it or begins it again.

import { make } from "./dom.js";
import { text } from "./strings.js";

export class Progress {
    constructor(root, cancel) {
        this.bar = make("progress", { max: 1 });
        this.name = make("span", { class: "stage-name" });
        this.button = make("button", { type: "button", class: "small", id: "cancel" });
        this.button.addEventListener("click", () => (this.running ? cancel() : this.again()));
        this.root = root;
        this.root.append(this.name, this.bar, this.button);
        this.hide();
    }

    words() {
        this.bar.setAttribute("aria-label", text("progress"));
        this.button.textContent = text(this.running ? "cancel" : "again");
    }

    show() {
        this.running = true;
        this.root.hidden = this.bar.hidden = false;
        this.name.textContent = "";
        this.bar.removeAttribute("value");
        this.words();
    }

    /** Of a stage, as the program calls it, so much is done, 0 .. 1. */
    tell(stage, fraction) {
        if (!this.running) return;
        const key = `stage_${stage.replaceAll(" ", "_")}`, words = text(key);
        this.name.textContent = words === key ? stage : words;
        this.bar.value = fraction;
    }

    hide() {
        this.running = false;
        this.root.hidden = true;
    }

    /** It was stopped; the button now calls again(). */
    offer(again) {
        this.running = false;
        this.again = again;
        this.bar.hidden = true;
        this.name.textContent = "";
        this.words();
    }
}
