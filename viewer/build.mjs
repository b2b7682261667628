// Makes the one file that the report contains. Its first lines name a fingerprint of the sources and one of
// itself, by which a test of moldwarp-io sees whether it is stale.
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const here = new URL(".", import.meta.url);
const out = new URL("../crates/moldwarp-io/src/report/viewer.js", here);

/** FNV-1a of 64 bits: few lines here and in Rust, and good enough to tell that something has changed. */
function fingerprint(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
  return hash.toString(16).padStart(16, "0");
}

/** All that the bundle is made from, by name, without carriage returns. */
function sources() {
  const own = readdirSync(new URL("src/", here)).map((name) => `src/${name}`);
  const all = ["build.mjs", "package.json", "package-lock.json", "tsconfig.json", ...own].sort();
  const parts = all.map((name) => `${name}\n${readFileSync(new URL(name, here), "utf8").replaceAll("\r", "")}`);
  return new TextEncoder().encode(parts.join("\n"));
}

const licence = readFileSync(new URL("node_modules/uplot/LICENSE", here), "utf8").replaceAll("\r", "").trim();
const made = await build({
  entryPoints: [new URL("src/main.ts", here).pathname],
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome90", "firefox113", "safari16.4"],
  charset: "utf8",
  legalComments: "none",
  loader: { ".css": "text" },
  write: false,
});
// Nothing in it may end the script element that it will stand in.
const body = made.outputFiles[0].text.replaceAll("</script", "<\\/script");
const notice = `/*! moldwarp's viewer, built from viewer/ by: npm ci && npm run build
sources ${fingerprint(sources())}
bundle ${fingerprint(new TextEncoder().encode(body))}

It contains uPlot (https://github.com/leeoniya/uPlot):

${licence}
*/
`;
writeFileSync(out, notice + body);
console.log(`${notice.length + body.length} bytes`);
