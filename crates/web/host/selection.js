// Selection of levels on the device: buffers, and the passes of crates/render/src/sources/adaptive. Twins: work.rs,
// batch.rs, passes.rs, grids.rs, layouts.rs. All parts of all cells are one batch.

import { Struct, baseFields, rows, unit, wgsl } from './shaders.js';
import { along, dot, minus } from './vectors.js';

/** Bytes of the arguments of a draw. */
export const DRAW_BYTES = 20;
const QUEUES = 3;
/** Passes that have nothing to do at level 1: in software they take most of the time to compile. */
const ONLY_REFINED = ['level_rings', 'decide_tubes', 'decide_singles', 'scatter'];

/**
 * The grids that patches are drawn in, with the indices that draw them.
 * @param {number[]} sizes @param {Record<string, number>} numbers
 */
function grids(sizes, numbers) {
  const { INDEX_BUCKET_SHIFT, INDEX_PATCH_SHIFT, INDEX_ROW_SHIFT, VERTICES_TOGETHER } = numbers;
  const all = [false, false, true].flatMap((round) => sizes.flatMap((ny) => sizes.map((nx) => {
    const together = Math.max(Math.floor(VERTICES_TOGETHER / ((nx + 1) * (ny + 1))), 1);
    return { nx, ny, round, together, count: 6 * nx * ny * together };
  })));
  const buckets = new Uint32Array(5 * all.length);
  const indices = new Uint32Array(all.reduce((sum, grid) => sum + grid.count, 0));
  let n = 0;
  all.forEach(({ nx, ny, round, together, count }, bucket) => {
    buckets.set([0, 0, together, count, n], 5 * bucket);
    for (let patch = 0; patch < together; patch++) {
      const at = (/** @type {number} */ i, /** @type {number} */ j) =>
        ((bucket << INDEX_BUCKET_SHIFT) | (patch << INDEX_PATCH_SHIFT) | (j << INDEX_ROW_SHIFT) | i) >>> 0;
      for (const index of quads(nx, ny, round, at)) indices[n++] = index;
    }
  });
  return { buckets, indices };
}

/**
 * Indices of a grid of quads in two triangles each; on round patches diagonals run towards the corners.
 * @param {number} nx @param {number} ny @param {boolean} round @param {(i: number, j: number) => number} at
 * @returns {number[]}
 */
export function quads(nx, ny, round, at) {
  const all = [];
  for (let j = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++) {
      const [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
      if (round && (2 * i < nx) !== (2 * j < ny)) all.push(a, b, d, b, c, d);
      else all.push(a, b, c, a, c, d);
    }
  }
  return all;
}

/**
 * @param {GPUDevice} device @param {string} label @param {number} words @param {number} usage
 * @returns {GPUBuffer}
 */
export const buffer = (device, label, words, usage) => device.createBuffer({ label, size: Math.max(4 * words, 16), usage });

/**
 * @param {GPUDevice} device @param {string} label @param {ArrayBufferView & { byteLength: number }} data @param {number} usage
 * @returns {GPUBuffer}
 */
export function upload(device, label, data, usage) {
  const made = buffer(device, label, data.byteLength / 4, usage | GPUBufferUsage.COPY_DST);
  device.queue.writeBuffer(made, 0, /** @type {any} */ (data));
  return made;
}

/**
 * @param {GPUDevice} device @param {GPUBindGroupLayout} layout @param {Record<number, GPUBuffer | GPUTextureView>} entries
 * @returns {GPUBindGroup}
 */
export const bindGroup = (device, layout, entries) => device.createBindGroup({ layout, entries: Object.entries(entries)
  .map(([binding, thing]) => ({ binding: +binding, resource: thing instanceof GPUBuffer ? { buffer: thing } : thing })) });

/**
 * @param {GPUDevice} device @param {[number, number, GPUBufferBindingType][]} entries binding, stages, type
 * @returns {GPUBindGroupLayout}
 */
export const bufferLayout = (device, entries) => device.createBindGroupLayout({ entries: entries
  .map(([binding, visibility, type]) => ({ binding, visibility, buffer: { type } })) });

/** What decides on levels: the same everywhere, or an error in pixels. @typedef {{ level: number } | { pixels: number }} Lod */

export class Selection {
  /** @param {GPUDevice} device @param {import('./scene.js').Scene} scene @param {any} shaders */
  constructor(device, scene, shaders) {
    this.device = device;
    this.scene = scene;
    this.shaders = shaders;
    const { CLUSTER, SECTION, QUEUE_U32S, BUCKETS, FLAT_INDICES } = this.numbers = shaders.numbers;
    this.clusters = scene.slots / CLUSTER;
    this.sections = Math.ceil(scene.slots / SECTION);
    const room = this.sections * SECTION, clusters = room / CLUSTER;
    const { buckets, indices } = grids(shaders.grid_sizes, shaders.numbers);
    const { STORAGE, UNIFORM, INDIRECT, INDEX, COPY_DST, COPY_SRC } = GPUBufferUsage;
    const make = (/** @type {string} */ label, /** @type {number} */ words, /** @type {number} */ usage) => buffer(device, label, words, usage);
    const dispatches = () => make('dispatches', 3 * QUEUES, STORAGE | INDIRECT | COPY_DST);
    this.placedSize = shaders.layouts.Placed.size;
    this.buffers = {
      packed: upload(device, 'packed', scene.packed, STORAGE),
      buckets: upload(device, 'buckets', buckets, STORAGE),
      indices: upload(device, 'grid indices', indices, INDEX),
      none: upload(device, 'no workgroups', new Uint32Array([0, 1, 1, 0, 1, 1, 0, 1, 1]), COPY_SRC),
      batch: upload(device, 'batch', new Uint32Array([0, scene.parts.length, scene.slots, this.clusters, this.sections, scene.explicit]), UNIFORM),
      frame: make('frame', shaders.layouts.Frame.size / 4, UNIFORM | COPY_DST),
      placed: make('placed', this.placedSize / 4 * scene.parts.length, STORAGE | COPY_DST),
      owners: make('owners', clusters, STORAGE),
      queues: make('queues', QUEUE_U32S * clusters + this.sections, STORAGE),
      marks: make('marks', 3 + 3 * clusters + (1 + BUCKETS) * this.sections, STORAGE | COPY_DST),
      cluster: dispatches(),
      single: dispatches(),
      noted: dispatches(),
      decisions: make('decisions', room, STORAGE),
      ringLevels: make('ring levels', room / 4, STORAGE | COPY_DST),
      coarse: make('coarse', 8 * (room / 4 + 2 * scene.explicit), STORAGE),
      list: make('list', 2 * room, STORAGE),
      flat: make('flat patches', FLAT_INDICES * room, STORAGE | INDEX),
      draws: make('draws', DRAW_BYTES / 4 * (1 + BUCKETS), STORAGE | INDIRECT | COPY_SRC),
    };
    /** @type {Record<string, GPUShaderModule>} */
    this.modules = {};
    /** @type {Record<string, GPUComputePipeline>} */
    this.pipelines = {};
    const b = this.buffers;
    const { COMPUTE, VERTEX } = GPUShaderStage;
    const read = 'read-only-storage', write = 'storage';
    this.layouts = {
      page: bufferLayout(device, [[0, COMPUTE, read]]),
      clusters: bufferLayout(device, [[0, COMPUTE, 'uniform'], [1, COMPUTE, 'uniform'], [2, COMPUTE, read], [3, COMPUTE, write],
        [4, COMPUTE, write], [5, COMPUTE, write]]),
      written: [1, 2, 3].map((n) => bufferLayout(device, [0, 1, 2].slice(0, n).map((k) => [k, COMPUTE, write]))),
      drawing: bufferLayout(device, [[0, VERTEX, read], [4, VERTEX, 'uniform'],
        ...[5, 6, 7, 8, 9].map((k) => /** @type {[number, number, GPUBufferBindingType]} */ ([k, VERTEX, read]))]),
    };
    const written = (/** @type {GPUBuffer[]} */ ...all) => bindGroup(device, this.layouts.written[all.length - 1], { ...all });
    this.groups = {
      page: bindGroup(device, this.layouts.page, { 0: b.packed }),
      clusters: bindGroup(device, this.layouts.clusters, { 0: b.frame, 1: b.batch, 2: b.placed, 3: b.owners, 4: b.queues, 5: b.marks }),
      drawing: bindGroup(device, this.layouts.drawing, { 0: b.packed, 4: b.frame, 5: b.placed, 6: b.owners, 7: b.list, 8: b.buckets, 9: b.coarse }),
    };
    const decide = written(b.decisions, b.ringLevels, b.single);
    const coarse = written(b.coarse), scan = written(b.buckets, b.draws);
    const lanes = (/** @type {number} */ count) => Math.ceil(count / this.numbers.CLUSTER);
    const { QUEUE_PLAIN, QUEUE_ASKED, QUEUE_SHOWN, QUEUE_SECTIONS, QUEUE_RINGS } = this.numbers;
    /**
     * The passes in their order: entry point, group 2, and workgroups or a buffer with their number and its queue.
     * @type {[string, GPUBindGroup, number | GPUBuffer, number?][]}
     */
    this.steps = [
      ['classify', written(b.cluster, b.single), lanes(this.clusters)],
      ['decide_plain', decide, b.cluster, QUEUE_PLAIN],
      ['level_rings', decide, b.cluster, QUEUE_ASKED],
      ['decide_tubes', decide, b.cluster, QUEUE_ASKED],
      ['decide_singles', written(b.decisions, b.ringLevels), b.single, 0],
      ['note', written(b.decisions, b.noted), b.cluster, QUEUE_SHOWN],
      ['make_rings', coarse, b.noted, QUEUE_RINGS],
      ['make_explicit', coarse, lanes(this.scene.explicit)],
      ['scan_marks', scan, BUCKETS + 1],
      ['scan_buckets', scan, 1],
      ['flatten', written(b.decisions, b.flat), b.cluster, QUEUE_SHOWN],
      ['scatter', written(b.decisions, b.list, b.buckets), b.noted, QUEUE_SECTIONS],
    ];
  }

  /** Compiles passes: those that level 1 needs, or the others. @param {boolean} first */
  async compile(first) {
    const { device, shaders } = this;
    const wanted = shaders.selection.filter((/** @type {[string, string, number]} */ [, entry]) => first === !ONLY_REFINED.includes(entry));
    await Promise.all(wanted.map(async (/** @type {[string, string, number]} */ [name, entryPoint, count]) => {
      const module = this.modules[name] ??= device.createShaderModule({ label: name, code: wgsl(shaders, name) });
      const layout = device.createPipelineLayout({ bindGroupLayouts: [this.layouts.page, this.layouts.clusters, this.layouts.written[count - 1]] });
      this.pipelines[entryPoint] = await device.createComputePipelineAsync({ label: entryPoint, layout, compute: { module, entryPoint } });
    }));
  }

  /**
   * Writes what a frame depends on.
   * @param {import('./camera.js').View} view @param {[number, number]} size pixels @param {Lod} lod
   * @param {boolean} wire whether vertices know their place in their grid
   */
  write(view, [width, height], lod, wire) {
    const { scene, device, buffers: b, numbers, shaders } = this;
    const { eye, right, up, backward, slope, flat, near } = view;
    const frame = new Struct(shaders.layouts.Frame).set({
      planes: planes(view, width / height), slope, flat, smallest: 0,
      flat_indices: wire ? numbers.FLAT_CORNERS : numbers.FLAT_PLACES, first_explicit: scene.slots,
      'levels.kind': 'level' in lod ? numbers.LEVELS_HOMOGENEOUS : numbers.LEVELS_PIXEL_ERROR,
      'levels.level': 'level' in lod ? lod.level : 1, 'levels.amount': 'pixels' in lod ? lod.pixels : 0,
      'levels.path': numbers.PATH_HERMITE, 'levels.caps': numbers.CAPS_ROUND,
    });
    device.queue.writeBuffer(b.frame, 0, frame.bytes);
    const placed = new ArrayBuffer(this.placedSize * scene.parts.length);
    scene.parts.forEach((part, k) => {
      const cell = scene.cells[part.cell], scale = scene.scale(part.cell);
      const inCell = (/** @type {import('./vectors.js').Vector} */ v) => [0, 1, 2].map((column) =>
        dot(v, /** @type {any} */ (cell.linear.map((/** @type {number[]} */ row) => row[column]))) / scale);
      new Struct(shaders.layouts.Placed, placed, this.placedSize * k).set({
        ...rows(cell, eye), eye: inCell(minus(eye, cell.translation)).map((v) => v / scale), scale,
        forward: inCell(along([0, 0, 0], backward, -1)), near: near / scale, ...baseFields(part.base),
        first_slot: part.firstSlot, patches: part.slots, instance: 0, state: 0, first_explicit: part.firstExplicit,
      });
    });
    device.queue.writeBuffer(b.placed, 0, placed);
  }

  /** Encodes the passes that are compiled. @param {GPUCommandEncoder} encoder */
  encode(encoder) {
    const { buffers: b, groups } = this;
    encoder.clearBuffer(b.marks);
    encoder.clearBuffer(b.ringLevels);
    for (const dispatches of [b.cluster, b.single, b.noted]) encoder.copyBufferToBuffer(b.none, 0, dispatches, 0, b.none.size);
    const pass = encoder.beginComputePass();
    pass.setBindGroup(0, groups.page);
    pass.setBindGroup(1, groups.clusters);
    for (const [entry, group, count, queue] of this.steps) {
      if (!this.pipelines[entry]) continue;
      pass.setPipeline(this.pipelines[entry]);
      pass.setBindGroup(2, group);
      if (typeof count === 'number') pass.dispatchWorkgroups(count);
      else pass.dispatchWorkgroupsIndirect(count, 12 * /** @type {number} */ (queue));
    }
    pass.end();
  }

  /** What a draw of each kind takes: the index buffer, and the first and last of its arguments. @returns {[GPUBuffer, number, number][]} */
  draws() {
    const { flat, indices } = this.buffers, tubes = this.shaders.grid_sizes.length ** 2;
    return [[flat, 0, 1], [indices, 1, 1 + tubes], [indices, 1 + tubes, 1 + this.numbers.BUCKETS]];
  }
}

/**
 * Planes of the frustum relative to the eye, unit normals inwards. Twin of `Camera::frustum`.
 * @param {import('./camera.js').View} view @param {number} aspect @returns {number[]}
 */
function planes({ right, up, backward, tan, orthographic, halfHeight, near }, aspect) {
  const side = (/** @type {import('./vectors.js').Vector} */ axis, /** @type {number} */ sign, /** @type {number} */ wide) => {
    const own = axis.map((v) => sign * v);
    if (orthographic) return [...own, halfHeight * wide];
    return [...unit(own.map((v, k) => v - backward[k] * tan * wide)), 0];
  };
  return [...side(right, 1, aspect), ...side(right, -1, aspect), ...side(up, 1, 1), ...side(up, -1, 1),
    ...backward.map((v) => -v), -near];
}
