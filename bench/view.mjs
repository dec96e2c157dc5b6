// What nullcone-view takes, from the server's answer to the pixels on the screen of a headless browser.
//   node bench/view.mjs [FRAMES]     FRAMES: for the memory (10000)
import {request, Agent} from "node:http";
import {readFileSync} from "node:fs";
import {idle, launch, open, sceneOf, serve} from "../tests/view/browser.mjs";

const kFrames = Number(process.argv[2] ?? 10000);
const agent = new Agent({keepAlive: true});

const sorted = (list) => [...list].sort((a, b) => a - b);
const report = (what, times) => {
  const by = sorted(times), at = (share) => by[Math.floor(share * (by.length - 1))].toFixed(1);
  console.log(`${what.padEnd(58)} median ${at(0.5).padStart(6)} ms   90 % ${at(0.9).padStart(6)}   greatest ${at(1).padStart(6)}   (${by.length})`);
};
const residentMiB = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024;

/** ms from the request to the last byte of the answer, and the server's own count. */
function ask(address, path, body) {
  return new Promise((done, fail) => {
    const begin = performance.now();
    const sent = request(new URL(path, address), {method: "POST", agent, headers: {"X-Nullcone-Viewer": "00000000000000bb"}}, (answer) => {
      let bytes = 0;
      answer.on("data", (part) => (bytes += part.length));
      answer.on("end", () => {
        if (answer.statusCode !== 200) return fail(new Error(`${answer.statusCode} ${path}`));
        const work = answer.headers["x-nullcone-times"].split(";").reduce((sum, part) => sum + Number(part.split("=")[1]), 0);
        done({ms: performance.now() - begin, work, bytes});
      });
    });
    sent.on("error", fail);
    sent.end(JSON.stringify(body));
  });
}

/** A map of the Earth all over the picture, every pixel a shifted black body. */
const dome = {
  metric: {name: "goedel", a: 1}, observer: {event: [0, 0, 0, 0]}, max_lookback: 10,
  camera: {type: "perspective", fov_deg: 100, resolution: [1280, 1024]},
  objects: [{name: "dome", shape: {type: "sphere", radius: 0.6, dome: true}, placing: {type: "local", worldline: {type: "static", event: [0, 0, 0, 0]}}}],
  look: {objects: {dome: {texture: {type: "image", file: "/usr/share/xplanet/images/earth.jpg"}, spectrum: {type: "black_body", temperature_K: 5000}}}},
};
const heated = (kelvin) => {
  const look = structuredClone(dome.look);
  look.objects.dome.spectrum.temperature_K = kelvin;
  return look;
};

async function answers(server) {
  for (const [scale, format] of [[1, "raw"], [1, "png"], [1, "jpeg"], [1, "webp"], [2, "raw"], [4, "raw"]]) {
    const all = [];
    for (let i = 0; i < 110; ++i) all.push(await ask(server.address, `api/frame?scale=${scale}&format=${format}`, heated(3000 + 20 * i)));
    const rest = all.slice(10);
    report(`server, 1280 x 1024, every ${scale}, ${format}, ${(rest[0].bytes / 1e6).toFixed(2)} MB: all`, rest.map(({ms}) => ms));
    report("    of that render and encode", rest.map(({work}) => work));
  }
}

/** From an input of the slider to the frame that shows it, and from its release to the full frame. */
async function slider(page) {
  const measured = await page.evaluate(async () => {
    const {frames, store} = window.nullcone;
    const slider = document.querySelector('[data-pointer="/objects/dome/spectrum/temperature_K"] input[type=range]');
    const painted = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
    const next = (fits) => new Promise((done) => frames.addEventListener("shown", function shown({detail}) {
      if (!fits(detail.scale)) return;
      frames.removeEventListener("shown", shown);
      done(detail.scale);
    }));
    const drags = [], paints = [], releases = [], scales = [];
    for (let i = 0; i < 60; ++i) {
      for (let k = 0; k < 4; ++k) {
        const begin = performance.now(), shown = next((scale) => scale > 1);
        slider.value = Number(slider.value) + (i % 2 ? 3 : -3);
        slider.dispatchEvent(new Event("input", {bubbles: true}));
        scales.push(await shown);
        drags.push(performance.now() - begin);
        await painted();
        paints.push(performance.now() - begin);
      }
      const begin = performance.now(), shown = next((scale) => scale === 1);
      slider.dispatchEvent(new Event("change", {bubbles: true}));
      await shown;
      await painted();
      releases.push(performance.now() - begin);
      await frames.idle();
    }
    return {drags: drags.slice(20), paints: paints.slice(20), releases: releases.slice(5), scales, kelvin: store.look.objects.dome.spectrum.temperature_K};
  });
  const halves = measured.scales.filter((scale) => scale === 2).length;
  report(`page, slider to drawn frame, half size in ${halves} of ${measured.scales.length}`, measured.drags);
  report("    and to the next paint of the screen", measured.paints);
  report("page, release to the lossless frame, painted", measured.releases);
}

async function memory(server) {
  const size = [];
  for (let i = 0; i < kFrames; ++i) {
    await ask(server.address, "api/frame?scale=2&format=raw", heated(2000 + (i % 5000))).catch(() => new Promise((done) => setTimeout(done, 200)));
    if (i % Math.ceil(kFrames / 10) === Math.ceil(kFrames / 10) - 1) size.push(residentMiB(server.pid));
  }
  console.log(`memory of the server over ${kFrames} frames, MiB: ${size.map((x) => x.toFixed(1)).join(" ")}`);
}

const sphere = (name, radius, x, y, z) => ({name, shape: {type: "sphere", radius}, placing: {type: "local", worldline: {type: "static", event: [0, x, y, z]}}});

/** The three spheres at rest of bench/trace.cpp, and two beside the Earth that falls with 0.7 c. */
function liveScenes() {
  const camera = {type: "perspective", fov_deg: 90, resolution: [640, 360]};
  const rest = {metric: {name: "goedel"}, observer: {event: [0, 0, 0, 0]}, camera: {...camera, azimuth_deg: 0}, max_lookback: 7,
    objects: [sphere("a", 0.2, 0.9, 0.1, 0), sphere("b", 0.15, 0.4, 0.8, 0.2), sphere("c", 0.1, 0.5, -0.6, -0.1)], look: {objects: {}}};
  for (const [name, kelvin] of [["a", 5762], ["b", 4000], ["c", 9000]])
    rest.look.objects[name] = {spectrum: {type: "black_body", temperature_K: kelvin}};
  const falling = sceneOf("goedel_earth.json", {camera: {...camera, azimuth_deg: 40}});
  falling.objects = [falling.objects[0], sphere("left", 0.1, 0.5, 0.5, 0.1), sphere("right", 0.1, 0.6, 0.2, -0.1)];
  falling.look.objects = {earth: falling.look.objects.earth};
  return {"three spheres at rest": rest, "two, and a falling Earth": falling};
}

async function live(browser, name, scene) {
  const server = await serve(scene), all = [];
  for (let i = 0; i < 110; ++i)
    all.push(await ask(server.address, "api/trace?scale=1&format=raw", {scene: {camera: {azimuth_deg: scene.camera.azimuth_deg + 0.2 * i}}, look: scene.look}));
  report(`server, Goedel, 640 x 360 traced, ${name}: all`, all.slice(10).map(({ms}) => ms));
  const page = await open(browser, server.address);
  const rates = await page.evaluate(async (azimuth) => {
    const {live, frames} = window.nullcone, counts = {};
    await live.begin();
    await frames.idle();
    live.source.addEventListener("frame", ({detail}) => (counts[detail.scale] = (counts[detail.scale] ?? 0) + 1));
    const begin = performance.now();
    for (let i = 0; performance.now() - begin < 4000; ++i) {
      live.scene.set("/camera/azimuth_deg", azimuth + 0.1 * (i % 200), {live: true});
      await new Promise((done) => requestAnimationFrame(done));
    }
    return counts;
  }, scene.camera.azimuth_deg);
  for (const [scale, count] of Object.entries(rates)) console.log(`page, the camera turned: ${(count / 4).toFixed(1)} frames a second, every ${scale}`);
  await page.context().close();
  await server.stop();
}

const browser = await launch();
const server = await serve(dome);
await answers(server);
const page = await open(browser, server.address);
await idle(page);
await slider(page);
await page.context().close();
for (const [name, scene] of Object.entries(liveScenes())) await live(browser, name, scene);
await memory(server);
await browser.close();
await server.stop();
agent.destroy();
