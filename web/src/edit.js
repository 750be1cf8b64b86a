// Bridges by hand, on the picture: what was found can be pinned, forbidden and moved, more can be drawn, places
// forbidden, regions locked.
//
// An SVG lies over the picture's canvas. Found bridges come with each run; what was laid down by hand is the state's
// `edits`, so undo, address and project file know it. Each drag has a key: Tab goes from one to the next, arrow keys move it,
// "e" chooses which end, Enter lays a new one down.

import { make } from "./dom.js";
import { NONE, editsOf, jsonOf, moved, textOf, wayToShown } from "./edits.js";
import { change, state } from "./state.js";
import { text } from "./strings.js";

const SVG = "http://www.w3.org/2000/svg", TOOLS = ["select", "bridge", "forbid", "lock", "erase"], MOST_FOUND = 1500;
const CLICK_PX = 4, ROOM = 3; // a pointer that went less has clicked; a forbidden bridge takes so many widths with it

function shape(tag, attributes) {
    const node = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    return node;
}

const keyOf = (points) => points.flat().map((n) => n.toFixed(1)).join();

export class Edit {
    /** tell(key, values) says something to the user. */
    constructor(view, bar, tell) {
        this.view = view;
        this.tell = tell;
        this.found = NONE; // bridges of the last run
        this.tool = "select";
        this.chosen = null; // {hand: index} or {found: key}
        this.end = -1; // which point the arrow keys move
        this.drag = null;
        this.toggle = make("button", { type: "button", id: "edit", "aria-pressed": "false", onclick: () => this.open(!this.isOpen) });
        bar.append(this.toggle);
        this.layer = shape("g", {});
        this.svg = shape("svg", { class: "edit-layer", tabindex: 0, role: "application" });
        this.svg.append(this.layer);
        this.tools = make("div", { class: "edit-bar", role: "toolbar" });
        this.root = make("div", { class: "fill edit", hidden: true }, this.svg, this.tools);
        view.root.append(this.root);
        view.onDraw = () => this.lay();
        this.listen();
        this.words();
    }

    get isOpen() { return !this.root.hidden; }
    get edits() { return editsOf(state().edits); }
    get size() { return this.found.size ?? this.edits.size; }

    words() {
        this.toggle.textContent = text("edit");
        this.svg.setAttribute("aria-label", text("editStage"));
        this.tools.setAttribute("aria-label", text("editTools"));
        const button = (words, attributes) => make("button", { type: "button", "data-act": words, title: text(`edit_${words}_hint`), ...attributes }, text(`edit_${words}`));
        this.toolButtons = TOOLS.map((tool) => button(tool, { "data-tool": tool, "aria-pressed": "false", onclick: () => this.take(tool) }));
        this.acts = ["pin", "avoid", "remove"].map((act) => button(act, { onclick: () => this.act(act) }));
        this.width = make("input", { type: "number", min: 0, max: 100, step: 0.1, "aria-label": text("edit_width"), onchange: () => this.setWidth(Number(this.width.value)) });
        this.widthRow = make("label", { class: "edit-width" }, text("edit_width"), this.width, text("mm"));
        this.save = button("save", { onclick: () => this.download() });
        this.tools.replaceChildren(...this.toolButtons, make("span", { class: "edit-acts" }, this.acts, this.widthRow), this.save);
        this.draw();
    }

    /** Bridges of a run, as bridges.json has them. */
    show(json) {
        this.found = { size: json.size, list: json.edits.slice(0, MOST_FOUND) };
        this.draw();
    }

    open(wanted) {
        this.root.hidden = !wanted;
        this.toggle.setAttribute("aria-pressed", String(wanted));
        this.view.setSplit(wanted ? 0 : 0.5);
        if (!wanted) return this.choose(null);
        this.draw();
        this.svg.focus({ preventScroll: true });
        this.tell("editHelp");
    }

    take(tool) {
        this.tool = tool;
        this.choose(null);
    }

    // --- What is there

    /** Everything that can be chosen, in the order of Tab: by hand first. */
    items() {
        const hand = this.edits.list.map((edit, i) => ({ edit, id: { hand: i } }));
        return [...hand, ...this.found.list.map((edit) => ({ edit, id: { found: keyOf(edit.points) } }))];
    }

    isChosen(id) {
        return Boolean(this.chosen) && this.chosen.hand === id.hand && this.chosen.found === id.found;
    }

    get item() { return this.items().find(({ id }) => this.isChosen(id)) ?? null; }

    choose(id) {
        this.chosen = id;
        this.end = -1;
        this.draw();
        const items = this.items(), at = items.findIndex((one) => this.isChosen(one.id));
        if (at >= 0) this.tell(`edit_is_${id.found ? "found" : items[at].edit.kind}`, { at: at + 1, all: items.length });
    }

    set(list, chosen) {
        change({ edits: textOf({ size: this.size, list }) });
        this.choose(chosen);
    }

    /** An edit takes the place of the one that is chosen; a found bridge becomes a drawn one, and its place is forbidden. */
    replace({ edit, id }, by) {
        const { list } = this.edits;
        if (id.found === undefined) return this.set(list.map((one, i) => (i === id.hand ? by : one)), id);
        this.set([...list, { ...edit, kind: "forbid" }, by], { hand: list.length + 1 });
    }

    add(edit) {
        const { list } = this.edits;
        this.set([...list, edit], { hand: list.length });
    }

    act(name) {
        const item = this.item, { list } = this.edits;
        if (!item) return;
        const isFound = item.id.found !== undefined;
        if (name === "pin" && isFound) this.add(item.edit);
        if (name === "avoid" && isFound) this.add({ ...item.edit, kind: "forbid", width: ROOM * item.edit.width });
        if (name === "remove" && !isFound) this.set(list.filter((_, i) => i !== item.id.hand), null);
        if (name === "remove" && isFound) this.act("avoid");
    }

    get pxPerMm() { return this.size ? wayToShown(this.size, state()).width / state().width : 1; }

    setWidth(mm) {
        const item = this.item;
        if (item && item.id.hand !== undefined && mm >= 0) this.replace(item, { ...item.edit, width: mm * this.pxPerMm });
    }

    download() {
        const link = make("a", { href: URL.createObjectURL(new Blob([JSON.stringify(jsonOf(this.edits), null, 1)], { type: "application/json" })), download: "edits.json" });
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    }

    // --- How it looks

    lay() {
        if (!this.isOpen || !this.size) return;
        const { left, top, width } = this.view.frame(), way = wayToShown(this.size, state());
        this.layer.setAttribute("transform", `translate(${left} ${top}) scale(${width / way.width})`);
    }

    draw() {
        if (!this.isOpen) return;
        const item = this.item, isFound = item?.id.found !== undefined, { list } = this.edits;
        for (const button of this.toolButtons) button.setAttribute("aria-pressed", String(button.dataset.tool === this.tool));
        for (const button of this.acts) button.hidden = !item || (!isFound && button.dataset.act !== "remove");
        this.widthRow.hidden = !item || isFound || (item.edit.kind !== "bridge" && item.edit.width === 0);
        if (item && document.activeElement !== this.width) this.width.value = Math.round((10 * item.edit.width) / this.pxPerMm) / 10;
        this.save.hidden = list.length === 0;
        this.svg.classList.toggle("drawing", this.tool !== "select" && this.tool !== "erase");
        if (!this.size) return;
        const way = wayToShown(this.size, state());
        this.layer.replaceChildren(...this.items().reverse().map((one) => this.drawn(one, way)), ...this.handles(item, way));
        this.lay();
    }

    // Strokes as wide as they are and never too thin to see; a wider one that is not seen takes the pointer.
    drawn({ edit, id }, way) {
        const kind = id.found === undefined ? edit.kind : "found", points = edit.points.map((p) => way.shown(p)).join(" ");
        const isRegion = edit.kind !== "bridge" && edit.width === 0, tag = isRegion ? "polygon" : "polyline";
        const group = shape("g", { class: `edit-item ${kind}${this.isChosen(id) ? " chosen" : ""}` });
        if (!isRegion) group.append(shape(tag, { points, class: "reach" }), shape(tag, { points, class: "thin" }));
        group.append(shape(tag, { points, class: isRegion ? "region" : "stroke", ...(isRegion ? {} : { "stroke-width": edit.width }) }));
        group.addEventListener("pointerdown", (event) => this.grab(event, id, -1));
        return group;
    }

    handles(item, way) {
        if (!item) return [];
        return item.edit.points.map((point, i) => {
            const [cx, cy] = way.shown(point), handle = shape("path", { d: `M${cx} ${cy}h0`, class: `edit-end${i === this.end ? " active" : ""}` });
            handle.addEventListener("pointerdown", (event) => this.grab(event, item.id, i));
            return handle;
        });
    }

    // --- Pointer

    at(event) {
        const { left, top, width } = this.view.frame(), box = this.svg.getBoundingClientRect(), way = wayToShown(this.size, state());
        const scale = way.width / width;
        return way.own([(event.clientX - box.left - left) * scale, (event.clientY - box.top - top) * scale]);
    }

    grab(event, id, end) {
        if (event.button !== 0) return;
        event.stopPropagation();
        this.svg.focus({ preventScroll: true });
        if (this.tool === "erase") {
            this.choose(id);
            return this.act("remove");
        }
        this.choose(id);
        this.svg.setPointerCapture(event.pointerId);
        this.drag = { from: this.at(event), end, item: this.item, event };
    }

    begin(event) {
        if (event.button !== 0 || !this.size || !this.svg.classList.contains("drawing")) return;
        this.svg.setPointerCapture(event.pointerId);
        this.drag = { from: this.at(event), fresh: this.tool, event };
    }

    // What the drag makes of it by now.
    dragged(event) {
        const { from, fresh, item, end } = this.drag, to = this.at(event);
        return fresh ? this.fresh(fresh, from, to) : moved(item.edit, end, to[0] - from[0], to[1] - from[1]);
    }

    // A bridge from there to here; a box with its sides as shown.
    fresh(kind, from, to) {
        if (kind === "bridge") return { kind, width: 0, points: [from, to] };
        const way = wayToShown(this.size, state()), a = way.shown(from), b = way.shown(to);
        return { kind, width: 0, points: [a, [b[0], a[1]], b, [a[0], b[1]]].map((p) => way.own(p)) };
    }

    hasGone(event) {
        return Math.hypot(event.clientX - this.drag.event.clientX, event.clientY - this.drag.event.clientY) >= CLICK_PX;
    }

    listen() {
        this.svg.addEventListener("pointerdown", (event) => this.begin(event));
        this.svg.addEventListener("pointermove", (event) => {
            if (!this.drag || !this.hasGone(event)) return;
            this.trial?.remove();
            this.trial = this.drawn({ edit: this.dragged(event), id: {} }, wayToShown(this.size, state()));
            this.trial.classList.add("trial");
            this.layer.append(this.trial);
        });
        this.svg.addEventListener("pointerup", (event) => {
            if (!this.drag) return;
            const made = this.hasGone(event) ? this.dragged(event) : null, { item } = this.drag;
            this.stop();
            if (made && item) this.replace(item, made);
            else if (made) this.add(made);
        });
        this.svg.addEventListener("pointercancel", () => this.stop());
        this.svg.addEventListener("wheel", (event) => {
            event.preventDefault();
            this.view.zoom(Math.exp(-event.deltaY * 0.0015), event.offsetX, event.offsetY);
        }, { passive: false });
        this.svg.addEventListener("keydown", (event) => this.key(event));
    }

    stop() {
        this.drag = null;
        this.trial?.remove();
        this.trial = null;
    }

    // --- Keys

    key(event) {
        const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
        const acts = { Delete: "remove", Backspace: "remove", p: "pin", f: "avoid" };
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        if (way) this.nudge(way, event.shiftKey ? 1 : 5);
        else if (event.key === "Tab") { if (!this.step(event.shiftKey ? -1 : 1)) return; }
        else if (event.key === "Enter") this.layDown();
        else if (event.key === "e") this.nextEnd();
        else if (acts[event.key]) this.act(acts[event.key]);
        else if (event.key === "Escape") this.back();
        else return;
        event.preventDefault();
        event.stopPropagation();
    }

    back() {
        if (this.drag) return this.stop();
        if (this.chosen) return this.choose(null);
        this.open(false);
        this.toggle.focus();
    }

    /** To the next one; false behind the last, so that Tab goes on through the page. */
    step(by) {
        const items = this.items(), at = items.findIndex(({ id }) => this.isChosen(id));
        const next = at < 0 ? (by > 0 ? 0 : items.length - 1) : at + by;
        this.choose(items[next]?.id ?? null);
        return Boolean(items[next]);
    }

    // Steps of so many pixels of the screen, in the direction shown.
    nudge([dx, dy], px) {
        const item = this.item, way = wayToShown(this.size, state()), step = (px * way.width) / this.view.frame().width;
        if (!item) return;
        const from = way.own([0, 0]), to = way.own([dx * step, dy * step]), { end } = this;
        this.replace(item, moved(item.edit, end, to[0] - from[0], to[1] - from[1]));
        this.end = end;
        this.draw();
    }

    nextEnd() {
        const item = this.item;
        if (!item) return;
        this.end = this.end + 1 < item.edit.points.length ? this.end + 1 : -1;
        this.draw();
        this.tell(this.end < 0 ? "edit_whole" : "edit_end", { at: this.end + 1 });
    }

    // A new one in the middle of what is seen.
    layDown() {
        if (this.tool === "select" || this.tool === "erase" || !this.size) return;
        const box = this.svg.getBoundingClientRect(), reach = Math.min(box.width, box.height) / 10;
        const x = box.left + box.width / 2, y = box.top + box.height / 2;
        this.add(this.fresh(this.tool, this.at({ clientX: x - reach, clientY: y - reach / 2 }), this.at({ clientX: x + reach, clientY: y + (this.tool === "bridge" ? -reach / 2 : reach) })));
    }
}
