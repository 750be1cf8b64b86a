// A server and a browser to measure with. WebGL is drawn by the processor (SwiftShader).
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

export const temporary = mkdtempSync(join(tmpdir(), "jali-bench-"));
let server, browser;

/** Start both; {page, address}. */
export async function serve(jali, viewport = { width: 1400, height: 900 }) {
    server = spawn(jali, ["serve", "--port", "0"], { stdio: ["ignore", "pipe", "ignore"] });
    const address = await new Promise((resolve, reject) => {
        let said = "";
        server.on("exit", () => reject(new Error(`jali serve ended: ${said}`)));
        server.stdout.on("data", (bytes) => {
            said += bytes;
            const found = said.match(/http:\S+/);
            if (found) resolve(found[0]);
        });
    });
    browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"] });
    const page = await (await browser.newContext({ viewport })).newPage();
    page.on("pageerror", (error) => console.error(error.message));
    return { page, address };
}

export async function closeAll() {
    await browser?.close();
    server?.kill();
    rmSync(temporary, { recursive: true, force: true });
}
