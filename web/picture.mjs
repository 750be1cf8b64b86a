// Draw the page itself, for the README: `make pictures` runs it where Node 20 and Chromium are.
//
//     CHROMIUM=/usr/bin/chromium node web/picture.mjs JALI OUT.png [ADDRESS] [WIDTHxHEIGHT] [light|dark]
//
// ADDRESS is what follows the token in the page's address, such as "&sample=tree&width=80".
import { spawn } from "node:child_process";
import { chromium } from "playwright-core";

const [jali, out, more = "&sample=tree", size = "1400x900", colorScheme = "light"] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const server = spawn(jali, ["serve", "--port", "0", "--quiet"], { stdio: ["ignore", "pipe", "inherit"] });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--use-gl=swiftshader"] });
try {
    const address = await new Promise((resolve, reject) => {
        server.on("exit", () => reject(new Error("jali serve ended")));
        server.stdout.on("data", (bytes) => { const found = String(bytes).match(/http:\S+/); if (found) resolve(found[0]); });
    });
    const page = await browser.newPage({ viewport: { width, height }, colorScheme });
    await page.goto(address + more);
    await page.waitForFunction(() => /^Done/.test(document.getElementById("status").textContent), null, { timeout: 120000 });
    await page.waitForTimeout(500); // the last pictures are drawn
    await page.screenshot({ path: out });
} finally {
    await browser.close();
    server.kill();
}
