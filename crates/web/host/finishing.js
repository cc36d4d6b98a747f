// What comes after the drawing: ambient occlusion, the mean of several steps, and the way to the canvas. Twins:
// finish.rs, targets.rs, progressive/step.rs.

import { linear } from './colors.js';
import { Struct, wgsl } from './shaders.js';
import { bindGroup, buffer } from './selection.js';

/** Color, normal, depth: see shade.rs. @type {GPUTextureFormat[]} */
export const FORMATS = ['rgba16float', 'rgba8unorm', 'rgba8unorm'];
export const DEPTH = 'depth32float';
/** Lists of blocks: see blocks.wgsl. */
const COVERED = 0, OCCLUDED = 16;
/** Occlusion reaches this share of the picture's height, at most so many pixels: see options.rs. */
const REACH = 0.08, MOST = 0.09, MAX_PIXELS = 360;

/** Textures and buffers of one size. */
export class Targets {
  /** @param {GPUDevice} device @param {[number, number]} size pixels @param {number} samples */
  constructor(device, size, samples) {
    const { RENDER_ATTACHMENT, TEXTURE_BINDING } = GPUTextureUsage;
    const { STORAGE, COPY_DST, INDIRECT } = GPUBufferUsage;
    this.size = size;
    /** @type {GPUTexture[]} */
    this.textures = [];
    const texture = (/** @type {GPUTextureFormat} */ format, /** @type {number} */ sampleCount, /** @type {number} */ usage) => {
      const made = device.createTexture({ size, format, sampleCount, usage });
      this.textures.push(made);
      return made.createView();
    };
    const read = RENDER_ATTACHMENT | TEXTURE_BINDING;
    this.samples = FORMATS.map((format, k) => texture(format, samples, k ? read : RENDER_ATTACHMENT));
    this.resolved = texture(FORMATS[0], 1, read);
    this.depth = texture(DEPTH, samples, RENDER_ATTACHMENT);
    const pixels = size[0] * size[1], blocks = Math.ceil(size[0] / 8) * Math.ceil(size[1] / 8);
    this.raw = buffer(device, 'occlusion', 2 * pixels, STORAGE | COPY_DST);
    this.blurred = buffer(device, 'occlusion', pixels, STORAGE);
    this.pixels = buffer(device, 'pixels', pixels, STORAGE);
    this.blocks = buffer(device, 'blocks', 4 * blocks, STORAGE | COPY_DST);
    this.dispatches = buffer(device, 'dispatches', 12, STORAGE | COPY_DST | INDIRECT);
    this.sums = buffer(device, 'sums', 4 * pixels, STORAGE);
  }

  destroy() {
    for (const texture of this.textures) texture.destroy();
    for (const made of [this.raw, this.blurred, this.pixels, this.blocks, this.dispatches, this.sums]) made.destroy();
  }
}

export class Finisher {
  /** @param {GPUDevice} device @param {any} shaders @param {GPUTextureFormat} format of the canvas */
  constructor(device, shaders, format) {
    this.device = device;
    this.shaders = shaders;
    this.format = format;
    const { COMPUTE, FRAGMENT } = GPUShaderStage;
    /** @type {GPUBindGroupLayoutEntry[]} */
    const entries = [{ binding: 0, visibility: COMPUTE, buffer: { type: 'uniform' } }];
    for (const binding of [1, 2, 3]) {
      entries.push({ binding, visibility: COMPUTE, texture: { sampleType: 'unfilterable-float', multisampled: binding > 1 } });
    }
    for (const binding of [4, 5, 6, 7, 8]) entries.push({ binding, visibility: COMPUTE, buffer: { type: 'storage' } });
    this.layout = device.createBindGroupLayout({ entries });
    this.dispatchLayout = device.createBindGroupLayout({ entries: [{ binding: 0, visibility: COMPUTE, buffer: { type: 'storage' } }] });
    this.presentLayout = device.createBindGroupLayout({ entries: [
      { binding: 0, visibility: FRAGMENT, buffer: { type: 'uniform' } },
      { binding: 1, visibility: FRAGMENT, buffer: { type: 'read-only-storage' } }] });
    const { UNIFORM, COPY_DST } = GPUBufferUsage;
    this.uniform = buffer(device, 'finish', shaders.layouts.Finish.size / 4, UNIFORM | COPY_DST);
    this.presented = buffer(device, 'present', shaders.layouts.Presented.size / 4, UNIFORM | COPY_DST);
    this.module = device.createShaderModule({ label: 'finish', code: wgsl(shaders, 'finish') });
    /** @type {Record<string, GPUComputePipeline>} */
    this.passes = {};
    /** @type {WeakMap<Targets, [GPUBindGroup, GPUBindGroup, GPUBindGroup]>} */
    this.groups = new WeakMap();
  }

  /** Compiles what every picture needs. */
  async compile() {
    const { device, shaders, format } = this;
    const module = device.createShaderModule({ label: 'present', code: wgsl(shaders, 'present') });
    const present = device.createRenderPipelineAsync({ label: 'present',
      layout: device.createPipelineLayout({ bindGroupLayouts: [this.presentLayout] }),
      vertex: { module, entryPoint: 'corner' }, fragment: { module, entryPoint: 'show', targets: [{ format }] } });
    await this.pass('accumulate');
    this.present = await present;
  }

  /** Compiles what fine pictures need, too. */
  async compileOcclusion() {
    await Promise.all(['find_blocks', 'copy_depths', 'occlude', 'blur_rows', 'blur_columns'].map((name) => this.pass(name)));
    this.occludes = true;
  }

  /** @param {string} entryPoint */
  async pass(entryPoint) {
    const groups = entryPoint === 'find_blocks' ? [this.layout, this.dispatchLayout] : [this.layout];
    const layout = this.device.createPipelineLayout({ bindGroupLayouts: groups });
    this.passes[entryPoint] = await this.device.createComputePipelineAsync({ label: entryPoint, layout, compute: { module: this.module, entryPoint } });
  }

  /** @param {Targets} t @returns {[GPUBindGroup, GPUBindGroup, GPUBindGroup]} */
  groupsOf(t) {
    let groups = this.groups.get(t);
    if (!groups) {
      groups = [bindGroup(this.device, this.layout, { 0: this.uniform, 1: t.resolved, 2: t.samples[1], 3: t.samples[2], 4: t.raw,
        5: t.blurred, 6: t.pixels, 7: t.blocks, 8: t.sums }), bindGroup(this.device, this.dispatchLayout, { 0: t.dispatches }),
      bindGroup(this.device, this.presentLayout, { 0: this.presented, 1: t.pixels })];
      this.groups.set(t, groups);
    }
    return groups;
  }

  /**
   * Encodes the end of a step of a picture.
   * @param {GPUCommandEncoder} encoder @param {Targets} targets @param {import('./camera.js').View} view
   * @param {{ step: number, steps: number, occlusion: boolean, background: import('./colors.js').Rgb }} how
   */
  finish(encoder, targets, view, { step, steps, occlusion, background }) {
    const { size } = targets, [red, green, blue] = background;
    const radius = occlusion && this.occludes ? REACH * 2 * view.halfHeight : 0;
    this.device.queue.writeBuffer(this.uniform, 0, new Struct(this.shaders.layouts.Finish).set({
      tile_size: size, tile_origin: [0, 0], half_size: size.map((n) => n / 2), slope: view.slope, flat: view.flat, scale: 1,
      radius, most: Math.ceil(Math.min(MOST * size[1], MAX_PIXELS)), tiled: 0, clear: steps === 1 ? 1 : 0, kept: size, spare: step,
      empty: red | (green << 8) | (blue << 16) | (255 << 24), background: [...background.map(linear), 1], inset: [0, 0],
    }).bytes);
    const [group, dispatches] = this.groupsOf(targets);
    // Steps lie within the same pixel, so occlusion is computed once for all of them.
    const occludes = radius > 0 && step === 0;
    if (occludes) for (const cleared of [targets.raw, targets.blocks, targets.dispatches]) encoder.clearBuffer(cleared);
    const pass = encoder.beginComputePass();
    pass.setBindGroup(0, group);
    if (occludes) {
      pass.setBindGroup(1, dispatches);
      pass.setPipeline(this.passes.find_blocks);
      pass.dispatchWorkgroups(Math.ceil(Math.ceil(size[0] / 8) / 8), Math.ceil(Math.ceil(size[1] / 8) / 8));
      for (const [name, list] of /** @type {[string, number][]} */ ([['copy_depths', COVERED], ['occlude', OCCLUDED],
        ['blur_rows', OCCLUDED], ['blur_columns', OCCLUDED]])) {
        pass.setPipeline(this.passes[name]);
        pass.dispatchWorkgroupsIndirect(targets.dispatches, list);
      }
    }
    pass.setPipeline(this.passes.accumulate);
    pass.dispatchWorkgroups(Math.ceil(size[0] / 8), Math.ceil(size[1] / 8));
    pass.end();
  }

  /** Shows a picture. @param {GPUCommandEncoder} encoder @param {Targets} targets @param {GPUTexture} canvas */
  show(encoder, targets, canvas) {
    this.device.queue.writeBuffer(this.presented, 0, new Struct(this.shaders.layouts.Presented).set({
      size: targets.size, canvas: [canvas.width, canvas.height] }).bytes);
    const pass = encoder.beginRenderPass({ colorAttachments: [{ view: canvas.createView(), loadOp: 'clear', storeOp: 'store' }] });
    pass.setPipeline(/** @type {GPURenderPipeline} */ (this.present));
    pass.setBindGroup(0, this.groupsOf(targets)[2]);
    pass.draw(3);
    pass.end();
  }
}
