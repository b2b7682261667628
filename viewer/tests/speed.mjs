// How many pictures a second the 3D view draws in software, at 800 × 600: node tests/speed.mjs REPORT
import { resolve } from "node:path";
import { found, launch, open } from "./browser.mjs";

if (!found) {
  console.log("skipped: there is no Chromium; CHROMIUM=PATH names one");
  process.exit(0);
}
const browser = await launch();
const { page } = await open(browser, resolve(process.argv[2]));
const result = await page.evaluate(async () => {
  const { view } = window.moldwarp;
  const canvas = document.querySelector(".stage canvas");
  Object.assign(canvas.style, { width: "800px", height: "600px" });
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  await frame();
  await frame();
  // Each picture waited for.
  const times = [];
  for (let i = 0; i < 40; i++) {
    const begun = performance.now();
    view.turn(0.05, 0);
    view.drawAndWait();
    times.push(performance.now() - begun);
    await frame();
  }
  times.sort((a, b) => a - b);
  // As a reader sees it: one picture for each frame of the browser.
  let shown = 0;
  const begun = performance.now();
  while (performance.now() - begun < 5000) {
    view.turn(0.05, 0);
    await frame();
    shown++;
  }
  return { size: [canvas.width, canvas.height], ...view.state, median: times[20], shown: shown / 5 };
});
await browser.close();
console.log(
  `${result.count * result.copies} particles at ${result.size.join(" × ")}: ${result.median.toFixed(1)} ms a picture, ` +
    `${result.shown.toFixed(1)} pictures a second while turning`,
);
