// The object in space: its views, its dimensions, what it bears in colour, its weakest place.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { address, barriers, check, done, download, folder, line, number, open, shot, t } from "./testing.mjs";

const see = async (more) => { await open(more); await t.page.click("#tab-solid"); };
const pressed = (name) => t.page.getAttribute(`.solid-bar [data-${name}]`, "aria-pressed");
const words = () => t.page.$$eval(".measure", (all) => all.filter((m) => m.style.display !== "none").map((m) => m.textContent));
// The mean colour in the middle of what is drawn. A WebGL canvas forgets what it showed, so a screenshot is read.
async function drawn() {
    const png = [...await t.page.locator("#stage").screenshot()];
    return t.page.evaluate(async (bytes) => {
        const image = await createImageBitmap(new Blob([Uint8Array.from(bytes)])), canvas = new OffscreenCanvas(64, 64);
        canvas.getContext("2d").drawImage(image, image.width / 4, image.height / 4, image.width / 2, image.height / 2, 0, 0, 64, 64);
        const { data } = canvas.getContext("2d").getImageData(0, 0, 64, 64);
        return [0, 1, 2].map((k) => data.reduce((sum, value, i) => (i % 4 === k ? sum + value : sum), 0) / 4096);
    }, png);
}

test("a plate has its three dimensions, and they are those of the file", async () => {
    await see("&width=50&frame=3&thickness=5&sample=rings");
    await t.page.waitForFunction(() => [...document.querySelectorAll(".measure")].filter((m) => m.style.display !== "none").length === 3);
    const { low, high } = check((await download("object.stl")).path).bounds_mm;
    assert.deepEqual((await words()).sort(), [0, 1, 2].map((k) => `${Number((high[k] - low[k]).toFixed(1))} mm`).sort());
    await shot("solid-plate");
    await t.page.click("[data-flip=dimensions]");
    await t.page.waitForFunction(() => [...document.querySelectorAll(".measure")].every((m) => m.style.display === "none"));
});

test("a sphere's wall is measured", async () => {
    await see("&surface=sphere&width=40&radius=35&thickness=2.4&sample=rings");
    await t.page.waitForFunction(() => document.querySelectorAll(".measure")[3].style.display === "");
    const wall = (await words()).find((word) => word.startsWith("wall"));
    assert.ok(Math.abs(Number(wall.match(/[\d.]+/)[0]) - 2.4) < 0.06, wall);
});

test("what presses on it is asked for and shown only when there is a force", async () => {
    const asked = [];
    t.page.on("request", (request) => asked.push(request.url()));
    await see("&width=40&sample=mask");
    assert.ok(await t.page.locator(".layers").isHidden());
    assert.ok(!asked.some((url) => /stress|displacement/.test(url)));
});

test("stress and displacement in colour, with a scale, the limit and the weakest place", async () => {
    await see("&width=40&sample=mask&force=15");
    const stone = await drawn();
    await t.page.click("[data-layer=stress]");
    await t.page.locator(".scale-card").waitFor();
    assert.equal(await pressed("layer=stress"), "true");
    assert.match(await t.page.textContent(".scale-card"), /Stress in MPa.*the material bears \d/);
    await t.page.waitForFunction(() => document.querySelector(".spot").style.display === "");
    assert.match(await t.page.textContent(".spot"), /^[\d.]+ MPa$/);
    const stress = await drawn();
    assert.ok(stone[0] > stone[2] + 10, `stone ${stone}`); // warm; the map is violet where little is borne
    assert.ok(stress[2] > stress[0] - 5, `map ${stress}`);
    await shot("solid-stress");
    const before = await t.page.getAttribute(".spot", "transform");
    await t.page.click("[data-weakest]");
    await t.page.waitForFunction((was) => document.querySelector(".spot").getAttribute("transform") !== was, before);
    await t.page.waitForFunction(() => { // in the middle of the view
        const [, x, y] = document.querySelector(".spot").getAttribute("transform").match(/([\d.]+)[ ,]+([\d.]+)/).map(Number), box = document.querySelector(".marks").getBoundingClientRect();
        return Math.hypot(x - box.width / 2, y - box.height / 2) < 3;
    });
    await shot("solid-weakest");
    await t.page.click("[data-layer=displacement]");
    await t.page.waitForFunction(() => /mm/.test(document.querySelector(".scale-card").textContent));
    assert.deepEqual(await barriers(), []);
});

test("standard views, keys and light change what is drawn; nothing is drawn when nothing changes", async () => {
    await see("&surface=cylinder&width=60&sample=rings");
    const seen = new Set();
    for (const side of ["front", "side", "topView", "back", "perspective"]) {
        await t.page.click(`[data-side=${side}]`);
        await t.page.waitForTimeout(600);
        seen.add(`${(await drawn()).map(Math.round)} ${await words()}`);
    }
    assert.ok(seen.size >= 4, [...seen].join("\n"));
    const day = await drawn();
    await t.page.click("[data-flip=light]");
    const night = await drawn();
    assert.ok(night[2] < day[2] - 20, `${day} by day, ${night} by night`);
    const before = await t.page.locator(".measure text").first().getAttribute("x");
    await t.page.focus(".fill canvas[role=img]");
    await t.page.keyboard.press("ArrowRight");
    await t.page.waitForFunction((x) => document.querySelector(".measure text").getAttribute("x") !== x, before);
    const frames = await t.page.evaluate(() => new Promise((resolve) => {
        let count = 0;
        const gl = document.querySelector(".fill canvas[role=img]").getContext("webgl2"), draw = gl.drawElements;
        gl.drawElements = function (...all) { count++; return draw.apply(this, all); };
        setTimeout(() => resolve(count), 700);
    }));
    assert.equal(frames, 0);
});

test("with reduced motion a view is there at once", async () => {
    await t.page.emulateMedia({ reducedMotion: "reduce" });
    await see("&width=40&sample=rings");
    await t.page.click("[data-side=side]");
    const once = await drawn();
    await t.page.waitForTimeout(400);
    assert.deepEqual(await drawn(), once);
});

test("all around a cylinder: as many copies as its height takes, and what the command line makes", async () => {
    await open("&sample=girih&surface=cylinder&radius=20&height=60&width=40");
    await t.page.getByLabel("All around, without a seam").check();
    await done();
    assert.equal(await number("Copies side by side").inputValue(), "3");
    assert.match(await address(), /around=true/);
    assert.ok(await number("Width").isHidden() && await t.page.locator("#edit").isHidden() && await number("Force pressed on it").isHidden());
    const { bytes } = await download("object.stl");
    line("sample", "girih", "--size", "1000", "-o", join(folder, "girih.png"));
    line("carve", join(folder, "girih.png"), "--surface", "cylinder:r=20,h=60", "--around", "--repeat", "3", "--frame", "2", "--thickness", "4",
        "--printer", "hori-z500", "-o", join(folder, "around.stl"));
    assert.ok(bytes.equals(readFileSync(join(folder, "around.stl"))));
    assert.ok(check(join(folder, "around.stl")).solid);
    await t.page.click("#tab-solid");
    await shot("around");
    await t.page.getByLabel("All around, without a seam").uncheck();
    await done();
    assert.ok(await number("Width").isVisible() && await t.page.locator("#edit").count() === 1);
    assert.deepEqual(await barriers(), []);
});
