// Keeps the look in full up to date, and puts the server's complaints beside the controls that they are about.

import {ApiError, isLost} from "./api.js";

/** Asks api/look after each change that is not part of a drag; the last answer counts. */
export function fill(app) {
  const {store} = app;
  let last = 0,
    asked = false,
    unanswered = false;
  const ask = async () => {
    asked = false;
    const number = ++last;
    const {data, frame} = app.view;
    try {
      const answer = await app.api.json("api/look", {query: {data, frame}, body: store.look});
      if (number !== last) return;
      unanswered = false;
      clear(app);
      store.fill(answer);
    } catch (error) {
      if (number !== last) return;
      if (!(error instanceof ApiError)) throw error;
      unanswered = isLost(error);
      complain(app, error.message, "look");
    }
  };
  const soon = () => {
    if (!asked) queueMicrotask(ask);
    asked = true;
  };
  store.addEventListener("history", soon);
  app.addEventListener("view", soon);
  app.frames.addEventListener("fault", ({detail}) => complain(app, detail.error.message, "frame"));
  app.frames.addEventListener("shown", () => {
    if (app.fault === "frame") clear(app);
    if (unanswered) soon();
  });
  soon();
}

function clear(app) {
  if (!app.fault) return;
  app.fault = null;
  app.say("");
  for (const control of document.querySelectorAll("[data-pointer]")) control.fault?.("");
}

/** On the status line, and where the control is that it is about. */
function complain(app, message, source) {
  app.fault = source;
  app.say(message, {error: true});
  const places = [...message.matchAll(/(?:^|[\s:'])((?:\/[\w~.-]+)+)/g)].map(([, place]) => place);
  places.map(nearest).find(Boolean)?.fault(message);
  app.store.dispatchEvent(new CustomEvent("fault", {detail: {message}}));
}

/** The control of `place`, or of what is around it, or of something in it. */
function nearest(place) {
  const controls = [...document.querySelectorAll("[data-pointer]")].filter((control) => control.fault);
  const within = (inner, outer) => inner === outer || inner.startsWith(`${outer}/`);
  const around = controls.filter(({dataset}) => within(place, dataset.pointer));
  const longest = around.reduce((a, b) => (b.dataset.pointer.length > (a?.dataset.pointer.length ?? 0) ? b : a), null);
  return longest ?? controls.find(({dataset}) => within(dataset.pointer, place));
}
