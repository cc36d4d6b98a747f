// Draws the cells with WebGPU: selection of levels, light, ambient occlusion, as the renderer's own window does.
//
// A **draft** is one coarse step, drawn at once while something moves; a fine picture is the mean of STEPS steps, each
// offset within the pixel.

import { WebGpuMarkers } from './markers.js';
import { DEPTH, FORMATS, Finisher, Targets } from './finishing.js';
import { DRAW_BYTES, Selection, bindGroup, buffer, bufferLayout, upload } from './selection.js';
import { Struct, clipFromRelative, baseFields, unit, wgsl } from './shaders.js';

/** Steps of a fine picture. */
export const STEPS = 16;
/** Side (pixels) of the square around the pointer that is searched for what is picked. */
const PICKED = 7;

/**
 * What a picture shows, apart from the colors of points.
 * @typedef {object} Look
 * @property {import('./selection.js').Lod} lod
 * @property {boolean} wireframe
 * @property {boolean} occlusion
 * @property {boolean} lit
 * @property {number} leastWidth pixels
 * @property {import('./colors.js').Rgb} background
 * @property {number} pixelRatio pixels of the screen for each of the page
 */

export class WebGpuRenderer {
  /**
   * @param {HTMLCanvasElement} canvas @param {import('./scene.js').Scene} scene @param {any} shaders
   * @param {(message: string) => void} failed
   * @returns {Promise<WebGpuRenderer | null>} null if the browser has no WebGPU
   */
  static async open(canvas, scene, shaders, failed) {
    const adapter = await navigator.gpu?.requestAdapter().catch(() => null);
    if (!adapter) return null;
    const { maxStorageBufferBindingSize, maxBufferSize } = adapter.limits;
    const device = await adapter.requestDevice({ requiredLimits: { maxStorageBufferBindingSize, maxBufferSize } }).catch(() => null);
    if (!device) return null;
    device.lost.then(({ reason, message }) => reason !== 'destroyed' && failed(`The graphics device was lost: ${message}. Reload the page.`));
    device.onuncapturederror = ({ error }) => failed(error.message);
    const renderer = new WebGpuRenderer(device, canvas, scene, shaders);
    await renderer.compile();
    return renderer;
  }

  /** @param {GPUDevice} device @param {HTMLCanvasElement} canvas @param {import('./scene.js').Scene} scene @param {any} shaders */
  constructor(device, canvas, scene, shaders) {
    this.device = device;
    this.canvas = canvas;
    this.scene = scene;
    this.shaders = shaders;
    this.name = 'WebGPU';
    this.selection = new Selection(device, scene, shaders);
    const format = navigator.gpu.getPreferredCanvasFormat();
    this.context = /** @type {GPUCanvasContext} */ (canvas.getContext('webgpu'));
    this.context.configure({ device, format, alphaMode: 'opaque' });
    this.finisher = new Finisher(device, shaders, format);
    const { STORAGE, UNIFORM, COPY_DST } = GPUBufferUsage, { VERTEX, FRAGMENT } = GPUShaderStage;
    this.shade = buffer(device, 'shade', shaders.layouts.Shade.size / 4, UNIFORM | COPY_DST);
    this.table = buffer(device, 'colors', 4 * scene.colors, STORAGE | COPY_DST);
    const states = upload(device, 'states', new Uint32Array(4), STORAGE);
    this.shadeLayout = bufferLayout(device, [[0, VERTEX | FRAGMENT, 'uniform'], [1, VERTEX, 'read-only-storage'], [2, VERTEX, 'read-only-storage']]);
    this.shadeGroup = bindGroup(device, this.shadeLayout, { 0: this.shade, 1: this.table, 2: states });
    /** @type {Targets[]} */
    this.targets = [];
    /** What the lists on the device are for. */
    this.selected = '';
    /** Whether all passes are compiled, so that levels are selected. */
    this.refines = false;
    this.markers = scene.data.markers ? new WebGpuMarkers(device, scene, shaders, this.shadeLayout) : null;
    /** Pipelines that picking needs. @type {Promise<GPURenderPipeline[]> | undefined} */
    this.ids = undefined;
    /** What saving needs. @type {{ layout: GPUBindGroupLayout, pipeline: GPUComputePipeline } | undefined} */
    this.expand = undefined;
    /** @type {GPURenderPipeline[]} */
    this.flat = [];
  }

  /** The same for other cells, on the same device. @param {import('./scene.js').Scene} scene @returns {Promise<WebGpuRenderer>} */
  async replaced(scene) {
    const renderer = new WebGpuRenderer(this.device, this.canvas, scene, this.shaders);
    await renderer.compile();
    return renderer;
  }

  /** Frees what the device holds of the cells. */
  destroy() {
    for (const targets of this.targets) targets.destroy();
    for (const made of [...Object.values(this.selection.buffers), this.shade, this.table]) made.destroy();
  }

  /** Compiles what a picture at level 1 needs, which is drawn until all else is there. */
  async compile() {
    const flat = this.pipelines('draw', ['vertex', 'fragment'], FORMATS, this.shaders.numbers.SAMPLES, [0]);
    await Promise.all([this.selection.compile(true), this.finisher.compile(), this.markers?.compile()]);
    this.flat = await flat;
    this.bundle = this.bundled(this.flat);
  }

  /** Compiles all else. */
  async complete() {
    const others = this.pipelines('draw', ['vertex', 'fragment'], FORMATS, this.shaders.numbers.SAMPLES, [1, 2]);
    await Promise.all([this.selection.compile(false), this.finisher.compileOcclusion()]);
    this.bundle = this.bundled([...this.flat, ...await others]);
    this.refines = true;
    this.selected = '';
  }

  /** All draws, most of them empty, encoded once. @param {GPURenderPipeline[]} pipelines by kind @returns {GPURenderBundle} */
  bundled(pipelines) {
    const bundle = this.device.createRenderBundleEncoder({ colorFormats: FORMATS, depthStencilFormat: DEPTH, sampleCount: this.shaders.numbers.SAMPLES });
    this.encodeDraws(bundle, pipelines);
    return bundle.finish();
  }

  /**
   * @param {string} name of the modules @param {[string, string]} entries @param {GPUTextureFormat[]} formats
   * @param {number} count samples @param {number[]} kinds @returns {Promise<GPURenderPipeline[]>}
   */
  pipelines(name, [vertex, fragment], formats, count, kinds) {
    const { device, shaders } = this;
    const layout = device.createPipelineLayout({ bindGroupLayouts: [this.selection.layouts.drawing, this.shadeLayout] });
    return Promise.all(kinds.map((kind) => {
      const module = device.createShaderModule({ label: name + kind, code: wgsl(shaders, name + kind) });
      return device.createRenderPipelineAsync({ label: name + kind, layout, vertex: { module, entryPoint: vertex },
        fragment: { module, entryPoint: fragment, targets: formats.map((format) => ({ format })) },
        primitive: { cullMode: 'back' }, depthStencil: { format: DEPTH, depthWriteEnabled: true, depthCompare: 'greater' },
        multisample: { count } });
    }));
  }

  /** @param {GPURenderBundleEncoder | GPURenderPassEncoder} pass @param {GPURenderPipeline[]} pipelines by kind */
  encodeDraws(pass, pipelines) {
    const { draws } = this.selection.buffers;
    pass.setBindGroup(0, this.selection.groups.drawing);
    pass.setBindGroup(1, this.shadeGroup);
    this.selection.draws().slice(0, pipelines.length).forEach(([indices, first, end], kind) => {
      pass.setPipeline(pipelines[kind]);
      pass.setIndexBuffer(indices, 'uint32');
      for (let draw = first; draw < end; draw++) pass.drawIndexedIndirect(draws, DRAW_BYTES * draw);
    });
  }

  /** @param {Float32Array} table linear colors by key */
  setColors(table) {
    this.device.queue.writeBuffer(this.table, 0, table);
  }

  /** @param {[number, number]} size @returns {Targets} those of the canvas, or of drafts */
  targetsOf(size) {
    let found = this.targets.find((t) => t.size[0] === size[0] && t.size[1] === size[1]);
    if (!found) {
      // Those of one fine size and one draft are kept.
      if (this.targets.length > 1) for (const old of this.targets.splice(0)) old.destroy();
      found = new Targets(this.device, size, this.shaders.numbers.SAMPLES);
      this.targets.push(found);
    }
    return found;
  }

  /**
   * Writes the uniform of the shading. Twin of `Shade::new`.
   * @param {import('./camera.js').View} view @param {Look} look @param {[number, number]} size of the whole picture
   * @param {[number, number, number, number]} tile @param {number} steps @param {number} step
   */
  writeShade(view, look, size, tile, steps, step) {
    const { GUARD, HALF_WIDTH } = this.shaders.numbers, { right, up, backward, near, slope, flat } = view;
    const side = Math.sqrt(steps), turn = steps > 1 ? [step % side, Math.floor(step / side)] : [0, 0];
    const jitter = steps > 1 ? turn.map((k) => (k + 0.5) / side - 0.5) : [0, 0];
    const [x, y, width, height] = tile, share = size[1] / this.canvas.height * look.pixelRatio;
    this.device.queue.writeBuffer(this.shade, 0, new Struct(this.shaders.layouts.Shade).set({
      clip_from_relative: clipFromRelative(view, size[0] / size[1]), right, near, up, slope, backward, half_width: HALF_WIDTH,
      key: unit(this.shaders.key_light), wire: look.wireframe ? 0.5 * share : 0, size, tile_origin: [x + turn[0], y + turn[1]],
      viewport_origin: [x - GUARD, y - GUARD], viewport_size: [width + 2 * GUARD, height + 2 * GUARD], lit: look.lit ? 1 : 0,
      scale_entries: 0, colors: this.scene.colors, valued: 0, ghosted: 1, jitter, least_half_width: 0.5 * look.leastWidth * share,
      edge: [0, 0, 0, 100], flat, steps, turn,
    }).bytes);
  }

  /** Selects levels, unless the lists are those of this view already. @param {GPUCommandEncoder} encoder @param {import('./camera.js').View} view @param {[number, number]} size @param {Look} look */
  select(encoder, view, size, look) {
    const key = JSON.stringify([view, size, look.lod, look.wireframe]);
    if (key === this.selected) return;
    this.selection.write(view, size, this.refines ? look.lod : { level: 1 }, look.wireframe);
    this.selection.encode(encoder);
    this.selected = key;
  }

  /**
   * Draws one step of a picture and shows what there is of it.
   * @param {import('./camera.js').Camera} camera @param {Look} look
   * @param {{ step: number, steps: number, scale: number }} how `scale`: size of a draft, as a share
   */
  draw(camera, look, { step, steps, scale }) {
    const { device, canvas } = this, { GUARD } = this.shaders.numbers;
    const size = /** @type {[number, number]} */ ([canvas.width, canvas.height].map((n) => Math.max(Math.round(n * scale), 1)));
    const targets = this.targetsOf(size), view = camera.view(size[1]);
    const [width, height] = size;
    this.writeShade(view, look, size, [0, 0, width, height], steps, step);
    const encoder = device.createCommandEncoder();
    this.select(encoder, view, size, look);
    const pass = encoder.beginRenderPass({
      colorAttachments: targets.samples.map((samples, k) => ({ view: samples, loadOp: 'clear', storeOp: k ? 'store' : 'discard',
        clearValue: [0, 0, 0, 0], resolveTarget: k ? undefined : targets.resolved })),
      depthStencilAttachment: { view: targets.depth, depthClearValue: 0, depthLoadOp: 'clear', depthStoreOp: 'discard' } });
    pass.setViewport(-GUARD, -GUARD, width + 2 * GUARD, height + 2 * GUARD, 0, 1);
    pass.executeBundles([/** @type {GPURenderBundle} */ (this.bundle)]);
    this.markers?.draw(pass, view, this.shadeGroup);
    pass.end();
    this.finisher.finish(encoder, targets, view, { step, steps, occlusion: look.occlusion && steps > 1, background: look.background });
    this.finisher.show(encoder, targets, this.context.getCurrentTexture());
    device.queue.submit([encoder.finish()]);
  }

  /** When everything that was asked for is done. @returns {Promise<void>} */
  async done() {
    await this.device.queue.onSubmittedWorkDone();
  }

  /**
   * The color key of what is drawn at a place, or near it; -1 if nothing is.
   * @param {import('./camera.js').Camera} camera @param {Look} look @param {number} x pixels of the canvas @param {number} y
   * @returns {Promise<number>}
   */
  async pick(camera, look, x, y) {
    const { device, canvas } = this, { GUARD } = this.shaders.numbers;
    if (!this.refines) return -1;
    this.ids ??= this.pipelines('id', ['vertex_id', 'fragment_id'], ['rg32uint'], 1, [0, 1, 2]);
    const pipelines = await this.ids;
    const size = /** @type {[number, number]} */ ([canvas.width, canvas.height]), view = camera.view(size[1]);
    const tile = /** @type {[number, number, number, number]} */ ([Math.floor(x) - (PICKED >> 1), Math.floor(y) - (PICKED >> 1), PICKED, PICKED]);
    this.writeShade(view, look, size, tile, 1, 0);
    const { RENDER_ATTACHMENT, COPY_SRC } = GPUTextureUsage, { COPY_DST, MAP_READ } = GPUBufferUsage;
    const texture = device.createTexture({ size: [PICKED, PICKED], format: 'rg32uint', usage: RENDER_ATTACHMENT | COPY_SRC });
    const depth = device.createTexture({ size: [PICKED, PICKED], format: DEPTH, usage: RENDER_ATTACHMENT });
    const read = buffer(device, 'ids', 64 * PICKED, COPY_DST | MAP_READ);
    const encoder = device.createCommandEncoder();
    this.select(encoder, view, size, look);
    const pass = encoder.beginRenderPass({
      colorAttachments: [{ view: texture.createView(), loadOp: 'clear', storeOp: 'store', clearValue: [0, 0, 0, 0] }],
      depthStencilAttachment: { view: depth.createView(), depthClearValue: 0, depthLoadOp: 'clear', depthStoreOp: 'discard' } });
    pass.setViewport(-GUARD, -GUARD, PICKED + 2 * GUARD, PICKED + 2 * GUARD, 0, 1);
    this.encodeDraws(pass, pipelines);
    pass.end();
    encoder.copyTextureToBuffer({ texture }, { buffer: read, bytesPerRow: 256 }, [PICKED, PICKED]);
    device.queue.submit([encoder.finish()]);
    await read.mapAsync(GPUMapMode.READ);
    const ids = new Uint32Array(read.getMappedRange()).slice();
    for (const made of [texture, depth, read]) made.destroy();
    return nearest((column, row) => (ids[64 * row + 2 * column] ? ids[64 * row + 2 * column + 1] & 0x7fffffff : -1));
  }

  /** Triangles that the last frame drew. @returns {Promise<number>} */
  async triangles() {
    const draws = new Uint32Array(await this.readBack(this.selection.buffers.draws));
    let triangles = 0;
    for (let k = 0; k < draws.length; k += DRAW_BYTES / 4) triangles += draws[k] * draws[k + 1] / 3;
    return triangles;
  }

  /** @param {GPUBuffer} from @param {number} [bytes] @returns {Promise<ArrayBuffer>} */
  async readBack(from, bytes = from.size) {
    const copy = buffer(this.device, 'read back', bytes / 4, GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ);
    const encoder = this.device.createCommandEncoder();
    encoder.copyBufferToBuffer(from, 0, copy, 0, bytes);
    this.device.queue.submit([encoder.finish()]);
    await copy.mapAsync(GPUMapMode.READ);
    const read = copy.getMappedRange().slice(0);
    copy.destroy();
    return read;
  }

  /**
   * Vertices of a range of a part's slots at one level: see even.wgsl.
   * @param {import('./scene.js').Part} part @param {number} level @param {number} columns @param {number} first slot
   * @param {number} slots @returns {Promise<Float32Array>} eight numbers for each vertex
   */
  async vertices(part, level, columns, first, slots) {
    const { device, shaders } = this, { STORAGE, COPY_SRC, UNIFORM, COPY_DST } = GPUBufferUsage, { COMPUTE } = GPUShaderStage;
    const count = slots * columns * columns;
    if (!this.expand) {
      const layout = bufferLayout(device, [[0, COMPUTE, 'read-only-storage'], [1, COMPUTE, 'uniform'], [2, COMPUTE, 'storage']]);
      const module = device.createShaderModule({ label: 'expand', code: wgsl(shaders, 'expand') });
      this.expand = { layout, pipeline: await device.createComputePipelineAsync({ label: 'expand',
        layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }), compute: { module, entryPoint: 'expand' } }) };
    }
    const { layout, pipeline } = this.expand;
    const uniform = buffer(device, 'even', shaders.layouts.Even.size / 4, UNIFORM | COPY_DST);
    const made = buffer(device, 'vertices', 8 * count, STORAGE | COPY_SRC);
    device.queue.writeBuffer(uniform, 0, new Struct(shaders.layouts.Even).set({ ...baseFields(part.base), level, columns,
      first_slot: first, slots: part.slots, vertices: count }).bytes);
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, bindGroup(device, layout, { 0: this.selection.buffers.packed, 1: uniform, 2: made }));
    const groups = Math.ceil(count / 64), across = Math.min(groups, 1024);
    pass.dispatchWorkgroups(across, Math.ceil(groups / across));
    pass.end();
    device.queue.submit([encoder.finish()]);
    const read = new Float32Array(await this.readBack(made, 32 * count));
    for (const old of [uniform, made]) old.destroy();
    return read;
  }
}

/**
 * What is nearest to the middle of a square of ids.
 * @param {(column: number, row: number) => number} at -1 where nothing is @param {number} [side] @returns {number}
 */
export function nearest(at, side = PICKED) {
  let best = -1, least = 1e9;
  for (let row = 0; row < side; row++) {
    for (let column = 0; column < side; column++) {
      const id = at(column, row), away = (column - (side >> 1)) ** 2 + (row - (side >> 1)) ** 2;
      if (id >= 0 && away < least) [best, least] = [id, away];
    }
  }
  return best;
}
