// A finger in place of the mouse, on a telephone: Chromium's own touch events.
import assert from "node:assert/strict";
import { test } from "node:test";
import { address, done, open, t } from "./testing.mjs";

// One finger or two: from, to, in CSS pixels; in a few moves.
async function swipe(...fingers) {
    const session = await t.context.newCDPSession(t.page), steps = 6;
    const points = (share) => fingers.map(([x, y, u, v], id) => ({ x: x + (u - x) * share, y: y + (v - y) * share, id }));
    await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: points(0) });
    for (let i = 1; i <= steps; i++) await session.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: points(i / steps) });
    await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
}

async function openOnTelephone(more) {
    await t.context.close();
    t.context = await t.browser.newContext({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    t.page = await t.context.newPage();
    t.page.on("pageerror", (error) => t.errors.push(error.message));
    await open(more);
}

test("a finger moves the handle, two enlarge the picture", async () => {
    await openOnTelephone("&sample=rings&width=40");
    const stage = await t.page.locator("#stage canvas").first().boundingBox();
    const middle = [stage.x + stage.width / 2, stage.y + stage.height / 2];
    await swipe([...middle, stage.x + stage.width / 4, middle[1]]);
    const split = Number(await t.page.locator("input.handle").inputValue());
    assert.ok(split < 40, `${split}`);
    const before = await t.page.locator("#stage canvas").first().screenshot();
    await swipe([middle[0] - 20, middle[1] + 60, middle[0] - 120, middle[1] + 60], [middle[0] + 20, middle[1] + 60, middle[0] + 120, middle[1] + 60]);
    await t.page.waitForTimeout(300);
    assert.ok(!before.equals(await t.page.locator("#stage canvas").first().screenshot()));
    assert.equal(Number(await t.page.locator("input.handle").inputValue()), split);
});

test("a finger crops, draws a bridge and turns the object", async () => {
    await openOnTelephone("&sample=rings&width=40");
    await t.page.click("#crop");
    const corner = await t.page.locator(".crop-handle.se").boundingBox();
    const at = [corner.x + corner.width / 2, corner.y + corner.height / 2];
    await swipe([...at, at[0] - 60, at[1] - 40]);
    const [, , width] = await t.page.locator(".crop-numbers input").evaluateAll((boxes) => boxes.map((box) => Number(box.value)));
    assert.ok(width < 950, `${width}`);
    await t.page.keyboard.press("Escape");
    await t.page.getByRole("button", { name: "Edit bridges" }).click();
    await t.page.getByRole("button", { name: "Bridge", exact: true }).click();
    const layer = await t.page.locator(".edit-layer").boundingBox();
    await swipe([layer.x + layer.width * 0.4, layer.y + layer.height * 0.5, layer.x + layer.width * 0.6, layer.y + layer.height * 0.5]);
    await t.page.waitForFunction(() => /edits=/.test(location.hash));
    await done();
    await t.page.click("#tab-solid");
    await t.page.waitForTimeout(1500);
    const canvas = t.page.locator("#stage canvas").last(), box = await canvas.boundingBox(), before = await canvas.screenshot();
    await swipe([box.x + box.width * 0.4, box.y + box.height * 0.6, box.x + box.width * 0.7, box.y + box.height * 0.6]);
    await t.page.waitForTimeout(800);
    assert.ok(!before.equals(await canvas.screenshot()));
    assert.match(await address(), /edits=/);
});
