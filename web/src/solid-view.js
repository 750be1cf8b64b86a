// The carved object in space: turn it, look from named sides, light it from inside, see what bears and what gives way.
//
// How:     indexed triangles as the server sends them, one draw call; normals of the faces come from the fragment shader,
//          so that no vertex stands for three. Drawn when something changed, never in an endless loop.
// Frame:   z is up, the front is -y. A plate lies on the ground as it is printed; here it stands, the picture in front.
// Checked: web/tests/solid.test.mjs, web/bench/orbit.mjs.

import {
    AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, Group, Mesh, MeshLambertMaterial,
    PerspectiveCamera, PointLight, Quaternion, Scene, Sphere, Vector3, Vector4, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { make } from "./dom.js";
import { legendOf, quantityOf } from "./solid-legend.js";
import { Marks } from "./solid-marks.js";
import { outwardAt, readMesh, wallOf } from "./solid-mesh.js";
import { text } from "./strings.js";

const SIDES = { perspective: [0.42, -1, 0.3], front: [0, -1, 0], back: [0, 1, 0], topView: [0, -0.001, 1], side: [1, 0, 0] };
const TURN_MS = 260, KEY_STEP = 0.15, ROOM = 1.22; // what the object leaves free around it, for its dimensions
const calm = matchMedia("(prefers-reduced-motion: reduce)");

/** A mesh of the server's as three.js draws it. */
export function geometryOf(mesh) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(mesh.position, 3));
    if (mesh.colour) geometry.setAttribute("color", new BufferAttribute(mesh.colour, 4, true));
    geometry.setIndex(new BufferAttribute(mesh.index, 1));
    const middle = new Vector3(...mesh.low).add(new Vector3(...mesh.high)).multiplyScalar(0.5);
    geometry.boundingSphere = new Sphere(middle, middle.distanceTo(new Vector3(...mesh.high)));
    return geometry;
}

// Colours of a map are meant as they stand, not as light; a shader that takes them for light gets the light they are of.
function mapMaterial() {
    const material = new MeshLambertMaterial({ vertexColors: true, flatShading: true });
    material.onBeforeCompile = (shader) => {
        shader.fragmentShader = shader.fragmentShader.replace("#include <color_fragment>", "diffuseColor.rgb *= pow(vColor.rgb, vec3(2.2));");
    };
    return material;
}

// Stone, darker inside a hollow object: a void shows the dark behind it, as it would by day, and not more of the same stone.
// `inside`: view coordinates of the object's middle, and how much is taken away there.
function stoneMaterial(inside) {
    const material = new MeshLambertMaterial({ color: new Color(0xe2d5c3), flatShading: true });
    material.onBeforeCompile = (shader) => {
        shader.uniforms.inside = inside;
        shader.fragmentShader = `uniform vec4 inside;\n${shader.fragmentShader}`.replace("#include <emissivemap_fragment>", `
            float outwards = dot(normal, normalize(-vViewPosition - inside.xyz));
            diffuseColor.rgb *= 1.0 - inside.w * (1.0 - smoothstep(-0.5, 0.1, outwards));`);
    };
    return material;
}

export class SolidView {
    /** `wanted(layer)` is asked for the bytes of "stress" or "displacement" when they are to be shown. */
    constructor(stage, wanted) {
        this.root = make("div", { class: "fill solid", hidden: true });
        this.wanted = wanted;
        this.layer = "object";
        this.lit = false;
        stage.append(this.root);
        try {
            this.renderer = new WebGLRenderer({ antialias: true, alpha: true, powerPreference: "high-performance" });
        } catch {
            this.root.append(make("p", { class: "notice" }, text("noWebgl")));
            return;
        }
        this.canvas = this.renderer.domElement;
        this.canvas.tabIndex = 0;
        this.canvas.setAttribute("role", "img");
        this.layers = make("div", { class: "layers", role: "group" });
        this.bar = make("div", { class: "sides", role: "group" });
        this.tools = make("div", { class: "sides" }); // what others add
        this.whenShown = () => {};
        this.cards = make("div", { class: "cards" });
        this.root.append(this.canvas);
        this.marks = new Marks(this.root);
        this.root.append(make("div", { class: "solid-bar" }, this.layers, this.bar, this.tools), this.cards);
        this.furnish();
        new ResizeObserver(() => this.resize()).observe(stage);
        this.canvas.addEventListener("keydown", (event) => this.turnByKey(event));
        this.words();
    }

    furnish() {
        this.scene = new Scene();
        this.object = new Group();
        this.camera = new PerspectiveCamera(30, 1, 0.1, 5000);
        this.camera.up.set(0, 0, 1);
        this.controls = new OrbitControls(this.camera, this.canvas);
        this.controls.addEventListener("change", () => this.draw());
        this.controls.addEventListener("start", () => { this.framed = null; });
        this.ambient = new AmbientLight(0xffffff, 0.9);
        this.sun = new DirectionalLight(0xffffff, 2.3);
        this.lamp = new PointLight(0xffc078, 0, 0, 0);
        this.scene.add(this.object, this.ambient, this.sun, this.sun.target, this.lamp);
        this.inside = { value: new Vector4() };
        this.stone = stoneMaterial(this.inside);
        this.map = mapMaterial();
        // Of a map, the rest of the object is there as a shade: what is not part of the sheet bears nothing here.
        this.shade = new MeshLambertMaterial({ color: new Color(0xb9ad9c), flatShading: true, transparent: true, opacity: 0.28, depthWrite: false,
            polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 8 });
        this.view = { camera: this.camera, object: this.object, width: 1, height: 1 };
        this.ahead = new Vector3();
    }

    words() {
        if (!this.bar) return;
        this.canvas.setAttribute("aria-label", text("solidHelp"));
        this.bar.setAttribute("aria-label", text("standardViews"));
        this.layers.setAttribute("aria-label", text("layers"));
        this.marks.unit = text("mm");
        this.marks.wallWords = text("wall");
        const side = (key) => make("button", { type: "button", "data-side": key, onclick: () => this.look(new Vector3(...SIDES[key])) }, text(key));
        const flip = (key, on, act) => {
            const button = make("button", { type: "button", "aria-pressed": String(on), "data-flip": key, onclick: () => {
                const now = button.getAttribute("aria-pressed") !== "true";
                button.setAttribute("aria-pressed", String(now));
                act(now);
            } }, text(key));
            return button;
        };
        this.bar.replaceChildren(...Object.keys(SIDES).map(side), flip("light", this.lit, (on) => this.light(on)),
            flip("dimensions", this.marks.shown, (on) => { this.marks.shown = on; this.draw(); }));
        this.showLayers();
    }

    // The chooser of what is shown; maps are there only when something presses.
    showLayers() {
        const structure = this.run?.structure;
        this.layers.hidden = !structure;
        this.layers.replaceChildren(...["object", "stress", "displacement"].map((name) =>
            make("button", { type: "button", "data-layer": name, "aria-pressed": String(name === this.layer), onclick: () => this.choose(name) }, text(`${name}Layer`))),
            make("button", { type: "button", "data-weakest": true, onclick: () => this.goToWeakest() }, text("weakest")));
        this.cards.replaceChildren(...(structure && this.layer !== "object" ? [legendOf(structure, this.layer)] : []));
    }

    /** Show the object of a run: mesh.bin's bytes, and of its figures `flat`, `structure` and the wall's `thickness`. */
    show(buffer, run) {
        if (!this.renderer) return;
        const first = !this.run, turned = this.run?.flat !== run.flat;
        this.run = run;
        this.meshes = { object: readMesh(buffer) };
        this.object.rotation.x = run.flat ? Math.PI / 2 : 0;
        this.object.updateMatrixWorld();
        this.marks.box = this.meshes.object;
        this.marks.wall = run.flat ? null : wallOf(this.meshes.object, run.thickness);
        this.measure();
        this.resize();
        if (first || turned) this.look(new Vector3(...SIDES.perspective), true);
        this.choose(run.structure ? this.layer : "object");
    }

    measure() {
        const { low, high } = this.meshes.object;
        this.middle = new Vector3(...low).add(new Vector3(...high)).multiplyScalar(0.5);
        this.radius = this.middle.distanceTo(new Vector3(...high));
        this.middle.applyMatrix4(this.object.matrixWorld);
        this.lamp.position.copy(this.middle);
        if (this.run.flat) this.lamp.position.y += 0.6 * this.radius; // behind the screen
        this.controls.minDistance = this.radius / 20;
        this.controls.maxDistance = this.radius * 12;
        this.camera.near = this.radius / 50;
        this.camera.far = this.radius * 20;
        this.camera.updateProjectionMatrix();
    }

    /** Show a layer, fetching what it needs; an object that came meanwhile wins. */
    async choose(name) {
        const run = this.run;
        this.layer = name;
        this.showLayers();
        if (!this.meshes[name]) {
            const mesh = readMesh(await this.wanted(name));
            if (this.run !== run) return;
            this.meshes[name] = mesh;
        }
        if (this.layer !== name) return;
        this.put(this.meshes[name]);
        this.whenShown();
    }

    put(mesh) {
        const group = new Group().add(new Mesh(geometryOf(mesh), mesh.colour ? this.map : this.stone));
        if (mesh.colour && !this.run.flat) group.add(new Mesh(geometryOf(this.meshes.object), this.shade));
        this.replace(group);
        this.marks.weakest = mesh.colour ? this.weakestOf(mesh) : null;
        this.draw();
    }

    /** Show something else in the object's place. */
    replace(group) {
        for (const old of [...this.object.children]) {
            for (const part of old.children) part.geometry.dispose();
            old.removeFromParent();
        }
        this.object.add(group);
        this.light(this.lit);
    }

    weakestOf(mesh) {
        const { at, most, unit } = quantityOf(this.run.structure, this.layer);
        return { at, outward: outwardAt(mesh, at), words: `${Number(most.toPrecision(3))} ${unit}` };
    }

    async goToWeakest() {
        if (this.layer === "object") await this.choose("stress");
        const { at, outward } = this.marks.weakest ?? {};
        if (!at) return;
        const way = new Vector3(...outward).transformDirection(this.object.matrixWorld);
        way.z += 0.12;
        this.look(way, false, new Vector3(...at).applyMatrix4(this.object.matrixWorld), 0.45);
    }

    // --- The camera

    /** Look from a direction, at the whole object or at a place of it from nearer. */
    look(direction, atOnce = false, target = this.middle, share = 1) {
        if (!this.middle) return;
        this.framed = share === 1 ? direction : null; // stays framed when the window changes, until the user turns it
        const from = this.camera.position.clone().sub(this.controls.target), to = direction.clone().normalize();
        const distance = share * this.distanceFrom(to);
        this.turn = { began: 0, target: this.controls.target.clone(), goal: target.clone(), from: from.clone().normalize(), by: new Quaternion(),
            length: from.length(), distance, to };
        this.turn.by.setFromUnitVectors(this.turn.from, to);
        if (atOnce || calm.matches) this.turn.began = -Infinity;
        this.draw();
    }

    // From how far the corners of the object's box fit into the view, with room around them.
    distanceFrom(direction) {
        const { low, high } = this.meshes.object, up = Math.tan((this.camera.fov * Math.PI) / 360) / ROOM;
        const right = new Vector3().crossVectors(this.camera.up, direction).normalize(), above = new Vector3().crossVectors(direction, right);
        let far = 0;
        for (let i = 0; i < 8; i++) {
            const corner = new Vector3(i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]).applyMatrix4(this.object.matrixWorld).sub(this.middle);
            const wide = Math.abs(corner.dot(right)) / (up * this.camera.aspect), tall = Math.abs(corner.dot(above)) / up;
            far = Math.max(far, corner.dot(direction) + Math.max(wide, tall));
        }
        return far;
    }

    // A step of the turn to another side; false when there is none under way.
    turnOn(now) {
        const turn = this.turn;
        if (!turn) return false;
        turn.began ||= now;
        const t = Math.min((now - turn.began) / TURN_MS, 1), eased = t * t * (3 - 2 * t);
        const way = t < 1 ? turn.from.clone().applyQuaternion(new Quaternion().slerp(turn.by, eased)) : turn.to;
        this.controls.target.lerpVectors(turn.target, turn.goal, eased);
        this.camera.position.copy(this.controls.target).addScaledVector(way, turn.length + (turn.distance - turn.length) * eased);
        if (t === 1) this.turn = null;
        this.controls.update();
        return t < 1;
    }

    light(on) {
        this.lit = on;
        const map = this.layer !== "object"; // its colours are to be read
        this.lamp.intensity = on && !map ? 3.2 : 0;
        this.sun.intensity = map ? 0.9 : on ? 0.22 : 2.5;
        this.ambient.intensity = map ? 2.2 : on ? 0.16 : 1.25;
        this.root.classList.toggle("night", on);
        this.draw();
    }

    turnByKey(event) {
        const step = { ArrowLeft: [-KEY_STEP, 0], ArrowRight: [KEY_STEP, 0], ArrowUp: [0, KEY_STEP], ArrowDown: [0, -KEY_STEP] }[event.key];
        const nearer = { "+": 0.85, "=": 0.85, "-": 1 / 0.85 }[event.key];
        if (event.key === "Home") this.look(new Vector3(...SIDES.perspective));
        else if (step || nearer) this.orbit(...(step ?? [0, 0]), nearer ?? 1);
        else return;
        event.preventDefault();
    }

    /** Turn by angles around and above, and come nearer by a factor. */
    orbit(around, above, times = 1) {
        if (!this.middle) return;
        this.framed = this.turn = null;
        const offset = this.camera.position.clone().sub(this.controls.target), length = offset.length() * times;
        const phi = Math.atan2(offset.y, offset.x) + around;
        const height = Math.min(Math.max(Math.asin(offset.z / offset.length()) + above, -1.55), 1.55);
        offset.set(Math.cos(height) * Math.cos(phi), Math.cos(height) * Math.sin(phi), Math.sin(height)).multiplyScalar(length);
        this.camera.position.copy(this.controls.target).add(offset);
        this.controls.update();
        this.draw();
    }

    resize() {
        const width = this.root.clientWidth, height = this.root.clientHeight;
        if (!this.renderer || width === 0 || height === 0) return;
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        this.renderer.setSize(width, height);
        this.view.width = width;
        this.view.height = height;
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        if (this.framed) this.look(this.framed, true);
        this.draw();
    }

    draw() {
        if (!this.renderer || this.asked) return;
        this.asked = requestAnimationFrame((now) => {
            this.asked = 0;
            if (this.root.hidden) return;
            if (this.turnOn(now)) this.draw();
            this.drawNow();
        });
    }

    drawNow() {
        const reach = this.radius ?? 1;
        this.sun.position.copy(this.camera.position);
        this.sun.position.x += 0.6 * reach;
        this.sun.position.z += 0.9 * reach;
        this.sun.target.position.copy(this.controls.target);
        if (this.middle) {
            this.camera.updateMatrixWorld();
            this.ahead.copy(this.middle).applyMatrix4(this.camera.matrixWorldInverse);
            this.inside.value.set(this.ahead.x, this.ahead.y, this.ahead.z, this.run.flat || this.lit ? 0 : 0.62);
        }
        this.renderer.render(this.scene, this.camera);
        this.marks.update(this.view);
    }
}
