// The surface before it is carved ("surface.bin", docs/serve.md): where a picture laid on it would lie.
//
// How:     a shape is unrolled, so a place of the picture is looked up there; on a model the picture is laid along
//          straight lines (geodesics) from its centre; projected, it is drawn into a grid of depths. The program itself
//          flattens more evenly: this is for the eye while the picture is dragged.
// Frame:   the object's, mm. A window is a grid of places, rows from the top, NaN where the surface has none.
// Checked: web/tests/placing.test.mjs.

import { hitOf, normalOf, readMesh } from "./solid-mesh.js";

const BINS = 96, MOST_STEPS = 20000;
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const along = (a, d, t) => [a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const length = Math.hypot(...a) || 1; return a.map((x) => x / length); };

export class Skin {
    constructor(buffer) {
        this.mesh = readMesh(buffer);
        this.uv = this.mesh.uv;
        if (this.uv) this.sortUnrolled();
    }

    corner(face, k) {
        const at = 3 * this.mesh.index[3 * face + k], { position } = this.mesh;
        return [position[at], position[at + 1], position[at + 2]];
    }

    normal(face) { return normalOf(this.mesh.position, this.mesh.index, 3 * face); }

    /** The first place that a ray meets, {at, face}, or null. */
    pick(origin, direction) {
        const hit = hitOf(this.mesh, origin, direction);
        return hit && { at: along(origin, direction, hit.t), face: hit.triangle };
    }

    /** The place nearest to a point, {at, face}. */
    nearest(point) {
        let least = Infinity, found = null;
        for (let face = 0; face < this.mesh.index.length / 3; face++) {
            if (this.uv && Number.isNaN(this.uv[6 * face])) continue;
            const at = nearestOnFace(point, this.corner(face, 0), this.corner(face, 1), this.corner(face, 2));
            const r = minus(at, point), away = dot(r, r);
            if (away < least) {
                least = away;
                found = { at, face };
            }
        }
        return found;
    }

    // --- Shapes: looked up where they are unrolled

    // Triangles by the square of the unrolled surface that they touch: bin b holds list[first[b] .. first[b + 1]].
    sortUnrolled() {
        const { uv } = this, low = [Infinity, Infinity], high = [-Infinity, -Infinity];
        for (let i = 0; i < uv.length; i++) {
            if (uv[i] < low[i & 1]) low[i & 1] = uv[i];
            if (uv[i] > high[i & 1]) high[i & 1] = uv[i];
        }
        this.low = low;
        this.binSize = [0, 1].map((i) => (high[i] - low[i]) / BINS || 1);
        const first = new Int32Array(BINS * BINS + 1);
        this.eachBin((bin) => { first[bin + 1]++; });
        for (let b = 0; b < BINS * BINS; b++) first[b + 1] += first[b];
        const next = first.slice(), list = new Int32Array(first[BINS * BINS]);
        this.eachBin((bin, face) => { list[next[bin]++] = face; });
        Object.assign(this, { first, list });
    }

    bin(i, value) { return Math.min(Math.max(Math.floor((value - this.low[i]) / this.binSize[i]), 0), BINS - 1); }

    eachBin(see) {
        const { uv } = this;
        for (let face = 0; face < uv.length / 6; face++) {
            if (Number.isNaN(uv[6 * face])) continue;
            const u = [uv[6 * face], uv[6 * face + 2], uv[6 * face + 4]], v = [uv[6 * face + 1], uv[6 * face + 3], uv[6 * face + 5]];
            for (let j = this.bin(1, Math.min(...v)); j <= this.bin(1, Math.max(...v)); j++)
                for (let i = this.bin(0, Math.min(...u)); i <= this.bin(0, Math.max(...u)); i++) see(j * BINS + i, face);
        }
    }

    /** The place at u, v of the unrolled surface, {at, face}, or null. */
    unrolled(u, v) {
        const { around } = this.mesh;
        if (around > 0) u -= around * Math.round(u / around);
        const bin = this.bin(1, v) * BINS + this.bin(0, u);
        for (let n = this.first[bin]; n < this.first[bin + 1]; n++) {
            const face = this.list[n], share = this.shares(face, u, v);
            if (Math.min(...share) < -1e-5) continue;
            const [a, b, c] = [0, 1, 2].map((k) => this.corner(face, k));
            return { at: [0, 1, 2].map((k) => share[0] * a[k] + share[1] * b[k] + share[2] * c[k]), face };
        }
        return null;
    }

    shares(face, u, v) {
        const p = this.uv.subarray(6 * face, 6 * face + 6);
        const area = (p[2] - p[0]) * (p[5] - p[1]) - (p[3] - p[1]) * (p[4] - p[0]);
        const b = ((u - p[0]) * (p[5] - p[1]) - (v - p[1]) * (p[4] - p[0])) / area;
        const c = ((p[2] - p[0]) * (v - p[1]) - (p[3] - p[1]) * (u - p[0])) / area;
        return [1 - b - c, b, c];
    }

    unrolledAt({ at, face }) {
        const area = (a, b, c) => Math.hypot(...cross(minus(b, a), minus(c, a)));
        const [a, b, c] = [0, 1, 2].map((k) => this.corner(face, k)), p = this.uv.subarray(6 * face, 6 * face + 6);
        const share = [area(at, b, c), area(a, at, c), area(a, b, at)], whole = share[0] + share[1] + share[2];
        return [0, 1].map((i) => (share[0] * p[i] + share[1] * p[2 + i] + share[2] * p[4 + i]) / whole);
    }

    // --- Models: straight on along the surface

    // The face on the other side of each side; side k is opposite corner k.
    link() {
        if (this.linked) return;
        const { index } = this.mesh, open = new Map(), vertices = this.mesh.position.length / 3;
        this.linked = new Int32Array(index.length).fill(-1);
        for (let i = 0; i < index.length; i++) {
            const face = Math.floor(i / 3), k = i % 3, a = index[3 * face + ((k + 1) % 3)], b = index[3 * face + ((k + 2) % 3)];
            const other = open.get(b * vertices + a);
            if (other === undefined) open.set(a * vertices + b, i);
            else {
                this.linked[i] = other;
                this.linked[other] = i;
            }
        }
    }

    /** Where one arrives who walks straight on for a length, or null at a border. */
    walk({ at, face }, direction, length) {
        this.link();
        let came = -1, way = direction;
        for (let steps = 0; steps < MOST_STEPS; steps++) {
            const normal = this.normal(face);
            way = unit(along(way, normal, -dot(way, normal)));
            let least = Infinity, side = -1;
            for (let k = 0; k < 3; k++) {
                if (k === came) continue;
                const a = this.corner(face, (k + 1) % 3), out = cross(minus(this.corner(face, (k + 2) % 3), a), normal);
                const towards = dot(way, out);
                if (towards <= 0) continue;
                const t = Math.max(dot(minus(a, at), out) / towards, 0);
                if (t < least) {
                    least = t;
                    side = k;
                }
            }
            if (length <= least || side < 0) return { at: along(at, way, Math.min(length, least)), face };
            const next = this.linked[3 * face + side];
            if (next < 0) return null;
            at = along(at, way, least);
            length -= least;
            // Around the common side: what goes along it stays, what goes across it goes on across.
            const e = unit(minus(this.corner(face, (side + 2) % 3), this.corner(face, (side + 1) % 3)));
            const across = dot(way, cross(e, normal));
            face = Math.floor(next / 3);
            came = next % 3;
            way = along(e.map((x) => x * dot(way, e)), cross(e, this.normal(face)), across);
        }
        return null;
    }

    // --- Windows

    /** How a picture whose centre is at a place lies there: right and up along the surface, or as seen along `direction`. */
    frame(place, direction) {
        const normal = direction ? direction.map((x) => -x) : this.meanNormal(place);
        const above = Math.abs(normal[2]) > 0.99 ? [0, 1, 0] : [0, 0, 1];
        const right = unit(cross(above, normal));
        return { normal, right, up: cross(normal, right) };
    }

    /** The mean normal over the faces near a place, so that bumps do not tilt the picture. */
    meanNormal({ at, face }, reach = 6) {
        const own = this.normal(face), sum = [...own];
        const { position, index } = this.mesh;
        for (let t = 0; t < index.length; t += 3) {
            const v = 3 * index[t], r = [position[v] - at[0], position[v + 1] - at[1], position[v + 2] - at[2]];
            if (dot(r, r) > reach * reach) continue;
            const n = this.normal(t / 3);
            if (dot(n, own) > 0) n.forEach((x, k) => { sum[k] += x; });
        }
        return unit(sum);
    }

    /** The place so far to the right and up of another, {at, face} or null. `how`: "wrap" or "project". */
    step(place, how, x, y) {
        if (how === "wrap" && this.uv) {
            const [u, v] = this.unrolledAt(place);
            return this.unrolled(u + x, v + y);
        }
        const { right, up } = this.frame(place);
        const way = along(right.map((r) => r * x), up, y);
        return x === 0 && y === 0 ? place : this.walk(place, unit(way), Math.hypot(x, y));
    }

    /** A grid of places under a picture: columns and rows of it, width and height in mm. */
    window(place, how, direction, size, columns, rows) {
        const grid = new Float32Array(3 * columns * rows).fill(NaN);
        const x = (i) => (i / (columns - 1) - 0.5) * size[0], y = (j) => (0.5 - j / (rows - 1)) * size[1];
        if (how === "project") {
            this.project(this.frame(place, direction), place.at, size, columns, rows, grid);
            return grid;
        }
        const [u, v] = this.uv ? this.unrolledAt(place) : [0, 0], frame = this.uv ? null : this.frame(place);
        for (let j = 0; j < rows; j++)
            for (let i = 0; i < columns; i++) {
                const found = this.uv ? this.unrolled(u + x(i), v + y(j)) : this.walkOut(place, frame, x(i), y(j));
                if (found) grid.set(found.at, 3 * (j * columns + i));
            }
        return grid;
    }

    walkOut(place, { right, up }, x, y) {
        const length = Math.hypot(x, y);
        return length < 1e-9 ? place : this.walk(place, along(right.map((r) => (r * x) / length), up, y / length), length);
    }

    // Each face that looks at the viewer is drawn into the grid; the nearest counts.
    project({ normal, right, up }, centre, size, columns, rows, grid) {
        const { position, index } = this.mesh, near = new Float32Array(columns * rows).fill(-Infinity), p = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
        for (let t = 0; t < index.length; t += 3) {
            for (let k = 0; k < 3; k++) {
                const v = 3 * index[t + k], rx = position[v] - centre[0], ry = position[v + 1] - centre[1], rz = position[v + 2] - centre[2];
                p[k][0] = ((rx * right[0] + ry * right[1] + rz * right[2]) / size[0] + 0.5) * (columns - 1);
                p[k][1] = (0.5 - (rx * up[0] + ry * up[1] + rz * up[2]) / size[1]) * (rows - 1);
                p[k][2] = rx * normal[0] + ry * normal[1] + rz * normal[2];
            }
            const [a, b, c] = p, area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if (area >= 0) continue; // y is down: those turned to the viewer are clockwise
            const last = [Math.floor(Math.max(a[0], b[0], c[0])), Math.floor(Math.max(a[1], b[1], c[1]))];
            for (let j = Math.max(Math.ceil(Math.min(a[1], b[1], c[1])), 0); j <= Math.min(last[1], rows - 1); j++)
                for (let i = Math.max(Math.ceil(Math.min(a[0], b[0], c[0])), 0); i <= Math.min(last[0], columns - 1); i++) {
                    const sb = ((i - a[0]) * (c[1] - a[1]) - (j - a[1]) * (c[0] - a[0])) / area;
                    const sc = ((b[0] - a[0]) * (j - a[1]) - (b[1] - a[1]) * (i - a[0])) / area, sa = 1 - sb - sc;
                    if (sa < -1e-6 || sb < -1e-6 || sc < -1e-6) continue;
                    const depth = sa * a[2] + sb * b[2] + sc * c[2], at = j * columns + i;
                    if (depth <= near[at]) continue;
                    near[at] = depth;
                    for (let k = 0; k < 3; k++)
                        grid[3 * at + k] = sa * position[3 * index[t] + k] + sb * position[3 * index[t + 1] + k] + sc * position[3 * index[t + 2] + k];
                }
        }
    }
}

// Ericson, Real-Time Collision Detection, 5.1.5, by shares; else the nearest of the sides.
function nearestOnFace(p, a, b, c) {
    const u = minus(b, a), v = minus(c, a), r = minus(p, a), n = cross(u, v), nn = dot(n, n);
    const sc = dot(cross(u, r), n) / nn, sb = dot(cross(r, v), n) / nn;
    if (sb >= 0 && sc >= 0 && sb + sc <= 1) return along(p, n, -dot(r, n) / nn);
    let least = Infinity, found = a;
    for (const [from, to] of [[a, b], [b, c], [c, a]]) {
        const e = minus(to, from), share = Math.min(Math.max(dot(minus(p, from), e) / dot(e, e), 0), 1), at = along(from, e, share);
        const away = dot(minus(p, at), minus(p, at));
        if (away < least) {
            least = away;
            found = at;
        }
    }
    return found;
}
