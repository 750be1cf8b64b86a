// Bundle the page into dist/, which is committed: building the C program needs no Node.
import { build } from "esbuild";
import { copyFile, mkdir } from "node:fs/promises";

const here = new URL(".", import.meta.url).pathname;
await mkdir(`${here}dist`, { recursive: true });
await build({
    entryPoints: [`${here}src/main.js`],
    outfile: `${here}dist/page.js`,
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    legalComments: "eof",
    logLevel: "warning",
});
for (const name of ["index.html", "page.css", "icon.svg"]) await copyFile(here + name, `${here}dist/${name}`);
