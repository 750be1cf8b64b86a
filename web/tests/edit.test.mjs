// Bridges by hand: drawn, pinned, moved, forbidden; regions locked; by pointer and by keys; undone, reloaded, saved.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { editsOf, jsonOf, textOf, wayToShown } from "../src/edits.js";
import { address, barriers, done, folder, line, number, open, shot, status, t } from "./testing.mjs";

const RINGS = "&sample=rings&width=50", items = (kind = "") => t.page.locator(`.edit-item${kind && `.${kind}`}`);
const edits = async () => editsOf(new URLSearchParams(await address()).get("edits"));
const press = async (...keys) => { for (const key of keys) await t.page.keyboard.press(key); };

async function edited(more = RINGS) {
    await open(more);
    await t.page.click("#edit");
    await items("found").first().waitFor({ state: "attached" });
}

// Drag over the stage, from and to in shares of its size.
async function drag(from, to) {
    const box = await t.page.locator("#stage").boundingBox(), at = ([x, y]) => [box.x + x * box.width, box.y + y * box.height];
    await t.page.mouse.move(...at(from));
    await t.page.mouse.down();
    await t.page.mouse.move(...at([(from[0] + to[0]) / 2, (from[1] + to[1]) / 2]));
    await t.page.mouse.move(...at(to));
    await t.page.mouse.up();
}

test("edits as text, as JSON, and on the turned picture", () => {
    const some = { size: [1000, 800], list: [{ kind: "bridge", width: 9.5, points: [[310, 420], [-3.5, 7]] }, { kind: "lock", width: 0, points: [[0, 0], [9, 0], [9, 9]] }] };
    assert.equal(textOf(some), "1000_800*b9.5_310_420_-3.5_7*l_0_0_9_0_9_9");
    assert.deepEqual(editsOf(textOf(some)), some);
    assert.deepEqual(jsonOf(some).edits[1], { kind: "lock", points: [[0, 0], [9, 0], [9, 9]] });
    for (const bad of ["", "x", "10_10", "10_10*b_1_2", "10_10*z_1_2_3_4", "10_10*l_1_2_3_4", "10_10*b_1_2_3_", "0_10*b_1_2_3_4", "10_10*b_1_2_x_4"])
        assert.equal(editsOf(bad).list.length, 0, bad);
    for (const rotate of [0, 90, 180, 270]) for (const mirror of [false, true]) for (const crop of ["", "100,50,400,300"]) {
        const way = wayToShown([1000, 800], { rotate, mirror, crop }), shown = way.shown([150, 60]);
        assert.deepEqual(way.own(shown), [150, 60]);
        assert.ok(shown[0] >= 0 && shown[1] >= 0 && shown[0] <= way.width && shown[1] <= way.height);
    }
    assert.deepEqual(wayToShown([1000, 800], { rotate: 90, mirror: false, crop: "" }).shown([0, 0]), [800, 0]);
});

test("found bridges are shown; a drawn one stays, by undo, redo and reload, and is what the command line makes of the saved file", async () => {
    await edited();
    const before = await items("found").count();
    assert.ok(before > 3, `${before} bridges`);
    await shot("edit-found");
    await t.page.click("[data-tool=bridge]");
    await drag([0.5, 0.5], [0.8, 0.5]);
    await done();
    assert.equal((await edits()).list.length, 1);
    assert.equal(await items("bridge").count(), 1);
    await t.page.click("#undo");
    assert.equal((await edits()).list.length, 0);
    assert.equal(await items("bridge").count(), 0);
    await t.page.click("#redo");
    assert.equal((await edits()).list.length, 1);
    await done();
    await t.page.reload();
    await done();
    await t.page.click("#edit");
    assert.equal(await items("bridge").count(), 1);
    await shot("edit-drawn");
    const wait = t.page.waitForEvent("download");
    await t.page.click("[data-act=save]");
    const path = join(folder, "edits.json");
    await (await wait).saveAs(path);
    line("sample", "rings", "--size", "1000", "-o", join(folder, "rings.png"), "--force-overwrite");
    line("carve", join(folder, "rings.png"), "--width", "50", "--printer", "hori-z500", "--edits", path, "-o", join(folder, "line.stl"), "--json", join(folder, "line.json"), "--force-overwrite");
    assert.equal(JSON.parse(readFileSync(join(folder, "line.json"), "utf8")).edits.bridges, 1);
    const stl = t.page.waitForEvent("download");
    await t.page.click("[data-file='object.stl']");
    await (await stl).saveAs(join(folder, "page.stl"));
    assert.ok(readFileSync(join(folder, "page.stl")).equals(readFileSync(join(folder, "line.stl"))));
    await t.context.grantPermissions(["clipboard-read", "clipboard-write"]);
    await t.page.click("#copy");
    await status(/^Copied/);
    assert.match(await t.page.evaluate(() => navigator.clipboard.readText()), /--edits edits\.json/);
});

test("a found bridge is pinned, another forbidden, a third moved by dragging", async () => {
    await edited();
    const middle = (at) => t.page.evaluate((i) => { // in one go: each run draws them anew
        const box = document.querySelectorAll(".edit-item.found")[i].querySelector(".thin").getBoundingClientRect();
        return [box.x + box.width / 2, box.y + box.height / 2];
    }, at);
    await t.page.mouse.click(...await middle(0));
    await t.page.click("[data-act=pin]");
    assert.deepEqual((await edits()).list.map((e) => e.kind), ["bridge"]);
    await done();
    await t.page.mouse.click(...await middle(0));
    await t.page.click("[data-act=avoid]");
    assert.deepEqual((await edits()).list.map((e) => e.kind), ["bridge", "forbid"]);
    await done();
    const [x, y] = await middle(1);
    await t.page.mouse.move(x, y);
    await t.page.mouse.down();
    await t.page.mouse.move(x + 20, y + 25);
    await t.page.mouse.move(x + 40, y + 30);
    await t.page.mouse.up();
    const { list } = await edits();
    assert.deepEqual(list.map((e) => e.kind), ["bridge", "forbid", "forbid", "bridge"]);
    assert.ok(Math.hypot(list[3].points[0][0] - list[2].points[0][0], list[3].points[0][1] - list[2].points[0][1]) > 10);
    await done();
    await shot("edit-moved");
    assert.match(await t.page.textContent(".promise:first-child"), /One piece: yes/);
});

test("what is locked stays, and its price is said", async () => {
    await edited("&sample=sunflower&width=40");
    await t.page.click("[data-tool=lock]");
    await drag([0.42, 0.4], [0.58, 0.6]);
    await done();
    assert.deepEqual((await edits()).list.map((e) => e.kind), ["lock"]);
    await t.page.locator(".price").first().waitFor();
    assert.match(await t.page.textContent(".promise:first-child"), /One piece: no/);
    await shot("edit-locked");
    await t.page.click("[data-tool=erase]");
    const box = await items("lock").boundingBox();
    await t.page.mouse.click(box.x + box.width / 2, box.y + 4);
    assert.equal((await edits()).list.length, 0);
    await done();
});

test("by keyboard alone: choose, move, an end, forbid, lay down, take away, leave", async () => {
    await open(RINGS);
    await t.page.locator("#edit").focus();
    await press("Enter");
    assert.equal(await t.page.evaluate(() => document.activeElement.classList.contains("edit-layer")), true);
    await items("found").first().waitFor({ state: "attached" });
    await press("Tab");
    assert.equal(await items("chosen").count(), 1);
    await status(/found/);
    await press("ArrowRight", "ArrowRight", "Shift+ArrowDown");
    assert.deepEqual((await edits()).list.map((e) => e.kind), ["forbid", "bridge"]);
    const [first, last] = (await edits()).list[1].points;
    await press("e", "ArrowLeft");
    const moved = (await edits()).list[1].points;
    assert.ok(moved[0][0] < first[0] && moved.at(-1)[0] === last[0] && moved.at(-1)[1] === last[1]);
    await press("Delete");
    assert.deepEqual((await edits()).list.map((e) => e.kind), ["forbid"]);
    await done();
    await press("Tab", "Tab", "f");
    assert.deepEqual((await edits()).list.map((e) => e.kind), ["forbid", "forbid"]);
    await t.page.locator("[data-tool=bridge]").focus();
    await press("Enter");
    await t.page.locator(".edit-layer").focus();
    await press("Enter", "ArrowUp");
    assert.equal((await edits()).list[2].kind, "bridge");
    await number("Stroke width").fill("2");
    await press("Enter");
    assert.ok((await edits()).list[2].width > 30);
    await t.page.locator(".edit-layer").focus();
    await press("Escape", "Escape");
    assert.equal(await t.page.locator("#edit").getAttribute("aria-pressed"), "false");
    await done();
});

test("edits too long for the address stay in the page, and go with another picture", async () => {
    await edited();
    const many = textOf({ size: [1000, 1000], list: Array.from({ length: 120 }, (_, i) => ({ kind: "forbid", width: 3, points: [[100 + i, 200], [110 + i, 210.5]] })) });
    await t.page.goto("about:blank");
    await open(`${RINGS}&edits=${many}`);
    await t.page.click("#edit");
    assert.equal(await items("forbid").count(), 120);
    await number("Frame").fill("3");
    await press("Tab");
    assert.doesNotMatch(await address(), /edits/);
    assert.equal(await items("forbid").count(), 120);
    await t.page.click("[data-sample=tree]");
    assert.equal(await items("forbid").count(), 0);
    await done();
});

test("on a turned and cropped picture the edits lie where they were drawn", async () => {
    await edited(`${RINGS}&rotate=90&mirror=true&crop=100,0,900,1000`);
    await t.page.click("[data-tool=bridge]");
    await drag([0.5, 0.5], [0.6, 0.7]);
    const drawn = await items("bridge").locator(".thin").boundingBox(), stage = await t.page.locator("#stage").boundingBox();
    assert.ok(Math.abs(drawn.x - stage.x - 0.5 * stage.width) < 3 && Math.abs(drawn.y - stage.y - 0.5 * stage.height) < 3);
    const before = await items("found").count();
    await done();
    assert.ok(before > 0);
});

test("no barrier that axe can find while editing", async () => {
    await edited();
    await items("found").first().locator(".thin").click({ force: true });
    assert.deepEqual(await barriers(), []);
    await t.page.setViewportSize({ width: 390, height: 844 });
    assert.deepEqual(await barriers(), []);
    await shot("edit-phone");
});
