// Project files: everything that was chosen comes back, wherever it is opened; what is none ends in a sentence.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { address, done, download, dropFile, folder, line, open, status, t, type } from "./testing.mjs";

const BOX = "OFF\n8 12 0\n-30 -20 0\n30 -20 0\n30 20 0\n-30 20 0\n-30 -20 80\n30 -20 80\n30 20 80\n-30 20 80\n" +
    "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
const PROFILE = '{"jali_printer": 1, "name": "mine", "inherits": "msla", "phi_s_mm": 0.45}';

async function saved() {
    const wait = t.page.waitForEvent("download");
    await t.page.click("#save");
    const got = await wait, path = join(folder, got.suggestedFilename());
    await got.saveAs(path);
    return { path, name: got.suggestedFilename(), bytes: readFileSync(path) };
}

test("picture, crop, profile, model and figures come back in another browser, and carve the same bytes", async () => {
    line("sample", "tree", "--size", "300", "-o", join(folder, "oak.png"));
    await open("&width=25");
    await dropFile("oak.png", readFileSync(join(folder, "oak.png")), "image/png");
    await status(/^Working/);
    await done();
    await dropFile("mine.json", Buffer.from(PROFILE), "");
    await t.page.getByText("mine:").waitFor();
    await dropFile("box.off", Buffer.from(BOX), "");
    await t.page.getByText("box.off").waitFor();
    await type("Thickness", 3);
    await done();
    const object = (await download("object.stl")).bytes, project = await saved();
    assert.equal(project.name, "oak.jali");

    await t.context.close(); // a browser that knows nothing of it
    t.context = await t.browser.newContext({ viewport: { width: 1400, height: 900 }, acceptDownloads: true });
    t.page = await t.context.newPage();
    await open("&sample=rings");
    await t.page.setInputFiles("#open", project.path);
    await status(/^(Reading|Working)/);
    await t.page.getByText("box.off").waitFor();
    await done();
    assert.ok((await download("object.stl")).bytes.equals(object));
    assert.equal((await download("object.stl")).name, "oak.stl");
    assert.match(await t.page.locator("fieldset").filter({ hasText: "Size and printer" }).textContent(), /mine:/);
    const again = JSON.parse((await saved()).bytes), first = JSON.parse(project.bytes);
    assert.deepEqual(again, first);
    await t.page.click("#undo");
    assert.match(await address(), /sample=rings/);
});

test("a sample's project is small, holds edits by hand, opens by dropping, and Ctrl+S saves", async () => {
    const edits = "1000_1000*b9_310_420_350_400";
    await open(`&sample=rings&rotate=90&invert=true&edits=${edits}`);
    const wait = t.page.waitForEvent("download");
    await t.page.keyboard.press("Control+s");
    const got = await wait, path = join(folder, "rings.jali");
    await got.saveAs(path);
    assert.ok(readFileSync(path).length < 4000);
    await t.page.click("[data-sample='tree']");
    await done();
    await dropFile("rings.jali", readFileSync(path), "");
    await status(/^Working/);
    await done();
    assert.match(await address(), /sample=rings.*invert=true.*rotate=90/);
    assert.equal(new URLSearchParams(await address()).get("edits"), edits);
});

test("a bad project ends in a sentence, and nothing changes", async () => {
    await open("&sample=rings");
    const before = await address();
    const files = { picture: { name: "x.png", base64: "" } };
    for (const [content, sentence] of [
        ["not json", /bad\.jali is no project of jali: it is not JSON/],
        ['{"state": {}}', /does not say "jali_project"/],
        ['{"jali_project": 2, "state": {}}', /version 2; this jali reads version 1/],
        ['{"jali_project": 1}', /lacks "state"/],
        [JSON.stringify({ jali_project: 1, state: { sample: "" }, files }), /lacks "files\.picture"/],
        [JSON.stringify({ jali_project: 1, state: { sample: "" }, files: { picture: { name: "x.png", base64: "%%%" } } }), /bytes of "files\.picture" are damaged/],
    ]) {
        await dropFile("bad.jali", Buffer.from(content), "");
        await status(sentence);
        assert.equal(await address(), before);
    }
    // Values of the wrong kind are left out, and what the program refuses it says itself.
    await dropFile("odd.jali", Buffer.from('{"jali_project": 1, "state": {"sample": "rings", "width": "wide", "frame": [1], "__proto__": 3, "printer": "nobody"}}'), "");
    await status(/there is no printer "nobody"/);
});
