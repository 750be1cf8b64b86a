// The carved object in space: turn it, look from named sides, light it from inside.

import {
    AmbientLight, Box3, BufferAttribute, BufferGeometry, DirectionalLight, DoubleSide, Mesh, MeshStandardMaterial,
    PerspectiveCamera, PointLight, Scene, Sphere, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { make } from "./dom.js";
import { text } from "./strings.js";

// A binary STL, as jali writes it: 80 bytes, a count, then 50 bytes a triangle.
function geometryOf(buffer) {
    const view = new DataView(buffer), count = view.getUint32(80, true);
    const position = new Float32Array(9 * count), normal = new Float32Array(9 * count);
    for (let i = 0, at = 84; i < count; i++, at += 50)
        for (let k = 0; k < 9; k++) {
            position[9 * i + k] = view.getFloat32(at + 12 + 4 * k, true);
            normal[9 * i + k] = view.getFloat32(at + 4 * (k % 3), true);
        }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(position, 3));
    geometry.setAttribute("normal", new BufferAttribute(normal, 3));
    return geometry;
}

export class SolidView {
    constructor(stage) {
        this.root = make("div", { class: "fill", hidden: true });
        stage.append(this.root);
        try {
            this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
        } catch {
            this.root.append(make("p", { class: "notice" }, text("noWebgl")));
            return;
        }
        this.canvas = this.renderer.domElement;
        this.canvas.tabIndex = 0;
        this.bar = make("div", { class: "sides", role: "group" });
        this.root.append(this.canvas, this.bar);
        this.scene = new Scene();
        this.camera = new PerspectiveCamera(35, 1, 0.1, 5000);
        this.camera.up.set(0, 0, 1);
        this.controls = new OrbitControls(this.camera, this.canvas);
        this.controls.addEventListener("change", () => this.draw());
        this.ambient = new AmbientLight(0xffffff, 0.9);
        this.sun = new DirectionalLight(0xffffff, 2.2);
        this.lamp = new PointLight(0xffc890, 0, 0, 0);
        this.scene.add(this.ambient, this.sun, this.lamp);
        this.material = new MeshStandardMaterial({ color: 0xd9cbb8, roughness: 0.75, metalness: 0, side: DoubleSide });
        new ResizeObserver(() => this.resize()).observe(stage);
        this.canvas.addEventListener("keydown", (event) => this.turnByKey(event));
        this.words();
    }

    words() {
        if (!this.bar) return;
        this.canvas.setAttribute("aria-label", text("solidHelp"));
        const side = (key, ...direction) => make("button", { type: "button", onclick: () => this.look(new Vector3(...direction)) }, text(key));
        const lit = make("button", { type: "button", "aria-pressed": "false", onclick: () => {
            const on = lit.getAttribute("aria-pressed") !== "true";
            lit.setAttribute("aria-pressed", String(on));
            this.light(on);
        } }, text("light"));
        this.bar.replaceChildren(side("front", 0, -1, 0.12), side("back", 0, 1, 0.12), side("side", 1, -0.3, 0.2), side("topView", 0, -0.01, 1), lit);
    }

    /** Show the object of a run; flat plates are seen from above. */
    show(buffer, flat) {
        if (!this.renderer) return;
        this.mesh?.geometry.dispose();
        this.mesh?.removeFromParent();
        this.mesh = new Mesh(geometryOf(buffer), this.material);
        this.scene.add(this.mesh);
        const box = new Box3().setFromObject(this.mesh);
        this.ball = box.getBoundingSphere(new Sphere());
        this.lamp.position.copy(this.ball.center);
        if (this.flat !== flat || !this.shown) this.look(flat ? new Vector3(0.1, -0.5, 1) : new Vector3(0.35, -1, 0.35));
        this.flat = flat;
        this.shown = true;
        this.resize();
    }

    look(direction) {
        if (!this.ball) return;
        const distance = this.ball.radius / Math.sin((this.camera.fov * Math.PI) / 360) * 1.02;
        this.controls.target.copy(this.ball.center);
        this.camera.position.copy(this.ball.center).addScaledVector(direction.normalize(), distance);
        this.camera.near = this.ball.radius / 50;
        this.camera.far = this.ball.radius * 30;
        this.controls.update();
        this.draw();
    }

    light(on) {
        this.lamp.intensity = on ? 3 : 0;
        this.sun.intensity = on ? 0.25 : 2.2;
        this.ambient.intensity = on ? 0.15 : 0.9;
        this.draw();
    }

    turnByKey(event) {
        const step = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, 0.15], ArrowDown: [0, -0.15] }[event.key];
        if (!step || !this.ball) return;
        event.preventDefault();
        const offset = this.camera.position.clone().sub(this.controls.target);
        const length = offset.length(), around = Math.atan2(offset.y, offset.x) + step[0];
        const above = Math.min(Math.max(Math.asin(offset.z / length) + step[1], -1.5), 1.5);
        offset.set(Math.cos(above) * Math.cos(around), Math.cos(above) * Math.sin(around), Math.sin(above)).multiplyScalar(length);
        this.camera.position.copy(this.controls.target).add(offset);
        this.controls.update();
        this.draw();
    }

    resize() {
        const width = this.root.clientWidth, height = this.root.clientHeight;
        if (!this.renderer || width === 0 || height === 0) return;
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        this.renderer.setSize(width, height);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        this.draw();
    }

    // Drawn when something changed, not sixty times a second for nothing.
    draw() {
        if (!this.renderer || this.asked) return;
        this.asked = requestAnimationFrame(() => {
            this.asked = 0;
            this.sun.position.copy(this.camera.position).add(new Vector3(0.6, 0, 0.9).multiplyScalar(this.ball?.radius ?? 1));
            this.sun.target.position.copy(this.controls.target);
            this.sun.target.updateMatrixWorld();
            this.renderer.render(this.scene, this.camera);
        });
    }
}
