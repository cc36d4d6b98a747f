// The cells of a page, as the host knows them: where their parts are, and what each tracing point is. A tracing
// point is known by its color key, which no other point of the page has.

import { Arrays } from './bytes.js';
import { along, length, minus } from './vectors.js';

/**
 * A part of a packed mesh, in the buffer of all parts.
 * @typedef {object} Part
 * @property {number} cell
 * @property {number[]} base the fields of `Base` in template.wgsl
 * @property {number} slots
 * @property {number} firstSlot
 * @property {number} explicit
 * @property {number} firstExplicit
 */

/**
 * What is known of a tracing point.
 * @typedef {object} Place
 * @property {number} key
 * @property {number} cell
 * @property {number} section -1 on somata
 * @property {number} distance µm along the neurite from its beginning
 * @property {number} radius µm
 * @property {import('./vectors.js').Vector} center µm, in the world
 */

const NO_SECTION = 0xffff;
/** Fields of `Base` that are counts, not places. */
const COUNTS = [1, 7];

/** Colors of a text: see schemes.rs. @param {string} text @returns {number[][]} */
const unhex = (text) => (text.match(/.{6}/g) ?? []).map((color) => [0, 2, 4].map((at) => parseInt(color.slice(at, at + 2), 16)));

export class Scene {
  /** @param {any} data @param {ArrayBuffer} bytes @param {number} first @param {Record<string, number>} numbers */
  constructor(data, bytes, first, numbers) {
    this.data = data;
    for (const one of [...data.palettes, ...data.color_maps]) for (const list of ['types', 'distinct', 'colors']) if (one[list]?.match) one[list] = unhex(one[list]);
    this.numbers = numbers;
    this.arrays = new Arrays(bytes, first);
    /** @type {any[]} */
    this.cells = data.cells;
    this.keys = this.cells.reduce((sum, cell) => sum + cell.keys, 0);
    /** @type {Part[]} */
    this.parts = [];
    /** All parts, one after the other. */
    this.packed = new Uint32Array(0);
    /** Entries of the color table: points, then markers. */
    this.colors = this.keys + (data.markers?.colors.length ?? 0);
    /** Slots and explicit vertices of all parts. */
    this.slots = 0;
    this.explicit = 0;
    this.placeParts();
    /** By key: section, or NO_SECTION. */
    this.section = new Uint16Array(this.keys);
    /** By key: µm along the neurite. */
    this.distance = new Float32Array(this.keys);
    /** By key: µm. */
    this.radius = new Float32Array(this.keys);
    /** By key. */
    this.cellOf = new Uint16Array(this.keys);
    /** Three coordinates by key: µm, in the world. */
    this.centers = new Float64Array(3 * this.keys);
    this.readPoints();
    /** Spheres that hold all cells: center in the world, and radius (µm). */
    this.spheres = this.readSpheres();
  }

  /** Puts all parts into one buffer, and gives their patches and vertices numbers. Twin of batch.rs. */
  placeParts() {
    const { CLUSTER } = this.numbers;
    let words = 0, slots = 0, explicit = 0;
    /** @type {[number, Uint32Array][]} */
    const texts = [];
    this.cells.forEach((cell, index) => {
      for (const { packed, layout, slots: own, explicit: vertices } of cell.parts) {
        const base = layout.map((/** @type {number} */ at, /** @type {number} */ k) => (COUNTS.includes(k) ? at : at + words));
        this.parts.push({ cell: index, base, slots: own, firstSlot: slots, explicit: vertices, firstExplicit: explicit });
        texts.push([words, this.arrays.records(packed)]);
        words += packed.count;
        slots += Math.ceil(own / CLUSTER) * CLUSTER;
        explicit += vertices;
      }
    });
    this.packed = new Uint32Array(words);
    for (const [at, part] of texts) this.packed.set(part, at);
    this.slots = slots;
    this.explicit = explicit;
    for (const part of this.parts) part.firstExplicit += slots;
  }

  /** Reads what points are, and finds their centers and radii in the packed mesh. Twin of template.wgsl. */
  readPoints() {
    this.cells.forEach((cell, index) => {
      const first = cell.first_key;
      this.section.set(this.arrays.u16s(cell.section), first);
      this.distance.set(Float32Array.from(this.arrays.u16s(cell.distance), (share) => share / 65535 * cell.distance_most), first);
      this.cellOf.fill(index, first, first + cell.keys);
      cell.parents = this.arrays.u16s(cell.parents);
      cell.ends = Float32Array.from(this.arrays.u16s(cell.ends), (end) => end / 65535 * cell.distance_most);
    });
    const { packed } = this, floats = new Float32Array(packed.buffer);
    const named = (/** @type {number} */ key) => (key & 0x7fffffff) >>> 0;
    const bits = new Uint32Array(1), float = new Float32Array(bits.buffer);
    for (const part of this.parts) {
      const [points, pointCount, spheres, , anchors, shaped, , , , , keys] = part.base;
      for (let point = 0; point < pointCount; point++) {
        const at = points + 4 * point, [x, y, z, w] = packed.subarray(at, at + 4);
        // A ring of explicit vertices has no center of its own.
        if (y >>> this.numbers.POINT_KIND_SHIFT === this.numbers.POINT_EXPLICIT) continue;
        const sphere = spheres + this.numbers.SPHERE_U32S * Math.floor(point / this.numbers.POINTS_OF_SPHERE);
        const radius = floats[sphere + 3], step = 2 * radius / this.numbers.POSITION_STEPS;
        const steps = [x & 0xfffff, (x >>> 20) | ((y & 0xff) << 12), (y >>> 8) & 0xfffff];
        bits[0] = ((z & 0xffff) + this.numbers.RADIUS_BASE) << 12;
        this.setPoint(part.cell, named(packed[keys + (w >>> 22)]), steps.map((n, k) => floats[sphere + k] + n * step - radius), float[0]);
      }
      for (let at = anchors; at < shaped; at += 8) {
        this.setPoint(part.cell, named(packed[at + 7]), [floats[at], floats[at + 1], floats[at + 2]], floats[at + 4]);
      }
    }
  }

  /** @param {number} cell @param {number} key @param {number[]} center @param {number} radius */
  setPoint(cell, key, center, radius) {
    this.centers.set(this.inWorld(cell, /** @type {any} */ (center)), 3 * key);
    // Somata have none.
    if (this.section[key] !== NO_SECTION) this.radius[key] = radius / this.cells[cell].radius_factor;
  }

  /** @param {number} cell @param {import('./vectors.js').Vector} p @returns {import('./vectors.js').Vector} */
  inWorld(cell, p) {
    const { linear, translation } = this.cells[cell];
    return /** @type {any} */ (linear.map((/** @type {number[]} */ row, /** @type {number} */ k) => row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + translation[k]));
  }

  /** @returns {{ center: import('./vectors.js').Vector, radius: number }[]} */
  readSpheres() {
    const floats = new Float32Array(this.packed.buffer);
    const all = [];
    for (const { cell, base: [, , first, end] } of this.parts) {
      const scale = this.scale(cell);
      for (let at = first; at < end; at += this.numbers.SPHERE_U32S) {
        const [x, y, z, radius] = floats.subarray(at, at + 4);
        all.push({ center: this.inWorld(cell, [x, y, z]), radius: radius * scale });
      }
    }
    return all;
  }

  /** @param {number} cell @returns {number} */
  scale(cell) {
    return length(this.cells[cell].linear[0]);
  }

  /** @param {number} key @returns {Place} */
  place(key) {
    const section = this.section[key], at = 3 * key;
    return { key, cell: this.cellOf[key], section: section === NO_SECTION ? -1 : section, distance: this.distance[key],
      radius: this.radius[key], center: [this.centers[at], this.centers[at + 1], this.centers[at + 2]] };
  }

  /**
   * Length (µm) of the way along the tree between two places; null if there is none.
   * @param {Place} a @param {Place} b @returns {number | null}
   */
  way(a, b) {
    if (a.cell !== b.cell || a.section < 0 || b.section < 0) return null;
    const { parents, ends } = this.cells[a.cell];
    const above = new Set();
    for (let s = a.section + 1; s; s = parents[s - 1]) above.add(s);
    if (above.has(b.section + 1) && b.section !== a.section) return a.distance - b.distance;
    let meet = b.section + 1;
    while (meet && !above.has(meet)) meet = parents[meet - 1];
    if (!meet) return null;
    if (meet === a.section + 1) return Math.abs(b.distance - a.distance);
    return a.distance + b.distance - 2 * ends[meet - 1];
  }

  /** @param {Place} a @param {Place} b @returns {number} straight, µm */
  straight(a, b) {
    return length(minus(a.center, b.center));
  }

  /** @returns {{ center: import('./vectors.js').Vector, radius: number }} a sphere around everything */
  around() {
    const low = [1e30, 1e30, 1e30], high = [-1e30, -1e30, -1e30];
    for (const { center, radius } of this.spheres) {
      for (let k = 0; k < 3; k++) {
        low[k] = Math.min(low[k], center[k] - radius);
        high[k] = Math.max(high[k], center[k] + radius);
      }
    }
    const center = /** @type {import('./vectors.js').Vector} */ (low.map((v, k) => (v + high[k]) / 2));
    const reach = this.spheres.map((s) => length(along(s.center, center, -1)) + s.radius);
    return { center, radius: Math.max(...reach) };
  }
}
