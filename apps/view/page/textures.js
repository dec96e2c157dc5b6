// Pictures from the user's disk as textures: dropped on the object's panel or on the object in the picture, or chosen.

import {pixelRecords} from "./plot.js";
import {make} from "./widgets.js";
import {pointerTo} from "./look_patch.js";
import {newSpectrum} from "./spectrum_fields.js";

/** `app.textures.pick(pointer, type)` asks for a file; `use(pointer, file, type)` uploads it and puts it there. */
export function setup(app) {
  app.textures = {
    pick: (pointer, type = "image") => pick(app, pointer, type),
    use: (pointer, file, type = "image") => use(app, pointer, file, type),
  };
  const current = () => (app.selected === null ? null : pointerTo("objects", app.selected));
  dropTarget(document.getElementById("panel-objects"), async () => current());
  dropTarget(app.picture.element, async (event) => {
    const name = await objectAt(app, app.picture.at(event.clientX, event.clientY));
    if (name === null) app.say("There is no object at that place.", {error: true});
    else app.select(name);
    return name === null ? null : pointerTo("objects", name);
  });
  // Beside the mark a file would replace the page.
  for (const name of ["dragover", "drop"])
    document.addEventListener(name, (event) => event.dataTransfer?.types.includes("Files") && event.preventDefault());

  /** @param {HTMLElement} element @param {function(DragEvent): Promise<?string>} target of the file: pointer of an object */
  function dropTarget(element, target) {
    if (!element) return;
    const carries = (event) => event.dataTransfer?.types.includes("Files");
    element.addEventListener("dragover", (event) => carries(event) && element.classList.add("drop"));
    element.addEventListener(
      "dragleave",
      (event) => element.contains(event.relatedTarget) || element.classList.remove("drop"),
    );
    element.addEventListener("drop", async (event) => {
      element.classList.remove("drop");
      const [file] = event.dataTransfer?.files ?? [];
      if (!file) return;
      event.preventDefault();
      const pointer = await target(event).catch((error) => app.say(error.message, {error: true}));
      if (pointer) await use(app, pointer, file);
    });
  }
}

/** Name of the object that is seen at a pixel of the canvas, null where there is none. */
export async function objectAt(app, {x, y, inside = true}) {
  if (!inside) return null;
  const answer = await pixelRecords(app, x, y);
  return answer.hits?.[0]?.object ?? null;
}

function pick(app, pointer, type) {
  const input = make("input", {type: "file", accept: "image/*,.exr,.hdr,.tif,.tiff"});
  input.addEventListener("change", () => input.files[0] && use(app, pointer, input.files[0], type));
  input.click();
}

/** Materials go with a spectrum of theirs, and without it. */
export function putTexture({store}, pointer, texture) {
  const before = store.get(`${pointer}/spectrum/type`) === "materials",
    after = texture?.type === "materials";
  store.set(`${pointer}/texture`, texture, {live: true});
  if (before !== after) store.set(`${pointer}/spectrum`, after ? newSpectrum("materials") : undefined, {live: true});
  store.commit();
}

async function use(app, pointer, file, type = "image") {
  const most = app.state.limits?.upload_bytes ?? Infinity;
  if (file.size > most)
    return app.say(`${file.name} has ${file.size} bytes; at most ${most} are taken.`, {error: true});
  app.say(`Sending ${file.name}…`);
  try {
    const got = await app.api.upload(file);
    const before = app.store.get(`${pointer}/texture`) ?? {};
    const {offset, scale, rotate_deg, filter} = before;
    const kept = before.type === type ? {offset, scale, rotate_deg, filter} : {};
    const texture = Object.fromEntries(
      Object.entries({type, file: got.file, ...kept}).filter(([, value]) => value !== undefined),
    );
    putTexture(app, pointer, texture);
    app.say(`${got.file}: ${got.width} × ${got.height} pixels, now on ${pointer.split("/").at(-1)}.`);
  } catch (error) {
    app.say(`${file.name}: ${error.message}`, {error: true});
  }
}
