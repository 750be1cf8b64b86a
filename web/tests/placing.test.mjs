// Placing the picture on the object: by dragging, by keys, in figures; what is shown of it against formulas.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Skin } from "../src/skin.js";
import { address, barriers, done, number, open, shot, status, t } from "./testing.mjs";

const near = (a, b, by, what = "") => assert.ok(Math.abs(a - b) <= by, `${what} ${a}, not ${b}`);
const place = async () => (new URLSearchParams(await address()).get("at") ?? "").split(",").map(Number);

// A ball of facets, as an OFF: no shape of ours, so it does not come unrolled.
function ball(radius, rings = 60) {
    const points = [[0, 0, -radius]], faces = [];
    const at = (j, i) => 1 + (j - 1) * 2 * rings + (i % (2 * rings));
    for (let j = 1; j < rings; j++)
        for (let i = 0; i < 2 * rings; i++) {
            const up = -Math.PI / 2 + (Math.PI * j) / rings, around = (Math.PI * i) / rings;
            points.push([radius * Math.cos(up) * Math.cos(around), radius * Math.cos(up) * Math.sin(around), radius * Math.sin(up)]);
        }
    points.push([0, 0, radius]);
    for (let i = 0; i < 2 * rings; i++) {
        faces.push([0, at(1, i + 1), at(1, i)], [points.length - 1, at(rings - 1, i), at(rings - 1, i + 1)]);
        for (let j = 1; j < rings - 1; j++) faces.push([at(j, i), at(j, i + 1), at(j + 1, i)], [at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)]);
    }
    return `OFF\n${points.length} ${faces.length} 0\n${points.map((p) => p.join(" ")).join("\n")}\n${faces.map((f) => `3 ${f.join(" ")}`).join("\n")}\n`;
}

// The server as a script asks it.
async function ask(path, body, type = "application/json") {
    const { origin, hash } = new URL(t.address), headers = { "X-Jali-Token": new URLSearchParams(hash.slice(1)).get("token"), "Content-Type": type };
    const answer = await fetch(`${origin}/api/v1${path}`, { headers, ...(body ? { method: "POST", body } : {}) });
    assert.ok(answer.ok, await answer.clone().text());
    return answer;
}
const upload = async (bytes) => (await (await ask("/uploads", bytes, "application/octet-stream")).json()).id;

async function skinOf(options, more = {}) {
    const picture = await upload(await (await ask("/samples/rings.png?size=64")).arrayBuffer());
    const { id } = await (await ask("/jobs", JSON.stringify({ picture, verb: "adapt", files: ["surface.bin"], options: { width: 5, "no-predict": true, ...options }, ...more }))).json();
    await (await ask(`/jobs/${id}/events`)).text();
    return new Skin(await (await ask(`/jobs/${id}/files/surface.bin`)).arrayBuffer());
}

test("the window of a wrapped picture is where the formula has it", async () => {
    const skin = await skinOf({ surface: "cylinder:r=30,h=80" });
    const grid = skin.window(skin.nearest([20, -25, 33]), "wrap", null, [50, 30], 11, 7), middle = Math.atan2(20, 25);
    for (let j = 0; j < 7; j++)
        for (let i = 0; i < 11; i++) {
            const [x, y, z] = grid.slice(3 * (j * 11 + i)), angle = middle + (i / 10 - 0.5) * (50 / 30);
            near(Math.atan2(x, -y), angle, 0.003, "angle");
            near(z, 33 + (0.5 - j / 6) * 30, 0.01, "height");
            near(Math.hypot(x, y), 30, 0.05, "radius");
        }
});

test("on a model the window follows straight lines on the surface, and a projected one the view", async () => {
    const mesh = await upload(ball(40)), skin = await skinOf({ surface: "model.mesh" }, { mesh });
    const centre = skin.nearest([0, -40, 40]);
    for (const [x, y] of [[25, 0], [0, 18], [-12, -20], [30, 30]]) {
        const { at } = skin.step(centre, "project", x, y), way = Math.hypot(x, y) / 40;
        const cosine = [0, 1, 2].reduce((sum, k) => sum + (at[k] - [0, 0, 40][k]) * (centre.at[k] - [0, 0, 40][k]), 0) / 1600;
        near(Math.acos(cosine), way, 0.01, `${x}, ${y}:`);
        assert.ok(y === 0 || Math.sign(at[2] - 40) === Math.sign(y));
    }
    const grid = skin.window(centre, "project", [0, 1, 0], [40, 40], 9, 9);
    for (let j = 0; j < 9; j++)
        for (let i = 0; i < 9; i++) {
            const [x, y, z] = grid.slice(3 * (9 * j + i)), wanted = [5 * i - 20, 60 - 5 * j];
            near(x, wanted[0], 0.01);
            near(z, wanted[1], 0.01);
            near(y, -Math.sqrt(1600 - x * x - (z - 40) ** 2), 0.1);
        }
});

const canvas = () => t.page.locator(".fill canvas[role=img]");
async function tool(more) {
    await open(more);
    await t.page.click("#tab-solid");
    await t.page.click("[data-side=front]");
    await t.page.click("[data-flip=placing]");
    await t.page.waitForFunction(() => document.querySelector(".outline").getAttribute("d")?.length > 50);
    await t.page.waitForTimeout(400);
}
async function drag(dx, dy) {
    const box = await canvas().boundingBox(), x = box.x + box.width / 2, y = box.y + box.height / 2;
    await t.page.mouse.move(x, y);
    await t.page.mouse.down();
    await t.page.mouse.move(x + dx, y + dy, { steps: 4 });
    await shot(`placing-${Math.round(dx)}`);
    await t.page.mouse.up();
}

test("dragged to another place on a cylinder, and back by undo", async () => {
    await tool("&surface=cylinder&width=30&radius=40&sample=rings");
    const outline = await t.page.getAttribute(".outline", "d");
    await drag(60, 40);
    const at = await place();
    near(Math.hypot(at[0], at[1]), 40, 0.2);
    assert.ok(at[0] > 8 && at[1] < 0 && at[2] < 55, at.join());
    await done();
    assert.notEqual(await t.page.getAttribute(".outline", "d"), outline);
    assert.equal(await number("Its middle, mm: x").inputValue(), String(at[0]));
    assert.deepEqual(await barriers(), []);
    await t.page.click("#undo");
    assert.doesNotMatch(await address(), /at=/);
    await done();
    await t.page.waitForFunction((was) => document.querySelector(".outline").getAttribute("d") === was, outline);
});

test("by keys: a mm, with Shift ten; in figures; and back to where it was found", async () => {
    await tool("&surface=sphere&width=30&radius=40&sample=rings");
    await canvas().focus();
    await t.page.keyboard.press("Shift+ArrowRight");
    const [x] = await place();
    near(x, 40 * Math.sin(10 / 40), 0.15);
    await t.page.keyboard.press("ArrowUp");
    assert.ok((await place())[2] > 40.5);
    await t.page.click("[data-unplace]");
    assert.doesNotMatch(await address(), /at=/);
    await number("Its middle, mm: z").fill("50");
    await t.page.keyboard.press("Tab");
    assert.deepEqual(await place(), [0, -40, 50]); // what was left empty is where it was found
    await done();
});

test("on a model of one's own, seen from where it is dragged to; where it does not fit, it says so and stays to be moved", async () => {
    await t.page.goto(t.address);
    const mesh = await upload(ball(40));
    await t.page.goto("about:blank");
    await tool(`&surface=mesh&mesh=${mesh}&meshName=ball.off&width=30&sample=rings`);
    await drag(70, -30);
    const parts = new URLSearchParams(await address()), [dx, dy] = parts.get("dir").split(",").map(Number);
    assert.ok(dx < -0.1 && dy > 0.5, parts.get("dir"));
    await done();
    assert.equal(await t.page.locator(".promise.kept").count(), 3);
    await number("Width").fill("140");
    await t.page.keyboard.press("Enter");
    await status(/did not work.*a width of/);
    assert.ok((await t.page.getAttribute(".outline", "d")).length > 20);
});
