// When pictures are drawn: drafts at once while something changes, fine ones step by step at rest.

/** Time (ms) without a change after which a picture is drawn finely. */
const REST = 180;
/** Drafts that take longer (ms) are drawn smaller, those that take less larger. */
const SLOW = 110, FAST = 35;
const SMALLEST = 0.34;

export class Loop {
  /**
   * @param {(how: { step: number, steps: number, scale: number, draft: boolean }) => void} draw
   * @param {() => Promise<void>} done when the device has drawn @param {number} steps of a fine picture
   */
  constructor(draw, done, steps) {
    this.drawStep = draw;
    this.done = done;
    this.steps = steps;
    this.changed = 0;
    this.step = 0;
    this.scale = 1;
    this.draftAsked = false;
    this.running = false;
    /** Time (ms) of the last draft. */
    this.took = 0;
    /** @type {(() => void)[]} */
    this.waiting = [];
  }

  /** Something has changed. */
  change() {
    this.changed = performance.now();
    this.draftAsked = true;
    this.step = 0;
    this.run();
  }

  /** The picture is to be made anew, but nothing moves. */
  refresh() {
    this.changed = 0;
    this.step = 0;
    this.run();
  }

  /** When the picture is fine. @returns {Promise<void>} */
  settled() {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
      this.run();
    });
  }

  async run() {
    if (this.running) return;
    this.running = true;
    while (this.draftAsked || this.step < this.steps) {
      await new Promise(requestAnimationFrame);
      const begin = performance.now();
      if (this.draftAsked) {
        this.draftAsked = false;
        this.drawStep({ step: 0, steps: 1, scale: this.scale, draft: true });
        await this.done();
        this.took = performance.now() - begin;
        if (this.took > SLOW) this.scale = Math.max(this.scale * 0.7, SMALLEST);
        else if (this.took < FAST) this.scale = Math.min(this.scale * 1.25, 1);
      } else if (begin - this.changed < REST) {
        await new Promise((resolve) => setTimeout(resolve, 30));
      } else {
        this.drawStep({ step: this.step, steps: this.steps, scale: 1, draft: false });
        this.step++;
        await this.done();
      }
    }
    this.running = false;
    for (const resolve of this.waiting.splice(0)) resolve();
  }
}
