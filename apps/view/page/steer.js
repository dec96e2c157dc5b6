// Steering a moving observer in proper time, where space is flat: part of the panel "Move".

import * as drive from "./drive.js";
import {html, text} from "./plot.js";
import {angles, fromAngles} from "./scene_numbers.js";
import {numberControl} from "./widgets.js";

const kKeys = new Set(["w", "s", "a", "d", "q", "e", "r", "f", " "]);
const kButtons = [["w", "Accelerate"], ["s", "Backwards"], ["a", "Turn left"], ["d", "Turn right"], ["q", "Thrust left"], ["e", "Thrust right"], [" ", "Brake"]];
const kLongest = 0.1; // s a step: where the page was asleep nothing happens

export function setup(app) {
  let steering = null;
  const begin = () => {
    steering?.end();
    steering = app.live?.metric === "minkowski" ? new Steering(app, app.live) : null;
  };
  app.addEventListener("live", begin);
  app.keys?.add(["Q", "E"], "steering: thrust to the left and right; W and S accelerate, A and D turn, Space brakes");
  begin();
}

class Steering {
  #app;
  #live;
  #held = new Set();
  #driving = false;
  #state = null;
  #before = 0;
  #own = 0;
  #street = 0;
  #settings;
  #drive = html("button", {type: "button", "aria-pressed": "false"}, "Steer");
  #level = html("input", {type: "checkbox", checked: true});
  #cells = {};
  #undo = [];

  constructor(app, live) {
    this.#app = app;
    this.#live = live;
    const far = live.hand.pace * 5;
    this.#settings = {c: tidy(far / 10), acceleration: tidy(far / 20)};
    live.place.replaceChildren(this.#panel());
    this.#drive.addEventListener("click", () => (this.#driving ? this.#pause() : this.#begin()));
    this.#on(document, "keydown", (event) => this.#down(event), true);
    this.#on(window, "keyup", (event) => this.#held.delete(event.key.toLowerCase()));
    this.#on(window, "blur", () => this.#held.clear());
    this.#on(app, "view", () => this.#driving && app.view.data !== "live" && live.on === false && this.#pause());
    this.#show(drive.begin(live.scene.look.observer, angles(live.scene.look.camera)));
  }

  #on(target, name, listener, capture = false) {
    target.addEventListener(name, listener, capture);
    this.#undo.push(() => target.removeEventListener(name, listener, capture));
  }
  end() {
    this.#pause();
    for (const undo of this.#undo) undo();
  }

  #panel() {
    const number = (key, label, unit) => {
      const first = this.#settings[key];
      const control = numberControl({label, unit, value: first, min: first / 100, max: first * 100, least: 1e-9, most: 3e8, scale: "log", digits: 4,
        reset: () => take(first), onInput: (x) => take(x)});
      const take = (x) => {
        control.value = this.#settings[key] = x;
        control.changed?.(x !== first);
      };
      take(first);
      return control;
    };
    const row = (key, name) => html("tr", {}, html("th", {scope: "row"}, name), (this.#cells[key] = html("td", {}, "")));
    const buttons = kButtons.map(([key, label]) => this.#button(key, label));
    return html("fieldset", {class: "steer"}, html("legend", {}, "Steering by the own clock"),
      html("div", {class: "row"}, this.#drive, html("label", {}, this.#level, " stay at this height")),
      html("p", {class: "hint"}, "W and S accelerate along the view, A and D turn, Q and E thrust aside, Space brakes to rest."),
      html("div", {class: "steer-keys", role: "group", "aria-label": "steering"}, ...buttons),
      number("c", "Speed of light", "1/s"), number("acceleration", "Acceleration", "1/s²"),
      html("table", {class: "records steer-readings"}, html("caption", {class: "hidden"}, "instruments"), html("tbody", {},
        row("beta", "speed β"), row("gamma", "γ"), row("own", "own clock"), row("street", "the street's clock"), row("ahead", "g ahead"))));
  }

  /** Held with finger, mouse, Space or Enter. */
  #button(key, label) {
    const release = () => this.#held.delete(key);
    const hold = (event) => {
      if (!this.#driving) this.#begin();
      this.#held.add(key);
      event.preventDefault();
    };
    const held = (event) => (event.key === " " || event.key === "Enter");
    return html("button", {type: "button", onpointerdown: hold, onpointerup: release, onpointerleave: release, onpointercancel: release,
      onblur: release, onkeydown: (event) => held(event) && hold(event), onkeyup: (event) => held(event) && release()}, label);
  }

  #down(event) {
    const key = event.key.toLowerCase();
    if (!this.#driving || !kKeys.has(key) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.closest("input:not([type=checkbox]), textarea, select")) return;
    if (key === " " && event.target.closest("button, summary, input")) return;
    event.preventDefault();
    event.stopPropagation();
    this.#held.add(key);
  }

  #begin() {
    const {scene} = this.#live;
    this.#driving = this.#live.steering = true;
    this.#live.begin();
    this.#state = {...drive.begin(scene.look.observer, angles(scene.look.camera)), own: this.#own, street: this.#street};
    this.#drive.textContent = "Pause";
    this.#drive.setAttribute("aria-pressed", "true");
    this.#app.picture.element.focus({preventScroll: true});
    this.#before = performance.now();
    requestAnimationFrame(() => this.#step());
  }

  #pause() {
    if (!this.#driving) return;
    this.#driving = this.#live.steering = this.#live.moving = false;
    this.#held.clear();
    this.#drive.textContent = "Steer";
    this.#drive.setAttribute("aria-pressed", "false");
    this.#live.scene.commit();
  }

  #step() {
    if (!this.#driving) return;
    const now = performance.now(), seconds = Math.min((now - this.#before) / 1000, kLongest);
    this.#before = now;
    const turned = angles(this.#live.scene.look.camera); // a drag may look round meanwhile
    this.#state = drive.advance({...this.#state, angles: turned}, this.#held, seconds, {...this.#settings, level: this.#level.checked});
    this.#own = this.#state.own;
    this.#street = this.#state.street;
    this.#write();
    this.#show(this.#state);
    requestAnimationFrame(() => this.#step());
  }

  /** Who rests among what rests sees the same again: then the picture becomes fine. */
  #write() {
    const {scene} = this.#live, {observer, angles: turned} = drive.asScene(this.#state);
    const pressed = [...this.#held].some((key) => key !== " ");
    if (!pressed && this.#state.u[0] === 1 && !this.#movers) return this.#rest();
    this.#live.moving = true;
    scene.replace({...scene.look, observer, camera: {...scene.look.camera, ...fromAngles(turned)}}, {live: true});
  }

  #rest() {
    if (!this.#live.moving) return;
    this.#live.moving = false;
    this.#live.scene.commit();
  }

  get #movers() {
    return Object.values(this.#live.scene.look.objects).some(({velocity}) => velocity?.some((x) => x !== 0));
  }

  #show(state) {
    const {beta, gamma, own, street, ahead} = drive.readings(state);
    const set = (key, words) => (this.#cells[key].textContent = words);
    set("beta", beta < 0.99 ? beta.toFixed(4) : beta.toFixed(8));
    set("gamma", text(gamma, 5));
    set("own", `${own.toFixed(2)} s`);
    set("street", `${street.toFixed(2)} s`);
    set("ahead", text(ahead, 4));
  }
}

const tidy = (x) => Number(x.toPrecision(2));
