// Before and after on one canvas, with a handle between them, overlays, zoom and pan.

import { bytesOf, plain } from "./compose.js";
import { make } from "./dom.js";
import { OVERLAYS, SOLID, VOID } from "./overlays.js";
import { text } from "./strings.js";

const MOST_PX = 1600; // longer side of what is composed; the carving itself is finer

export class PictureView {
    constructor(stage, legend, bar) {
        this.legend = legend;
        this.split = 0.5;
        this.overlay = OVERLAYS[0];
        this.layers = null; // width, height, and input and mask as bytes
        this.layer = null; // gives other files of the whole run that is shown
        this.view = { scale: 1, x: 0, y: 0 };
        this.canvas = make("canvas", { class: "picture" });
        this.handle = make("input", { type: "range", class: "handle", min: 0, max: 100, value: 50, step: 1, "aria-label": text("handle") });
        this.chooser = make("select", { "aria-label": text("overlay"), class: "overlay" });
        this.root = make("div", { class: "fill" }, this.canvas, this.handle);
        stage.append(this.root);
        bar.append(this.chooser);
        this.listen();
        new ResizeObserver(() => this.draw()).observe(stage);
        this.words();
    }

    words() {
        this.handle.setAttribute("aria-label", text("handle"));
        this.chooser.setAttribute("aria-label", text("overlay"));
        this.chooser.replaceChildren(...OVERLAYS.map(({ name, words }) => make("option", { value: name }, text(words))));
        this.chooser.value = this.overlay.name;
        this.showLegend();
    }

    listen() {
        this.handle.addEventListener("input", () => this.setSplit(this.handle.value / 100));
        this.handle.addEventListener("keydown", (event) => {
            const place = { 1: 1, 2: 0.5, 3: 0 }[event.key];
            if (place !== undefined) this.setSplit(place);
        });
        this.chooser.addEventListener("change", () => { this.overlay = OVERLAYS.find(({ name }) => name === this.chooser.value); this.paint(true); });
        this.canvas.addEventListener("wheel", (event) => {
            event.preventDefault();
            this.zoom(Math.exp(-event.deltaY * 0.0015), event.offsetX, event.offsetY);
        }, { passive: false });
        const held = new Map();
        this.canvas.addEventListener("pointerdown", (event) => {
            this.canvas.setPointerCapture(event.pointerId);
            event.onHandle = Math.abs(event.offsetX - this.split * this.root.clientWidth) < 20;
            held.set(event.pointerId, event);
        });
        this.canvas.addEventListener("pointermove", (event) => {
            const last = held.get(event.pointerId);
            if (!last) return;
            this.drag(held, last, event);
            held.set(event.pointerId, event);
        });
        for (const kind of ["pointerup", "pointercancel"]) this.canvas.addEventListener(kind, (event) => held.delete(event.pointerId));
        this.canvas.addEventListener("dblclick", () => { this.view = { scale: 1, x: 0, y: 0 }; this.draw(); });
    }

    // On the handle one finger moves it, elsewhere the picture; two come nearer.
    drag(held, last, now) {
        if (held.size === 1 && last.onHandle) {
            now.onHandle = true;
            this.setSplit(Math.min(Math.max(now.offsetX / this.root.clientWidth, 0), 1));
            return;
        }
        if (held.size === 2) {
            const other = [...held.values()].find((e) => e.pointerId !== now.pointerId);
            const before = Math.hypot(last.offsetX - other.offsetX, last.offsetY - other.offsetY);
            const after = Math.hypot(now.offsetX - other.offsetX, now.offsetY - other.offsetY);
            if (before > 0) this.zoom(after / before, other.offsetX, other.offsetY);
            return;
        }
        this.view.x += now.offsetX - last.offsetX;
        this.view.y += now.offsetY - last.offsetY;
        this.draw();
    }

    zoom(times, x, y) {
        const scale = Math.min(Math.max(this.view.scale * times, 0.5), 40), real = scale / this.view.scale;
        this.view = { scale, x: x - (x - this.view.x) * real, y: y - (y - this.view.y) * real };
        this.draw();
    }

    /** Where the picture lies on the stage, in its pixels. */
    frame() {
        const { clientWidth: width, clientHeight: height } = this.root, { width: w, height: h } = this.before ?? { width: 1, height: 1 };
        const fit = 0.94 * Math.min(width / w, height / h) * this.view.scale;
        return { left: (width - w * fit) / 2 + this.view.x, top: (height - h * fit) / 2 + this.view.y, width: w * fit, height: h * fit, fit };
    }

    setSplit(share) {
        this.split = share;
        this.handle.value = Math.round(share * 100);
        this.draw();
    }

    /** Show a run's pictures: ImageBitmaps of the same area. layer(name) gives further files of a whole run; null: there are none yet.
     *  `quick`: as many pixels as are seen now, for what will be shown anew soon. */
    show({ input, mask, layer = null }, quick = false) {
        const seen = Math.max(this.root.clientWidth, this.root.clientHeight) * (devicePixelRatio || 1) * Math.max(this.view.scale, 1);
        const most = quick && seen > 0 ? Math.min(MOST_PX, seen) : MOST_PX, shrink = Math.min(1, most / Math.max(mask.width, mask.height));
        const width = Math.max(1, Math.round(mask.width * shrink)), height = Math.max(1, Math.round(mask.height * shrink));
        const was = this.layers, same = was && was.bitmap === input && was.width === width && was.height === height;
        this.layers = { width, height, bitmap: input, input: same ? was.input : bytesOf(input, width, height), mask: bytesOf(mask, width, height) };
        this.layer = layer;
        this.after = null;
        this.paint(same);
    }

    paint(sameInput = false) {
        if (!this.layers) return;
        const { layers, overlay, layer } = this, { width, height, input, mask } = layers;
        if (!sameInput) this.before = plain(width, height, input, VOID, SOLID);
        if (!overlay.paint || !layer || !this.after) this.after = overlay.quick?.(layers) ?? plain(width, height, mask, VOID, SOLID);
        this.showLegend();
        this.draw();
        if (overlay.paint && layer) this.finish(layers, overlay, layer);
    }

    // What needs files comes when they are there, unless something else is wanted by then.
    async finish(layers, overlay, layer) {
        const after = await overlay.paint(layers, layer).catch(() => null); // a run that is over: the next one paints
        if (!after || layers !== this.layers || overlay !== this.overlay) return;
        this.after = after;
        this.chooser.dataset.shows = overlay.name;
        this.draw();
    }

    showLegend() {
        this.legend.replaceChildren(...this.overlay.keys.map(([key, colour]) => {
            const patch = make("span", { class: "patch", "aria-hidden": "true" });
            patch.style.background = `rgb(${colour})`;
            return make("span", { class: "key" }, patch, text(key));
        }));
    }

    draw() {
        const ratio = devicePixelRatio || 1, width = this.root.clientWidth, height = this.root.clientHeight;
        if (width === 0 || height === 0) return;
        this.canvas.width = width * ratio;
        this.canvas.height = height * ratio;
        if (!this.before) return;
        const context = this.canvas.getContext("2d");
        const { left, top, fit, ...size } = this.frame();
        context.scale(ratio, ratio);
        context.imageSmoothingEnabled = fit * ratio < 2;
        const place = [left, top, size.width, size.height];
        const edge = this.split * width;
        for (const [picture, from, to] of [[this.before, 0, edge], [this.after, edge, width]]) {
            context.save();
            context.beginPath();
            context.rect(from, 0, to - from, height);
            context.clip();
            context.drawImage(picture, ...place);
            context.restore();
        }
        if (this.split > 0 && this.split < 1) this.drawHandle(context, edge, height);
        this.onDraw?.();
    }

    drawHandle(context, x, height) {
        context.fillStyle = "#a8542f";
        context.fillRect(x - 1, 0, 2, height);
        context.beginPath();
        context.arc(x, height / 2, 15, 0, 2 * Math.PI);
        context.fill();
        context.fillStyle = "#fff";
        for (const side of [-1, 1]) {
            context.beginPath();
            context.moveTo(x + side * 9, height / 2);
            context.lineTo(x + side * 3.5, height / 2 - 5);
            context.lineTo(x + side * 3.5, height / 2 + 5);
            context.fill();
        }
    }
}
