// Colors of tracing points: schemes, palettes, color maps, what is hidden. See schemes.rs and recording.rs.

/** @typedef {[number, number, number]} Rgb sRGB, 0 to 255 */

/**
 * An entry of the legend.
 * @typedef {{ name: string, color: Rgb, index: number }} Entry
 */

/** Set in the key of a category. */
const CATEGORY = 1 << 15;
/** Of points without a value. */
const NOTHING = /** @type {Rgb} */ ([160, 160, 160]);
/** Ends of color maps with less contrast to the background (WCAG 2.2) are left out. */
const MIN_CONTRAST = 1.4;
/** Types from here on take the last colors in turn. */
const CUSTOM = 5;

/** @param {number} byte @returns {number} linear light (IEC 61966-2-1) */
export function linear(byte) {
  const c = byte / 255;
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
}

/** @param {Rgb} color @returns {number} relative luminance, 0 to 1 */
function luminance(color) {
  const [r, g, b] = color.map(linear);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** @param {Rgb} color @returns {boolean} whether light things stand out better against it */
export const isDark = (color) => luminance(color) < 0.2;

/** @param {Rgb} color @returns {string} */
export const css = (color) => `rgb(${color.join()})`;

export class Colors {
  /** @param {import('./scene.js').Scene} scene */
  constructor(scene) {
    this.scene = scene;
    const { data } = scene;
    /** @type {any[]} */
    this.schemes = [...data.schemes];
    if (data.recording) this.schemes.push({ id: 'value', label: data.recording.title || 'values', recording: true });
    this.scheme = this.schemes[data.scheme ?? this.schemes.length - 1];
    this.palette = data.palettes.find((/** @type {any} */ p) => p.name === data.palette);
    this.map = data.color_maps.find((/** @type {any} */ m) => m.name === data.color_map);
    /** @type {Rgb} */
    this.background = [255, 255, 255];
    this.frame = 0;
    /** Hidden categories, by scheme. @type {Map<string, Set<number>>} */
    this.hidden = new Map();
    /** Linear colors by key; the last component is 0 for those that are hidden. */
    this.table = new Float32Array(4 * scene.colors);
    data.markers?.colors.forEach((/** @type {Rgb} */ color, /** @type {number} */ k) => this.table.set([...color.map(linear), 1], 4 * (scene.keys + k)));
  }

  /** @param {string} id */
  choose(id) {
    this.scheme = this.schemes.find((scheme) => scheme.id === id) ?? this.scheme;
  }

  /** @returns {boolean} whether it has a scale of numbers */
  isScale() {
    return !!(this.scheme.range || this.scheme.recording);
  }

  /** @returns {Set<number>} */
  hiddenNow() {
    const { id } = this.scheme;
    if (!this.hidden.has(id)) this.hidden.set(id, new Set());
    return /** @type {Set<number>} */ (this.hidden.get(id));
  }

  /** @param {any} thing @param {number} index among things without a type @returns {Rgb} */
  colorOf(thing, index) {
    if (thing.own) return thing.own;
    const { types, soma_on_dark: onDark, distinct } = this.palette;
    if (thing.kind === undefined) return distinct[index % distinct.length];
    if (thing.kind === 1 && isDark(this.background)) return onDark;
    if (thing.kind < CUSTOM) return types[Math.max(thing.kind, 0)];
    return types[CUSTOM + (thing.kind - CUSTOM) % (types.length - CUSTOM)];
  }

  /** @returns {Entry[]} */
  entries() {
    let index = 0;
    return (this.scheme.things ?? []).map((/** @type {any} */ thing, /** @type {number} */ k) => {
      const color = this.colorOf(thing, thing.kind === undefined ? index++ : 0);
      return { name: thing.name, color, index: k };
    });
  }

  /** The name of what a point is by type. @param {number} key @returns {string} */
  typeOf(key) {
    const scheme = this.schemes.find(({ id }) => id === 'type');
    return scheme ? scheme.things[this.keyIn(scheme, key) & ~CATEGORY]?.name ?? '' : '';
  }

  /** @param {any} scheme @param {number} key @returns {number} */
  keyIn(scheme, key) {
    return this.keysOf(scheme)[key];
  }

  /** The keys of all points in a scheme. @param {any} scheme @returns {Uint16Array} */
  keysOf(scheme) {
    if (!scheme.read) {
      const { cells, arrays, keys } = this.scene;
      scheme.read = new Uint16Array(keys);
      const from = scheme.recording ? this.scene.data.recording.keys : scheme.keys;
      cells.forEach((cell, k) => scheme.read.set(arrays.u16s(from[k]), cell.first_key));
    }
    return scheme.read;
  }

  /** Frame after frame of the recording. @returns {Uint8Array} */
  frames() {
    const { recording } = this.scene.data;
    if (!recording.read) {
      const bytes = this.scene.arrays.u8s(recording.frames).slice();
      for (let k = recording.values; k < bytes.length; k++) bytes[k] += bytes[k - recording.values];
      recording.read = bytes;
    }
    return recording.read;
  }

  /** @returns {{ title: string, range: [number, number], more: boolean }} */
  scale() {
    const { scheme } = this, { recording } = this.scene.data;
    if (scheme.range) return { title: scheme.title, range: scheme.range[0], more: scheme.range[1] };
    const unit = recording.unit ? ` (${recording.unit})` : '';
    return { title: recording.title + unit, range: recording.range, more: false };
  }

  /** The value of a point, 0 to 1; -1 if it has none. @param {number} key @returns {number} */
  shareOf(key) {
    const { scheme, scene } = this;
    if (scheme.recording) {
      const { recording } = scene.data, place = this.keysOf(scheme)[key];
      if (!place) return -1;
      const at = this.frame * recording.values + recording.firsts[scene.cellOf[key]] + place - 1;
      return (this.frames()[at] - 1) / 254;
    }
    if (scene.section[key] === 0xffff) return -1;
    if (!scheme.attribute) return this.keysOf(scheme)[key] / (CATEGORY - 1);
    const [low, high] = scheme.range[0], value = scene[/** @type {'radius' | 'distance'} */ (scheme.attribute)][key];
    return Math.min(Math.max((value - low) / (high - low), 0), 1);
  }

  /** @param {number} share 0 to 1 @returns {Rgb} of the part of the map that stands out against the background */
  ofShare(share) {
    const { colors } = this.map, [first, last] = this.visible(), place = first + share * (last - first), low = Math.min(Math.floor(place), colors.length - 2);
    return colors[low].map((/** @type {number} */ c, /** @type {number} */ k) => Math.round(c + (colors[low + 1][k] - c) * (place - low)));
  }

  /** First and last color of the map that one can tell from the background. @returns {[number, number]} */
  visible() {
    const { colors } = this.map, behind = luminance(this.background) + 0.05;
    const seen = colors.map((/** @type {Rgb} */ color) => {
      const own = luminance(color) + 0.05;
      return Math.max(own, behind) / Math.min(own, behind) >= MIN_CONTRAST;
    });
    return [Math.max(seen.indexOf(true), 0), Math.max(seen.lastIndexOf(true), 1)];
  }

  /** Writes the table anew. @returns {Float32Array} */
  update() {
    const { table, scene } = this, entries = this.entries();
    const hidden = this.hiddenNow();
    const known = entries.map(({ color, index }) => [...color.map(linear), hidden.has(index) ? 0 : 1]);
    if (!this.isScale()) {
      const keys = this.keysOf(this.scheme);
      for (let key = 0; key < scene.keys; key++) table.set(known[keys[key] & ~CATEGORY] ?? known[known.length - 1], 4 * key);
      return table;
    }
    const shares = Array.from({ length: 256 }, (_, k) => [...this.ofShare(k / 255).map(linear), 1]);
    const none = this.scheme.recording ? [...NOTHING.map(linear), 1] : known[0];
    for (let key = 0; key < scene.keys; key++) {
      const share = this.shareOf(key);
      table.set(share < 0 ? none : shares[Math.round(255 * share)], 4 * key);
    }
    return table;
  }
}
