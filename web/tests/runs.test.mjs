// What happens while the program works: cancelling, progress, a job that is killed, pages of other origins.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { test } from "node:test";
import { done, open, status, t, type } from "./testing.mjs";

const LONG = "&surface=vase&width=150&radius=60&height=200&force=30&printer=lite600"; // several seconds

test("a run can be cancelled by its button and begun again", async () => {
    await t.page.goto(t.address + LONG);
    await t.page.locator("#progress progress[value]").waitFor();
    assert.notEqual(await t.page.textContent(".stage-name"), "");
    await t.page.click("#cancel");
    await status(/^Cancelled/);
    const ids = t.server.pid;
    // Nothing goes on behind our back: the server's workers are at rest.
    await t.page.waitForTimeout(300);
    const busy = () => Number(spawnSync("ps", ["--ppid", String(ids), "-o", "cputimes="], { encoding: "utf8" }).stdout.split("\n").reduce((sum, line) => sum + Number(line), 0));
    const before = busy();
    await t.page.waitForTimeout(1500);
    assert.ok(busy() - before <= 1, "the job went on");
    await type("Width", 40);
    await status(/^Working/);
    await t.page.keyboard.press("Escape");
    await status(/^Cancelled/);
    await type("Force pressed on it", 0);
    await t.page.selectOption("select[id^=surface]", "plate"); // a change begins a new run
    await status(/^Working/);
    await t.page.keyboard.press("Escape");
    await t.page.click("#cancel"); // "Run"
    await done();
    assert.ok(await t.page.locator("#progress").isHidden());
});

test("another origin can neither read nor start anything", async () => {
    await t.page.goto("data:text/html,<title>elsewhere</title>");
    const port = new URL(t.address).port, token = t.address.match(/token=(\w+)/)[1];
    const outcome = await t.page.evaluate(async ([at, secret]) => {
        const tries = {};
        const attempt = async (name, path, init) => { tries[name] = await fetch(`http://127.0.0.1:${at}${path}`, init).then((r) => `${r.type} ${r.status}`, () => "refused"); };
        await attempt("read", "/api/v1/lists", { headers: { "X-Jali-Token": secret } });
        await attempt("start", "/api/v1/jobs", { method: "POST", body: "{}", headers: { "X-Jali-Token": secret } });
        await attempt("blind", "/api/v1/uploads", { method: "POST", body: "x", mode: "no-cors" });
        return tries;
    }, [port, token]);
    assert.equal(outcome.read, "refused");
    assert.equal(outcome.start, "refused");
    assert.match(outcome.blind, /refused|opaque/);
    t.errors.length = 0; // the browser says on the console that it refused
});

test("a job that is killed is said so, and the next one runs", async () => {
    await open();
    await type("Width", 200);
    // The server keeps a process waiting beside those that work: all are killed until the page has met one.
    const says = () => t.page.textContent("#status");
    for (let i = 0; i < 400 && !/ended by a signal/.test(await says()); i++) {
        spawnSync("pkill", ["-9", "-P", String(t.server.pid)]);
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
    assert.match(await says(), /ended by a signal/);
    await type("Width", 45);
    await done();
});
