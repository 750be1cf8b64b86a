// The whole way: from a picture to a file, what comes between, and what the page looks like to those who do not see it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { address, barriers, check, done, download, dropFile, folder, line, number, open, shot, status, t, type } from "./testing.mjs";

test("from a dropped picture to a 3MF that jali check passes", async () => {
    line("sample", "mask", "--size", "400", "-o", join(folder, "lion.png"));
    await open();
    await dropFile("lion.png", readFileSync(join(folder, "lion.png")), "image/png");
    await status(/^(Reading|Working)/);
    await done();
    assert.equal(await t.page.locator(".promise.kept").count(), 3);
    const got = await download("object.3mf");
    assert.equal(got.name, "lion.3mf");
    const found = check(got.path);
    assert.ok(found.solid);
    assert.equal(found.pieces, 1);
});

test("what it shows is what the command line carves", async () => {
    await open("&sample=mask&width=50");
    const { bytes } = await download("object.stl");
    line("sample", "mask", "--size", "1000", "-o", join(folder, "mask.png"));
    line("carve", join(folder, "mask.png"), "--width", "50", "--printer", "hori-z500", "-o", join(folder, "line.stl"));
    assert.ok(bytes.equals(readFileSync(join(folder, "line.stl"))));
});

test("a file that is no picture is refused with the program's own sentence, and the page goes on", async () => {
    await open();
    await dropFile("notes.png", Buffer.from("this is no picture"), "image/png");
    await status(/not a picture of a known type/);
    await t.page.click("[data-sample='rings']");
    await done();
});

test("the newest change wins", async () => {
    await open();
    for (const width of [40, 55, 62]) await type("Width", width);
    await done();
    const { low, high } = check((await download("object.stl")).path).bounds_mm;
    assert.ok(Math.abs(high[0] - low[0] - 66) < 0.1, `${high[0] - low[0]} mm wide`); // 62 mm and a frame of 2 mm on both sides
});

test("undo, redo, and the address says it all", async () => {
    await open("&width=50");
    await type("Frame", 5);
    assert.match(await address(), /frame=5/);
    await t.page.click("#undo");
    assert.doesNotMatch(await address(), /frame/);
    await t.page.click("#redo");
    assert.match(await address(), /frame=5/);
    await done();
    await t.page.reload();
    await done();
    assert.match(await address(), /width=50/);
    assert.equal(await number("Frame").inputValue(), "5");
    assert.doesNotMatch(t.page.url(), /token/);
});

test("undo brings a dropped picture back, and so does reloading", async () => {
    line("sample", "rings", "--size", "300", "-o", join(folder, "rings.png"));
    await open();
    await dropFile("rings.png", readFileSync(join(folder, "rings.png")), "image/png");
    await status(/^Working/);
    await done();
    await t.page.click("[data-sample='tree']");
    await done();
    await t.page.click("#undo");
    await done();
    assert.equal((await download("mask.png")).name, "rings.png");
    await t.page.reload();
    await done();
    assert.equal((await download("mask.png")).name, "rings.png");
});

test("by keyboard alone: a sample, the handle, the object", async () => {
    await open();
    await t.page.locator("[data-sample='tree']").focus();
    await t.page.keyboard.press("Enter");
    await done();
    await t.page.locator("input.handle").focus();
    await t.page.keyboard.press("3");
    assert.equal(await t.page.locator("input.handle").inputValue(), "0");
    await t.page.keyboard.press("ArrowRight");
    assert.equal(await t.page.locator("input.handle").inputValue(), "1");
    await t.page.locator("#tab-picture").focus();
    await t.page.keyboard.press("ArrowRight");
    assert.equal(await t.page.locator("#tab-solid").getAttribute("aria-selected"), "true");
});

test("a vase, and a load that it bears", async () => {
    await open("&surface=vase&width=60&force=10");
    assert.equal(await t.page.locator(".promise.kept").count(), 4);
    await t.page.click("#tab-solid");
    assert.equal(await t.page.locator("[data-file='outline.svg']").count(), 0);
});

test("in Chinese", async () => {
    await open();
    await t.page.selectOption("#language", "zh");
    await t.page.getByText("选择图片").first().waitFor();
    assert.equal(await t.page.evaluate(() => document.documentElement.lang), "zh-Hans");
});

for (const [name, size, scheme] of [["wide", { width: 1400, height: 900 }, "light"], ["dark", { width: 1400, height: 900 }, "dark"], ["phone", { width: 390, height: 844 }, "light"]])
    test(`no barrier that axe can find: ${name}`, async () => {
        await t.page.setViewportSize(size);
        await t.page.emulateMedia({ colorScheme: scheme });
        await open();
        assert.deepEqual(await barriers(), []);
        await shot(name);
    });
