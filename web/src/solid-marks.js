// Lines and words over the object: its dimensions, its weakest place, where a picture would lie.
//
// They are SVG over the canvas, so that words stay sharp and arrows keep their size; a few elements, made once, moved
// as the object turns. A dimension stands at an edge of the object's box that lies on the box's outline, and so is never
// behind the object.

import { Vector3 } from "three";

const SVG = "http://www.w3.org/2000/svg";
const AWAY_PX = 22, ROOMY_PX = 60, SHORTEST_PX = 4, ARROW_PX = 7;
const node = (tag, kind, parent) => {
    const made = document.createElementNS(SVG, tag);
    made.setAttribute("class", kind);
    parent.append(made);
    return made;
};
const figure = (mm) => Number(mm.toFixed(mm < 10 ? 2 : 1)).toString();

// A line between two points of the screen, with arrow heads that point outwards, and its words.
class Measure {
    constructor(root) {
        this.root = node("g", "measure", root);
        this.line = node("path", "", this.root);
        this.words = node("text", "", this.root);
    }

    hide() { this.root.style.display = "none"; }

    /** `ends` and `feet`: x, y, x, y of the arrows, and of where they stand on the object. */
    show(ends, feet, words) {
        const [x0, y0, x1, y1] = ends, length = Math.hypot(x1 - x0, y1 - y0);
        const ux = (x1 - x0) / length, uy = (y1 - y0) / length;
        const roomy = length > ROOMY_PX, side = x0 + x1 - feet[0] - feet[2] < 0 ? "end" : "start";
        const head = (x, y, s) => `M${x + s * ARROW_PX * ux - 3 * uy} ${y + s * ARROW_PX * uy + 3 * ux}L${x} ${y}L${x + s * ARROW_PX * ux + 3 * uy} ${y + s * ARROW_PX * uy - 3 * ux}`;
        this.root.style.display = "";
        this.line.setAttribute("d", `M${feet[0]} ${feet[1]}L${x0} ${y0}M${feet[2]} ${feet[3]}L${x1} ${y1}M${x0} ${y0}L${x1} ${y1}${head(x0, y0, roomy ? 1 : -1)}${head(x1, y1, roomy ? -1 : 1)}`);
        // Words that do not fit between the arrows stand beside them, further out.
        const nx = (x0 - feet[0]) / AWAY_PX, ny = (y0 - feet[1]) / AWAY_PX;
        this.words.style.textAnchor = roomy ? "middle" : side;
        this.words.setAttribute("x", (x0 + x1) / 2 + (roomy ? 0 : 16 * nx));
        this.words.setAttribute("y", (y0 + y1) / 2 + (roomy ? 0 : 16 * ny));
        this.words.textContent = words;
    }
}

export class Marks {
    constructor(parent) {
        this.root = node("svg", "marks", parent);
        this.root.setAttribute("aria-hidden", "true");
        this.measures = [0, 1, 2].map(() => new Measure(this.root));
        this.wallMeasure = new Measure(this.root);
        this.spot = node("g", "spot", this.root);
        node("circle", "", this.spot).setAttribute("r", 11);
        node("circle", "dot", this.spot).setAttribute("r", 2.5);
        this.spotWords = node("text", "", this.spot);
        this.spotWords.setAttribute("y", -18);
        this.outline = node("path", "outline", this.root);
        this.flat = new Float64Array(16); // the box's corners on the screen
        this.near = [0, 0, 0]; // which of the two faces across an axis look at the eye: bit 0 the lower, bit 1 the upper
        this.ends = [0, 0, 0, 0];
        this.point = new Vector3();
        this.eye = new Vector3();
        this.clear();
    }

    clear() {
        this.box = this.wall = this.weakest = this.path = null;
        this.shown = true;
    }

    // A place of the object, on the screen.
    place(x, y, z, view, out, at) {
        const p = this.point.set(x, y, z).applyMatrix4(view.object.matrixWorld).project(view.camera);
        out[at] = (0.5 + p.x / 2) * view.width;
        out[at + 1] = (0.5 - p.y / 2) * view.height;
        return p.z;
    }

    /** Bring all of it to where the object now is. `view`: {camera, object, width, height}. */
    update(view) {
        this.root.setAttribute("viewBox", `0 0 ${view.width} ${view.height}`);
        this.updateBox(view);
        this.updateWall(view);
        this.updateSpot(view);
        this.updateOutline(view);
    }

    updateBox(view) {
        for (const measure of this.measures) measure.hide();
        if (!this.box || !this.shown) return;
        const { low, high } = this.box, flat = this.flat;
        for (let i = 0; i < 8; i++) this.place(i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2], view, flat, 2 * i);
        this.eye.copy(view.camera.position);
        view.object.worldToLocal(this.eye);
        const eye = [this.eye.x, this.eye.y, this.eye.z];
        for (let a = 0; a < 3; a++) this.near[a] = (eye[a] < low[a] ? 1 : 0) | (eye[a] > high[a] ? 2 : 0);
        for (let a = 0; a < 3; a++) this.updateMeasure(a, view);
    }

    // Of the four edges along an axis, those with one face towards the eye and one away are on the outline.
    updateMeasure(a, view) {
        const b = (a + 1) % 3, c = (a + 2) % 3, flat = this.flat, upright = Math.abs(this.turnedZ(a, view)) > 0.5;
        const middle = view.width / 2, size = this.box.high[a] - this.box.low[a];
        let best = -Infinity, from = 0;
        for (let n = 0; n < 4; n++) {
            const i = ((n & 1) << b) | ((n >> 1) << c), j = i | (1 << a);
            const first = (this.near[b] >> (n & 1)) & 1, second = (this.near[c] >> (n >> 1)) & 1;
            if (first === second) continue;
            const score = upright ? flat[2 * i] + flat[2 * j] - 2 * middle : flat[2 * i + 1] + flat[2 * j + 1];
            if (score > best) {
                best = score;
                from = i;
            }
        }
        if (best === -Infinity) return;
        const i = 2 * from, j = 2 * (from | (1 << a));
        const dx = flat[j] - flat[i], dy = flat[j + 1] - flat[i + 1], length = Math.hypot(dx, dy);
        if (length < SHORTEST_PX) return;
        let cx = 0, cy = 0;
        for (let k = 0; k < 8; k++) { cx += flat[2 * k] / 8; cy += flat[2 * k + 1] / 8; }
        let nx = -dy / length, ny = dx / length;
        if (nx * (flat[i] + dx / 2 - cx) + ny * (flat[i + 1] + dy / 2 - cy) < 0) { nx = -nx; ny = -ny; }
        const ends = [flat[i] + AWAY_PX * nx, flat[i + 1] + AWAY_PX * ny, flat[j] + AWAY_PX * nx, flat[j + 1] + AWAY_PX * ny];
        this.measures[a].show(ends, [flat[i] + 4 * nx, flat[i + 1] + 4 * ny, flat[j] + 4 * nx, flat[j + 1] + 4 * ny], `${figure(size)} ${this.unit}`);
    }

    // How far up an axis of the object points in the room.
    turnedZ(a, view) {
        return view.object.matrixWorld.elements[4 * a + 2];
    }

    // Does a place look at the eye, given its way out?
    seen(place, outward, view) {
        this.eye.copy(view.camera.position);
        view.object.worldToLocal(this.eye);
        return (this.eye.x - place[0]) * outward[0] + (this.eye.y - place[1]) * outward[1] + (this.eye.z - place[2]) * outward[2] > 0;
    }

    // The wall: a leader from where it was measured to its words, outwards.
    updateWall(view) {
        this.wallMeasure.hide();
        if (!this.wall || !this.shown || !this.seen(this.wall.at, this.wall.outward, view)) return;
        const p = this.flat, middle = (p[0] + p[2] + p[4] + p[6] + p[8] + p[10] + p[12] + p[14]) / 8;
        this.place(...this.wall.at, view, this.ends, 0);
        this.place(...this.wall.to, view, this.ends, 2);
        const [x0, y0, x1, y1] = this.ends, way = x0 < middle ? -1 : 1, x = Math.max(x0 * way, x1 * way) * way + 26 * way, y = Math.min(y0, y1) - 20;
        this.wallMeasure.root.style.display = "";
        this.wallMeasure.line.setAttribute("d", `M${x0} ${y0}L${x1} ${y1}M${(x0 + x1) / 2} ${(y0 + y1) / 2}L${x} ${y}h${6 * way}`);
        this.wallMeasure.words.style.textAnchor = way < 0 ? "end" : "start";
        this.wallMeasure.words.setAttribute("x", x + 10 * way);
        this.wallMeasure.words.setAttribute("y", y);
        this.wallMeasure.words.textContent = `${this.wallWords} ${figure(this.wall.mm)} ${this.unit}`;
    }

    updateSpot(view) {
        this.spot.style.display = this.weakest ? "" : "none";
        if (!this.weakest) return;
        const at = [0, 0], { at: place, outward, words } = this.weakest;
        this.place(...place, view, at, 0);
        this.spot.setAttribute("transform", `translate(${at[0]} ${at[1]})`);
        this.spot.classList.toggle("behind", !this.seen(place, outward, view));
        this.spotWords.textContent = words;
    }

    // A closed line on the object, x, y, z a point.
    updateOutline(view) {
        this.outline.style.display = this.path ? "" : "none";
        if (!this.path) return;
        const at = [0, 0];
        let d = "";
        for (let i = 0; i < this.path.length; i += 3) {
            this.place(this.path[i], this.path[i + 1], this.path[i + 2], view, at, 0);
            d += `${i === 0 ? "M" : "L"}${at[0].toFixed(1)} ${at[1].toFixed(1)}`;
        }
        this.outline.setAttribute("d", `${d}Z`);
    }
}
