// Draws the cells with WebGL 2, where there is no WebGPU: at one level everywhere, since there are no passes that
// select levels. The packed mesh is a texture; the card makes the vertices of a level once, by transform feedback, and
// keeps them as long as they fit.

import { WebGlMarkers } from './markers.js';
import { nearest } from './webgpu.js';
import { Struct, baseFields, clipFromRelative, rows, unit } from './shaders.js';
import { quads } from './selection.js';
import { ranges } from './ranges.js';
import { Shadows } from './shadows.js';

/** Numbers in a row of a texture: see texture_source.rs. */
const ROW = 1024;
/** Vertices that are made and drawn together, and the most that are kept. */
const TOGETHER = 1 << 18, MAX_KEPT = 1 << 23;
const PICKED = 7;
const BYTES = 32;

/** @typedef {import('./ranges.js').Range & { buffer: WebGLBuffer, made: boolean }} Stretch */

export class WebGlRenderer {
  /**
   * @param {HTMLCanvasElement} canvas @param {import('./scene.js').Scene} scene @param {any} shaders
   * @param {(message: string) => void} failed @returns {WebGlRenderer | null} null if there is no WebGL 2
   */
  static open(canvas, scene, shaders, failed) {
    const gl = canvas.getContext('webgl2', { antialias: true, alpha: false, preserveDrawingBuffer: true });
    if (!gl) return null;
    canvas.addEventListener('webglcontextlost', () => failed('The graphics device was lost: reload the page.'));
    return new WebGlRenderer(gl, canvas, scene, shaders);
  }

  /** The same for other cells. @param {import('./scene.js').Scene} scene @returns {Promise<WebGlRenderer>} */
  async replaced(scene) {
    return new WebGlRenderer(this.gl, this.canvas, scene, this.shaders);
  }

  /** Frees what the device holds of the cells. */
  destroy() {
    this.gl.deleteTexture(this.packed);
    for (const { buffer } of this.stretches) this.gl.deleteBuffer(buffer);
  }

  /** @param {WebGL2RenderingContext} gl @param {HTMLCanvasElement} canvas @param {import('./scene.js').Scene} scene @param {any} shaders */
  constructor(gl, canvas, scene, shaders) {
    this.gl = gl;
    this.canvas = canvas;
    this.scene = scene;
    this.shaders = shaders;
    this.name = 'WebGL 2';
    const { capture, kept, ids, dots } = shaders.glsl;
    this.programs = {
      capture: this.program(capture, capture, ['_vs2fs_location0', '_vs2fs_location1']),
      draw: this.program(kept, kept),
      ids: this.program(kept, ids),
    };
    this.uniforms = /** @type {WebGLBuffer} */ (gl.createBuffer());
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.uniforms);
    const packed = new Uint32Array(ROW * Math.ceil(scene.packed.length / ROW));
    packed.set(scene.packed);
    this.packed = this.texture(gl.R32UI, gl.RED_INTEGER, gl.UNSIGNED_INT, packed, packed.length);
    this.feedback = gl.createTransformFeedback();
    this.none = gl.createVertexArray();
    this.drawn = gl.createVertexArray();
    /** Index buffers by columns, kind of triangles and whether they are lines. @type {Map<string, { buffer: WebGLBuffer, ofPatch: number }>} */
    this.grids = new Map();
    /** @type {Stretch[]} */
    this.stretches = [];
    this.level = 0;
    this.keeps = true;
    /** Radius (µm) of the thickest part. */
    this.thickest = scene.radius.reduce((most, radius) => Math.max(most, radius), 0) || 5;
    /** @type {WebGLFramebuffer | undefined} */
    this.ids = undefined;
    /** Made when they are first asked for. @type {Shadows | undefined} */
    this.shadows = undefined;
    this.markers = scene.data.markers ? new WebGlMarkers(gl, scene, this.program(dots, kept)) : null;
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.GREATER);
    gl.clearDepth(0);
  }

  /** @param {any} vertex @param {any} fragment @param {string[]} [captured] @returns {WebGLProgram} */
  program(vertex, fragment, captured) {
    const { gl } = this, program = /** @type {WebGLProgram} */ (gl.createProgram());
    const both = /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, vertex.vertex], [gl.FRAGMENT_SHADER, fragment.fragment]]);
    const shaders = both.map(([type, text]) => {
      const shader = /** @type {WebGLShader} */ (gl.createShader(type));
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    if (captured) gl.transformFeedbackVaryings(program, captured, gl.INTERLEAVED_ATTRIBS);
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new Error([...shaders.map((shader) => gl.getShaderInfoLog(shader)), gl.getProgramInfoLog(program)].join(' '));
    }
    gl.useProgram(program);
    for (const name of ['even', 'shade', 'finish'].flatMap((own) => [...vertex.names[own] ?? [], ...fragment.names[own] ?? []])) {
      const block = gl.getUniformBlockIndex(program, name);
      if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, block, 0);
    }
    for (const name of [...vertex.names.packed_texels ?? [], ...vertex.names.table ?? []]) gl.uniform1i(gl.getUniformLocation(program, name), 0);
    return program;
  }

  /**
   * @param {number} internal @param {number} format @param {number} type @param {ArrayBufferView} data
   * @param {number} texels @returns {WebGLTexture}
   */
  texture(internal, format, type, data, texels) {
    const { gl } = this, texture = /** @type {WebGLTexture} */ (gl.createTexture());
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, internal, ROW, texels / ROW, 0, format, type, data);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  /** @param {Float32Array} table linear colors by key */
  setColors(table) {
    const { gl } = this, texels = ROW * Math.ceil(table.length / 4 / ROW), data = new Float32Array(4 * texels);
    data.set(table);
    if (this.table) gl.deleteTexture(this.table);
    this.table = this.texture(gl.RGBA32F, gl.RGBA, gl.FLOAT, data, texels);
  }

  /** The level that a picture has: chosen, or so that the thickest parts are round. @param {import('./camera.js').View} view @param {import('./webgpu.js').Look} look @param {number} distance */
  levelOf(view, look, distance) {
    if ('level' in look.lod) return look.lod.level;
    // A quarter of a circle in n chords is off by r (π / 4n)² / 2.
    const pixels = this.thickest / (view.flat + view.slope * distance);
    const level = Math.ceil(Math.PI / 4 * Math.sqrt(pixels / 2 / look.lod.pixels));
    const affordable = Math.floor(Math.sqrt(MAX_KEPT / this.scene.slots)) - 1;
    return Math.max(Math.min(level, affordable, 16), 1);
  }

  /** Makes the stretches of a level. @param {number} level */
  setLevel(level) {
    if (level === this.level) return;
    const { gl, scene } = this;
    for (const buffer of new Set(this.stretches.map(({ buffer }) => buffer))) gl.deleteBuffer(buffer);
    const all = scene.parts.flatMap((part) => ranges(part, level, this.shaders.numbers.HIGHEST_LEVEL, TOGETHER));
    const vertices = all.reduce((sum, { slots, columns }) => sum + slots * columns ** 2, 0);
    this.keeps = vertices <= MAX_KEPT;
    const make = (/** @type {number} */ count) => {
      const buffer = /** @type {WebGLBuffer} */ (gl.createBuffer());
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, BYTES * count, gl.DYNAMIC_COPY);
      return buffer;
    };
    const shared = this.keeps ? null : make(TOGETHER);
    this.stretches = all.map((range) => ({ ...range, buffer: shared ?? make(range.slots * range.columns ** 2), made: false }));
    this.level = level;
  }

  /** Has the card make the vertices of a stretch. @param {Stretch} stretch */
  capture(stretch) {
    const { gl } = this, { part, first, slots, columns, buffer } = stretch, vertices = slots * columns ** 2;
    this.write(new Struct(this.shaders.layouts.Even).set({ ...baseFields(part.base), level: this.level, columns, first_slot: first,
      slots: part.slots, vertices }));
    gl.useProgram(this.programs.capture);
    gl.bindTexture(gl.TEXTURE_2D, this.packed);
    gl.bindVertexArray(this.none);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, this.feedback);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.beginTransformFeedback(gl.POINTS);
    gl.drawArrays(gl.POINTS, 0, vertices);
    gl.endTransformFeedback();
    gl.disable(gl.RASTERIZER_DISCARD);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, null);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, null);
    stretch.made = !!this.keeps;
  }

  /** @param {Struct} struct */
  write(struct) {
    const { gl } = this;
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.uniforms);
    gl.bufferData(gl.UNIFORM_BUFFER, struct.bytes, gl.DYNAMIC_DRAW);
  }

  /** Indices of all patches of a stretch; a vertex array is bound. @param {Stretch} stretch @param {boolean} lines @returns {number} for each patch */
  bindGrid({ columns, round }, lines) {
    const { gl } = this, name = `${columns} ${round} ${lines}`;
    let grid = this.grids.get(name);
    if (!grid) {
      const n = columns - 1, at = (/** @type {number} */ i, /** @type {number} */ j) => j * columns + i;
      const triangles = quads(n, n, round, at);
      const own = lines ? triangles.flatMap((_, k) => (k % 3 ? [] : [0, 1, 1, 2, 2, 0].map((side) => triangles[k + side]))) : triangles;
      const patches = Math.max(Math.floor(TOGETHER / columns ** 2), 1), indices = new Uint32Array(own.length * patches);
      for (let patch = 0; patch < patches; patch++) {
        for (let k = 0; k < own.length; k++) indices[patch * own.length + k] = own[k] + patch * columns ** 2;
      }
      grid = { buffer: /** @type {WebGLBuffer} */ (gl.createBuffer()), ofPatch: own.length };
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, grid.buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
      this.grids.set(name, grid);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, grid.buffer);
    return grid.ofPatch;
  }

  /**
   * @param {WebGLProgram} program @param {import('./camera.js').View} view @param {import('./webgpu.js').Look} look
   * @param {number} aspect @param {number[]} [ink] of lines, with which lines are drawn
   */
  drawAll(program, view, look, aspect, ink) {
    const { gl, scene } = this;
    const clip = clipFromRelative(view, aspect);
    // Depth in −1 to 1, so that the depth buffer has what it has with WebGPU.
    for (let column = 0; column < 16; column += 4) clip[column + 2] = 2 * clip[column + 2] - clip[column + 3];
    const { right, up, backward, near, slope, flat, eye } = view;
    const kept = new Struct(this.shaders.layouts.Kept).set({ clip_from_relative: clip, right, near, up, slope, backward, flat,
      key: unit(this.shaders.key_light), least_half_width: 0.5 * look.leastWidth * look.pixelRatio, ink: ink ?? [0, 0, 0, 0] });
    for (const stretch of this.stretches) {
      if (!stretch.made) this.capture(stretch);
      this.write(kept.set(rows(scene.cells[stretch.part.cell], eye)));
      gl.useProgram(program);
      gl.bindTexture(gl.TEXTURE_2D, /** @type {WebGLTexture} */ (this.table));
      gl.bindVertexArray(this.drawn);
      gl.bindBuffer(gl.ARRAY_BUFFER, stretch.buffer);
      for (const place of [0, 1]) {
        gl.enableVertexAttribArray(place);
        gl.vertexAttribPointer(place, 4, gl.FLOAT, false, BYTES, 16 * place);
      }
      const ofPatch = this.bindGrid(stretch, !!ink);
      gl.drawElements(ink ? gl.LINES : gl.TRIANGLES, ofPatch * stretch.slots, gl.UNSIGNED_INT, 0);
    }
    if (program === this.programs.draw && !ink) this.markers?.draw(eye);
  }

  /**
   * @param {import('./camera.js').Camera} camera @param {import('./webgpu.js').Look} look
   * @param {{ step: number, steps: number, scale: number }} how
   */
  draw(camera, look, { step, steps }) {
    if (step) return;
    const { gl, canvas } = this, view = camera.view(canvas.height), aspect = canvas.width / canvas.height;
    this.setLevel(this.levelOf(view, look, camera.distance));
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(look.background[0] / 255, look.background[1] / 255, look.background[2] / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (look.wireframe) {
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(-1, -2);
    }
    this.drawAll(this.programs.draw, view, look, aspect);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    if (look.wireframe) this.drawAll(this.programs.draw, view, look, aspect, [0.03, 0.03, 0.03, 1]);
    if (!look.occlusion || steps < 2) return;
    const shadows = this.shadows ??= new Shadows(gl, this.shaders, (vertex, fragment) => this.program(vertex, fragment));
    shadows.darken(view, [canvas.width, canvas.height], () => this.drawAll(shadows.facing, view, look, aspect), (struct) => this.write(struct));
  }

  async complete() {}

  /** When everything that was asked for is done. @returns {Promise<void>} */
  async done() {
    const { gl } = this, fence = /** @type {WebGLSync} */ (gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0));
    gl.flush();
    while (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) await new Promise((resolve) => setTimeout(resolve, 4));
    gl.deleteSync(fence);
  }

  /**
   * @param {import('./camera.js').Camera} camera @param {import('./webgpu.js').Look} look @param {number} x @param {number} y
   * @returns {Promise<number>}
   */
  async pick(camera, look, x, y) {
    const { gl, canvas } = this, view = camera.view(canvas.height);
    this.setLevel(this.levelOf(view, look, camera.distance));
    const frame = this.ids ??= this.idFrame();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.viewport((PICKED >> 1) - Math.floor(x), (PICKED >> 1) - (canvas.height - 1 - Math.floor(y)), canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawAll(this.programs.ids, view, look, canvas.width / canvas.height);
    const ids = new Uint8Array(4 * PICKED * PICKED);
    // By way of a buffer: what is read at once makes browsers wait, and say so.
    const copy = gl.createBuffer();
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, copy);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, ids.length, gl.STREAM_READ);
    gl.readPixels(0, 0, PICKED, PICKED, gl.RGBA, gl.UNSIGNED_BYTE, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    await this.done();
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, copy);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, ids);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    gl.deleteBuffer(copy);
    return nearest((column, row) => {
      const at = 4 * (row * PICKED + column);
      return (ids[at] | (ids[at + 1] << 8) | (ids[at + 2] << 16)) - 1;
    });
  }

  /** A small picture for ids. @returns {WebGLFramebuffer} */
  idFrame() {
    const { gl } = this, frame = /** @type {WebGLFramebuffer} */ (gl.createFramebuffer());
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    for (const [format, attachment] of [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      const made = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, made);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, PICKED, PICKED);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, made);
    }
    return frame;
  }

  /** Triangles that a frame of this level draws. @returns {Promise<number>} */
  async triangles() {
    return this.stretches.reduce((sum, { slots, columns }) => sum + 2 * slots * (columns - 1) ** 2, 0);
  }

  /**
   * Vertices of a range at a level: see webgpu.js.
   * @param {import('./scene.js').Part} part @param {number} level @param {number} columns @param {number} first
   * @param {number} slots @returns {Promise<Float32Array>}
   */
  async vertices(part, level, columns, first, slots) {
    const { gl } = this, before = this.level, read = new Float32Array(8 * slots * columns ** 2);
    const buffer = /** @type {WebGLBuffer} */ (gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, read.byteLength, gl.STREAM_READ);
    this.level = level;
    this.capture({ part, first, slots, columns, round: false, buffer, made: false });
    this.level = before;
    await this.done();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.getBufferSubData(gl.ARRAY_BUFFER, 0, read);
    gl.deleteBuffer(buffer);
    return read;
  }
}
