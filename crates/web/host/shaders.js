// Shaders of the page and their uniforms: see shaders.rs.

/** The WGSL of a module. @param {any} shaders @param {string} name @returns {string} */
export const wgsl = (shaders, name) => shaders.modules[name].map((/** @type {number} */ k) => shaders.pieces[k]).join('\n');

/** Bytes of a struct, written by the names of its fields. */
export class Struct {
  /** @param {{ size: number, fields: [string, number, string][] }} layout @param {ArrayBuffer} [bytes] @param {number} [start] */
  constructor(layout, bytes = new ArrayBuffer(layout.size), start = 0) {
    this.fields = new Map(layout.fields.map(([name, at, kind]) => [name, [at, kind]]));
    this.view = new DataView(bytes, start, layout.size);
    this.bytes = bytes;
  }

  /** @param {Record<string, number | ArrayLike<number>>} values @returns {this} */
  set(values) {
    for (const [name, value] of Object.entries(values)) {
      const [at, kind] = /** @type {[number, string]} */ (this.fields.get(name));
      const all = typeof value === 'number' ? [value] : Array.from(value);
      all.forEach((number, k) => {
        if (kind === 'f') this.view.setFloat32(at + 4 * k, number, true);
        else this.view.setInt32(at + 4 * k, number, true);
      });
    }
    return this;
  }
}

/** Names of the fields of `Base`, in the order of a part's layout. */
export const BASE = ['points', 'point_count', 'spheres', 'explicit_vertices', 'anchors', 'shaped', 'soma', 'soma_count',
  'quads', 'caps', 'color_keys'];

/** The fields of a part's base, as fields of a struct. @param {number[]} base @returns {Record<string, number>} */
export const baseFields = (base) => Object.fromEntries(BASE.map((name, k) => [`base.${name}`, base[k]]));

/**
 * Rows of the transform from a cell's coordinates to those relative to the eye.
 * @param {any} cell @param {import('./vectors.js').Vector} eye @returns {{ row_x: number[], row_y: number[], row_z: number[] }}
 */
export function rows(cell, eye) {
  const [x, y, z] = cell.linear.map((/** @type {number[]} */ row, /** @type {number} */ k) => [...row, cell.translation[k] - eye[k]]);
  return { row_x: x, row_y: y, row_z: z };
}

/** @param {import('./camera.js').View} view @param {number} aspect @returns {number[]} `clip_from_relative`, by columns */
export function clipFromRelative({ right, up, backward, tan, orthographic, halfHeight, near }, aspect) {
  const lens = orthographic ? halfHeight : tan;
  const column = (/** @type {number} */ k) => [right[k] / (lens * aspect), up[k] / lens,
    orthographic ? backward[k] / (2 * Math.abs(near)) : 0, orthographic ? 0 : -backward[k]];
  return [...column(0), ...column(1), ...column(2), 0, 0, orthographic ? 0.5 : near, orthographic ? 1 : 0];
}

/** @param {number[]} v @returns {number[]} */
export const unit = (v) => v.map((x) => x / Math.hypot(...v));
