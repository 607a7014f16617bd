// Holds a page of scripts/report.sh against its results.json in headless Chromium:
// node check_page.mjs RESULTS [folder for screenshots]. Needs puppeteer-core and chromium.
import { readFileSync, statSync, existsSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
const puppeteer = createRequire(process.cwd() + "/")("puppeteer-core");

const folder = resolve(process.argv[2]), pictures = process.argv[3];
const document_ = JSON.parse(readFileSync(`${folder}/results.json`, "utf8"));
const faults = [];
const hold = (claim, holds) => { if (!holds) faults.push(claim); };
const at = path => path.split(".").reduce((value, key) => value[key], document_);

hold("smaller than 3 MB", statSync(`${folder}/index.html`).size < 3e6);
const browser = await puppeteer.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
let values = 0;
for (const width of [1280, 390]) for (const scheme of ["light", "dark"]) {
  const page = await browser.newPage(), where = `${width} ${scheme}: `;
  page.on("request", r => hold(where + "request " + r.url().slice(0, 80), /^(file|data|blob):/.test(r.url())));
  page.on("console", m => hold(where + m.text(), !["error", "warning"].includes(m.type()) || /GPU stall/.test(m.text())));
  page.on("pageerror", e => hold(where + e.message, false));
  await page.setViewport({ width, height: 900 });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  await page.goto(`file://${folder}/index.html`);
  const has = await page.evaluate(() => ({ costs: costs.length, octrees: octrees.length }));
  if (has.costs) await page.waitForFunction("window.costReady === 0");
  if (has.octrees) await page.waitForFunction("window.octreeReady");
  const shown = await page.$$eval("[data-value]", all => all.map(e => [e.dataset.value, e.value, e.textContent]));
  for (const [path, exact, text] of shown) {
    const value = at(path);
    hold(where + path, JSON.stringify(value) === JSON.stringify(JSON.parse(exact)));
    if (value !== null) {  // the text is the number, rounded to what it shows
      const digits = (text.split(".")[1] ?? "").length, said = Number(text.replaceAll(",", ""));
      hold(where + path + " " + text, Math.abs(said - value) <= 0.5001 * 10 ** -digits);
    }
  }
  values = shown.length;
  const wide = await page.evaluate(() => [...document.querySelectorAll("body *")].filter(e =>
    !e.closest(".scroll, pre, svg, select, datalist") && e.getBoundingClientRect().right > innerWidth + 1).map(e => e.tagName + "." + e.id));
  hold(where + "wider than the window: " + wide.slice(0, 5), wide.length === 0);
  hold(where + "the page scrolls sideways", await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  const boxes = await page.$$eval("svg", all => all.map(e => e.getBoundingClientRect()).map(b => b.width * b.height));
  hold(where + "an empty SVG", boxes.length > 0 && boxes.every(area => area > 1000));
  const colors = id => page.evaluate(id => {
    const from = document.getElementById(id), to = document.createElement("canvas");
    to.width = from.width; to.height = from.height;
    const context = to.getContext("2d");
    context.drawImage(from, 0, 0);
    const rgba = new Uint32Array(context.getImageData(0, 0, to.width, to.height).data.buffer);
    return { kinds: new Set(rgba).size, lit: rgba.filter(c => c !== rgba[0]).length };
  }, id);
  if (has.costs) {
    hold(where + "few colors of cost", (await colors("cost")).kinds > 50);
    const sums = await page.evaluate(() => Object.values(planes[0]).map(p => p.reduce((a, b) => a + b, 0)));
    const { names, counter } = await page.evaluate(() => costs[0]);
    hold(where + "sum of a plane", ["uniform", "nonuniform"].every((t, i) => document_.looks[names[t]].counts[counter] === sums[i]));
    await (await page.$("#cost")).hover();
    const said = await page.$eval("#cost-value", e => e.textContent);
    const [, x, y, u] = /pixel (\d+),(\d+): uniform (\d+)/.exec(said) ?? [];
    hold(where + "hover says " + said, Number(u) === await page.evaluate((x, y) => planes[0].uniform[y * costs[0].width + x], Number(x), Number(y)));
  }
  if (has.octrees) {
    const all = await colors("space");
    hold(where + "few colors of octrees " + all.kinds, all.kinds > 50);
    const rays = await page.evaluate(() => (results.rays ?? {})[views[views.length - 1].octree.name]?.filter(r => r.end !== null).length ?? 0);
    if (rays > 0) {
      const choose = i => page.evaluate(i => { const e = document.getElementById("ray-choice"); e.value = i; e.dispatchEvent(new Event("input")); return window.raysShown; }, i);
      hold(where + "not all rays are shown", await page.evaluate(() => window.raysShown) === rays);
      const with_all = (await colors("space")).lit;
      hold(where + "one ray is not shown alone", await choose(0) === 1 && (await colors("space")).lit !== with_all);
      hold(where + "all rays do not come back", await choose(-1) === rays && (await colors("space")).lit === with_all);
    }
    const voxels = await page.evaluate(() => window.voxels);
    for (const [name, count] of Object.entries(voxels)) hold(where + "voxels of " + name, document_.looks[name].tree.voxels === count);
    await (await page.$("#space")).scrollIntoView();
    const box = await (await page.$("#space")).boundingBox();
    await page.mouse.click(box.x + box.width / 4, box.y + box.height / 2);
    hold(where + "a click names no voxel", /voxel \d+/.test(await page.$eval("#voxel", e => e.textContent)));
    await page.evaluate(() => { const e = document.getElementById("octree-depth"); e.value = 0; e.dispatchEvent(new Event("input")); });
    hold(where + "depth 0 draws as much", (await colors("space")).lit < all.lit / 4);
    await page.evaluate(() => { const e = document.getElementById("octree-depth"); e.value = 24; e.dispatchEvent(new Event("input")); });
  }
  if (width === 1280 && scheme === "light") {
    await page.emulateMediaType("print");
    hold(where + "print shows tools", await page.$$eval(".tool", all => all.every(e => e.getBoundingClientRect().height === 0)));
    hold(where + "print lacks a panel", await page.$$eval("section[data-panel]", all => all.every(e => e.getBoundingClientRect().height > 0)));
    hold(where + "no PDF", Buffer.from(await page.pdf()).subarray(0, 5).toString() === "%PDF-");
    await page.emulateMediaType(null);
  }
  if (pictures) await page.screenshot({ path: `${pictures}/${width}-${scheme}.png`, fullPage: true });
  if (pictures && width === 1280 && scheme === "light") await page.pdf({ path: `${pictures}/print.pdf` });
  await page.close();
}
const bare = await browser.newPage();
await bare.setJavaScriptEnabled(false);
await bare.goto(`file://${folder}/index.html`);
hold("without JavaScript", (await bare.$$("section[data-panel] table, section[data-panel] svg")).length > 5);
await browser.close();
for (const fault of new Set(faults)) console.error("NO  " + fault);
console.log(`${values} values, ${faults.length} faults`);
process.exit(faults.length === 0 ? 0 : 1);
