// Cropping: the whole picture on the stage, a box on it with handles for pointer, touch and keys, and its numbers.
//
// The box counts pixels as the picture is shown, turned and mirrored; the state's crop counts the picture's own
// pixels, as the command line's --crop does. Nothing changes until it is done.

import { make } from "./dom.js";
import { text } from "./strings.js";

const LEAST_PX = 8, EDGES = ["nw", "n", "ne", "e", "se", "s", "sw", "w"];
const RATIOS = [["free", 0], ["asIs", -1], ["1 : 1", 1], ["4 : 3", 4 / 3], ["3 : 4", 3 / 4], ["16 : 9", 16 / 9], ["2 : 3", 2 / 3]];
const clamp = (value, least, most) => Math.min(Math.max(value, least), Math.max(least, most));

/** A box of a picture w x h, as it lies after so many quarter turns clockwise. */
function turned([x, y, bw, bh], w, h, quarters) {
    for (let i = 0; i < quarters; i++) [x, y, bw, bh, w, h] = [h - y - bh, x, bh, bw, h, w];
    return [x, y, bw, bh];
}

/** From the picture's own pixels to those shown: turned, then mirrored. w and h are the picture's own. */
export function toShown(box, w, h, quarters, mirror) {
    const [x, y, bw, bh] = turned(box, w, h, quarters), width = quarters % 2 ? h : w;
    return mirror ? [width - x - bw, y, bw, bh] : [x, y, bw, bh];
}

/** And back. */
export function toOwn([x, y, bw, bh], w, h, quarters, mirror) {
    const [width, height] = quarters % 2 ? [h, w] : [w, h];
    return turned([mirror ? width - x - bw : x, y, bw, bh], width, height, (4 - quarters) % 4);
}

/** A box whose edges ("nw", "e", ...; "" moves it) went by dx, dy, inside w x h; a ratio (width by height) above 0 is kept. */
export function dragged([x, y, bw, bh], edges, dx, dy, w, h, ratio) {
    if (edges === "") return [clamp(x + dx, 0, w - bw), clamp(y + dy, 0, h - bh), bw, bh].map(Math.round);
    const west = edges.includes("w"), north = edges.includes("n"), across = west || edges.includes("e"), down = north || edges.includes("s");
    let width = across ? clamp(bw + (west ? -dx : dx), LEAST_PX, west ? x + bw : w - x) : bw;
    let height = down ? clamp(bh + (north ? -dy : dy), LEAST_PX, north ? y + bh : h - y) : bh;
    const cx = x + bw / 2, cy = y + bh / 2;
    if (ratio > 0) {
        if (across) height = width / ratio;
        else width = height * ratio;
        const roomX = west ? x + bw : across ? w - x : 2 * Math.min(cx, w - cx);
        const roomY = north ? y + bh : down ? h - y : 2 * Math.min(cy, h - cy);
        const shrink = Math.min(1, roomX / width, roomY / height);
        width *= shrink;
        height *= shrink;
    }
    const left = west ? x + bw - width : across ? x : cx - width / 2, top = north ? y + bh - height : down ? y : cy - height / 2;
    const first = [clamp(Math.round(left), 0, w - 1), clamp(Math.round(top), 0, h - 1)];
    return [...first, clamp(Math.round(width), 1, w - first[0]), clamp(Math.round(height), 1, h - first[1])];
}

export class Crop {
    /** done(text) takes the crop as the state keeps it; closed() is called at the end either way. */
    constructor(stage, done, closed) {
        this.stage = stage;
        this.done = done;
        this.closed = closed;
    }

    get isOpen() { return Boolean(this.root); }

    /** Begin with the whole picture, an ImageBitmap in its own pixels. */
    open(bitmap, s) {
        this.close();
        this.own = [bitmap.width, bitmap.height];
        this.quarters = s.rotate / 90;
        this.mirror = s.mirror;
        [this.width, this.height] = this.quarters % 2 ? [bitmap.height, bitmap.width] : this.own;
        const kept = s.crop.split(",").map(Number), whole = [0, 0, ...this.own];
        const fits = s.crop && kept.every((n, i) => n >= 0 && (i < 2 || n > 0)) && kept[0] + kept[2] <= this.own[0] && kept[1] + kept[3] <= this.own[1];
        this.box = toShown(fits ? kept : whole, ...this.own, this.quarters, this.mirror);
        this.ratio = 0;
        this.build(bitmap);
        this.watch = new ResizeObserver(() => this.lay());
        this.watch.observe(this.stage);
        this.lay();
        this.frame.focus();
    }

    build(bitmap) {
        this.canvas = make("canvas", { width: this.width, height: this.height });
        const context = this.canvas.getContext("2d");
        context.setTransform(this.mirror ? -1 : 1, 0, 0, 1, this.mirror ? this.width : 0, 0);
        context.translate(this.width / 2, this.height / 2);
        context.rotate((this.quarters * Math.PI) / 2);
        context.drawImage(bitmap, -bitmap.width / 2, -bitmap.height / 2);
        this.frame = make("button", { type: "button", class: "crop-frame", "aria-label": text("cropMove") });
        this.handles = EDGES.map((edges) => make("button", { type: "button", class: `crop-handle ${edges}`, "data-edges": edges, "aria-label": text(`crop_${edges}`) }));
        this.holder = make("div", { class: "crop-box" }, this.frame, this.handles);
        this.area = make("div", { class: "crop-area" }, this.canvas, this.holder);
        this.root = make("div", { class: "fill crop", role: "group", "aria-label": text("crop") }, this.area, this.bar());
        for (const [node, edges] of [[this.frame, ""], ...this.handles.map((node) => [node, node.dataset.edges])]) this.listen(node, edges);
        this.root.addEventListener("keydown", (event) => {
            if (event.key !== "Escape" && !(event.key === "Enter" && event.target.matches(".crop-frame, .crop-handle"))) return;
            event.preventDefault();
            event.stopPropagation();
            if (event.key === "Enter") this.finish();
            else this.close();
        });
        this.stage.append(this.root);
    }

    bar() {
        this.numbers = ["cropLeft", "cropTop", "width", "height"].map((words, i) => {
            const box = make("input", { type: "number", min: i < 2 ? 0 : 1, step: 1, onchange: () => this.type(i, Math.round(box.value)) });
            return { box, label: make("label", {}, `${text(words)}, ${text("px")}`, box) };
        });
        const ratio = make("select", { "aria-label": text("cropRatio"), onchange: () => this.keep(Number(ratio.value)) },
            RATIOS.map(([words, value]) => make("option", { value }, /\d/.test(words) ? words : text(`ratio_${words}`))));
        const button = (words, onclick, kind) => make("button", { type: "button", class: kind, onclick }, text(words));
        return make("div", { class: "crop-bar" }, make("span", { class: "crop-numbers" }, this.numbers.map(({ label }) => label)), ratio,
            button("cropAll", () => { this.box = [0, 0, this.width, this.height]; this.lay(); }),
            button("cropCancel", () => this.close()), button("cropDone", () => this.finish(), "accent"));
    }

    listen(node, edges) {
        let from = null;
        node.addEventListener("pointerdown", (event) => {
            node.setPointerCapture(event.pointerId);
            from = { x: event.clientX, y: event.clientY, box: this.box };
        });
        node.addEventListener("pointermove", (event) => {
            if (!from) return;
            this.set(dragged(from.box, edges, (event.clientX - from.x) / this.scale, (event.clientY - from.y) / this.scale, this.width, this.height, this.keptRatio()));
        });
        for (const kind of ["pointerup", "pointercancel"]) node.addEventListener(kind, () => { from = null; });
        node.addEventListener("keydown", (event) => {
            const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
            if (!way) return;
            event.preventDefault();
            const step = event.shiftKey ? 1 : Math.max(1, Math.round(Math.max(this.width, this.height) / 100));
            this.set(dragged(this.box, edges, way[0] * step, way[1] * step, this.width, this.height, this.keptRatio()));
        });
    }

    keptRatio() { return this.ratio < 0 ? this.width / this.height : this.ratio; }

    // The largest box of the ratio around the middle of the one there is.
    keep(ratio) {
        this.ratio = ratio;
        if (ratio === 0) return;
        const [x, y, w, h] = this.box, kept = this.keptRatio(), width = Math.min(w, h * kept), height = width / kept;
        this.set([x + (w - width) / 2, y + (h - height) / 2, width, height].map(Math.round));
    }

    type(i, value) {
        const box = [...this.box];
        if (!Number.isFinite(value)) return this.lay();
        if (i < 2) return this.set(dragged(box, "", i === 0 ? value - box[0] : 0, i === 1 ? value - box[1] : 0, this.width, this.height, 0));
        this.set(dragged(box, i === 2 ? "e" : "s", i === 2 ? value - box[2] : 0, i === 3 ? value - box[3] : 0, this.width, this.height, this.keptRatio()));
    }

    set(box) {
        this.box = box;
        this.lay();
    }

    lay() {
        const bar = this.root.querySelector(".crop-bar").offsetHeight;
        const room = [this.stage.clientWidth - 48, this.stage.clientHeight - bar - 56];
        this.scale = Math.max(Math.min(room[0] / this.width, room[1] / this.height), 0.001);
        Object.assign(this.area.style, { width: `${this.width * this.scale}px`, height: `${this.height * this.scale}px` });
        const part = (value, all) => `${(100 * value) / all}%`, [x, y, w, h] = this.box;
        Object.assign(this.holder.style, { left: part(x, this.width), top: part(y, this.height), width: part(w, this.width), height: part(h, this.height) });
        this.numbers.forEach(({ box }, i) => { if (document.activeElement !== box || Number(box.value) !== this.box[i]) box.value = this.box[i]; });
    }

    finish() {
        const own = toOwn(this.box, ...this.own, this.quarters, this.mirror);
        const whole = own[0] === 0 && own[1] === 0 && own[2] === this.own[0] && own[3] === this.own[1];
        this.done(whole ? "" : own.join());
        this.close();
    }

    close() {
        if (!this.root) return;
        const hadFocus = this.root.contains(document.activeElement);
        this.watch.disconnect();
        this.root.remove();
        this.root = null;
        this.closed(hadFocus);
    }
}
