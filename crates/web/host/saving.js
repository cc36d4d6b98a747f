// The surface as a PLY file, made of the card's own vertices.

import { quads } from './selection.js';
import { ranges } from './ranges.js';

/** Vertices that the card makes at once, and the most triangles of a file. */
const TOGETHER = 1 << 18, MAX_TRIANGLES = 20e6;
/** See even.wgsl. */
const KIND_STEP = 1 << 21;

/** Numbers of one kind that become more: an array of all numbers of JavaScript would take twice the memory. */
class Growing {
  /** @param {Float32Array | Int32Array | Uint32Array} numbers room for the first */
  constructor(numbers) {
    this.numbers = numbers;
    this.count = 0;
  }

  /** @param {number[]} more */
  push(...more) {
    if (this.count + more.length > this.numbers.length) {
      const Kind = /** @type {any} */ (this.numbers.constructor), larger = new Kind(2 * this.numbers.length);
      larger.set(this.numbers);
      this.numbers = larger;
    }
    for (const number of more) this.numbers[this.count++] = number;
  }

  /** @returns {any} */
  taken() {
    return this.numbers.subarray(0, this.count);
  }
}

/** Finds equal positions. Corners and edges of neighboring patches are computed by the same formulas, so they are equal. */
class Welder {
  /** @param {number} most different positions */
  constructor(most) {
    this.size = 2 ** Math.ceil(Math.log2(2 * most + 16));
    this.slots = new Int32Array(this.size).fill(-1);
    this.bits = new Uint32Array(4 * most);
    this.count = 0;
  }

  /** @param {number} x bits @param {number} y @param {number} z @param {number} cell @param {number} next number of the vertex if it is new @returns {number} */
  find(x, y, z, cell, next) {
    let hash = Math.imul(x, 0x9e3779b1) ^ Math.imul(y, 0x85ebca6b) ^ Math.imul(z, 0xc2b2ae35) ^ cell;
    hash ^= hash >>> 15;
    for (let at = hash & (this.size - 1); ; at = (at + 1) & (this.size - 1)) {
      const known = this.slots[at];
      if (known < 0) {
        this.slots[at] = this.count;
        this.bits.set([x, y, z, next], 4 * this.count);
        this.count++;
        return next;
      }
      const b = 4 * known;
      if (this.bits[b] === x && this.bits[b + 1] === y && this.bits[b + 2] === z) return this.bits[b + 3];
    }
  }
}

/**
 * The surface of all cells at a level: closed, as files of the program are.
 * @param {import('./webgpu.js').WebGpuRenderer | import('./webgl.js').WebGlRenderer} renderer
 * @param {import('./scene.js').Scene} scene @param {number} level
 * @returns {Promise<{ vertices: Float32Array, sections: Int32Array, triangles: Uint32Array }>} six numbers a vertex
 */
export async function surface(renderer, scene, level) {
  const { HIGHEST_LEVEL, PATCH_CAP, PATCH_SOMA } = scene.numbers;
  if (2 * level ** 2 * scene.slots > MAX_TRIANGLES) throw new Error(`level ${level} is too fine for a file of this page: choose a lower one`);
  const room = 1 << 16, vertices = new Growing(new Float32Array(room)), sections = new Growing(new Int32Array(room));
  const triangles = new Growing(new Uint32Array(room));
  let count = 0, cell = -1, welder = new Welder(1);
  for (const part of scene.parts) {
    if (part.cell !== cell) {
      cell = part.cell;
      const slots = scene.parts.filter((other) => other.cell === cell).reduce((sum, other) => sum + other.slots, 0);
      welder = new Welder(slots * 4 * (2 * level + 1));
    }
    for (const range of ranges(part, level, HIGHEST_LEVEL, TOGETHER)) {
      const { first, slots, columns } = range, n = columns - 1;
      const made = await renderer.vertices(part, level, columns, first, slots), bits = new Uint32Array(made.buffer);
      const number = new Uint32Array(columns ** 2);
      for (let patch = 0; patch < slots; patch++) {
        const start = 8 * patch * columns ** 2;
        if (made[start + 7] === 0) continue;
        const kind = Math.floor((made[start + 7] - 1) / KIND_STEP);
        for (let k = 0; k < columns ** 2; k++) {
          const at = start + 8 * k, i = k % columns, j = Math.floor(k / columns);
          const inside = i > 0 && i < n && j > 0 && j < n;
          number[k] = inside ? count : welder.find(bits[at], bits[at + 1], bits[at + 2], cell, count);
          if (number[k] < count) continue;
          count++;
          vertices.push(...scene.inWorld(cell, [made[at], made[at + 1], made[at + 2]]), made[at + 4], made[at + 5], made[at + 6]);
          const section = scene.section[(made[at + 7] - 1) % KIND_STEP];
          sections.push(section === 0xffff ? -1 : section);
        }
        const all = quads(n, n, kind === PATCH_CAP || kind === PATCH_SOMA, (i, j) => number[j * columns + i]);
        for (let k = 0; k < all.length; k += 3) {
          const [a, b, c] = [all[k], all[k + 1], all[k + 2]];
          // Triangles that lie in an edge are none.
          if (a !== b && b !== c && c !== a) triangles.push(a, b, c);
        }
      }
    }
  }
  return { vertices: vertices.taken(), sections: sections.taken(), triangles: triangles.taken() };
}

/** @param {{ vertices: Float32Array, sections: Int32Array, triangles: Uint32Array }} surface @returns {Blob} a binary PLY file */
export function ply({ vertices, sections, triangles }) {
  const count = sections.length, faces = triangles.length / 3;
  const properties = ['x', 'y', 'z', 'nx', 'ny', 'nz'].map((name) => `property float ${name}\n`).join('');
  const header = `ply\nformat binary_little_endian 1.0\ncomment made by a page of neurotess, lengths in micrometers\nelement vertex ${count}\n`
    + `${properties}property int section\nelement face ${faces}\nproperty list uchar int vertex_indices\nend_header\n`;
  const body = new DataView(new ArrayBuffer(28 * count + 13 * faces));
  for (let v = 0; v < count; v++) {
    for (let k = 0; k < 6; k++) body.setFloat32(28 * v + 4 * k, vertices[6 * v + k], true);
    body.setInt32(28 * v + 24, sections[v], true);
  }
  for (let f = 0; f < faces; f++) {
    const at = 28 * count + 13 * f;
    body.setUint8(at, 3);
    for (let k = 0; k < 3; k++) body.setUint32(at + 1 + 4 * k, triangles[3 * f + k], true);
  }
  return new Blob([header, body], { type: 'application/octet-stream' });
}
