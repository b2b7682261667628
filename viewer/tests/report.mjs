// Opens reports as a reader would, and checks what is seen: node tests/report.mjs RUN_FOLDER…
// Each folder holds a run and its report.html.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { found, launch, open, settled } from "./browser.mjs";

const folders = process.argv.slice(2).map((path) => resolve(path));
if (!folders.length) {
  console.error("name folders of runs that have a report.html");
  process.exit(2);
}
if (!found) {
  console.log("skipped: there is no Chromium; CHROMIUM=PATH names one");
  process.exit(0);
}

/** What is drawn: how many pixels are not the background, how many colours there are, and a fingerprint. */
function picture(page) {
  return page.evaluate(() => {
    const view = window.moldwarp.view;
    const source = document.querySelector(".stage canvas");
    // In one go: afterwards the browser has taken the picture away.
    view.draw();
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [source.width, source.height];
    const context = copy.getContext("2d");
    context.drawImage(source, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    const pixels = new Uint32Array(data.buffer);
    const colours = new Set();
    let drawn = 0;
    let print = 0;
    for (const pixel of pixels) {
      if (pixel !== pixels[0]) drawn++;
      colours.add(pixel);
      print = (Math.imul(print, 31) + pixel) | 0;
    }
    return { share: drawn / pixels.length, colours: colours.size, print };
  });
}

const legend = (page) => page.$eval(".legend", (e) => e.innerText);
const state = (page) => page.evaluate("window.moldwarp.view.state");
const choose = async (page, id, value) => {
  await page.select(`#${id}`, value);
  await settled(page);
};

/** Figures of a table by the key of the row. */
function figures(page, table) {
  return page.$$eval(`#table-${table} tr[data-key]`, (rows) =>
    rows.map((row) => [row.dataset.key, [...row.querySelectorAll("data")].map((d) => [d.value, d.textContent, d.dataset.scale])]),
  );
}

function asNumber(text) {
  const plain = text.replaceAll(",", "").replaceAll("−", "-").replaceAll("\n", "");
  const [digits, power] = plain.split("·10");
  return Number(digits) * 10 ** Number(power ?? 0);
}

/** The exact value, and what is read of it to four digits. */
function same([value, text, scale], expected, what) {
  assert.equal(Number(value), expected, what);
  const shown = asNumber(text) * Number(scale ?? 1);
  assert.ok(Math.abs(shown - expected) <= 5.01e-4 * Math.abs(expected), `${what}: ${text} of ${expected}`);
}

async function figuresAreThoseOfTheFiles(page, summary, history) {
  let seen = 0;
  for (const [key, [first]] of await figures(page, "summary")) {
    const value = key.split(".").reduce((of, k) => of?.[k], summary);
    if (typeof value === "number") {
      same(first, value, key);
      seen++;
    }
  }
  assert.ok(seen >= 18, `${seen} figures of the summary`);
  for (const [key, [first]] of await figures(page, "energies")) same(first, summary.energy[key], key);
  const rows = await figures(page, "history");
  assert.equal(rows.length, history.names.length - 4);
  for (const [key, [last, least, , greatest]] of rows) {
    const column = history.column(key);
    same(last, column.at(-1), `${key} at the end`);
    same(least, Math.min(...column), `least ${key}`);
    same(greatest, Math.max(...column), `greatest ${key}`);
  }
}

async function curves(page, history) {
  await page.evaluate("window.moldwarp.plots.forEach((p) => p.draw())");
  const plots = await page.evaluate("window.moldwarp.plots.map((p) => ({ name: p.group.name, points: p.points, curves: p.curves, csv: p.csv() }))");
  assert.equal(plots.reduce((n, p) => n + p.curves, 0), history.names.length - 4, "every column is a curve");
  for (const plot of plots) {
    assert.equal(plot.points, history.rows.length, `points of ${plot.name}`);
    const [names, ...rows] = plot.csv.trim().split("\n").map((l) => l.split(","));
    names.forEach((name, i) => assert.deepEqual(rows.map((r) => Number(r[i])), history.column(name), `CSV of ${name}`));
  }
  assert.equal((await page.$$("#plots figure canvas")).length, plots.length);
  // The values under the cursor, by keys.
  const ground = await page.$("#plots .ground");
  await ground.focus();
  await page.keyboard.press("End");
  await settled(page);
  const shown = await page.$eval("#plots .u-legend .u-series:nth-child(2) .u-value", (e) => e.textContent);
  const first = plots[0].csv.trim().split("\n").at(-1).split(",")[1];
  assert.ok(Math.abs(asNumber(shown.replace(/10([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)$/, (_, p) => `10${plainPower(p)}`)) - Number(first)) <= 6e-4 * Math.abs(Number(first)), `${shown} for ${first}`);
  // Zoomed by dragging, and whole again.
  const span = () => page.evaluate("(() => { const x = window.moldwarp.plots[0].shown; return x[1] - x[0]; })()");
  const whole = await span();
  const over = await page.$("#plots .u-over");
  await over.scrollIntoView();
  const box = await over.boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 62, { steps: 4 });
  await page.mouse.up();
  const part = await span();
  assert.ok(part < 0.5 * whole, `zoomed to ${part} of ${whole}`);
  await (await page.$("#plots .tools button")).click();
  assert.ok(Math.abs((await span()) - whole) < 1e-9 * whole);
}

const plainPower = (text) => [...text].map((c) => (c === "⁻" ? "-" : "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c))).join("");

async function ground3d(page) {
  const { frames } = await state(page);
  const end = await picture(page);
  assert.ok(end.share > 0.01 && end.colours > 10, `blank: ${JSON.stringify(end)}`);

  if (frames > 1) {
    await page.focus("#frame");
    await page.keyboard.press("Home");
    await settled(page);
    assert.equal((await state(page)).frame, 0);
    assert.notEqual((await picture(page)).print, end.print, "the slider changes the picture");
    await page.keyboard.press("End");
    await settled(page);
    assert.equal((await picture(page)).print, end.print, "and back");
    await page.focus(".stage canvas");
    await page.keyboard.press(" ");
    await page.waitForFunction("window.moldwarp.view.state.frame > 0 && window.moldwarp.view.state.frame < window.moldwarp.view.state.frames - 1 || window.moldwarp.view.state.frames < 3");
    await page.keyboard.press(" ");
    await page.focus("#frame");
    await page.keyboard.press("End");
    await settled(page);
  }

  const options = await page.$$eval("#field option", (all) => all.map((o) => o.value));
  const legends = new Set();
  for (const option of options) {
    await choose(page, "field", option);
    assert.equal((await state(page)).field, option);
    legends.add(await legend(page));
    const { share, colours } = await picture(page);
    assert.ok(share > 0.01 && colours > 3, `blank: ${option}`);
  }
  assert.equal(legends.size, options.length, "each field has a legend of its own");

  await choose(page, "field", "displacement/0");
  const before = await picture(page);
  await choose(page, "clip", "2");
  assert.notEqual((await picture(page)).print, before.print, "a cut");
  await choose(page, "clip", "");
  assert.equal((await picture(page)).print, before.print);
  await choose(page, "map", "cool-warm");
  assert.notEqual((await picture(page)).print, before.print, "colours");
  await choose(page, "map", "auto");
  await page.focus(".stage canvas");
  await page.keyboard.press("ArrowLeft");
  await settled(page);
  assert.notEqual((await picture(page)).print, before.print, "arrows turn it");
  await page.keyboard.press("0");
  await settled(page);
  assert.equal((await picture(page)).print, before.print);
  if (await page.$("#extent")) {
    await choose(page, "extent", "part");
    const part = await state(page);
    const one = await picture(page);
    await choose(page, "extent", "whole");
    const whole = await state(page);
    assert.ok(part.copies === 1 && whole.copies >= 2);
    assert.notEqual((await picture(page)).print, one.print, "the whole body");
    await choose(page, "extent", "part");
  }
}

async function aClickedParticle(page) {
  const canvas = await page.$(".stage canvas");
  await canvas.scrollIntoView();
  const box = await canvas.boundingBox();
  for (const [x, y] of [[0.5, 0.5], [0.5, 0.6], [0.47, 0.7], [0.53, 0.4], [0.45, 0.5]]) {
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
    await settled(page);
    const { picked } = await state(page);
    if (picked === null) continue;
    const text = await page.$eval(".picked", (e) => e.innerText);
    assert.ok(text.includes(`Particle ${picked}`) && text.includes("Displacement"), text);
    return;
  }
  assert.fail("no particle was found under five places");
}

/** Each question has an answer in sight, and what its button shows is what it says. */
async function fiveQuestions(page) {
  for (const id of ["far", "rest", "yield", "force", "trust"]) {
    const short = await page.$eval(`#answer-${id} .short`, (e) => e.innerText);
    assert.ok(short.length > 0, id);
    const button = await page.$(`#answer-${id} button.show`);
    if (!button) continue;
    const what = JSON.parse(await button.evaluate((b) => b.dataset.show));
    await button.click();
    await settled(page);
    await settled(page);
    if (what.plot) {
      const name = await page.evaluate("document.activeElement.closest('figure')?.dataset.plot");
      assert.equal(name, what.plot, id);
    } else {
      const now = await state(page);
      assert.equal(now.field, `${what.field}/${what.part ?? 0}`, id);
      if (what.id !== undefined) assert.equal(now.picked, what.id, id);
    }
  }
  // The particle that went farthest is the marked one, and its displacement is what the answer says.
  await (await page.$("#answer-far button.show")).click();
  await settled(page);
  const { number, least } = await page.evaluate(() => {
    const about = JSON.parse(document.getElementById("about").textContent);
    const what = JSON.parse(document.querySelector("#answer-far button.show").dataset.show);
    const shown = about.pictures.frames.some((f) => f.number === what.frame);
    return { number: Number(document.querySelector("#answer-far .short data").value), least: shown ? 0.994 : 0 };
  });
  const text = await page.$eval(".picked", (e) => [...e.querySelectorAll("tr")].find((r) => r.innerText.startsWith("Displacement")).innerText);
  const parts = [...text.matchAll(/[xyz] (−?[\d.]+(?:·10[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)?)/g)].map((m) =>
    asNumber(m[1].replace(/10([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)$/, (_, p) => `10${plainPower(p)}`)),
  );
  const size = Math.hypot(...parts) * (text.trimEnd().endsWith("mm") ? 1e-3 : 1);
  // Three digits of each component are shown.
  assert.ok(size >= least * number && size <= 1.01 * number, `${text} against ${number}`);
}

/** What the graphics processor draws, here one that is only imitated: about the same as without one. */
async function withWebGl(browser, folder) {
  const pictures = [];
  for (const hash of ["#webgl", "#software"]) {
    const { page, said } = await open(browser, `${folder}/report.html`, { hash });
    assert.equal((await state(page)).software, hash === "#software");
    await choose(page, "field", "velocity/3");
    pictures.push(await picture(page));
    assert.deepEqual(said, []);
    await page.close();
  }
  const [a, b] = pictures;
  assert.ok(Math.abs(a.share - b.share) < 0.03 * b.share, `${JSON.stringify(a)} against ${JSON.stringify(b)}`);
  assert.ok(a.colours > 10 && b.colours > 10);
}

const browser = await launch();
let failed = 0;
for (const folder of folders) {
  const begun = Date.now();
  const lines = readFileSync(`${folder}/history.csv`, "utf8").trim().split("\n").map((l) => l.split(","));
  const history = { names: lines[0], rows: lines.slice(1), column: (name) => lines.slice(1).map((r) => Number(r[lines[0].indexOf(name)])) };
  const summary = JSON.parse(readFileSync(`${folder}/summary.json`, "utf8"));
  const { page, said } = await open(browser, `${folder}/report.html`);
  try {
    // A title may be anything, and does nothing.
    assert.equal(await page.title(), summary.title);
    assert.equal(await page.$eval("h1", (e) => e.textContent), summary.title);
    await figuresAreThoseOfTheFiles(page, summary, history);
    await ground3d(page);
    await aClickedParticle(page);
    await fiveQuestions(page);
    await curves(page, history);
    if (folder === folders[0]) await withWebGl(browser, folder);
    const phone = await open(browser, `${folder}/report.html`, { width: 390, height: 844, dark: true });
    const wide = await phone.page.evaluate("document.documentElement.scrollWidth - innerWidth");
    assert.ok(wide <= 0, `${wide} pixels wider than a phone`);
    assert.ok((await picture(phone.page)).share > 0.01, "blank on a phone");
    assert.deepEqual([...said, ...phone.said], [], "no request, no error");
    await phone.page.close();
    console.log(`ok ${folder} (${((Date.now() - begun) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed++;
    console.error(`FAILED ${folder}: ${error.stack}\n${said.join("\n")}`);
  }
  await page.close();
}
await browser.close();
process.exit(failed ? 1 : 0);
