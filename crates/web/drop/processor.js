// Draws the cell by the processor, where there is neither WebGPU nor WebGL 2, in place of webgl.js of the page in the frame:
// the core makes the pixels, see drawing.rs of bindings/wasm. Pages by themselves have no core, since the command cannot
// carry one, so this is not part of them.

/** Samples of a pixel of drafts and first fine pictures, and of finished ones. */
const FEW = 4, MANY = 16;
/**
 * The first stay where they take longer (ms), since a picture cannot be stopped; and where there are more pixels: many
 * samples of a soma that fills them take 900 bytes each.
 */
const SLOW = 200, MOST_PIXELS = 1.2e6;

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
    /** What the canvas shows: a view in JSON, and the samples of its pixels. */
    this.shown = '';
    this.samples = FEW;
    /** Whether colors have changed since. */
    this.recolored = false;
    /** Whether the first fine picture took long. */
    this.slow = false;
    /** When the last picture is there. @type {Promise<void>} */
    this.drawing = Promise.resolve();
  }

  /** @param {Float32Array} table linear colors by key */
  setColors(table) {
    this.colors = Uint8Array.from(this.colors, (_, k) => (k % 4 < 3 ? encoded(table[k]) : 255 * table[k]));
    this.recolored = true;
  }

  /**
   * What the core is asked for: see `Asked` in drawing.rs.
   * @param {import('../host/camera.js').Camera} camera @param {import('../host/webgpu.js').Look} look @param {boolean} draft @param {number} share of the canvas
   */
  view(camera, look, draft, share) {
    const size = [this.canvas.width, this.canvas.height].map((n) => Math.max(Math.round(n * share), 1));
    const { eye, up, near } = camera.view(size[1]), { lod, background, wireframe, occlusion } = look, ratio = share * look.pixelRatio;
    return { size, eye, target: camera.target, up, fov: 2 * Math.atan(camera.tan), orthographic: camera.orthographic, near,
      level: 'level' in lod ? lod.level : 0, error: 'pixels' in lod ? lod.pixels : 0, samples: this.samples,
      occlusion: occlusion && !draft, wire: wireframe ? ratio : 0, least_width: look.leastWidth * ratio, background, draft };
  }

  /**
   * @param {import('../host/camera.js').Camera} camera @param {import('../host/webgpu.js').Look} look
   * @param {{ step: number, steps: number, scale: number }} how
   */
  draw(camera, look, { step, steps, scale }) {
    const draft = steps < 2, view = this.view(camera, look, draft, draft ? scale : 1), [width, height] = view.size;
    if (step && (this.slow || width * height > MOST_PIXELS)) return;
    const text = JSON.stringify({ ...view, samples: 0 }), same = text === this.shown;
    const samples = Math.max(step ? MANY : FEW, same ? this.samples : 0);
    if (same && !this.recolored && samples === this.samples) return;
    Object.assign(this, { shown: text, samples, recolored: false });
    const begin = performance.now();
    this.drawing = this.core.ask({ view: { ...view, samples }, colors: this.colors }).then(({ told: [width, height], bytes }) => {
      // None come if the core has another cell by now.
      if (bytes.length) this.put(new ImageData(new Uint8ClampedArray(bytes), width, height));
      if (!draft && !step && !same) this.slow = performance.now() - begin > SLOW;
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
