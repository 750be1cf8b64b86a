// Meshes as the server sends them ("jalimesh", docs/serve.md), and what is measured on them.

const HEAD_BYTES = 20;

/** The arrays of a mesh, views of the buffer: nothing is copied. `low` and `high` are the corners of its box; of a shape,
 *  `uv` says where the corners of its triangles lie unrolled, which is `around` mm long. */
export function readMesh(buffer) {
    const view = new DataView(buffer), word = new TextDecoder().decode(new Uint8Array(buffer, 0, 8));
    const vertices = view.getInt32(8, true), triangles = view.getInt32(12, true), more = view.getInt32(16, true);
    const end = HEAD_BYTES + 12 * (vertices + triangles), size = end + [0, 4 * vertices, 24 * triangles + 4][more];
    if (word !== "jalimesh" || buffer.byteLength !== size) throw new TypeError("no mesh of ours");
    const position = new Float32Array(buffer, HEAD_BYTES, 3 * vertices);
    const index = new Uint32Array(buffer, HEAD_BYTES + 12 * vertices, 3 * triangles);
    const colour = more === 1 ? new Uint8Array(buffer, end, 4 * vertices) : null;
    const uv = more === 2 ? new Float32Array(buffer, end, 6 * triangles) : null;
    return { position, index, colour, uv, around: uv ? view.getFloat32(size - 4, true) : 0, ...boxOf(position) };
}

function boxOf(position) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < position.length; i += 3)
        for (let k = 0; k < 3; k++) {
            const value = position[i + k];
            if (value < low[k]) low[k] = value;
            if (value > high[k]) high[k] = value;
        }
    return { low, high };
}

/** The nearest hit of a ray beyond `after`, {t, normal} with the triangle's outward normal, or null.
 *  Every triangle is asked: for a question now and then. (Moeller and Trumbore 1997.) */
export function hitOf({ position, index }, [ox, oy, oz], [dx, dy, dz], after = 1e-4) {
    let nearest = Infinity, found = -1;
    for (let i = 0; i < index.length; i += 3) {
        const a = 3 * index[i], b = 3 * index[i + 1], c = 3 * index[i + 2];
        const ax = position[a], ay = position[a + 1], az = position[a + 2];
        const ux = position[b] - ax, uy = position[b + 1] - ay, uz = position[b + 2] - az;
        const vx = position[c] - ax, vy = position[c + 1] - ay, vz = position[c + 2] - az;
        const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
        const det = ux * px + uy * py + uz * pz;
        if (det > -1e-12 && det < 1e-12) continue;
        const sx = ox - ax, sy = oy - ay, sz = oz - az;
        const u = (sx * px + sy * py + sz * pz) / det;
        if (u < 0 || u > 1) continue;
        const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
        const v = (dx * qx + dy * qy + dz * qz) / det;
        if (v < 0 || u + v > 1) continue;
        const t = (vx * qx + vy * qy + vz * qz) / det;
        if (t > after && t < nearest) {
            nearest = t;
            found = i;
        }
    }
    return found < 0 ? null : { t: nearest, triangle: found / 3, normal: normalOf(position, index, found) };
}

export function normalOf(position, index, first) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * index[first + k]);
    const u = [0, 1, 2].map((k) => position[b + k] - position[a + k]), v = [0, 1, 2].map((k) => position[c + k] - position[a + k]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.hypot(...n) || 1;
    return n.map((x) => x / length);
}

/** The way out of the wall at a place. A map's vertices come in two halves, outer and inner, in the same order. */
export function outwardAt({ position }, at) {
    const half = position.length / 2;
    let nearest = Infinity, from = 0;
    for (let i = 0; i < half; i += 3) {
        const j = half + i;
        const away = ((position[i] + position[j]) / 2 - at[0]) ** 2 + ((position[i + 1] + position[j + 1]) / 2 - at[1]) ** 2 + ((position[i + 2] + position[j + 2]) / 2 - at[2]) ** 2;
        if (away < nearest) {
            nearest = away;
            from = i;
        }
    }
    const out = [0, 1, 2].map((k) => position[from + k] - position[half + from + k]), length = Math.hypot(...out) || 1;
    return out.map((x) => x / length);
}

/** Where a hollow object's wall can be measured, high on its right: {at, to, outward, mm}, or null.
 *  The wall is taken across, along the outer skin's normal; what is much thicker than `about` mm is no wall. */
export function wallOf(mesh, about) {
    const middle = [0, 1, 2].map((k) => (mesh.low[k] + mesh.high[k]) / 2), reach = mesh.high[0] - mesh.low[0] + 10;
    for (const share of [0.8, 0.9, 0.97, 0.65, 0.5, 0.3, 0.1]) {
        const from = [middle[0] + reach, middle[1], mesh.low[2] + share * (mesh.high[2] - mesh.low[2])];
        const outer = hitOf(mesh, from, [-1, 0, 0]);
        if (!outer) continue;
        const at = [from[0] - outer.t, from[1], from[2]], inwards = outer.normal.map((x) => -x);
        const inner = hitOf(mesh, at, inwards, about * 0.01);
        if (inner && inner.t < 1.5 * about) return { at, to: at.map((x, k) => x + inner.t * inwards[k]), outward: outer.normal, mm: inner.t };
    }
    return null;
}
