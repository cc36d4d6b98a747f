// The panel beside the picture: colors, detail, background, buttons; and the slider of time.

/** @typedef {import('./app.js').App} App */

/** @template {HTMLElement} T @param {string} id @returns {T} */
export const byId = (id) => /** @type {T} */ (document.getElementById(id));

/** Fills the panel, and listens to it. @param {App} app */
export function makePanel(app) {
  const { colors, scene } = app;
  const choose = (/** @type {string} */ id, /** @type {string[][]} */ options) =>
    byId(id).replaceChildren(...options.map(([value, text]) => new Option(text, value)));
  choose('scheme', colors.schemes.map(({ id, label }) => [id, label]));
  if (scene.data.background) byId('background').prepend(new Option('of the page', 'own'));
  const background = /** @type {HTMLSelectElement} */ (byId('background'));
  background.value = app.background;
  const on = (/** @type {string} */ id, /** @type {(value: string) => void} */ act) => {
    const element = /** @type {HTMLInputElement} */ (byId(id));
    element.oninput = () => act(element.value);
  };
  on('scheme', (value) => chooseScheme(app, value));
  on('colors', (value) => {
    if (colors.isScale()) colors.map = scene.data.color_maps.find((/** @type {any} */ map) => map.name === value);
    else colors.palette = scene.data.palettes.find((/** @type {any} */ palette) => palette.name === value);
    app.recolor();
  });
  on('background', (value) => {
    app.background = /** @type {any} */ (value);
    app.showBackground();
    app.recolor();
  });
  on('level', () => showLevel(app));
  for (const id of ['orthographic', 'wireframe', 'occlusion']) on(id, () => app.loop?.refresh());
  const press = (/** @type {string} */ id, /** @type {() => void} */ act) => { byId(id).onclick = act; };
  press('fit', () => app.act('f'));
  press('front', () => app.act('1'));
  press('side', () => app.act('2'));
  press('top', () => app.act('3'));
  press('measure', () => app.act('m'));
  press('copy', () => app.act('l'));
  press('picture', () => app.act('p'));
  press('mesh', () => app.act('s'));
  chooseScheme(app, colors.scheme.id);
  const { recording } = scene.data;
  if (recording?.times.length > 1) {
    const frame = /** @type {HTMLInputElement} */ (byId('frame'));
    frame.max = String(recording.times.length - 1);
    on('frame', (value) => showFrame(app, +value));
    press('play', () => play(app));
  }
}

/** @param {App} app @param {string} id */
export function chooseScheme(app, id) {
  const { colors, scene } = app;
  colors.choose(id);
  /** @type {HTMLSelectElement} */ (byId('scheme')).value = colors.scheme.id;
  const isScale = colors.isScale(), all = isScale ? scene.data.color_maps : scene.data.palettes;
  byId('colors-name').textContent = isScale ? 'Color map' : 'Palette';
  byId('colors').replaceChildren(...all.map((/** @type {any} */ { name }) => new Option(name, name)));
  /** @type {HTMLSelectElement} */ (byId('colors')).value = (isScale ? colors.map : colors.palette).name;
  byId('time').hidden = !(colors.scheme.recording && scene.data.recording.times.length > 1);
  if (colors.scheme.recording) showFrame(app, colors.frame);
  app.recolor();
}

/** @param {App} app @param {number} frame of the recording */
function showFrame(app, frame) {
  const { times } = app.scene.data.recording;
  app.colors.frame = Math.min(Math.max(frame, 0), Math.max(times.length - 1, 0));
  /** @type {HTMLInputElement} */ (byId('frame')).value = String(app.colors.frame);
  byId('frame-name').textContent = times.length ? `${+times[app.colors.frame].toFixed(3)} ms` : '';
  app.renderer?.setColors(app.colors.update());
  if (app.playing) app.loop?.change();
  else app.loop?.refresh();
}

/** Plays the recording, or stops. @param {App} app */
export function play(app) {
  app.playing = !app.playing;
  byId('play').textContent = app.playing ? '❚❚' : '▶';
  const next = async () => {
    while (app.playing) {
      showFrame(app, (app.colors.frame + 1) % app.scene.data.recording.times.length);
      await new Promise((resolve) => setTimeout(resolve, 60));
      await app.renderer?.done();
    }
    app.loop?.refresh();
  };
  if (app.playing) next();
}

/** @param {App} app */
export function showLevel(app) {
  const level = app.level();
  byId('level-name').textContent = level ? `level ${level}` : 'automatic';
  app.loop?.refresh();
}
