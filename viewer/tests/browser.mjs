// A browser without a screen and without a network.
import { existsSync } from "node:fs";
import puppeteer from "puppeteer-core";

/** Where Debian and others put it; CHROMIUM names another place. */
const PLACES = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

export const found = PLACES.find((path) => path && existsSync(path));

export function launch() {
  return puppeteer.launch({
    executablePath: found,
    headless: true,
    args: [
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--no-sandbox",
      "--disable-dev-shm-usage",
      // No name is resolved, so that nothing can be reached.
      "--host-resolver-rules=MAP * ~NOTFOUND",
    ],
  });
}

/** Opens a report. `said` collects errors and requests of any other place than the file itself. */
export async function open(browser, file, { width = 1280, height = 800, dark = false, hash = "" } = {}) {
  const page = await browser.newPage();
  const said = [];
  page.on("console", (message) => message.type() === "error" && said.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  page.on("request", (request) => {
    const own = request.url() === `file://${file}${hash}` || /^(data|blob):/.test(request.url());
    if (!own) said.push(`request: ${request.url()}`);
  });
  await page.setViewport({ width, height, deviceScaleFactor: 1 });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }]);
  await page.goto(`file://${file}${hash}`);
  await page.waitForFunction("window.moldwarp && window.moldwarp.ready", { timeout: 60_000 });
  return { page, said };
}

/** Waits until what was asked for is drawn. */
export async function settled(page) {
  await page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 120))))");
}
