// How long after a slider's stop the first preview is drawn, in a real browser, against `jali adapt` alone in turn.
//
//     JALI=path/to/jali node web/bench/preview.mjs [stops] [folder of pictures]
//
// A stop is a short drag of the width's slider: six moves, 16 ms apart. The time is from the last of them to the frame after
// the canvas was drawn. Pictures are built-in samples of 1000 x 1000, or those of a folder. The machine's load is said,
// since the times mean little under it; the ratio to the command line, which suffers alike, means more.
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { loadavg } from "node:os";
import { join } from "node:path";
import { closeAll, serve, temporary } from "./serving.mjs";

const jali = process.env.JALI, stops = Number(process.argv[2] ?? 36), folder = process.argv[3];
const names = folder ? readdirSync(folder).filter((name) => /\.(png|jpe?g|webp)$/.test(name)) : ["girih", "tree", "mask", "lettering", "sunflower", "halftone"];
const at = (sorted, share) => sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)];
const told = (times) => { const sorted = [...times].sort((a, b) => a - b); return `${Math.round(at(sorted, 0.5))} ms median, ${Math.round(at(sorted, 0.95))} ms 95th percentile`; };

// One drag in the page; the milliseconds from its last move to each step.
const stop = (page, from) => page.evaluate(async (first) => {
    const slider = document.querySelector("input[type=range][aria-label=Width]");
    performance.clearMarks();
    for (let i = 1; i <= 6; i++) {
        slider.value = first + i;
        slider.dispatchEvent(new Event("input", { bubbles: true }));
        if (i < 6) await new Promise((resolve) => setTimeout(resolve, 16));
    }
    const last = performance.now(), marks = () => performance.getEntriesByName("preview:drawn");
    while (marks().length === 0 && performance.now() < last + 5000) await new Promise((resolve) => setTimeout(resolve, 2));
    await new Promise((resolve) => requestAnimationFrame(resolve));
    const of = (name) => Math.max(...performance.getEntriesByName(`preview:${name}`).map((entry) => entry.startTime)) - last;
    return { asked: of("asked"), made: of("made"), drawn: of("drawn"), seen: performance.now() - last };
}, from);

const { page, address } = await serve(jali);
const all = [], alone = [], parts = { asked: [], made: [], drawn: [] };
for (const name of names) {
    const file = folder ? join(folder, name) : join(temporary, `${name}.png`);
    if (!folder) execFileSync(jali, ["sample", name, "--size", "1000", "-o", file, "--quiet"]);
    await page.goto("about:blank");
    await page.goto(`${address}&sample=${folder ? "" : name}`);
    if (folder) await page.setInputFiles("input[type=file]", { name, mimeType: "", buffer: readFileSync(file) });
    await page.waitForFunction(() => /^Done|not work/.test(document.getElementById("status").textContent), null, { timeout: 180000 });
    const own = [];
    for (let i = 0; i < Math.ceil(stops / names.length); i++) {
        const width = 62 + ((7 * i) % 12), taken = await stop(page, width);
        own.push(taken.seen);
        for (const key of Object.keys(parts)) parts[key].push(taken[key]);
        const began = performance.now();
        execFileSync(jali, ["adapt", file, "--width", String(width + 6), "--printer", "hori-z500", "--no-predict", "-o", join(temporary, "out.png"), "--force-overwrite", "--quiet"]);
        alone.push(performance.now() - began);
        await page.waitForTimeout(150);
    }
    console.log(`${name.padEnd(24)} ${told(own)}`);
    all.push(...own);
}
console.log(`${all.length} stops: ${told(all)}; asked for after ${told(parts.asked)}; made ${told(parts.made)}; drawn ${told(parts.drawn)}`);
console.log(`jali adapt alone, in turn: ${told(alone)}; load ${loadavg()[0].toFixed(1)}`);
await closeAll();
