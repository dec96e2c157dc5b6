// The page of nullcone-view in a real browser against the real server: what it shows is what the command line gives.
// Run by ctest; by hand: node --test tests/view/page_test.mjs
// With NULLCONE_SCREENSHOTS=FOLDER it leaves pictures to look at.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {copyFileSync, readFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {developed, difference, idle, launch, lookFile, open, sceneOf, screenshot, serve, shown, stopAll, tool, tools} from "./browser.mjs";

let browser, server, page;
const data = () => server.data[0];
const at = (pointer) => page.locator(`[data-pointer="${pointer}"]`);

before(async () => {
  browser = await launch();
  server = await serve(sceneOf("goedel_earth.json", {camera: {resolution: [880, 100]}}));
  page = await open(browser, server.address);
});
after(async () => {
  await browser?.close();
  await stopAll();
});

/** What is on the screen against what nullcone-postrender makes of the page's look. */
async function agrees(what) {
  await idle(page);
  const expected = await developed(page, server.folder, [data(), "--look", await lookFile(page, server.folder)]);
  assert.equal(difference(await shown(page), expected), 0, what);
}

test("the page loads and shows the picture of the command line", async () => {
  const picture = await shown(page);
  assert.deepEqual([picture.width, picture.height], [880, 100]);
  assert.equal(difference(picture, await developed(page, server.folder, [data()])), 0);
  assert.ok(picture.rgb.some((value) => value > 100), "a picture of nothing proves nothing");
  await screenshot(page, "loaded");
});

test("a temperature slider changes the picture to the pixels of the command line", async () => {
  const before = await shown(page);
  await at("/objects/earth/spectrum/type").locator("select").selectOption("black_body");
  await agrees("black body");
  const slider = at("/objects/earth/spectrum/temperature_K").locator("input[type=range]"), box = await slider.boundingBox();
  await page.evaluate(() => {
    window.scales = [];
    window.nullcone.frames.addEventListener("shown", ({detail}) => window.scales.push(detail.scale));
  });
  await page.mouse.move(box.x + box.width * 0.5, box.y + box.height / 2);
  await page.mouse.down();
  for (let share = 0.5; share > 0.25; share -= 0.02) await page.mouse.move(box.x + box.width * share, box.y + box.height / 2);
  await page.waitForTimeout(300);
  await page.mouse.up();
  await agrees("after the drag");
  const scales = await page.evaluate(() => window.scales);
  assert.ok(scales.some((scale) => scale > 1), "coarse while dragging");
  assert.equal(scales.at(-1), 1, "in full after it");
  const temperature = await page.evaluate(() => window.nullcone.store.look.objects.earth.spectrum.temperature_K);
  assert.ok(temperature > 500 && temperature < 5000, `a lower temperature: ${temperature}`);
  assert.ok(difference(before, await shown(page)) > 1000, "another picture");
  await screenshot(page, "black_body");
  // A drag is one step of history.
  await page.keyboard.press("Control+z");
  await idle(page);
  assert.equal(await page.evaluate(() => window.nullcone.store.look.objects.earth.spectrum.temperature_K), 5800);
  await page.keyboard.press("Control+z");
  await idle(page);
  assert.equal(difference(before, await shown(page)), 0, "undone");
  await page.keyboard.press("Control+Shift+z");
  await page.keyboard.press("Control+Shift+z");
  await idle(page);
  assert.equal(await page.evaluate(() => window.nullcone.store.look.objects.earth.spectrum.temperature_K), temperature);
});

test("numbers are typed, stepped by keys and reset", async () => {
  const field = at("/exposure/ev").locator("input[type=text]");
  await page.evaluate(() => document.querySelectorAll("details.panel").forEach((panel) => (panel.open = true)));
  await field.fill("1.5");
  await field.press("Enter");
  await agrees("typed");
  assert.equal(await page.evaluate(() => window.nullcone.store.look.exposure.ev), 1.5);
  await field.press("ArrowUp");
  const stepped = await page.evaluate(() => window.nullcone.store.look.exposure.ev);
  assert.ok(stepped > 1.5 && stepped < 3, `${stepped}`);
  await field.fill("much");
  await field.press("Enter");
  assert.match(await at("/exposure/ev").locator("[role=alert]").textContent(), /not a number/);
  await at("/exposure/ev").locator("button.reset").click();
  await agrees("reset");
  assert.equal(await page.evaluate(() => window.nullcone.store.look.exposure?.ev), undefined);
});

test("a dropped texture appears", async () => {
  const name = "night.jpg", bytes = readFileSync("/usr/share/xplanet/images/night.jpg");
  const before = await shown(page);
  const transfer = await page.evaluateHandle(({name, text}) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name, {type: "image/jpeg"}));
    return transfer;
  }, {name, text: bytes.toString("base64")});
  await page.dispatchEvent("#panel-objects", "drop", {dataTransfer: transfer});
  await page.waitForFunction(() => window.nullcone.store.look.objects.earth.texture.file === "night.jpg");
  copyFileSync("/usr/share/xplanet/images/night.jpg", join(server.folder, name));  // beside the look, as the page says
  await agrees("with another texture");
  assert.ok(difference(before, await shown(page)) > 1000);
  // What is no picture is refused in a line.
  const wrong = await page.evaluateHandle(() => {
    const transfer = new DataTransfer();
    transfer.items.add(new File(["no picture"], "notes.txt"));
    return transfer;
  });
  await page.dispatchEvent("#panel-objects", "drop", {dataTransfer: wrong});
  await page.waitForFunction(() => /picture/.test(document.getElementById("status").textContent));
});

test("a time band is dragged", async () => {
  const panel = page.locator("#panel-slices");
  await panel.locator("select").first().selectOption("earth");
  await page.waitForFunction(() => document.querySelector(".slices-bars"));
  await panel.getByRole("button", {name: "Add slice"}).click();
  await page.evaluate(() => {
    const {store} = window.nullcone, [slice] = store.look.objects.earth.time_slices;
    store.set("/objects/earth/time_slices", [{...slice, spectrum: {type: "display"}, texture: {type: "color", rgb: [1, 0, 0]}}]);
  });
  await agrees("with a slice");
  const grip = panel.locator('[data-handle="0-to"] rect, [data-handle="0-to"]').first();
  await grip.scrollIntoViewIfNeeded();
  const slice = () => page.evaluate(() => window.nullcone.store.look.objects.earth.time_slices[0]);
  const begin = await slice(), box = await grip.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  for (let x = 0; x <= 60; x += 5) await page.mouse.move(box.x + box.width / 2 + x, box.y + box.height / 2);
  await page.mouse.up();
  const end = await slice();
  assert.equal(end.from, begin.from);
  assert.ok(end.to > begin.to, `${begin.to} to ${end.to}`);
  await agrees("after the band was dragged");
  await panel.locator('[data-handle="0-both"]').focus();
  await page.keyboard.press("ArrowLeft");
  assert.ok((await slice()).from < end.from, "keys move it too");
  await agrees("after a key");
  await screenshot(page, "slices");
});

test("the records of a pixel are those of nullcone-info", async () => {
  const [x, y] = [240, 50];
  const expected = JSON.parse(tool("info", data(), "--json", "--pixel", `${x},${y}`));
  assert.equal(expected.hits[0].object, "earth");
  const {spectra, ...got} = await page.evaluate(([x, y]) => window.nullcone.api.json("api/pixel",
    {query: {data: 0, frame: 0, x, y}, body: window.nullcone.store.look}), [x, y]);
  assert.deepEqual(got, expected);
  assert.equal(spectra[0].object, "earth");
  // As text in the panel, wherever the pointer is.
  await page.evaluate(() => window.nullcone.picture.fit?.());
  const canvas = await page.locator("#picture").boundingBox();
  await page.mouse.move(canvas.x + ((x + 0.5) / 880) * canvas.width, canvas.y + ((y + 0.5) / 100) * canvas.height);
  await page.waitForFunction(() => /earth/.test(document.getElementById("panel-pixel").textContent));
  const panel = await page.locator("#panel-pixel").textContent();
  for (const value of [expected.hits[0].shift, expected.hits[0].t, expected.hits[0].mu, expected.hits[0].uv[0]])
    assert.ok(panel.includes(String(Number(Math.abs(value).toPrecision(4)))), `${value} in ${panel.slice(0, 400)}`);
  await screenshot(page, "pixel");
});

async function saved(click) {
  const [download] = await Promise.all([page.waitForEvent("download"), click()]);
  const path = join(server.folder, download.suggestedFilename());
  await download.saveAs(path);
  return path;
}

test("a saved look and the address bring the same picture back", async () => {
  const before = await shown(page);
  await page.locator("#save-menu > summary").click();
  const look = await saved(() => page.getByRole("button", {name: "Save look.json"}).click());
  assert.deepEqual(JSON.parse(readFileSync(look)), await page.evaluate(() => window.nullcone.store.look));
  assert.equal(difference(before, await developed(page, server.folder, [data(), "--look", look])), 0, "command line");
  // In a page of its own, by the address; and by --look in a server of its own.
  await page.waitForFunction(() => location.hash.length > 20);
  const other = await open(browser, page.url());
  assert.equal(difference(before, await shown(other)), 0, "address");
  assert.deepEqual(other.faults, []);
  await other.context().close();
  const again = await serve(sceneOf("goedel_earth.json", {camera: {resolution: [880, 100]}}), "--look", look);
  const reloaded = await open(browser, again.address);
  assert.equal(difference(before, await shown(reloaded)), 0, "--look");
  await reloaded.context().close();
  await again.stop();
});

test("the command line that is copied makes the same picture", async () => {
  await page.evaluate(() => (document.getElementById("save-menu").open = true));
  const line = await page.locator("#save-items textarea").first().inputValue();
  assert.match(line, /^nullcone-postrender /);
  // The picture that was sent must stand beside the dataset, as the page says.
  execFileSync("/bin/sh", ["-ec", line], {cwd: server.folder, env: {...process.env, PATH: `${tools}:${process.env.PATH}`}});
  const file = await saved(() => page.getByRole("button", {name: "Save picture"}).click());
  assert.ok(readFileSync(file).equals(readFileSync(join(server.folder, "picture.png"))), "the very bytes that the page saves");
});

test("looks are compared, channels shown in false colours, images listed", async () => {
  const compare = page.locator("#panel-compare");
  await compare.getByRole("button", {name: /Keep this look/}).click();
  await page.evaluate(() => window.nullcone.store.set("/background", [0, 0.3, 0]));
  await agrees("beside a kept look");
  await page.locator(".wipe").focus();
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.locator(".wipe").getAttribute("aria-valuenow"), "51");
  await screenshot(page, "compare");
  await compare.getByRole("button", {name: "Leave"}).click();

  await page.locator("#panel-channels select").selectOption("shift");
  await page.waitForFunction(() => document.querySelector(".legend-bar"));
  await screenshot(page, "channel");
  await page.locator("#panel-channels input[type=checkbox]").uncheck();

  await page.locator("#panel-images select").selectOption("earth");
  await page.waitForFunction(() => document.querySelectorAll(".images-item").length === 3);
  const times = (await page.locator(".images-item strong").allTextContents()).map((text) => parseFloat(text.replace("−", "-").slice(2)));
  assert.deepEqual([...times].sort((a, b) => a - b), times, "earliest first");
  await page.locator(".images-item").first().click();
  await screenshot(page, "images");
});

test("nothing was wrong on the way, and everything has a name", async () => {
  assert.deepEqual(page.faults.filter((fault) => !/400/.test(fault)), []);  // the file that was no picture
  const nameless = await page.evaluate(() => [...document.querySelectorAll("button, input, select, textarea, [role=slider], [tabindex='0']")]
    .filter((element) => element.checkVisibility() && !element.closest("[aria-hidden=true]"))
    .filter((element) => !(element.ariaLabel || element.labels?.length || element.textContent.trim() || element.title || element.closest("label")))
    .map((element) => element.outerHTML.slice(0, 120)));
  assert.deepEqual(nameless, []);
});

for (const [name, options] of Object.entries({
  light: {colorScheme: "light"}, dark: {colorScheme: "dark"}, narrow: {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true}}))
  test(`the page fits: ${name}`, async () => {
    const other = await open(browser, server.address, options);
    const wide = await other.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `${wide} pixels too wide`);
    assert.deepEqual(other.faults, []);
    await screenshot(other, name);
    await other.context().close();
  });
