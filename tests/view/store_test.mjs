// The look's history, and looks as patches, addresses and command lines.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import test from "node:test";

import {Store, difference, merged, settings} from "../../apps/view/page/store.js";
import {changed, find, pointerTo, steps} from "../../apps/view/page/look_patch.js";
import {packed, readFragment, unpacked, writeFragment} from "../../apps/view/page/fragment.js";
import {commandLine, filesOf, quoted} from "../../apps/view/page/shell.js";
import {fromNotch, notches, nudged, numberText, toNotch, typedNumber} from "../../apps/view/page/number_scale.js";

const kBase = {
  objects: {
    earth: {
      texture: {type: "image", file: "maps/earth.jpg"},
      spectrum: {type: "gaussian", centre_nm: 550, fwhm_nm: 40},
    },
    moon: {opacity: 0.5},
  },
  exposure: {white_cd_m2: "auto"},
  tone: {curve: "exponential", k: 2},
};
const kLook = {
  objects: {
    earth: {texture: {type: "color", rgb: [1, 0, 0.25]}, spectrum: {type: "black_body", temperature_K: 5800}},
    moon: {opacity: 0.5, blink: {channel: "tau", period: 2}},
  },
  exposure: {white_cd_m2: {auto: "percentile", percentile: 90}, ev: -1.5},
  gamut: "clip",
};

test("a pointer's steps are escaped as RFC 6901 has it", () => {
  assert.deepEqual(steps("/a~1b/m~0n/~01"), ["a/b", "m~n", "~1"]);
  assert.equal(pointerTo("a/b", "m~n", "~1"), "/a~1b/m~0n/~01");
  assert.equal(find({a: [{b: 7}]}, "/a/0/b"), 7);
  assert.equal(find({}, "/toString"), undefined);
});

test("changed() leaves the document alone and makes the way", () => {
  const before = structuredClone(kBase);
  assert.deepEqual(changed(kBase, "/lights/sun/on", false).lights, {sun: {on: false}});
  assert.deepEqual(changed(kBase, "/tone/k", undefined).tone, {curve: "exponential"});
  assert.deepEqual(
    changed(
      {
        a: [
          [1, 2],
          [3, 4],
        ],
      },
      "/a/1",
      [5, 6],
    ),
    {
      a: [
        [1, 2],
        [5, 6],
      ],
    },
  );
  assert.equal(changed(kBase, "/tone/k", 3).objects, kBase.objects);
  assert.deepEqual(kBase, before);
});

test("merge patches: the examples of RFC 7386, appendix A", () => {
  const kExamples = [
    [{a: "b"}, {a: "c"}, {a: "c"}],
    [{a: "b"}, {b: "c"}, {a: "b", b: "c"}],
    [{a: "b"}, {a: null}, {}],
    [{a: "b", b: "c"}, {a: null}, {b: "c"}],
    [{a: ["b"]}, {a: "c"}, {a: "c"}],
    [{a: "c"}, {a: ["b"]}, {a: ["b"]}],
    [{a: {b: "c"}}, {a: {b: "d", c: null}}, {a: {b: "d"}}],
    [{a: [{b: "c"}]}, {a: [1]}, {a: [1]}],
    [
      ["a", "b"],
      ["c", "d"],
      ["c", "d"],
    ],
    [{a: "b"}, ["c"], ["c"]],
    [{a: "foo"}, null, null],
    [{a: "foo"}, "bar", "bar"],
    [{e: null}, {a: 1}, {e: null, a: 1}],
    [[1, 2], {a: "b", c: null}, {a: "b"}],
    [{}, {a: {bb: {ccc: null}}}, {a: {bb: {}}}],
  ];
  for (const [document, patch, result] of kExamples) assert.deepEqual(merged(document, patch), result);
});

test("a difference makes the look of the base, and says only what differs", () => {
  const patch = difference(kBase, kLook);
  assert.deepEqual(merged(kBase, patch), kLook);
  assert.deepEqual(patch.objects.earth.spectrum, {
    type: "black_body",
    temperature_K: 5800,
    centre_nm: null,
    fwhm_nm: null,
  });
  assert.equal(patch.tone, null);
  assert.ok(!("opacity" in patch.objects.moon));
  assert.deepEqual(difference(kBase, structuredClone(kBase)), {});
  const odd = JSON.parse('{"__proto__": {"a": 1}}');
  assert.equal(JSON.stringify(merged({}, difference({}, odd))), JSON.stringify(odd));
  assert.equal({}.a, undefined);
});

/** As nullcone-postrender reads --set: JSON or else text, merged at the path. */
function set(document, setting) {
  const [, path, text] = /^([^=]*)=(.*)$/s.exec(setting);
  const keys = path.includes("/") ? steps(path) : path.split(".");
  let value = text;
  try {
    value = JSON.parse(text);
  } catch {}
  return merged(
    document,
    keys.reduceRight((inner, key) => ({[key]: inner}), value),
  );
}

test("settings make the look of the base", () => {
  const list = settings(kBase, kLook);
  assert.deepEqual(list.reduce(set, kBase), kLook);
  assert.ok(list.includes("objects.earth.spectrum.temperature_K=5800"));
  assert.ok(list.includes("objects.earth.spectrum.centre_nm=null"));
  assert.ok(list.includes("tone=null"));
  assert.ok(list.includes("gamut=clip"));
  assert.deepEqual(settings(kLook, kLook), []);
  // Texts that could be read as something else; names with the signs of paths.
  const odd = {"a.b": {"c/d": "12"}, file: "true", e: "null", f: "x"};
  assert.deepEqual(settings({}, odd).reduce(set, {}), odd);
  assert.deepEqual(settings({}, {file: "12"}), ['file="12"']);
});

test("history: what is dragged is one step", () => {
  const store = new Store(kBase);
  for (const kelvin of [1000, 2000, 3000]) store.set("/objects/earth/spectrum/temperature_K", kelvin, {live: true});
  assert.equal(store.canUndo, false);
  store.commit();
  store.set("/gamut", "clip");
  assert.equal(store.get("/objects/earth/spectrum/temperature_K"), 3000);
  store.undo();
  assert.equal(store.get("/gamut"), undefined);
  store.undo();
  assert.equal(store.look, kBase);
  assert.equal(store.canUndo, false);
  store.undo();
  store.redo();
  store.redo();
  assert.equal(store.get("/gamut"), "clip");
  store.undo();
  store.set("/gamut", "hue_preserving");
  assert.equal(store.canRedo, false);
  store.undo();
  assert.equal(store.get("/gamut"), undefined, "what was undone and written over is gone");
});

test("history: undo in the middle of a drag goes to before it, and nothing is a step", () => {
  const store = new Store(kBase);
  store.set("/tone/k", 5, {live: true});
  store.undo();
  assert.deepEqual(store.look, kBase);
  store.redo();
  assert.equal(store.get("/tone/k"), 5);
  store.undo();
  store.set("/tone/k", 2);
  assert.equal(store.canUndo, false);
});

test("what holds is the look's, else the default; reset goes back to the base", () => {
  const store = new Store(kBase);
  const heard = [];
  for (const name of ["change", "history", "full"])
    store.addEventListener(name, ({detail}) => heard.push([name, detail.live]));
  store.fill({full: {...kBase, gamut: "hue_preserving", tone: {curve: "exponential", k: 2}}});
  assert.equal(store.get("/gamut"), "hue_preserving");
  store.set("/tone/k", 7);
  assert.ok(store.differs("/tone/k"));
  store.reset("/tone/k");
  assert.equal(store.get("/tone/k"), 2);
  store.set("/gamut", "clip");
  store.reset("/gamut");
  assert.deepEqual(store.look, kBase);
  assert.deepEqual(heard[0], ["full", undefined]);
  assert.deepEqual(heard[1], ["change", false]);
  store.set("/tone/k", 1, {live: true});
  assert.deepEqual(heard.at(-1), ["change", true]);
});

test("addresses: a look there and back", async () => {
  const patch = difference(kBase, kLook);
  const text = await packed(patch);
  assert.match(text, /^[\w-]+$/);
  assert.deepEqual(await unpacked(text), patch);
  const fragment = await writeFragment({patch, data: 2, frame: 17});
  assert.deepEqual(await readFragment(fragment), {patch, data: 2, frame: 17});
  assert.equal(await writeFragment({patch: {}, data: 0, frame: 0}), "");
  assert.deepEqual(await readFragment(""), {data: undefined, frame: undefined});
  // {"gamut":"clip"}, by another program (Python's zlib, raw deflate).
  assert.deepEqual(await unpacked("q1ZKT8wtLVGyUkrOySxQqgUA"), {gamut: "clip"});
  const much = {e: Array.from({length: 20000}, (_, i) => Math.sin(i))};
  assert.deepEqual(await unpacked(await packed(much)), much);
});

test("addresses: damage is refused", async () => {
  await assert.rejects(readFragment("#look=AAAA"));
  await assert.rejects(readFragment("#look=%%%"));
  assert.deepEqual(await readFragment("#data=-1&frame=x"), {data: undefined, frame: undefined});
});

test("words of a shell come back as they were", () => {
  const kWords = [
    "plain",
    "a b",
    "it's",
    '$HOME `id` "x" \\',
    "",
    "new\nline",
    "=x",
    "~",
    "*",
    "x=[1,2]",
    "!",
    "é",
    "#",
    "-o",
    "{a,b}",
  ];
  for (const word of kWords) {
    const got = spawnSync("/bin/sh", ["-c", `printf %s ${quoted(word)}`], {encoding: "utf8"});
    assert.equal(got.stdout, word);
  }
  assert.equal(quoted("objects.earth.opacity=0.5"), "objects.earth.opacity=0.5");
});

test("the command line", () => {
  const what = {
    path: "out/my earth.exr",
    lookFile: "a.json",
    given: ["gamut=clip"],
    base: kBase,
    look: {...kBase, background: [0, 0, 1]},
    frame: 3,
  };
  assert.equal(
    commandLine(what),
    "nullcone-postrender 'out/my earth.exr' --look a.json --set gamut=clip --set 'background=[0,0,1]' --frame 3 -o picture.png",
  );
  assert.equal(commandLine({path: "-x.exr", base: {}, look: {}}), "nullcone-postrender ./-x.exr -o picture.png");
  assert.deepEqual(filesOf(kBase), ["maps/earth.jpg"]);
  assert.deepEqual(filesOf({sensor: {file: "a"}, o: [{file: "b"}, {file: "a"}]}), ["a", "b"]);
});

test("numbers as text and on sliders", () => {
  const kelvin = {min: 500, max: 50000, scale: "log"};
  assert.equal(toNotch(500, kelvin), 0);
  assert.equal(toNotch(50000, kelvin), notches(kelvin));
  assert.equal(toNotch(5000, kelvin), notches(kelvin) / 2);
  assert.equal(fromNotch(notches(kelvin) / 2, kelvin), 5000);
  assert.equal(toNotch(1e9, kelvin), notches(kelvin));
  assert.equal(toNotch(0, kelvin), 0);
  const share = {min: -1, max: 1, step: 0.005};
  for (let notch = 0; notch <= notches(share); ++notch) assert.equal(toNotch(fromNotch(notch, share), share), notch);
  assert.equal(fromNotch(300, share), 0.5);
  assert.equal(nudged(0.1, 2, {min: 0, max: 1, step: 0.1}), 0.3);
  assert.equal(nudged(5000, 1, kelvin), 5050);
  assert.equal(numberText(3.1e9), "3.1e9");
  assert.equal(numberText(0.1 + 0.2), "0.3");
  assert.equal(numberText(0), "0");
  assert.equal(typedNumber(" 6 500 "), 6500);
  assert.equal(typedNumber("2,5"), 2.5);
  assert.equal(typedNumber("−3e4"), -3e4);
  assert.ok(Number.isNaN(typedNumber("")) && Number.isNaN(typedNumber("5k")));
});
