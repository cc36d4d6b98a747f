// Markers: spheres beside the cells. Twins: crates/render/src/sources/markers.

import { linear } from './colors.js';
import { Struct, wgsl } from './shaders.js';
import { bindGroup, buffer, bufferLayout, upload } from './selection.js';
import { DEPTH, FORMATS } from './finishing.js';
import { minus } from './vectors.js';

/** Times that the triangles of an octahedron are divided: 128 triangles a marker. */
const DIVISIONS = 2;
/** Least radius (pixels). */
const LEAST = 1.5;

/** Corners of a unit sphere's triangles, four numbers each. @returns {Float32Array} */
function sphere() {
  /** @type {number[][][]} */
  let triangles = [1, -1].flatMap((z) => [[1, 0], [0, 1], [-1, 0], [0, -1]].map(([x, y]) =>
    (z > 0 ? [[x, y, 0], [-y, x, 0], [0, 0, z]] : [[-y, x, 0], [x, y, 0], [0, 0, z]])));
  const middle = (/** @type {number[]} */ a, /** @type {number[]} */ b) => {
    const sum = a.map((v, k) => v + b[k]), size = Math.hypot(...sum);
    return sum.map((v) => v / size);
  };
  for (let k = 0; k < DIVISIONS; k++) {
    triangles = triangles.flatMap(([a, b, c]) => {
      const [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
      return [[a, d, f], [d, b, e], [f, e, c], [d, e, f]];
    });
  }
  return Float32Array.from(triangles.flat().flatMap((corner) => [...corner, 0]));
}

/** @param {import('./scene.js').Scene} scene */
function read(scene) {
  const { positions, categories } = scene.data.markers;
  return { positions: new Float32Array(scene.arrays.records(positions).buffer), categories: scene.arrays.u16s(categories) };
}

export class WebGpuMarkers {
  /** @param {GPUDevice} device @param {import('./scene.js').Scene} scene @param {any} shaders @param {GPUBindGroupLayout} shadeLayout */
  constructor(device, scene, shaders, shadeLayout) {
    this.device = device;
    this.scene = scene;
    this.shaders = shaders;
    const { VERTEX } = GPUShaderStage, { STORAGE, UNIFORM, COPY_DST } = GPUBufferUsage, { numbers } = shaders;
    const { positions, categories } = read(scene), stored = new Float32Array(5 * categories.length), bits = new Uint32Array(stored.buffer);
    categories.forEach((category, k) => {
      stored.set(positions.subarray(3 * k, 3 * k + 3), 5 * k);
      bits[5 * k + 3] = (numbers.CATEGORY_BIT | (scene.keys + category)) >>> 0;
      bits[5 * k + 4] = numbers.NO_OUTWARDS;
    });
    const corners = sphere();
    this.count = categories.length;
    this.corners = corners.length / 4;
    this.frame = buffer(device, 'markers', shaders.layouts.MarkerFrame.size / 4, UNIFORM | COPY_DST);
    const layout = bufferLayout(device, [[0, VERTEX, 'read-only-storage'], [1, VERTEX, 'read-only-storage'], [2, VERTEX, 'uniform']]);
    this.group = bindGroup(device, layout, { 0: upload(device, 'markers', stored, STORAGE), 1: upload(device, 'sphere', corners, STORAGE), 2: this.frame });
    this.layout = device.createPipelineLayout({ bindGroupLayouts: [layout, shadeLayout] });
  }

  async compile() {
    const { device, shaders } = this;
    const module = device.createShaderModule({ label: 'markers', code: wgsl(shaders, 'markers') });
    this.pipeline = await device.createRenderPipelineAsync({ label: 'markers', layout: this.layout, vertex: { module, entryPoint: 'vertex' },
      fragment: { module, entryPoint: 'fragment', targets: FORMATS.map((format) => ({ format })) }, primitive: { cullMode: 'back' },
      depthStencil: { format: DEPTH, depthWriteEnabled: true, depthCompare: 'greater' }, multisample: { count: shaders.numbers.SAMPLES } });
  }

  /** @param {GPURenderPassEncoder} pass @param {import('./camera.js').View} view @param {GPUBindGroup} shade */
  draw(pass, view, shade) {
    const { right, up, backward, near, slope, flat, eye } = view, { radius, origin } = this.scene.data.markers;
    this.device.queue.writeBuffer(this.frame, 0, new Struct(this.shaders.layouts.MarkerFrame).set({ relative_from_block: minus(origin, eye),
      radius: Math.max(radius, LEAST * flat), right, near, up, least: LEAST * slope, backward, first: 0, pixel_slope: slope, pixel_flat: flat }).bytes);
    pass.setPipeline(/** @type {GPURenderPipeline} */ (this.pipeline));
    pass.setBindGroup(0, this.group);
    pass.setBindGroup(1, shade);
    pass.draw(this.corners, this.count);
  }
}

export class WebGlMarkers {
  /** @param {WebGL2RenderingContext} gl @param {import('./scene.js').Scene} scene @param {WebGLProgram} program */
  constructor(gl, scene, program) {
    this.gl = gl;
    this.scene = scene;
    this.program = program;
    this.read = read(scene);
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    const corners = sphere();
    this.corners = corners.length / 4;
    const colors = scene.data.markers.colors.map((/** @type {number[]} */ color) => [...color.map(linear), 1]);
    this.attribute(0, corners, 0);
    this.attribute(2, Float32Array.from(Array.from(this.read.categories, (category) => colors[category]).flat()), 1);
    this.centers = this.attribute(1, new Float32Array(4 * this.read.categories.length), 1);
  }

  /** @param {number} place @param {Float32Array} data @param {number} divisor @returns {WebGLBuffer} */
  attribute(place, data, divisor) {
    const { gl } = this, made = /** @type {WebGLBuffer} */ (gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, made);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 4, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(place, divisor);
    return made;
  }

  /** Draws with the uniforms of the cells. @param {import('./vectors.js').Vector} eye */
  draw(eye) {
    const { gl, scene: { data: { markers: { origin, radius } } }, read: { positions, categories } } = this;
    const centers = new Float32Array(4 * categories.length);
    for (let k = 0; k < categories.length; k++) {
      for (let axis = 0; axis < 3; axis++) centers[4 * k + axis] = origin[axis] - eye[axis] + positions[3 * k + axis];
      centers[4 * k + 3] = radius;
    }
    gl.useProgram(this.program);
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.centers);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, centers);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, this.corners, categories.length);
  }
}
