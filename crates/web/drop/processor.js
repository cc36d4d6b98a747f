// Draws the cell by the processor, where there is neither WebGPU nor WebGL 2, in place of webgl.js of the page in the frame:
// the core makes the pixels, see drawing.rs of bindings/wasm. Pages by themselves have no core, since the command cannot
// carry one, so this is not part of them.

/** Samples of a pixel of a fine picture, and of a draft. */
const SAMPLES = 16, DRAFT_SAMPLES = 4;

/** @param {number} light linear @returns {number} the byte of it (IEC 61966-2-1) */
const encoded = (light) => Math.round(255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055));

export class ProcessorRenderer {
  /** The same for other cells. @param {import('../host/scene.js').Scene} scene @returns {Promise<ProcessorRenderer>} */
  async replaced(scene) {
    return new ProcessorRenderer(this.core, this.canvas, scene, this.failed);
  }

  destroy() {}

  /** @param {import('./core.js').Core} core @param {HTMLCanvasElement} canvas @param {import('../host/scene.js').Scene} scene @param {(message: string) => void} failed */
  constructor(core, canvas, scene, failed) {
    this.canvas = canvas;
    this.scene = scene;
    this.core = core;
    this.failed = failed;
    this.name = 'processor';
    this.said = 'Drawn by the processor, since there is neither WebGPU nor WebGL 2 here.';
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    this.small = document.createElement('canvas');
    /** Four bytes a tracing point; the last is 0 for those that are hidden. */
    this.colors = new Uint8Array(4 * scene.keys);
    /** What the canvas shows: a view in JSON; empty if its colors have changed since. */
    this.shown = '';
    /** When the last picture is there. @type {Promise<void>} */
    this.drawing = Promise.resolve();
  }

  /** @param {Float32Array} table linear colors by key */
  setColors(table) {
    this.colors = Uint8Array.from(this.colors, (_, k) => (k % 4 < 3 ? encoded(table[k]) : 255 * table[k]));
    this.shown = '';
  }

  /**
   * What the core is asked for: see `Asked` in drawing.rs.
   * @param {import('../host/camera.js').Camera} camera @param {import('../host/webgpu.js').Look} look @param {boolean} draft @param {number} share of the canvas
   */
  view(camera, look, draft, share) {
    const size = [this.canvas.width, this.canvas.height].map((n) => Math.max(Math.round(n * share), 1));
    const { eye, up, near } = camera.view(size[1]), { lod, background, wireframe, occlusion } = look, ratio = share * look.pixelRatio;
    return { size, eye, target: camera.target, up, fov: 2 * Math.atan(camera.tan), orthographic: camera.orthographic, near,
      level: 'level' in lod ? lod.level : 0, error: 'pixels' in lod ? lod.pixels : 0, samples: draft ? DRAFT_SAMPLES : SAMPLES,
      occlusion: occlusion && !draft, wire: wireframe ? ratio : 0, least_width: look.leastWidth * ratio, background, draft };
  }

  /**
   * @param {import('../host/camera.js').Camera} camera @param {import('../host/webgpu.js').Look} look
   * @param {{ step: number, steps: number, scale: number }} how
   */
  draw(camera, look, { step, steps, scale }) {
    const draft = steps < 2, view = this.view(camera, look, draft, draft ? scale : 1), text = JSON.stringify(view);
    if (step || text === this.shown) return;
    this.shown = text;
    this.drawing = this.core.ask({ view, colors: this.colors }).then(({ told: [width, height], bytes }) => {
      // None come if the core has another cell by now.
      if (bytes.length) this.put(new ImageData(new Uint8ClampedArray(bytes), width, height));
    }).catch((/** @type {Error} */ { message }) => this.failed(message));
  }

  /** Fills the canvas with a picture. @param {ImageData} picture */
  put(picture) {
    const { context, canvas, small } = this;
    [small.width, small.height] = [picture.width, picture.height];
    /** @type {CanvasRenderingContext2D} */ (small.getContext('2d')).putImageData(picture, 0, 0);
    context.drawImage(small, 0, 0, canvas.width, canvas.height);
  }

  async complete() {}

  /** When everything that was asked for is done. @returns {Promise<void>} */
  done() {
    return this.drawing;
  }

  /**
   * @param {import('../host/camera.js').Camera} camera @param {import('../host/webgpu.js').Look} look @param {number} x @param {number} y
   * @returns {Promise<number>}
   */
  async pick(camera, look, x, y) {
    const { told } = await this.core.ask({ view: this.view(camera, look, false, 1), colors: this.colors, at: [Math.floor(x), Math.floor(y)] });
    return told ?? -1;
  }

  /** The surface as a file: the core's own. @param {number} level @returns {Promise<{ file: Blob, triangles: number }>} */
  async mesh(level) {
    const { told, bytes } = await this.core.ask({ mesh: 'ply', level });
    return { file: new Blob([/** @type {any} */ (bytes)], { type: 'application/octet-stream' }), triangles: told.faces };
  }
}
