// What the page's tests share: a server, a browser, a page for each test, and words for what they do with it.
//
//     JALI=path/to/jali node --test web/tests/
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before, beforeEach } from "node:test";
import { chromium } from "playwright-core";

export const jali = process.env.JALI;
export const folder = mkdtempSync(join(tmpdir(), "jali-page-"));
export const t = {}; // server, address, browser; and of the test that runs: context, page, errors

const axe = readFileSync(new URL("../node_modules/axe-core/axe.min.js", import.meta.url), "utf8");

before(async () => {
    t.server = spawn(jali, ["serve", "--port", "0"], { stdio: ["ignore", "pipe", "ignore"] });
    t.address = await new Promise((resolve, reject) => {
        let said = "";
        t.server.on("exit", () => reject(new Error(`jali serve ended: ${said}`)));
        t.server.stdout.on("data", (bytes) => {
            said += bytes;
            const found = said.match(/http:\S+/);
            if (found) resolve(found[0]);
        });
    });
    t.browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--no-sandbox", "--use-gl=swiftshader", "--enable-webgl", "--ignore-gpu-blocklist"],
    });
});

after(async () => {
    await t.browser?.close();
    t.server?.kill();
    rmSync(folder, { recursive: true, force: true });
});

beforeEach(async () => {
    t.context = await t.browser.newContext({ viewport: { width: 1400, height: 900 }, acceptDownloads: true });
    t.page = await t.context.newPage();
    t.errors = [];
    t.page.on("pageerror", (error) => t.errors.push(error.message));
    t.page.on("console", (message) => {
        if (message.type() === "error") t.errors.push(`${message.text()} ${message.location().url}`);
    });
});

afterEach(async () => {
    await t.context.close();
    assert.deepEqual(t.errors, []);
});

/** Run the command line; what it says. */
export const line = (...words) => execFileSync(jali, [...words, "--quiet"], { encoding: "utf8" });

export const check = (path) => JSON.parse(line("check", path, "--json", "-"));

/** The status line, when it matches. */
export async function status(pattern) {
    await t.page.waitForFunction((p) => new RegExp(p).test(document.getElementById("status").textContent), pattern.source, { timeout: 60000 });
    return t.page.textContent("#status");
}

/** Wait until the whole run of what is chosen now is shown. */
export async function done() {
    await status(/^(Done|用时)/);
    assert.equal(await t.page.locator(".promise").count(), 4);
}

export async function open(more = "") {
    await t.page.goto(t.address + more);
    await done();
}

/** A number box by its label. */
export const number = (words) => t.page.getByLabel(words, { exact: true }).and(t.page.locator("[type=number]"));

export async function type(words, value) {
    await number(words).fill(String(value));
    await t.page.keyboard.press("Enter");
}

export const address = () => t.page.evaluate(() => new URLSearchParams(location.hash.slice(1)).toString());

export async function dropFile(name, bytes, kind) {
    await t.page.evaluate(([fileName, content, mime]) => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([Uint8Array.from(content)], fileName, { type: mime }));
        for (const event of ["dragover", "drop"]) dispatchEvent(Object.assign(new DragEvent(event, { dataTransfer: transfer, bubbles: true, cancelable: true })));
    }, [name, [...bytes], kind]);
}

/** Click a download button; the file's bytes and the name that was proposed. */
export async function download(file) {
    const wait = t.page.waitForEvent("download");
    await t.page.click(`[data-file='${file}']`);
    const got = await wait, path = join(folder, `got-${file}`);
    await got.saveAs(path);
    return { path, name: got.suggestedFilename(), bytes: readFileSync(path) };
}

/** What axe finds wrong. The page's own policy lets no script in: axe is run by the browser, not by the page. */
export const barriers = () => t.page.evaluate(`${axe}; axe.run().then((r) => r.violations.map((v) => v.id + ": " + v.nodes[0].html))`);

/** A screenshot to look at, where SHOTS names a folder. */
export async function shot(name) {
    if (process.env.SHOTS) await t.page.screenshot({ path: join(process.env.SHOTS, `${name}.png`) });
}
