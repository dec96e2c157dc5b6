// The look and its history. Looks are plain documents that are never changed: each step is a new one, which shares
// with the last what is the same.

import {changed, difference, find, merged, same, settings} from "./look_patch.js";

export {difference, merged, settings};

const kLongest = 500; // steps of history

/**
 * Events: "change" {pointer, live} when the look is another one, "history" when a step was made or undone, "full" when
 * the server has filled it in, "fault" {message} when the server refuses it, "base" when there is another look to begin
 * with.
 */
export class Store extends EventTarget {
  #history;
  #at = 0;
  #look;

  constructor(base) {
    super();
    this.base = base;
    this.full = {}; // with all defaults, of the last look that is right
    this.words = {}; // what texts may be, by pointer
    this.keys = {}; // what objects may hold, by pointer
    this.#look = base;
    this.#history = [base];
  }

  get look() {
    return this.#look;
  }

  /** What holds at `pointer`: of the look, or else by default. */
  get(pointer) {
    return find(this.#look, pointer) ?? find(this.full, pointer);
  }

  /**
   * undefined removes the entry. `live`: while something is dragged; all until commit() is one step of history.
   * @param {string} pointer @param {*} value @param {{live?: boolean}} [how]
   */
  set(pointer, value, {live = false} = {}) {
    this.#put(changed(this.#look, pointer, value), {pointer, live});
    if (!live) this.commit();
  }

  /** @param {object} look @param {{live?: boolean}} [how] */
  replace(look, {live = false} = {}) {
    this.#put(look, {pointer: "", live});
    if (!live) this.commit();
  }

  /** Ends a drag. */
  commit() {
    const before = this.#history[this.#at];
    if (before !== this.#look && !same(before, this.#look)) {
      this.#history.splice(this.#at + 1);
      this.#history.push(this.#look);
      if (this.#history.length > kLongest) this.#history.shift();
      this.#at = this.#history.length - 1;
    }
    this.#tell("history");
  }

  get canUndo() {
    return this.#at > 0;
  }
  get canRedo() {
    return this.#at + 1 < this.#history.length;
  }
  undo() {
    if (!same(this.#look, this.#history[this.#at])) this.commit();
    this.#go(this.#at - 1);
  }
  redo() {
    this.#go(this.#at + 1);
  }

  /** As it was to begin with. */
  reset(pointer) {
    this.set(pointer, find(this.base, pointer));
  }
  /** Whether it is no longer as it was to begin with. */
  differs(pointer) {
    return !same(find(this.#look, pointer), find(this.base, pointer));
  }

  /** Another look to begin with; with `look` another look, and a new history. */
  rebase(base, look) {
    this.base = base;
    if (look !== undefined) {
      this.#history = [look];
      this.#at = 0;
      this.full = {};
      this.#put(look, {pointer: "", live: false});
    }
    this.#tell("base");
    if (look !== undefined) this.#tell("history");
  }

  /** @param {{full: object, words: object, keys: object}} answer of api/look */
  fill({full, words = {}, keys = {}}) {
    Object.assign(this, {full, words, keys});
    this.#tell("full");
  }

  #put(look, detail) {
    this.#look = look;
    this.#tell("change", detail);
  }
  #go(place) {
    if (place < 0 || place >= this.#history.length) return;
    this.#at = place;
    this.#put(this.#history[place], {pointer: "", live: false});
    this.#tell("history");
  }
  #tell(name, detail = {}) {
    this.dispatchEvent(new CustomEvent(name, {detail}));
  }
}
