// How many frames a second the object turns at, and what a frame costs beside the drawing of its triangles.
//
//     JALI=path/to/jali node web/bench/orbit.mjs [sample] [width, mm]
//
// The page itself, a drag of the pointer over the canvas. Drawn by the processor (SwiftShader): what a graphics card does in a
// fraction of a ms takes it tens. So the same is timed once more with the draw calls left out, which is what the page itself
// costs a frame: its own work, three.js, and the lines and words over the object.
import { loadavg } from "node:os";
import { closeAll, serve } from "./serving.mjs";

const [sample = "halftone", width = "150"] = process.argv.slice(2), FRAMES = 90;
const { page, address } = await serve(process.env.JALI);

await page.addInitScript(() => {
    window.seen = { draws: 0, indices: 0, skip: false, spent: [] };
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
        const gl = get.call(this, kind, ...more);
        if (kind === "webgl2" && gl && !gl.counted) {
            gl.counted = true;
            const draw = gl.drawElements;
            gl.drawElements = function (mode, count, ...rest) {
                window.seen.draws++;
                window.seen.indices += count;
                if (!window.seen.skip) draw.call(this, mode, count, ...rest);
            };
        }
        return gl;
    };
    const ask = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (work) => ask((now) => {
        const began = performance.now();
        work(now);
        window.seen.spent.push(performance.now() - began);
    });
});
await page.goto(`${address}&sample=${sample}&width=${width}`);
await page.waitForFunction(() => /^Done|not work/.test(document.getElementById("status").textContent), null, { timeout: 400000 });
await page.click("#tab-solid");
await page.waitForTimeout(4000);

// Orbit by pointer moves, one a frame; frames a second and the median of what a frame took on the main thread.
const orbit = (skip) => page.evaluate(async ([without, frames]) => {
    const canvas = document.querySelector(".fill canvas[role=img]"), box = canvas.getBoundingClientRect();
    const send = (type, x) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, isPrimary: true, button: 0, buttons: type === "pointerup" ? 0 : 1, bubbles: true, cancelable: true,
        pointerType: "mouse", clientX: box.left + x, clientY: box.top + box.height / 2 + x / 9, pageX: box.left + x, pageY: box.top + x / 9 }));
    canvas.setPointerCapture = canvas.releasePointerCapture = () => {};
    Object.assign(window.seen, { skip: without, draws: 0, indices: 0, spent: [] });
    const gl = canvas.getContext("webgl2"), pixel = new Uint8Array(4), began = performance.now();
    send("pointerdown", 100);
    let moves = 0;
    for (let i = 0; i < frames; i++) {
        const start = performance.now();
        send("pointermove", 100 + 4 * i);
        moves += performance.now() - start;
        await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
        if (!without) gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // until it is really drawn
    }
    const seconds = (performance.now() - began) / 1000, spent = window.seen.spent.filter((ms) => ms > 0.02).sort((a, b) => a - b);
    send("pointerup", 100);
    return { fps: frames / seconds, median: spent[spent.length >> 1] + moves / frames, most: spent[Math.floor(0.95 * spent.length)] + moves / frames, draws: window.seen.draws / frames, triangles: window.seen.indices / 3 / Math.max(window.seen.draws, 1) };
}, [skip, FRAMES]);

const drawn = await orbit(false), bare = await orbit(true);
console.log(`${sample}, ${width} mm: ${Math.round(drawn.triangles).toLocaleString("en")} triangles in ${drawn.draws.toFixed(1)} draw calls a frame`);
console.log(`by SwiftShader: ${drawn.fps.toFixed(1)} frames a second`);
console.log(`without the draw calls: ${bare.median.toFixed(2)} ms of the main thread a frame, 95th percentile ${bare.most.toFixed(2)} ms; load ${loadavg()[0].toFixed(1)}`);
await closeAll();
