// Pictures of a report, to be looked at: node tests/shots.mjs REPORT FOLDER
import { resolve } from "node:path";
import { launch, open, settled } from "./browser.mjs";

const [report, folder] = process.argv.slice(2).map((path) => resolve(path));
const browser = await launch();
for (const [name, width, height] of [["desktop", 1280, 800], ["phone", 390, 844]]) {
  for (const dark of [false, true]) {
    const { page, said } = await open(browser, report, { width, height, dark });
    await page.evaluate("window.moldwarp.plots.forEach((p) => p.draw())");
    await settled(page);
    const path = `${folder}/${name}-${dark ? "dark" : "light"}.png`;
    await page.screenshot({ path, fullPage: true });
    if (said.length) console.log(path, said);
    await page.close();
  }
}
await browser.close();
