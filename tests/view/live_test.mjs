// Scenes that are traced again as one drags, steering by the own clock, and time lines, in a real browser.
import assert from "node:assert/strict";
import {writeFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {developed, difference, idle, launch, lookFile, open, sceneOf, screenshot, serve, shown, stopAll, tool} from "./browser.mjs";

let browser;
before(async () => (browser = await launch()));
after(async () => {
  await browser?.close();
  await stopAll();
});

const spheres = () => {
  const scene = sceneOf("goedel_earth.json", {camera: {type: "perspective", azimuth_deg: 40, fov_deg: 70, resolution: [320, 180]}});
  const place = (name, x, y, z) => ({name, shape: {type: "sphere", radius: 0.1}, placing: {type: "local", worldline: {type: "static", event: [0, x, y, z]}}});
  scene.objects = [scene.objects[0], place("left", 0.5, 0.5, 0.1), place("right", 0.6, 0.2, -0.1)];
  scene.look.objects = {earth: scene.look.objects.earth};
  return scene;
};

/** What the tools make of the scene that the page shows, changed by hand here. */
async function expected(page, server, scene) {
  const changes = await page.evaluate(() => window.nullcone.live.source.changes);
  const copy = structuredClone(scene);
  Object.assign(copy.observer, changes.observer);
  Object.assign(copy.camera, changes.camera);
  for (const [name, {event, velocity, radius}] of Object.entries(changes.objects ?? {})) {
    const object = copy.objects.find((one) => one.name === name);
    if (event) object.placing.worldline.event = event;
    if (velocity) object.placing.worldline.velocity = velocity;
    if (radius) object.shape.radius = radius;
  }
  const file = join(server.folder, "changed.json"), data = join(server.folder, "changed.exr");
  writeFileSync(file, JSON.stringify(copy));
  tool("trace", file, "-o", data, "-q");
  return {changes, data, picture: await developed(page, server.folder, [data, "--look", await lookFile(page, server.folder)])};
}

test("a dragged camera and a moved object are traced again, and saved", async () => {
  const scene = spheres(), server = await serve(scene), page = await open(browser, server.address);
  await page.evaluate(() => (document.getElementById("panel-live").open = true));
  await page.locator("input[name=live-mode][value=look]").check();
  await page.waitForFunction(() => window.nullcone.live.on);
  await idle(page);
  await page.evaluate(() => {
    window.scales = [];
    window.nullcone.live.source.addEventListener("frame", ({detail}) => window.scales.push(detail.scale));
  });
  const box = await page.locator("#stage").boundingBox();
  await page.mouse.move(box.x + 300, box.y + 300);
  await page.mouse.down();
  for (let i = 1; i <= 15; ++i) {
    await page.mouse.move(box.x + 300 + 8 * i, box.y + 300 + 2 * i);
    await page.waitForTimeout(15);
  }
  await page.mouse.up();
  await idle(page);
  const first = await expected(page, server, scene);
  assert.ok(Math.abs(first.changes.camera.azimuth_deg - 40) > 5, JSON.stringify(first.changes));
  assert.equal(difference(await shown(page), first.picture), 0, "the camera was turned");
  const scales = await page.evaluate(() => window.scales);
  assert.ok(scales.some((scale) => scale > 1) && scales.at(-1) === 1, `${scales}`);
  await screenshot(page, "live");

  // Numbers of an object; what cannot be is refused in a line and the picture stays.
  await page.evaluate(() => window.nullcone.live.scene.set("/objects/left/radius", 0.2));
  await page.evaluate(() => window.nullcone.live.scene.set("/objects/right/event", [0, 0.7, 0.25, 0]));
  await idle(page);
  const second = await expected(page, server, scene);
  assert.equal(difference(await shown(page), second.picture), 0, "objects were changed");
  assert.ok(difference(first.picture, second.picture) > 500);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", {name: "Save as dataset"}).click()]);
  const saved = join(server.folder, "saved.exr");
  await download.saveAs(saved);
  tool("info", saved, "--verify", "--quiet");
  const payload = (file) => JSON.parse(tool("info", file, "--json")).payload;
  assert.deepEqual(payload(saved), payload(second.data), "the very records that nullcone-trace makes");
  assert.equal(difference(await developed(page, server.folder, [saved]), second.picture), 0, "with its look");

  // Looks and inspection are about what was traced.
  await page.evaluate(() => window.nullcone.store.set("/background", [0, 0, 0.5]));
  await idle(page);
  assert.equal(difference(await shown(page), await developed(page, server.folder, [second.data, "--look", await lookFile(page, server.folder)])), 0);
  const got = await page.evaluate(() => window.nullcone.api.json("api/pixel", {query: {data: "live", x: 160, y: 90}, body: {}}));
  delete got.spectra;
  assert.deepEqual(got, JSON.parse(tool("info", second.data, "--json", "--pixel", "160,90")));

  // While something moves what is traced is coarser than the picture whose pixels are asked about.
  const coarse = await page.evaluate(async () => {
    const {api, live} = window.nullcone;
    await api.frame({data: 0, scale: 4, format: "raw"}, {scene: live.source.changes, look: {}}, "api/trace");
    const pixel = (x, y) => api.json("api/pixel", {query: {data: "live", x, y, width: 320, height: 180}, body: {}});
    return [await pixel(160, 90), await pixel(319, 179)];
  });
  assert.deepEqual(coarse.map(({pixel}) => pixel), [[160, 90], [319, 179]]);
  assert.deepEqual(coarse[0].hits.map(({object}) => object), got.hits.map(({object}) => object));
  assert.deepEqual(page.faults, []);
  await page.context().close();
  await server.stop();
});

test("a street is walked along by the own clock", async () => {
  const scene = sceneOf("street.json", {camera: {resolution: [320, 200], samples: 1}, observer: {event: [0, -20, 0, 2.2], velocity: [0, 0, 0]}});
  const server = await serve(scene), page = await open(browser, server.address);
  await page.evaluate(() => (document.getElementById("panel-live").open = true));
  await page.getByRole("button", {name: "Steer", exact: true}).click();
  await page.waitForFunction(() => window.nullcone.live.on);
  await page.keyboard.down("w");
  await page.waitForTimeout(1500);
  await page.keyboard.up("w");
  await page.keyboard.down("a");
  await page.waitForTimeout(300);
  await page.keyboard.up("a");
  await screenshot(page, "steer");
  await page.getByRole("button", {name: "Pause", exact: true}).click();
  await idle(page);
  const {changes, picture} = await expected(page, server, scene);
  const speed = Math.hypot(...changes.observer.velocity);
  assert.ok(speed > 0.1 && speed < 1, `${speed}`);
  assert.ok(changes.observer.event[1] > -20 && changes.camera.azimuth_deg > 5, JSON.stringify(changes));
  const readings = await page.locator(".steer-readings td").allTextContents();
  assert.ok(Math.abs(parseFloat(readings[0]) - speed) < 1e-3, `${readings} and ${speed}`);
  assert.ok(parseFloat(readings[3]) > parseFloat(readings[2]), "the street's clock is ahead of one's own");
  assert.equal(difference(await shown(page), picture), 0, "what is seen there");
  assert.deepEqual(page.faults, []);
  await page.context().close();
  await server.stop();
});

test("a sequence is a time line that plays", async () => {
  const scenes = [24, 34, 44].map((azimuth_deg) => sceneOf("goedel_earth.json", {camera: {azimuth_deg, resolution: [440, 50]}}));
  const server = await serve(scenes), page = await open(browser, server.address);
  const agrees = async (number) =>
    assert.equal(difference(await shown(page), await developed(page, server.folder, [server.data[number]])), 0, `frame ${number}`);
  await agrees(0);
  await page.getByRole("button", {name: "next frame"}).click();
  await page.waitForFunction(() => window.nullcone.view.data === 1);
  await idle(page);
  await agrees(1);
  const seen = await page.evaluate(() => new Promise((done) => {
    const seen = [];
    window.nullcone.addEventListener("view", () => seen.push(window.nullcone.view.data) >= 8 && done(seen));
    document.querySelector(".timeline-play").click();
  }));
  assert.deepEqual(seen, [2, 0, 1, 2, 0, 1, 2, 0]);
  await page.locator(".timeline-play").click();
  await idle(page);
  await agrees(await page.evaluate(() => window.nullcone.view.data));
  await screenshot(page, "timeline");
  assert.deepEqual(page.faults, []);
  await page.context().close();
  await server.stop();
});

test("the keyframes of a look are a time line over one dataset", async () => {
  const server = await serve(sceneOf("goedel_earth.json", {camera: {resolution: [440, 50]}}), "--frames", "0-10", "--set",
    "objects.earth.spectrum={\"type\":\"black_body\",\"temperature_K\":{\"keyframes\":[[0,2000],[10,9000]]}}");
  const page = await open(browser, server.address);
  await page.locator(".timeline-number").fill("7");
  await page.locator(".timeline-number").press("Enter");
  await page.waitForFunction(() => window.nullcone.view.frame === 7);
  await idle(page);
  const look = await lookFile(page, server.folder);
  assert.equal(difference(await shown(page), await developed(page, server.folder, [server.data[0], "--look", look, "--frame", "7"])), 0);
  await page.context().close();
  await server.stop();
});
