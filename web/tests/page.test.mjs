// The page in a real browser, against the real server.
//
//     JALI=path/to/jali node --test web/tests/
import assert from "node:assert/strict";
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, beforeEach, afterEach, test } from "node:test";
import { chromium } from "playwright-core";

const jali = process.env.JALI, folder = mkdtempSync(join(tmpdir(), "jali-page-"));
const axe = readFileSync(new URL("../node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
let server, address, browser, context, page, errors;

before(async () => {
    execFileSync(jali, ["sample", "mask", "--size", "400", "-o", join(folder, "lion.png"), "--quiet"]);
    server = spawn(jali, ["serve", "--port", "0"], { stdio: ["ignore", "pipe", "ignore"] });
    address = await new Promise((resolve, reject) => {
        let said = "";
        server.on("exit", () => reject(new Error(`jali serve ended: ${said}`)));
        server.stdout.on("data", (bytes) => {
            said += bytes;
            const found = said.match(/http:\S+/);
            if (found) resolve(found[0]);
        });
    });
    browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--no-sandbox", "--use-gl=swiftshader", "--enable-webgl", "--ignore-gpu-blocklist"],
    });
});

after(async () => {
    await browser?.close();
    server?.kill();
    rmSync(folder, { recursive: true, force: true });
});

beforeEach(async () => {
    context = await browser.newContext({ viewport: { width: 1400, height: 900 }, acceptDownloads: true });
    page = await context.newPage();
    errors = [];
    page.on("pageerror", (error) => errors.push(error.message));
    page.on("console", (message) => {
        if (message.type() === "error") errors.push(message.text());
    });
});

afterEach(async () => {
    await context.close();
    assert.deepEqual(errors, []);
});

const done = () => page.waitForFunction(() => document.querySelectorAll(".promise").length === 4 && /^(Done|用时)/.test(document.getElementById("status").textContent), null, { timeout: 60000 });
const open = async (more = "") => { await page.goto(address + more); await done(); };
const check = (path) => JSON.parse(execFileSync(jali, ["check", path, "--json", "-", "--quiet"], { encoding: "utf8" }));
const number = (words) => page.getByLabel(words, { exact: true }).and(page.locator("[type=number]"));
const options = () => page.evaluate(() => new URLSearchParams(location.hash.slice(1)).toString());

async function dropFile(name, bytes, type) {
    await page.evaluate(([fileName, content, kind]) => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([Uint8Array.from(content)], fileName, { type: kind }));
        for (const event of ["dragover", "drop"]) dispatchEvent(Object.assign(new DragEvent(event, { dataTransfer: transfer, bubbles: true, cancelable: true })));
    }, [name, [...bytes], type]);
}

test("from a dropped picture to a 3MF that jali check passes", async () => {
    await open();
    await page.evaluate(() => { document.getElementById("status").textContent = ""; });
    await dropFile("lion.png", readFileSync(join(folder, "lion.png")), "image/png");
    await done();
    assert.equal(await page.locator(".promise.kept").count(), 3);
    const wait = page.waitForEvent("download");
    await page.click("[data-file='object.3mf']");
    const download = await wait, path = join(folder, "lion.3mf");
    assert.equal(download.suggestedFilename(), "lion.3mf");
    await download.saveAs(path);
    const found = check(path);
    assert.ok(found.solid);
    assert.equal(found.pieces, 1);
});

test("what it shows is what the command line carves", async () => {
    await open("&sample=mask&width=50");
    const wait = page.waitForEvent("download");
    await page.click("[data-file='object.stl']");
    await (await wait).saveAs(join(folder, "page.stl"));
    execFileSync(jali, ["sample", "mask", "--size", "1000", "-o", join(folder, "mask.png"), "--quiet"]);
    execFileSync(jali, ["carve", join(folder, "mask.png"), "--width", "50", "--printer", "hori-z500", "-o", join(folder, "line.stl"), "--quiet"]);
    assert.ok(readFileSync(join(folder, "page.stl")).equals(readFileSync(join(folder, "line.stl"))));
});

test("a file that is no picture is refused with the program's own sentence, and the page goes on", async () => {
    await open();
    await dropFile("notes.png", Buffer.from("this is no picture"), "image/png");
    await page.waitForFunction(() => document.getElementById("status").textContent.includes("not a picture of a known type"));
    await page.click("[data-sample='rings']");
    await done();
});

test("the newest change wins", async () => {
    await open();
    const box = number("Width");
    for (const width of [40, 55, 62]) {
        await box.fill(String(width));
        await box.press("Enter");
    }
    await page.waitForFunction(() => !/^Done/.test(document.getElementById("status").textContent));
    await done();
    const wait = page.waitForEvent("download");
    await page.click("[data-file='object.stl']");
    await (await wait).saveAs(join(folder, "newest.stl"));
    const { low, high } = check(join(folder, "newest.stl")).bounds_mm;
    assert.ok(Math.abs(high[0] - low[0] - 66) < 0.1, `${high[0] - low[0]} mm wide`); // 62 mm and a frame of 2 mm on both sides
});

test("undo, redo, and the address says it all", async () => {
    await open("&width=50");
    await number("Frame").fill("5");
    await page.keyboard.press("Tab");
    assert.match(await options(), /frame=5/);
    await page.click("#undo");
    assert.doesNotMatch(await options(), /frame/);
    await page.click("#redo");
    assert.match(await options(), /frame=5/);
    await done();
    await page.reload();
    await done();
    assert.match(await options(), /width=50/);
    assert.equal(await number("Frame").inputValue(), "5");
    assert.doesNotMatch(page.url(), /token/);
});

test("by keyboard alone: a sample, the handle, the object", async () => {
    await open();
    await page.locator("[data-sample='tree']").focus();
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => !/^Done/.test(document.getElementById("status").textContent));
    await done();
    await page.locator("input.handle").focus();
    await page.keyboard.press("3");
    assert.equal(await page.locator("input.handle").inputValue(), "0");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator("input.handle").inputValue(), "1");
    await page.locator("#tab-picture").focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator("#tab-solid").getAttribute("aria-selected"), "true");
});

test("a vase, and a load that it bears", async () => {
    await open("&surface=vase&width=60&force=10");
    assert.equal(await page.locator(".promise.kept").count(), 4);
    await page.click("#tab-solid");
    assert.equal(await page.locator("[data-file='outline.svg']").count(), 0);
});

test("in Chinese", async () => {
    await open();
    await page.selectOption("#language", "zh");
    await page.getByText("选择图片").first().waitFor();
    assert.equal(await page.evaluate(() => document.documentElement.lang), "zh-Hans");
});

for (const [name, size, scheme] of [["wide", { width: 1400, height: 900 }, "light"], ["dark", { width: 1400, height: 900 }, "dark"], ["phone", { width: 390, height: 844 }, "light"]])
    test(`no barrier that axe can find: ${name}`, async () => {
        await page.setViewportSize(size);
        await page.emulateMedia({ colorScheme: scheme });
        await open();
        // The page's own policy lets no script in: axe is run by the browser, not by the page.
        const violations = await page.evaluate(`${axe}; axe.run().then((r) => r.violations.map((v) => v.id + ": " + v.nodes[0].html))`);
        assert.deepEqual(violations, []);
        if (process.env.SHOTS) await page.screenshot({ path: join(process.env.SHOTS, `${name}.png`) });
    });

test("another origin can neither read nor start anything", async () => {
    await page.goto("data:text/html,<title>elsewhere</title>");
    const port = new URL(address).port, token = address.match(/token=(\w+)/)[1];
    const outcome = await page.evaluate(async ([at, secret]) => {
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
    errors.length = 0; // the browser says on the console that it refused
});

test("a job that is killed is said so, and the next one runs", async () => {
    await open();
    await number("Width").fill("200");
    await page.keyboard.press("Enter");
    // The server keeps a process waiting beside those that work: all are killed until the page has met one.
    const says = () => page.textContent("#status");
    for (let i = 0; i < 400 && !/ended by a signal/.test(await says()); i++) {
        spawnSync("pkill", ["-9", "-P", String(server.pid)]);
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
    assert.match(await says(), /ended by a signal/);
    await number("Width").fill("45");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => !/^Done/.test(document.getElementById("status").textContent));
    await done();
});
