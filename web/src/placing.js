// Placing the picture by hand: it is dragged over the object, or moved by the arrow keys.
//
// While it moves, the surface stands there uncarved with the picture on it; when it is let go, the new place is one step
// of the history, and the usual run shows what becomes of it.

import { BufferAttribute, BufferGeometry, CanvasTexture, DoubleSide, Group, Mesh, MeshBasicMaterial, Raycaster, SRGBColorSpace, Vector2 } from "three";
import { make } from "./dom.js";
import { Skin } from "./skin.js";
import { geometryOf } from "./solid-view.js";
import { change, goesAround, state } from "./state.js";
import { text } from "./strings.js";

const COLUMNS = 33, ROWS = 33, KEY_MM = 1, SHIFT_MM = 10;
const numbers = (words) => (words ? words.split(",").map(Number) : null);
const rounded = (v, digits) => v.map((x) => Number(x.toFixed(digits))).join();

/** How the picture lies on what is chosen: "wrap" or "project" (docs/place.md). */
export const placingOf = (s) => (s.place !== "auto" ? s.place : s.surface === "mesh" ? "project" : "wrap");

const surfaceOf = (s) => [s.surface, s.radius, s.height, s.mesh, s.meshHeight, s.meshUp, s.meshTurn].join();

export class Placing {
    /** `source`: skin() fetches surface.bin; size() is the picture's in mm; picture() a canvas of it; found() where the last run laid it. */
    constructor(view, source) {
        this.view = view;
        this.source = source;
        this.on = false;
        this.card = make("div", { class: "card placing-card", hidden: true });
        if (!view.renderer) return;
        view.cards.before(this.card);
        this.button = make("button", { type: "button", "data-flip": "placing", "aria-pressed": "false", onclick: () => this.flip(!this.on) });
        view.tools.append(this.button);
        this.decal = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ transparent: true, opacity: 0.9, depthTest: false, side: DoubleSide }));
        this.decal.renderOrder = 2;
        for (const kind of ["pointerdown", "pointermove", "pointerup", "pointercancel"])
            view.root.addEventListener(kind, (event) => event.target === view.canvas && this.point(kind, event), true);
        view.root.addEventListener("keydown", (event) => event.target === view.canvas && this.key(event), true);
        view.whenShown = () => { this.standing = false; this.refresh(); };
        this.words();
    }

    words() {
        if (!this.button) return;
        this.button.textContent = text("placePicture");
        this.card.replaceChildren(make("p", {}, text("placingHelp")),
            make("button", { type: "button", "data-unplace": true, onclick: () => change({ at: "", dir: "" }) }, text("placeFound")));
    }

    /** What was chosen has changed, or a run is shown. */
    refresh() {
        if (!this.button) return;
        const fixed = state().surface === "plate" || goesAround(state());
        this.button.hidden = fixed;
        if (fixed && this.on) this.flip(false);
        if (this.on) this.begin();
    }

    async flip(on) {
        this.on = on;
        this.button.setAttribute("aria-pressed", String(on));
        this.card.hidden = !on;
        this.view.root.classList.toggle("placing", on);
        this.view.marks.path = null;
        if (on) {
            this.view.canvas.focus({ preventScroll: true });
            await this.begin();
        } else if (this.standing) this.view.choose(this.view.layer);
        this.view.draw();
    }

    // Know the surface and where the picture lies on it.
    async begin() {
        const name = surfaceOf(state());
        if (this.name !== name) {
            this.name = name;
            this.skin = null;
            const bytes = await this.source.skin();
            if (this.name !== name) return;
            this.skin = new Skin(bytes);
        }
        if (!this.skin || this.held) return;
        const at = numbers(state().at) ?? this.source.found();
        if (!at) return;
        this.place = this.skin.nearest(at);
        this.direction = numbers(state().dir) ?? null;
        this.trace();
    }

    // --- Pointer and keys

    pick(event) {
        const { canvas, camera } = this.view, box = canvas.getBoundingClientRect();
        const ray = new Raycaster();
        ray.setFromCamera(new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2), camera);
        return this.skin?.pick(ray.ray.origin.toArray(), ray.ray.direction.toArray());
    }

    point(kind, event) {
        if (!this.on || (kind !== "pointerdown" && !this.held)) return;
        if (kind === "pointerdown") {
            if (event.button !== 0 || !event.isPrimary) return;
            const hit = this.pick(event);
            if (!hit) return; // beside the object it is turned as ever
            this.held = true;
            this.view.canvas.setPointerCapture(event.pointerId);
            this.moveTo(hit);
        } else if (kind === "pointermove") {
            const hit = this.pick(event);
            if (hit) this.moveTo(hit);
        } else {
            this.held = false;
            if (kind === "pointerup") this.settle();
        }
        event.stopPropagation();
        event.preventDefault();
    }

    key(event) {
        const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
        if (event.key === "Escape" && this.on) this.flip(false);
        else if (!this.on || !step || !this.place) return;
        else {
            const mm = event.shiftKey ? SHIFT_MM : KEY_MM, hit = this.skin.step(this.place, placingOf(state()), step[0] * mm, step[1] * mm);
            if (hit) {
                this.moveTo(hit);
                this.settle();
            }
        }
        event.stopPropagation();
        event.preventDefault();
    }

    moveTo(place) {
        this.place = place;
        this.direction = placingOf(state()) === "project" ? this.skin.meanNormal(place).map((x) => -x) : null;
        this.stand();
        this.trace();
    }

    settle() {
        change({ at: rounded(this.place.at, 1), dir: this.direction ? rounded(this.direction, 3) : "" });
    }

    // --- What is seen

    // The uncarved surface instead of the object, and the picture on it.
    stand() {
        if (this.standing) return;
        this.standing = true;
        const group = new Group(), { view } = this;
        group.add(new Mesh(geometryOf(this.skin.mesh), view.stone), this.decal);
        const canvas = this.source.picture();
        this.decal.material.map?.dispose();
        this.decal.material.map = canvas ? new CanvasTexture(canvas) : null;
        if (canvas) Object.assign(this.decal.material.map, { colorSpace: SRGBColorSpace, flipY: false });
        this.decal.material.needsUpdate = true;
        view.replace(group);
    }

    // The window's outline, and while the surface stands there the picture in it.
    trace() {
        const how = placingOf(state()), direction = this.direction ?? (how === "project" ? [0, 1, 0] : null);
        const grid = this.skin.window(this.place, how, direction, this.source.size(), COLUMNS, ROWS);
        const border = [], middle = [(COLUMNS - 1) / 2, (ROWS - 1) / 2];
        // A place of the border, or the outermost one on the way to it that the surface has.
        const edge = (i, j) => {
            for (let share = 1; share > 0; share -= 1 / COLUMNS) {
                const at = 3 * (Math.round(middle[1] + share * (j - middle[1])) * COLUMNS + Math.round(middle[0] + share * (i - middle[0])));
                if (!Number.isNaN(grid[at])) return border.push(grid[at], grid[at + 1], grid[at + 2]);
            }
            return 0;
        };
        for (let i = 0; i < COLUMNS - 1; i++) edge(i, 0);
        for (let j = 0; j < ROWS - 1; j++) edge(COLUMNS - 1, j);
        for (let i = COLUMNS - 1; i > 0; i--) edge(i, ROWS - 1);
        for (let j = ROWS - 1; j > 0; j--) edge(0, j);
        this.view.marks.path = border;
        if (this.standing) this.lay(grid);
        this.view.draw();
    }

    lay(grid) {
        const { geometry } = this.decal, index = [], whole = (at) => !Number.isNaN(grid[3 * at]);
        if (!geometry.getAttribute("uv")) {
            const uv = new Float32Array(2 * COLUMNS * ROWS);
            for (let j = 0, n = 0; j < ROWS; j++) for (let i = 0; i < COLUMNS; i++, n += 2) uv.set([i / (COLUMNS - 1), j / (ROWS - 1)], n);
            geometry.setAttribute("uv", new BufferAttribute(uv, 2));
        }
        for (let j = 0; j < ROWS - 1; j++)
            for (let i = 0; i < COLUMNS - 1; i++) {
                const a = j * COLUMNS + i, b = a + 1, c = a + COLUMNS, d = c + 1;
                if (whole(a) && whole(b) && whole(c) && whole(d)) index.push(a, c, b, b, c, d);
            }
        geometry.setAttribute("position", new BufferAttribute(grid, 3));
        geometry.setIndex(index);
        geometry.boundingSphere = this.decal.parent.children[0].geometry.boundingSphere;
    }
}
