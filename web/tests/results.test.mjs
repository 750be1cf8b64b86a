// The result bar: reasons, what is lost, the smallest size, what is drawn over the picture.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { barriers, done, folder, line, number, open, t, type } from "./testing.mjs";

test("the smallest size at which nothing is lost is the program's, and a button takes it", async () => {
    await open("&sample=rings&width=30");
    assert.match(await t.page.textContent("#results"), /what does not come out: solid parts [1-9]/);
    await t.page.click("#find-smallest");
    await t.page.locator("#use-smallest").waitFor({ timeout: 60000 });
    line("sample", "rings", "--size", "1000", "-o", join(folder, "rings.png"));
    const found = JSON.parse(line("smallest", join(folder, "rings.png"), "--printer", "hori-z500", "--json", "-")).smallest;
    const width = String(Math.ceil(found.width_mm));
    assert.match(await t.page.textContent("#use-smallest"), new RegExp(`${width} mm`));
    assert.deepEqual(await barriers(), []);
    await t.page.click("#use-smallest");
    await done();
    assert.equal(await number("Width").inputValue(), width);
    await t.page.getByText("That is its width now.").waitFor();
    assert.match(await t.page.textContent("#results"), /Nothing: every part and every line comes out/);
    await t.page.click("[data-sample='tree']"); // another picture: the answer is of no use
    await t.page.locator("#find-smallest").waitFor();
    await t.page.click("#find-smallest");
    await t.page.click("#stop-smallest");
    await t.page.locator("#find-smallest").waitFor();
});

test("what a load that is too large would need is said", async () => {
    await open("&sample=rings&width=40&thickness=1&force=500");
    assert.equal(await t.page.locator(".promise.broken").count(), 1);
    assert.match(await t.page.textContent(".promise.broken"), /Strong enough: no.*of \d+ MPa.*(would hold|It bears)/);
    await type("Force pressed on it", 0);
    await done();
    assert.match(await t.page.textContent(".promises"), /Strong enough: not asked.*press on it with a force to know/);
});

// The colours on the stage, as shares of its pixels, right of the handle and inside the picture.
const share = (colour) => t.page.evaluate(([r, g, b]) => {
    const canvas = document.querySelector("canvas.picture"), { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let p = 0; p < data.length; p += 4) count += data[p] === r && data[p + 1] === g && data[p + 2] === b;
    return count / (data.length / 4);
}, colour);

test("what is laid over the picture has its legend and its colours", async () => {
    await open("&sample=tree&width=40");
    await t.page.locator("input.handle").focus();
    await t.page.keyboard.press("3");
    const chooser = t.page.locator("select.overlay");
    for (const [name, keys, colours] of [
        ["change", 3, [[42, 120, 180], [112, 176, 214], [200, 90, 160]]],
        ["lost", 2, [[214, 69, 48], [250, 170, 40]]],
        ["conflict", 1, [[150, 90, 200]]],
        ["error", 2, []],
        ["print", 0, []],
    ]) {
        await chooser.selectOption(name);
        await t.page.locator(`select.overlay[data-shows=${name}]`).waitFor();
        assert.equal(await t.page.locator("#legend .key").count(), keys);
        for (const colour of colours) assert.ok(await share(colour) > 0.0005, `${name}: ${colour}`);
    }
    await chooser.selectOption("lost");
    await type("Width", 45); // a new run is painted so, too
    await done();
    await t.page.waitForFunction(() => document.querySelector("select.overlay").value === "lost");
    assert.deepEqual(await barriers(), []);
});
