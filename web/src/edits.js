// Edits by hand as values: a text that fits into the address, the program's JSON (docs/edits.md), and the way from the
// picture's own pixels to those shown.
//
// The text: the picture's size, then each edit after a "*": its kind's letter, its width, and its points, all joined
// by "_", in the picture's own pixels to a tenth: 1000_800*b9_310_420_350.5_400*l_0_0_90_0_90_60. None is "".

const LETTERS = { bridge: "b", forbid: "f", lock: "l" };
const KINDS = Object.fromEntries(Object.entries(LETTERS).map(([kind, letter]) => [letter, kind]));
const FEWEST = { bridge: 2, forbid: 1, lock: 1 }, MOST_EDITS = 10000;
export const NONE = Object.freeze({ size: null, list: Object.freeze([]) });

const round = (value) => Math.round(10 * value) / 10;

/** The text of edits {size: [w, h], list: [{kind, width, points}]}. */
export function textOf({ size, list }) {
    if (list.length === 0 || !size) return "";
    return [size.join("_"), ...list.map(({ kind, width, points }) => [LETTERS[kind] + (width ? round(width) : ""), ...points.flat().map(round)].join("_"))].join("*");
}

function editOf(words) {
    const [head, ...rest] = words.split("_"), numbers = rest.map(Number), width = Number(head.slice(1));
    const points = numbers.flatMap((x, i) => (i % 2 ? [] : [[x, numbers[i + 1]]]));
    const kind = KINDS[head[0]], fewest = kind !== "bridge" && width === 0 ? 3 : FEWEST[kind];
    const sound = kind && width >= 0 && numbers.length % 2 === 0 && points.length >= fewest && rest.every((word) => word !== "") && numbers.every(Number.isFinite);
    return sound ? { kind, width, points } : null;
}

/** Back from the text; what is none gives NONE. */
export function editsOf(words) {
    const [head, ...rest] = String(words ?? "").split("*"), size = head.split("_").map(Number), list = rest.map(editOf);
    const sound = size.length === 2 && size.every((n) => n > 0 && Number.isFinite(n)) && list.length > 0 && list.length <= MOST_EDITS && list.every(Boolean);
    return sound ? { size, list } : NONE;
}

/** As the program takes them; null when there are none. */
export function jsonOf({ size, list }) {
    return list.length === 0 ? null : { version: 1, size, edits: list.map(({ kind, width, points }) => ({ kind, points, ...(width ? { width } : {}) })) };
}

// Quarter turns clockwise of a point in w x h.
function turned([x, y], w, h, quarters) {
    for (let i = 0; i < quarters; i++) [x, y, w, h] = [h - y, x, h, w];
    return [x, y];
}

/** From the picture's own pixels to those shown and back, as the state s has it cropped, turned and mirrored. */
export function wayToShown(size, s) {
    const [left, top, w, h] = s.crop ? s.crop.split(",").map(Number) : [0, 0, ...size];
    const quarters = (s.rotate / 90) % 4, [width, height] = quarters % 2 ? [h, w] : [w, h];
    return {
        width, height,
        shown([x, y]) {
            const [u, v] = turned([x - left, y - top], w, h, quarters);
            return s.mirror ? [width - u, v] : [u, v];
        },
        own([u, v]) {
            const [x, y] = turned([s.mirror ? width - u : u, v], width, height, (4 - quarters) % 4);
            return [x + left, y + top];
        },
    };
}

/** An edit that went by dx, dy; `end` names one of its points, -1 all. */
export function moved(edit, end, dx, dy) {
    return { ...edit, points: edit.points.map(([x, y], i) => (end < 0 || i === end ? [x + dx, y + dy] : [x, y])) };
}
