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
