// The page: its parts put together.

import { Camera } from './camera.js';
import { Colors, css, isDark } from './colors.js';
import { showLegend, showScale } from './legend.js';
import { LEVELS, read, restore, stateOf } from './link.js';
import { Measuring, described } from './measuring.js';
import { Loop } from './loop.js';
import { byId, chooseScheme, makePanel, play, showLevel } from './panel.js';
import { listen } from './pointer.js';
import { ply, surface } from './saving.js';
import { save } from './files.js';
import { drawn } from './picture.js';
import { Scene } from './scene.js';
import { STEPS, WebGpuRenderer } from './webgpu.js';
import { WebGlRenderer } from './webgl.js';

/** @typedef {import('../drop/processor.js').ProcessorRenderer} ProcessorRenderer of the page around this one */

/** Error (pixels) of automatic levels: at rest it cannot be seen. */
const PIXELS = 0.5, DRAFT_PIXELS = 2, DRAFT_LEVEL = 3;
/** Milliseconds between two questions what is under the pointer. */
const HOVER = 70;
const BACKGROUNDS = { light: /** @type {import('./colors.js').Rgb} */ ([255, 255, 255]), dark: /** @type {import('./colors.js').Rgb} */ ([21, 23, 27]) };
/** Most pixels of a picture, half as many on phones: each takes some 120 bytes of the card. */
const MAX_PIXELS = 4e6;
/** Level of meshes that are saved while the level is automatic, as of the command. */
const SAVED_LEVEL = 4;

export class App {
  /** @param {{ shaders: any, cells: any, bytes: ArrayBuffer, first: number }} page */
  constructor({ shaders, cells, bytes, first }) {
    this.shaders = shaders;
    this.canvas = /** @type {HTMLCanvasElement} */ (byId('canvas'));
    this.message = byId('message');
    this.background = /** @type {'own' | 'system' | 'light' | 'dark'} */ (cells.background ? 'own' : 'system');
    this.scene = new Scene(cells, bytes, first, shaders.numbers);
    this.colors = new Colors(this.scene);
    this.camera = new Camera(this.scene.spheres);
    this.measuring = new Measuring(this.scene, (text) => this.say(text));
    /** What was hidden before the last click on the legend. @type {number[]} */
    this.hiddenBefore = [];
    /** @type {WebGpuRenderer | WebGlRenderer | ProcessorRenderer | undefined} */
    this.renderer = undefined;
    this.hovered = 0;
    /** Pixels of the canvas for each of the page. */
    this.ratio = 1;
    this.system = matchMedia('(prefers-color-scheme: dark)');
    /** A page in another one has no address of its own. */
    this.hasAddress = location.protocol !== 'about:';
  }

  /** Opens a renderer: WebGPU, or else WebGL 2, or else the processor, in the page that takes tracings. */
  async open() {
    const begin = performance.now();
    this.resize();
    this.showBackground();
    const wanted = read(location.hash).renderer;
    const failed = (/** @type {string} */ message) => this.say(message);
    /** @type {WebGpuRenderer | WebGlRenderer | ProcessorRenderer | null} */
    let renderer = wanted === 'webgl' ? null : await WebGpuRenderer.open(this.canvas, this.scene, this.shaders, failed);
    let said = '';
    if (!renderer) {
      renderer = WebGlRenderer.open(this.canvas, this.scene, this.shaders, failed);
      said = 'Drawn with WebGL 2, since there is no WebGPU here: one level everywhere.';
    }
    if (!renderer) {
      // Pages by themselves have none: see frame.js.
      renderer = /** @type {any} */ (frameElement)?.processor?.(this.canvas, this.scene, failed);
      said = /** @type {any} */ (renderer)?.said;
    }
    if (!renderer) {
      for (const id of ['panel', 'legend', 'scale']) byId(id).hidden = true;
      this.say('No WebGPU and no WebGL 2 here: turn hardware acceleration on, or use neurotess render or the page that takes tracings.');
      return;
    }
    this.renderer = renderer;
    // All others draw all of a fine picture in the first of two steps: one is a draft.
    const steps = renderer instanceof WebGpuRenderer ? STEPS : 2;
    this.loop = new Loop((how) => this.draw(how), () => /** @type {any} */ (this.renderer).done(), steps);
    this.say(said);
    /** @type {HTMLDetailsElement} */ (byId('panel')).open = innerWidth > 760;
    byId('copy').hidden = !this.hasAddress;
    makePanel(this);
    this.camera.fit(this.aspect(), this.covered());
    this.restore();
    this.recolor();
    this.watch();
    await this.show(begin);
    await this.completed;
  }

  /** Draws what is there already, then all. @param {number} begin when it began (ms) */
  async show(begin) {
    const { renderer } = this;
    if (!renderer) return;
    this.loop?.change();
    this.opened = performance.now() - begin;
    await new Promise((resolve) => setTimeout(resolve));
    await renderer.done();
    this.shown = performance.now() - begin;
    this.completed = renderer.complete().then(() => this.loop?.refresh());
  }

  /**
   * Shows other cells, in the same way. What is compiled for the device stays: browsers know equal pipelines of a device.
   * @param {string} text of a page's cells
   */
  async replace(text) {
    const begin = performance.now(), { renderer: before } = this;
    const [cells, bytes, first] = await /** @type {any} */ (window).neurotess.unpacked(text);
    const scene = new Scene(cells, bytes, first, this.shaders.numbers);
    const renderer = await before?.replaced(scene);
    if (!renderer) throw new Error('nothing can be drawn here');
    this.canvas.setAttribute('aria-label', (this.canvas.getAttribute('aria-label') ?? '').replace(this.scene.data.title, () => cells.title));
    this.scene = scene;
    this.colors = new Colors(scene);
    this.camera = new Camera(scene.spheres);
    this.measuring = new Measuring(scene, (text) => this.say(text));
    this.hiddenBefore = [];
    this.renderer = renderer;
    this.playing = false;
    document.title = cells.title;
    for (const heading of document.querySelectorAll('h1')) heading.textContent = cells.title;
    this.showBackground();
    makePanel(this);
    this.measure(false);
    this.tip(null, 0, 0);
    this.camera.fit(this.aspect(), this.covered());
    await this.show(begin);
    before?.destroy();
  }

  /** @param {string} text */
  say(text) {
    this.message.textContent = text;
  }

  aspect() {
    return this.canvas.width / this.canvas.height;
  }

  /** The share of the width that the panel covers; none if little would be left. */
  covered() {
    const panel = /** @type {HTMLDetailsElement} */ (byId('panel'));
    const share = panel.open ? (panel.offsetWidth + 12) / this.canvas.clientWidth : 0;
    return share < 0.36 ? share : 0;
  }

  resize() {
    const { canvas } = this, most = matchMedia('(pointer: coarse)').matches ? MAX_PIXELS / 2 : MAX_PIXELS;
    this.ratio = Math.min(devicePixelRatio, Math.sqrt(most / (canvas.clientWidth * canvas.clientHeight + 1)));
    const size = [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(Math.round(n * this.ratio), 1));
    if (canvas.width === size[0] && canvas.height === size[1]) return false;
    [canvas.width, canvas.height] = size;
    return true;
  }

  /** @param {boolean} draft @returns {import('./webgpu.js').Look} */
  look(draft) {
    const level = this.level();
    const slow = draft && this.loop && this.loop.took > 100;
    return {
      lod: level ? { level: slow ? Math.min(level, DRAFT_LEVEL) : level } : { pixels: draft ? DRAFT_PIXELS : PIXELS },
      wireframe: this.checked('wireframe'), occlusion: this.checked('occlusion'), lit: true,
      leastWidth: this.scene.data.least_width, background: this.colors.background, pixelRatio: this.ratio,
    };
  }

  /** @returns {number} that is chosen; 0: automatic */
  level() {
    return LEVELS[+(/** @type {HTMLInputElement} */ (byId('level')).value)];
  }

  /** @param {string} id @returns {boolean} */
  checked(id) {
    return /** @type {HTMLInputElement} */ (byId(id)).checked;
  }

  /** @param {{ step: number, steps: number, scale: number, draft: boolean }} how */
  draw(how) {
    const { renderer, camera } = this;
    if (!renderer) return;
    camera.orthographic = this.checked('orthographic');
    renderer.draw(camera, this.look(how.draft), how);
    if (how.step) return;
    const pixel = 2 * camera.tan * camera.distance / this.canvas.clientHeight;
    this.bar = showScale(byId('scale'), pixel, this.canvas.clientWidth);
    this.measuring.draw(byId('overlay'), camera);
    if (!how.draft) this.writeLink();
  }

  /** Colors, legend and what is hidden, as they are now. */
  recolor() {
    this.renderer?.setColors(this.colors.update());
    showLegend(byId('legend'), this.colors, (index, alone, again) => this.toggle(index, alone, again));
    this.loop?.refresh();
  }

  /**
   * Hides or shows an entry of the legend, or all others.
   * @param {number} index @param {boolean} alone @param {boolean} again whether a click before has hidden or shown it
   */
  toggle(index, alone, again) {
    const hidden = this.colors.hiddenNow(), all = this.colors.entries().length;
    if (again) {
      hidden.clear();
      for (const before of this.hiddenBefore) hidden.add(before);
    }
    this.hiddenBefore = [...hidden];
    if (alone) {
      const isAlone = hidden.size === all - 1 && !hidden.has(index);
      hidden.clear();
      if (!isAlone) for (let other = 0; other < all; other++) if (other !== index) hidden.add(other);
    } else if (!hidden.delete(index)) hidden.add(index);
    this.recolor();
  }

  showBackground() {
    const { background, system, colors } = this, own = this.scene.data.background;
    colors.background = background === 'own' ? own : BACKGROUNDS[background === 'dark' || (background === 'system' && system.matches) ? 'dark' : 'light'];
    document.documentElement.dataset.theme = isDark(colors.background) ? 'dark' : 'light';
    document.body.style.background = css(colors.background);
  }

  /** Listens to input. */
  watch() {
    const { canvas } = this;
    const change = () => this.loop?.change();
    new ResizeObserver(() => this.resize() && change()).observe(canvas);
    this.system.onchange = () => {
      this.showBackground();
      this.recolor();
    };
    addEventListener('hashchange', () => location.hash !== this.link && (this.restore(), this.recolor(), change()));
    listen(canvas, {
      turn: (right, up) => { this.camera.turn(right, up); change(); },
      pan: (x, y) => { this.camera.pan(x, y, canvas.clientHeight); change(); },
      zoom: (factor, x, y) => { this.camera.zoom(factor, x - canvas.clientWidth / 2, y - canvas.clientHeight / 2, canvas.clientHeight); change(); },
      hover: (x, y) => this.hover(x, y),
      leave: () => this.tip(null, 0, 0),
      click: (x, y) => this.click(x, y),
      near: (x, y) => this.near(x, y),
      key: (key) => this.act(key.toLowerCase()),
    });
  }

  /** What is drawn at a place of the page. @param {number} x @param {number} y @returns {Promise<import('./scene.js').Place | null>} */
  async pick(x, y) {
    const { renderer, camera, ratio } = this;
    const key = renderer ? await renderer.pick(camera, this.look(false), x * ratio, y * ratio) : -1;
    return key < 0 || key >= this.scene.keys ? null : this.scene.place(key);
  }

  /** @param {number} x @param {number} y */
  async hover(x, y) {
    this.pointer = [x, y];
    const now = performance.now();
    if (this.asking || now - this.hovered < HOVER || (this.loop?.draftAsked ?? true)) return;
    this.asking = true;
    this.hovered = now;
    const place = await this.pick(x, y);
    this.asking = false;
    const [px, py] = this.pointer;
    this.tip(place, px, py);
    if (px !== x || py !== y) setTimeout(() => this.hover(px, py), HOVER);
  }

  /** @param {import('./scene.js').Place | null} place @param {number} x @param {number} y */
  tip(place, x, y) {
    const tip = byId('tip');
    tip.hidden = !place;
    if (!place) return;
    tip.textContent = described(place, this.scene, this.colors);
    const { offsetWidth: width, offsetHeight: height } = tip;
    tip.style.left = `${Math.min(x + 14, innerWidth - width - 8)}px`;
    tip.style.top = `${y + 18 + height > innerHeight ? y - height - 10 : y + 18}px`;
  }

  /** @param {number} x @param {number} y */
  async click(x, y) {
    const place = await this.pick(x, y);
    if (!this.measuring.active) this.tip(place, x, y);
    else if (place) this.measuring.add(place);
    this.measuring.draw(byId('overlay'), this.camera);
  }

  /** Goes near to what is at a place. @param {number} x @param {number} y */
  async near(x, y) {
    const place = await this.pick(x, y);
    if (!place) return;
    this.camera.target = place.center;
    this.camera.distance = Math.min(this.camera.distance * 0.4, Math.max(60 * place.radius, 40));
    this.loop?.change();
  }

  /** Does what a key means. @param {string} key @returns {boolean} whether it means something */
  act(key) {
    const { camera } = this;
    const look = (/** @type {number} */ yaw, /** @type {number} */ pitch) => {
      [camera.yaw, camera.pitch] = [yaw, pitch];
      camera.orthographic = this.checked('orthographic');
      camera.fit(this.aspect(), this.covered());
      this.loop?.change();
    };
    const flip = (/** @type {string} */ id) => byId(id).click();
    /** @type {Record<string, () => void>} */
    const actions = {
      f: () => look(camera.yaw, camera.pitch), 1: () => look(0, 0), 2: () => look(Math.PI / 2, 0), 3: () => look(0, Math.PI / 2 - 1e-4),
      o: () => flip('orthographic'), w: () => flip('wireframe'), m: () => this.measure(), p: () => this.savePicture(),
      s: () => this.saveMesh(), l: () => this.copyLink(), ' ': () => this.scene.data.recording && !byId('time').hidden && play(this),
      escape: () => this.measuring.active && this.measure(),
    };
    if (!actions[key]) return false;
    actions[key]();
    return true;
  }

  /** Begins or ends measuring. @param {boolean} [active] */
  measure(active = !this.measuring.active) {
    const { measuring } = this;
    if (active !== measuring.active) measuring.toggle();
    byId('measure').setAttribute('aria-pressed', String(measuring.active));
    this.canvas.classList.toggle('measuring', measuring.active);
    measuring.draw(byId('overlay'), this.camera);
  }

  async savePicture() {
    await this.loop?.settled();
    const { canvas, colors } = this;
    // A canvas of WebGPU can be read only in the task in which it was drawn.
    this.drawWhole();
    const picture = drawn(canvas, colors, this.bar, this.ratio);
    picture.toBlob((blob) => blob && save(blob, `${this.fileName()}.png`));
  }

  /** Draws all steps of the picture again. */
  drawWhole() {
    const { renderer, loop } = this;
    if (!renderer || !loop) return;
    for (let step = 0; step < loop.steps; step++) renderer.draw(this.camera, this.look(false), { step, steps: loop.steps, scale: 1 });
  }

  async saveMesh() {
    const level = this.level() || SAVED_LEVEL;
    this.say(`Making the surface at level ${level} …`);
    try {
      const { file, triangles } = await this.mesh(level);
      save(file, `${this.fileName()}.ply`);
      this.say(`Saved ${triangles.toLocaleString('en')} triangles at level ${level}.`);
    } catch (error) {
      this.say(/** @type {Error} */ (error).message);
    }
  }

  /** The surface as a file. @param {number} level @returns {Promise<{ file: Blob, triangles: number }>} */
  async mesh(level) {
    const { renderer } = this;
    if (renderer && 'mesh' in renderer) return renderer.mesh(level);
    const made = await surface(/** @type {any} */ (renderer), this.scene, level);
    return { file: ply(made), triangles: made.triangles.length / 3 };
  }

  fileName() {
    return (this.scene.data.title || 'cells').replace(/[^\w.-]+/g, '_').slice(0, 80);
  }

  async copyLink() {
    this.writeLink();
    try {
      await navigator.clipboard.writeText(location.href);
      this.say('The address of this view is copied: it works wherever the file is.');
    } catch {
      this.say('Copy the page\'s address: it holds this view.');
    }
  }

  /** Puts what is shown into the address. */
  writeLink() {
    if (!this.hasAddress) return;
    this.link = stateOf(this);
    if (location.hash !== this.link) location.replace(this.link);
  }

  /** Shows what the address says. */
  restore() {
    restore(this, location.hash);
    this.showBackground();
    showLevel(this);
    chooseScheme(this, this.colors.scheme.id);
  }
}

const page = /** @type {any} */ (window).neurotess;
page.app = new App(page);
page.ready = page.app.open().catch((/** @type {Error} */ error) => page.app.say(`The cells cannot be shown: ${error.message}`));
