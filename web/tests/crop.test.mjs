// The box of a crop: its arithmetic over seeds, and the box in the browser against the command line.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { dragged, toOwn, toShown } from "../src/crop.js";
import { address, barriers, done, download, folder, line, open, t } from "./testing.mjs";

let seed = 7;
const random = (most) => { seed = (seed * 1103515245 + 12345) % 2147483648; return seed % most; };

test("what is shown comes back to the picture's own pixels, however it is turned", () => {
    for (let i = 0; i < 400; i++) {
        const w = 10 + random(300), h = 10 + random(300), x = random(w - 1), y = random(h - 1);
        const box = [x, y, 1 + random(w - x), 1 + random(h - y)], quarters = i % 4, mirror = i % 8 > 3;
        const shown = toShown(box, w, h, quarters, mirror);
        assert.deepEqual(toOwn(shown, w, h, quarters, mirror), box);
        assert.equal(shown[2] * shown[3], box[2] * box[3]);
    }
    assert.deepEqual(toShown([0, 0, 10, 5], 100, 50, 1, false), [45, 0, 5, 10]); // clockwise: the upper left corner goes to the right
    assert.deepEqual(toShown([0, 0, 10, 5], 100, 50, 1, true), [0, 0, 5, 10]);
});

test("a dragged box stays inside, keeps its ratio, and leaves the other edges where they are", () => {
    for (let i = 0; i < 2000; i++) {
        const w = 40 + random(400), h = 40 + random(400), edges = ["", "nw", "n", "ne", "e", "se", "s", "sw", "w"][i % 9], ratio = [0, 1, 1.5, 0.5][random(4)];
        const bw = 8 + random(w - 8), bh = 8 + random(h - 8), box = [random(w - bw + 1), random(h - bh + 1), bw, bh];
        const [x, y, nw, nh] = dragged(box, edges, random(600) - 300, random(600) - 300, w, h, ratio);
        assert.ok(x >= 0 && y >= 0 && nw >= 1 && nh >= 1 && x + nw <= w && y + nh <= h, `${[box, edges, ratio, x, y, nw, nh]}`);
        if (edges === "") assert.deepEqual([nw, nh], [bw, bh]);
        else if (ratio) assert.ok(Math.abs(nw - ratio * nh) <= 2 * Math.max(1, ratio), `${nw} x ${nh} for ${ratio}`);
        if (edges.includes("w")) assert.ok(Math.abs(x + nw - box[0] - bw) <= 1);
        if (edges.includes("s")) assert.ok(Math.abs(y - box[1]) <= 1);
    }
});

const mask = async (...options) => {
    line("adapt", join(folder, "mask.png"), "--width", "70", "--printer", "hori-z500", ...options, "-o", join(folder, "line.png"), "--force-overwrite");
    return readFileSync(join(folder, "line.png"));
};

test("cropped by keyboard on a turned and mirrored picture: what the command line crops", async () => {
    line("sample", "mask", "--size", "1000", "-o", join(folder, "mask.png"));
    await open("&sample=mask&rotate=90&mirror=true");
    await t.page.click("#crop");
    await t.page.locator(".crop-frame").waitFor();
    assert.deepEqual(await barriers(), []);
    await t.page.getByLabel("Lower right corner").focus();
    for (let i = 0; i < 20; i++) await t.page.keyboard.press("ArrowLeft");
    await t.page.keyboard.press("Shift+ArrowUp");
    await t.page.getByLabel("Upper edge").focus();
    for (let i = 0; i < 10; i++) await t.page.keyboard.press("ArrowDown");
    await t.page.keyboard.press("Enter");
    await done();
    // Shown: left 0, top 100, 800 x 899. Mirrored it begins at 200 from the left; turned back, that is from the bottom.
    assert.equal(new URLSearchParams(await address()).get("crop"), "100,0,899,800");
    assert.ok((await download("mask.png")).bytes.equals(await mask("--crop", "100,0,899,800", "--rotate", "90", "--mirror")));
});

test("cropped by dragging, with a ratio, left, and taken back", async () => {
    await open("&sample=rings");
    await t.page.click("#crop");
    await t.page.locator(".crop select").selectOption("1.7777777777777777");
    const corner = await t.page.locator(".crop-handle.se").boundingBox();
    await t.page.mouse.move(corner.x + corner.width / 2, corner.y + corner.height / 2);
    await t.page.mouse.down();
    await t.page.mouse.move(corner.x - 150, corner.y - 100, { steps: 5 });
    await t.page.mouse.up();
    const [left, top, width, height] = await t.page.locator(".crop-numbers input").evaluateAll((boxes) => boxes.map((box) => Number(box.value)));
    assert.ok(width < 900 && Math.abs(width / height - 16 / 9) < 0.02, `${[left, top, width, height]}`);
    await t.page.keyboard.press("Escape");
    assert.doesNotMatch(await address(), /crop/);
    await t.page.click("#crop");
    await t.page.locator(".crop-numbers input").nth(2).fill("400");
    await t.page.keyboard.press("Tab");
    await t.page.getByText("Crop to this").click();
    await done();
    assert.equal(new URLSearchParams(await address()).get("crop"), "0,0,400,1000");
    await t.page.click("#undo");
    await done();
    assert.doesNotMatch(await address(), /crop/);
});
