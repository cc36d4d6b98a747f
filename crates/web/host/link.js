// What the page shows, in its address: a link opens the same view.

/** Levels of the slider; the first place is the automatic one. */
export const LEVELS = [0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64];
/** Boxes that are in the address by their first letter; occlusion if it is off. */
const FLAGS = ['orthographic', 'wireframe'];
const NO_OCCLUSION = 'n';

/** @param {string} hash @returns {Record<string, string>} */
export const read = (hash) => Object.fromEntries(new URLSearchParams(hash.replace(/^#/, '')));

/** A number with six digits, without a power. @param {number} value @returns {number} */
const short = (value) => +value.toPrecision(6);

/** @param {string | undefined} text @param {number} count @returns {number[] | null} */
function numbers(text, count) {
  const all = (text ?? '').split(',').map(Number);
  return text && all.length === count && all.every(Number.isFinite) ? all : null;
}

/** @param {string} id @returns {HTMLInputElement} */
const input = (id) => /** @type {HTMLInputElement} */ (document.getElementById(id));

/** The state of a page as the end of its address. @param {import('./app.js').App} app @returns {string} */
export function stateOf(app) {
  const { camera, colors } = app;
  const flags = FLAGS.filter((id) => app.checked(id)).map((id) => id[0]).join('') + (app.checked('occlusion') ? '' : NO_OCCLUSION);
  const state = {
    view: [camera.yaw, camera.pitch, camera.distance, ...camera.target].map(short).join(), colors: colors.scheme.id,
    palette: colors.palette.name, map: colors.map.name, level: app.level() || '', flags, hide: [...colors.hiddenNow()].join(),
    background: app.background, frame: colors.frame || '', renderer: read(location.hash).renderer ?? '',
  };
  return '#' + Object.entries(state).filter(([, value]) => value !== '')
    .map(([name, value]) => `${name}=${encodeURIComponent(String(value)).replaceAll('%2C', ',')}`).join('&');
}

/** Sets a page to what its address says; the rest stays. @param {import('./app.js').App} app @param {string} hash */
export function restore(app, hash) {
  const state = read(hash), { camera, colors, scene: { data } } = app;
  const view = numbers(state.view, 6);
  if (view && view[2] > 0) {
    [camera.yaw, camera.pitch, camera.distance] = view;
    camera.target = [view[3], view[4], view[5]];
  }
  const flags = state.flags ?? '';
  for (const id of FLAGS) input(id).checked = flags.includes(id[0]);
  input('occlusion').checked = !flags.includes(NO_OCCLUSION);
  const named = (/** @type {any[]} */ all, /** @type {string | undefined} */ name, /** @type {any} */ usual) => all.find((one) => one.name === name) ?? usual;
  colors.palette = named(data.palettes, state.palette, colors.palette);
  colors.map = named(data.color_maps, state.map, colors.map);
  if (['light', 'dark', 'system'].includes(state.background)) app.background = /** @type {any} */ (state.background);
  input('background').value = app.background;
  colors.choose(state.colors ?? colors.scheme.id);
  const hidden = colors.hiddenNow();
  hidden.clear();
  for (const index of (state.hide ?? '').split(',')) if (index) hidden.add(+index);
  const last = Math.max((data.recording?.times.length ?? 1) - 1, 0), frame = Math.floor(Number(state.frame ?? 0));
  colors.frame = Math.min(Math.max(frame || 0, 0), last);
  input('level').value = String(Math.max(LEVELS.indexOf(Number(state.level ?? 0)), 0));
}
