// Soft shadows with WebGL 2: ambient occlusion in passes over the whole picture. See shadows.wgsl.

import { Struct } from './shaders.js';

/** Occlusion reaches this share of the picture's height, at most so many pixels: see options.rs of `render`. */
const REACH = 0.08, MOST = 0.09, MAX_PIXELS = 360;

export class Shadows {
  /**
   * @param {WebGL2RenderingContext} gl @param {any} shaders
   * @param {(vertex: any, fragment: any) => WebGLProgram} program makes one
   */
  constructor(gl, shaders, program) {
    this.gl = gl;
    this.shaders = shaders;
    const { kept, facing, occlude, blur, darken } = shaders.glsl;
    /** Draws the cells' normals and depths. */
    this.facing = program(kept, facing);
    this.steps = [occlude, blur, darken].map((step) => {
      const made = program(occlude, step);
      ['normals', 'depths', 'shares'].forEach((name, unit) => {
        for (const glsl of step.names[name] ?? []) gl.uniform1i(gl.getUniformLocation(made, glsl), unit);
      });
      return made;
    });
    this.none = gl.createVertexArray();
    /** @type {[number, number]} */
    this.size = [0, 0];
    /** @type {WebGLTexture[]} */
    this.textures = [];
  }

  /** Textures and frames of this size. @param {[number, number]} size */
  resize(size) {
    if (size[0] === this.size[0] && size[1] === this.size[1]) return;
    const { gl } = this;
    for (const old of this.textures) gl.deleteTexture(old);
    for (const old of this.frames ?? []) gl.deleteFramebuffer(old);
    if (this.depth) gl.deleteRenderbuffer(this.depth);
    this.size = size;
    // Normals, depths, and the shares of two steps.
    this.textures = [0, 1, 2, 3].map(() => {
      const texture = /** @type {WebGLTexture} */ (gl.createTexture());
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, ...size);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      return texture;
    });
    this.depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, ...size);
    this.frames = [[0, 1], [2], [3]].map((targets) => {
      const frame = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      targets.forEach((target, k) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + k, gl.TEXTURE_2D, this.textures[target], 0));
      gl.drawBuffers(targets.map((_, k) => gl.COLOR_ATTACHMENT0 + k));
      return frame;
    });
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frames[0]);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, this.depth);
  }

  /**
   * Darkens the picture that is drawn.
   * @param {import('./camera.js').View} view @param {[number, number]} size @param {() => void} draw draws the cells with `facing`
   * @param {(struct: Struct) => void} write a uniform
   */
  darken(view, size, draw, write) {
    const { gl } = this;
    this.resize(size);
    const [facing, first, second] = /** @type {WebGLFramebuffer[]} */ (this.frames);
    gl.bindFramebuffer(gl.FRAMEBUFFER, facing);
    gl.viewport(0, 0, ...size);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    draw();
    write(new Struct(this.shaders.layouts.Shadows).set({ size, slope: view.slope, flat: view.flat, radius: REACH * 2 * view.halfHeight,
      most: Math.ceil(Math.min(MOST * size[1], MAX_PIXELS)), tile_origin: [0, 0] }));
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.none);
    const [normals, depths, occluded, blurred] = this.textures;
    [first, second, null].forEach((frame, k) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.useProgram(this.steps[k]);
      [normals, depths, k === 2 ? blurred : occluded].forEach((texture, unit) => {
        gl.activeTexture(gl.TEXTURE0 + unit);
        // What is written is not bound.
        gl.bindTexture(gl.TEXTURE_2D, k === 0 && unit === 2 ? null : texture);
      });
      if (!frame) {
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.DST_COLOR, gl.ZERO);
      }
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    });
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.activeTexture(gl.TEXTURE0);
  }
}
