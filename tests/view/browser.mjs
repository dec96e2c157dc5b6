// A dataset, nullcone-view and a headless Chromium for tests of the page.
import {execFileSync, spawn} from "node:child_process";
import {mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join, resolve} from "node:path";
import {fileURLToPath} from "node:url";
import {chromium} from "playwright-core";

export const source = fileURLToPath(new URL("../..", import.meta.url));
export const tools = resolve(process.env.NULLCONE_TOOLS ?? join(source, "build/release/bin"));
const pictures = process.env.NULLCONE_SCREENSHOTS;  // a folder, to look at

/** Runs a tool of Nullcone; its standard output. */
export const tool = (name, ...args) => execFileSync(join(tools, `nullcone-${name}`), args, {encoding: "utf8", maxBuffer: 1e9});

/** The scene of a file in scenes/, with other entries at its top. */
export function sceneOf(file, changes = {}) {
  const scene = JSON.parse(readFileSync(join(source, "scenes", file), "utf8"));
  for (const [key, value] of Object.entries(changes))
    scene[key] = value !== null && typeof value === "object" && !Array.isArray(value) ? {...scene[key], ...value} : value;
  return scene;
}

const running = new Set();
/** Ends what failed tests have left. */
export const stopAll = () => Promise.all([...running].map((stop) => stop()));

/** A folder with a traced scene and a server of it; `stop()` ends both. */
export async function serve(scenes, ...options) {
  const folder = mkdtempSync(join(tmpdir(), "nullcone-page-"));
  mkdirSync(join(folder, "tmp"));
  const data = [scenes].flat().map((scene, i) => {
    writeFileSync(join(folder, "scene.json"), JSON.stringify(scene));
    const path = join(folder, `data_${String(i).padStart(4, "0")}.exr`);
    tool("trace", join(folder, "scene.json"), "-o", path, "-q");
    return path;
  });
  const server = spawn(join(tools, "nullcone-view"), [...data, ...options], {cwd: folder, env: {...process.env, TMPDIR: join(folder, "tmp")}});
  server.stderr.on("data", text => process.stderr.write(text));
  const address = await new Promise((done, fail) => {
    server.stdout.once("data", text => done(String(text).trim()));
    server.once("exit", () => fail(new Error("nullcone-view ended")));
  });
  const stop = async () => {
    running.delete(stop);
    const ended = new Promise(done => server.once("exit", done));
    server.kill("SIGINT");
    await ended;
    rmSync(folder, {recursive: true, force: true});
  };
  running.add(stop);
  return {folder, data, address, pid: server.pid, stop};
}

export async function launch() {
  const quiet = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync"];
  return chromium.launch({executablePath: "/usr/bin/chromium", args: quiet});
}

/** A page that fails the test for whatever it complains of. */
export async function open(browser, address, options = {}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 720}, acceptDownloads: true, ...options});
  const page = await context.newPage();
  page.faults = [];
  page.on("pageerror", error => page.faults.push(String(error)));
  page.on("console", message => message.type() === "error" && page.faults.push(message.text()));
  page.on("request", request => {
    if (!request.url().startsWith(new URL(address).origin) && !/^(blob|data):/.test(request.url())) page.faults.push(`asked ${request.url()}`);
  });
  await page.goto(address);
  await idle(page);
  return page;
}

/** Waits until the picture is up to date. */
export async function idle(page) {
  await page.waitForFunction(() => window.nullcone?.frames, null, {timeout: 30000});
  await page.evaluate(() => window.nullcone.frames.idle());
}

/** The canvas: {width, height, rgb}. */
export async function shown(page) {
  const {width, height, text} = await page.evaluate(() => {
    const canvas = document.getElementById("picture");
    const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let text = "";
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
    return {width: canvas.width, height: canvas.height, text: btoa(text)};
  });
  return {width, height, rgb: Buffer.from(text, "base64")};
}

/** The same of a picture that nullcone-postrender makes of a look, or of the given arguments. */
export async function developed(page, folder, args) {
  const file = join(folder, "expected.png");
  tool("postrender", ...args, "-o", file, "-q");
  const url = `data:image/png;base64,${readFileSync(file).toString("base64")}`;
  const {width, height, text} = await page.evaluate(async url => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const bitmap = await createImageBitmap(image, {colorSpaceConversion: "none", premultiplyAlpha: "none"});
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height), context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const {data} = context.getImageData(0, 0, bitmap.width, bitmap.height);
    let text = "";
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
    return {width: bitmap.width, height: bitmap.height, text: btoa(text)};
  }, url);
  return {width, height, rgb: Buffer.from(text, "base64")};
}

/** How many bytes differ. */
export function difference(a, b) {
  if (a.width !== b.width || a.height !== b.height) return Infinity;
  let count = 0;
  for (let i = 0; i < a.rgb.length; ++i) count += a.rgb[i] !== b.rgb[i];
  return count;
}

/** The look as the page has it, in a file. */
export async function lookFile(page, folder) {
  const file = join(folder, "look.json");
  writeFileSync(file, JSON.stringify(await page.evaluate(() => window.nullcone.store.look)));
  return file;
}

export async function screenshot(page, name) {
  if (pictures) await page.screenshot({path: join(pictures, `${name}.png`)});
}
