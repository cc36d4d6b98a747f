// The camera: it goes around a target, upright along y. Twins: camera.rs, framing.rs.

import { along, clamp, cross, dot, minus } from './vectors.js';

/** @typedef {import('./vectors.js').Vector} Vector */

/**
 * A camera as renderers take it.
 * @typedef {object} View
 * @property {Vector} eye
 * @property {Vector} right
 * @property {Vector} up
 * @property {Vector} backward
 * @property {number} tan of half the vertical angle of view
 * @property {boolean} orthographic
 * @property {number} halfHeight µm, at the target
 * @property {number} near µm; negative without perspective
 * @property {number} slope size of a pixel (µm) for each µm of depth
 * @property {number} flat size of a pixel (µm) at every depth
 */

/** 20°, as pictures have it. */
const FOV = Math.PI / 9;
/** Free on each side, as a share. */
const MARGIN = 0.06;

export class Camera {
  /** @param {{ center: Vector, radius: number }[]} spheres what is looked at */
  constructor(spheres) {
    this.spheres = spheres;
    this.tan = Math.tan(FOV / 2);
    this.yaw = 0;
    this.pitch = 0;
    this.orthographic = false;
    /** @type {Vector} */
    this.target = [0, 0, 0];
    this.distance = 100;
  }

  /** @returns {{ right: Vector, up: Vector, backward: Vector }} */
  axes() {
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    /** @type {Vector} */
    const backward = [sy * cp, sp, cy * cp];
    /** @type {Vector} */
    const right = [cy, 0, -sy];
    return { right, up: cross(backward, right), backward };
  }

  /** @returns {Vector} */
  eye() {
    return along(this.target, this.axes().backward, this.distance);
  }

  /** @param {number} height of the picture (pixels) @returns {View} */
  view(height) {
    const axes = this.axes(), eye = this.eye();
    const halfHeight = this.tan * this.distance;
    const flat = this.orthographic ? 2 * halfHeight / height : 0;
    const slope = this.orthographic ? 0 : 2 * this.tan / height;
    return { eye, ...axes, tan: this.tan, orthographic: this.orthographic, halfHeight, slope, flat, near: this.near(eye, axes.backward) };
  }

  /** @param {Vector} eye @param {Vector} backward @returns {number} */
  near(eye, backward) {
    let near = 1e30, far = 1e-3;
    for (const { center, radius } of this.spheres) {
      const depth = dot(minus(eye, center), backward);
      near = Math.min(near, depth - radius);
      far = Math.max(far, depth + radius);
    }
    if (this.orthographic) return -(1.1 * Math.max(far, -near) + 2 * this.tan * this.distance);
    return Math.max(0.9 * Math.min(near, far), 1e-5 * far);
  }

  /**
   * Moves the target and the distance so that these spheres fill the picture.
   * @param {number} aspect @param {number} covered share of the width, from the right, that something else covers
   * @param {{ center: Vector, radius: number }[]} [spheres]
   */
  fit(aspect, covered, spheres = this.spheres) {
    if (!spheres.length) return;
    const { right, up, backward } = this.axes();
    if (this.orthographic) {
      this.fitFlat(aspect, covered, spheres);
      return;
    }
    const free = 1 - 2 * MARGIN, across = this.tan * aspect;
    // Where the eye must be along each axis, and how far, so that the planes on both sides touch the spheres.
    const touch = (/** @type {Vector} */ axis, /** @type {number} */ lowTan, /** @type {number} */ highTan) => {
      let low = 1e30, high = -1e30;
      for (const { center, radius } of spheres) {
        const v = dot(center, axis), z = dot(center, backward);
        high = Math.max(high, v + highTan * z + radius * Math.hypot(highTan, 1));
        low = Math.min(low, v - lowTan * z - radius * Math.hypot(lowTan, 1));
      }
      return [(low * highTan + high * lowTan) / (lowTan + highTan), (high - low) / (lowTan + highTan)];
    };
    const rightTan = across * (free - 2 * covered);
    const [x0, depthX] = touch(right, across * free, rightTan), [y, depthY] = touch(up, this.tan * free, this.tan * free);
    // If the height needs a larger distance, the spheres are centered in what is not covered.
    const x = x0 + Math.max(depthY - depthX, 0) * (across * free - rightTan) / 2;
    const depths = spheres.map(({ center }) => dot(center, backward));
    const nearest = Math.max(...spheres.map(({ radius }, k) => depths[k] + radius));
    const middle = depths.reduce((sum, z) => sum + z, 0) / depths.length;
    const eye = Math.max(depthX, depthY, nearest + 1e-3 * Math.max(Math.abs(nearest - middle), 1e-3));
    const z = Math.min(middle, nearest - 1e-6, eye - 1e-3);
    this.target = along(along(along([0, 0, 0], right, x), up, y), backward, z);
    this.distance = eye - z;
  }

  /**
   * The same without perspective.
   * @param {number} aspect @param {number} covered @param {{ center: Vector, radius: number }[]} spheres
   */
  fitFlat(aspect, covered, spheres) {
    const { right, up, backward } = this.axes(), free = 1 - 2 * MARGIN;
    const [x, y, z] = [right, up, backward].map((axis) => {
      const places = spheres.map(({ center }) => dot(center, axis));
      const low = Math.min(...places.map((place, k) => place - spheres[k].radius));
      const high = Math.max(...places.map((place, k) => place + spheres[k].radius));
      return { middle: (low + high) / 2, half: (high - low) / 2 };
    });
    const height = Math.max(y.half / free, x.half / aspect / (free - covered));
    this.target = along(along(along([0, 0, 0], right, x.middle + covered * aspect * height), up, y.middle), backward, z.middle);
    this.distance = height / this.tan;
  }

  /** @param {number} right radians @param {number} up radians */
  turn(right, up) {
    this.yaw -= right;
    this.pitch = clamp(this.pitch + up, -Math.PI / 2 + 1e-4, Math.PI / 2 - 1e-4);
  }

  /** @param {number} x pixels @param {number} y pixels @param {number} height of the picture (pixels) */
  pan(x, y, height) {
    const { right, up } = this.axes(), pixel = 2 * this.tan * this.distance / height;
    this.target = along(along(this.target, right, -x * pixel), up, y * pixel);
  }

  /**
   * Comes closer, so that what is at a place of the picture stays there.
   * @param {number} factor on the distance @param {number} x from the middle (pixels), to the right
   * @param {number} y downwards @param {number} height of the picture (pixels)
   */
  zoom(factor, x, y, height) {
    this.distance = Math.max(this.distance * factor, 1e-3);
    this.pan((1 - 1 / factor) * x, (1 - 1 / factor) * y, height);
  }

  /**
   * Where a point is in a picture (pixels); null if it is behind the eye.
   * @param {Vector} point @param {number} width @param {number} height @returns {[number, number] | null}
   */
  project(point, width, height) {
    const { eye, right, up, backward, slope, flat } = this.view(height);
    const v = minus(point, eye), pixel = -dot(v, backward) * slope + flat;
    return pixel > 0 ? [width / 2 + dot(v, right) / pixel, height / 2 - dot(v, up) / pixel] : null;
  }
}
