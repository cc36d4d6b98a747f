// The page in a notebook, joined with the kernel: a module for anywidget. It is not part of pages.
//
// A view is an output with a frame, which stays when there is no kernel. Here the frames of a view are found, and
// what pages show is kept equal to the traits of _browser_view.py. Why from outside: pages stay what they are.

/** @typedef {import('./app.js').App} App */
/** @typedef {import('./vectors.js').Vector} Vector */
/** @typedef {[Vector, Vector, Vector, number]} Seen eye, target, upwards (µm), vertical angle of view (radians) */
/** @typedef {{ get(name: string): any, set(name: string, value: any): void, save_changes(): void, send(message: any): void, on(event: string, act: (...given: any[]) => void): void, off(event: string, act: (...given: any[]) => void): void }} Model */

/** Traits that views and pages share. */
const SHARED = ['_camera', 'color_by', 'hidden', 'orthographic', 'time'];
/** Schemes that are called otherwise in Python. @type {Record<string, string>} */
const IN_PYTHON = { distance: 'depth' };
/** Milliseconds between two questions whether a page is there. */
const PATIENCE = 50;

/** @param {any} a @param {any} b @returns {boolean} whether they are equal, numbers but for rounding */
function same(a, b) {
  if (typeof a === 'number' && typeof b === 'number') return Math.abs(a - b) <= 1e-9 * (1 + Math.abs(a));
  if (!Array.isArray(a) || !Array.isArray(b)) return a === b;
  return a.length === b.length && a.every((one, k) => same(one, b[k]));
}

/** Lets a camera lean, which in pages alone it does not. @param {App} app @returns {(angle: number) => void} */
function leaning(app) {
  const { camera } = app, { axes, fit, turn } = camera;
  let lean = 0;
  camera.axes = () => {
    const { right, up, backward } = axes.call(camera), [c, s] = [Math.cos(lean), Math.sin(lean)];
    const mixed = (/** @type {number} */ a, /** @type {number} */ b) => /** @type {Vector} */ (right.map((x, k) => a * x + b * up[k]));
    return { right: mixed(c, -s), up: mixed(s, c), backward };
  };
  camera.turn = (x, y) => turn.call(camera, x * Math.cos(lean) - y * Math.sin(lean), x * Math.sin(lean) + y * Math.cos(lean));
  // The buttons of the page give upright pictures.
  camera.fit = (...given) => {
    lean = 0;
    fit.apply(camera, given);
  };
  return (angle) => { lean = angle; };
}

/** A page, by the names of the view's traits. */
class Page {
  /** @param {Window} inner of the frame @param {App} app */
  constructor(inner, app) {
    this.inner = inner;
    this.app = app;
    this.lean = leaning(app);
  }

  /** @param {string} id @returns {HTMLInputElement} */
  input(id) {
    return /** @type {HTMLInputElement} */ (this.inner.document.getElementById(id));
  }

  /** Sets an input, as a reader does. @param {string} id @param {'value' | 'checked'} name @param {any} value */
  enter(id, name, value) {
    const input = /** @type {any} */ (this.input(id));
    input[name] = value;
    input.dispatchEvent(new Event('input'));
  }

  /** @returns {Record<string, any>} */
  get() {
    const { app, app: { camera, colors } } = this, { up } = camera.axes(), { id } = colors.scheme;
    const hidden = colors.isScale() ? new Set() : colors.hiddenNow();
    return {
      _camera: [camera.eye(), [...camera.target], up, 2 * Math.atan(camera.tan)],
      color_by: IN_PYTHON[id] ?? id,
      hidden: colors.entries().filter(({ index }) => hidden.has(index)).map(({ name }) => name),
      orthographic: app.checked('orthographic'),
      time: app.scene.data.recording?.times[colors.frame] ?? null,
    };
  }

  /** Sets what is another: colors first, since each has hidden entries of its own. @param {Record<string, any>} wanted */
  set(wanted) {
    const { app, app: { colors } } = this;
    const differs = (/** @type {string} */ name) => wanted[name] !== null && !same(wanted[name], this.get()[name]);
    if (differs('color_by')) {
      const id = Object.keys(IN_PYTHON).find((id) => IN_PYTHON[id] === wanted.color_by);
      this.enter('scheme', 'value', id ?? wanted.color_by);
    }
    if (differs('hidden')) {
      const hidden = colors.hiddenNow();
      hidden.clear();
      for (const { name, index } of colors.entries()) if (wanted.hidden.includes(name)) hidden.add(index);
      app.recolor();
    }
    if (differs('orthographic')) this.enter('orthographic', 'checked', wanted.orthographic);
    if (differs('time')) this.enter('frame', 'value', app.scene.data.recording.times.findIndex((/** @type {number} */ time) => same(time, wanted.time)));
    if (differs('_camera')) this.look(wanted._camera);
  }

  /** @param {Seen} seen */
  look([eye, target, upwards, fov]) {
    const { app, app: { camera } } = this, back = eye.map((x, k) => x - target[k]);
    camera.distance = Math.hypot(...back);
    camera.target = [...target];
    camera.tan = Math.tan(fov / 2);
    this.lean(0);
    [camera.yaw, camera.pitch] = [Math.atan2(back[0], back[2]), 0];
    camera.turn(0, Math.asin(back[1] / camera.distance));
    const { right, up } = camera.axes(), along = (/** @type {Vector} */ axis) => axis.reduce((sum, x, k) => sum + x * upwards[k], 0);
    this.lean(Math.atan2(along(right), along(up)));
    app.loop?.change();
  }

  /** Calls back when the page has come to rest, and with what is clicked. @param {() => void} rested @param {(picked: any) => void} picked */
  listen(rested, picked) {
    const { app } = this, { draw, click, pick } = app;
    app.draw = (how) => {
      draw.call(app, how);
      if (!how.draft && !how.step) rested();
    };
    app.click = async (x, y) => {
      // What is asked for once the page asks for, too.
      const found = pick.call(app, x, y);
      app.pick = () => found;
      const shown = click.call(app, x, y);
      app.pick = pick;
      const place = await found;
      await shown;
      if (!app.measuring.active) picked(place && { key: place.key, position: place.center });
    };
  }
}

/** What runs in a frame when it has a picture; none if it is gone. @param {HTMLIFrameElement} frame @returns {Promise<[Window, App] | null>} */
async function opened(frame) {
  const inner = /** @type {any} */ (frame.contentWindow);
  while (inner && frame.contentWindow === inner) {
    const app = inner.neurotess?.app;
    if (app?.shown !== undefined) return [inner, app];
    await new Promise((resolve) => setTimeout(resolve, PATIENCE));
  }
  return null;
}

/** Joins a page with its view. @param {Page} page @param {Model} model @returns {() => void} what parts them */
function join(page, model) {
  let telling = false, parted = false;
  const tell = () => {
    const told = Object.entries(page.get()).filter(([name, value]) => !same(value, model.get(name)));
    if (parted || !told.length) return;
    // Setting a trait calls who listens to it, at once.
    telling = true;
    for (const [name, value] of told) model.set(name, value);
    telling = false;
    model.save_changes();
  };
  const take = () => { if (!telling) page.set(Object.fromEntries(SHARED.map((name) => [name, model.get(name)]))); };
  take();
  tell();
  page.listen(tell, (picked) => { if (!parted) model.send({ picked }); });
  const events = SHARED.map((name) => `change:${name}`);
  for (const event of events) model.on(event, take);
  return () => {
    parted = true;
    for (const event of events) model.off(event, take);
  };
}

/** Frames that are joined, or will be when their pages are there. */
const KNOWN = new WeakSet();

/**
 * Joins a frame with its view whenever it is loaded: notebooks take outputs away and put them back.
 * @param {HTMLIFrameElement} frame @param {Model} model @param {(() => void)[]} parting what is to be called at the end
 */
function keep(frame, model, parting) {
  if (KNOWN.has(frame)) return;
  KNOWN.add(frame);
  /** @type {App | undefined} */
  let joined;
  let part = () => {};
  const again = async () => {
    const [inner, app] = await opened(frame) ?? [];
    if (!inner || !app || app === joined) return;
    part();
    joined = app;
    part = join(new Page(inner, app), model);
  };
  frame.addEventListener('load', again);
  again();
  parting.push(() => {
    frame.removeEventListener('load', again);
    part();
  });
}

export default {
  /** Looks for the frames of a view, as long as it is there. @param {{ model: Model }} given @returns {() => void} */
  initialize({ model }) {
    /** @type {(() => void)[]} */
    const parting = [];
    const look = () => {
      const frames = document.querySelectorAll(`iframe[data-view="${model.get('_key')}"]`);
      for (const frame of frames) keep(/** @type {HTMLIFrameElement} */ (frame), model, parting);
    };
    const observer = new MutationObserver(look);
    observer.observe(document.body, { childList: true, subtree: true });
    look();
    return () => {
      observer.disconnect();
      for (const part of parting) part();
    };
  },

  /** Makes a frame, in a layout of several widgets and where programs show nothing else. @param {{ model: Model, el: HTMLElement }} given */
  render({ model, el }) {
    /** @type {(() => void)[]} */
    const parting = [];
    const show = (/** @type {any} */ message) => {
      if (!message.frame || el.firstElementChild) return;
      el.innerHTML = message.frame;
      for (const frame of el.querySelectorAll('iframe')) keep(frame, model, parting);
    };
    model.on('msg:custom', show);
    model.send({ frame: true });
    return () => {
      model.off('msg:custom', show);
      for (const part of parting) part();
    };
  },
};
