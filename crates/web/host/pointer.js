// Mouse, fingers and keys on the canvas.

/**
 * What input does.
 * @typedef {object} Actions
 * @property {(right: number, up: number) => void} turn radians
 * @property {(x: number, y: number) => void} pan pixels of the page
 * @property {(factor: number, x: number, y: number) => void} zoom around a place (pixels of the page)
 * @property {(x: number, y: number) => void} hover
 * @property {() => void} leave
 * @property {(x: number, y: number) => void} click
 * @property {(x: number, y: number) => void} near double click
 * @property {(key: string) => boolean} key whether it means something
 */

/** Radians for each pixel, and pixels below which a press is a click. */
const TURN = 0.008, STILL = 4;

/** @param {HTMLCanvasElement} canvas @param {Actions} actions */
export function listen(canvas, actions) {
  /** Pressed pointers, by their number. @type {Map<number, { x: number, y: number }>} */
  const pressed = new Map();
  let moved = 0;
  const spread = () => {
    const [a, b] = [...pressed.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.hypot(a.x - b.x, a.y - b.y) };
  };
  canvas.onpointerdown = (event) => {
    canvas.setPointerCapture(event.pointerId);
    if (!pressed.size) moved = 0;
    pressed.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    canvas.classList.add('turning');
  };
  canvas.onpointermove = (event) => {
    const before = pressed.get(event.pointerId), now = { x: event.offsetX, y: event.offsetY };
    if (!before) {
      actions.hover(now.x, now.y);
      return;
    }
    const [x, y] = [now.x - before.x, now.y - before.y];
    moved += Math.hypot(x, y);
    if (pressed.size === 2) {
      const from = spread();
      pressed.set(event.pointerId, now);
      const to = spread();
      actions.pan(to.x - from.x, to.y - from.y);
      if (to.size > 0) actions.zoom(from.size / to.size, to.x, to.y);
      return;
    }
    pressed.set(event.pointerId, now);
    if (pressed.size > 1 || moved < STILL) return;
    if (event.buttons & 6 || event.shiftKey || event.ctrlKey) actions.pan(x, y);
    else actions.turn(TURN * x, TURN * y);
  };
  const release = (/** @type {PointerEvent} */ event) => {
    if (!pressed.delete(event.pointerId)) return;
    canvas.classList.toggle('turning', pressed.size > 0);
    if (event.type === 'pointerup' && !pressed.size && moved < STILL && event.button === 0) actions.click(event.offsetX, event.offsetY);
  };
  canvas.onpointerup = release;
  canvas.onpointercancel = release;
  canvas.onpointerleave = () => actions.leave();
  canvas.oncontextmenu = (event) => event.preventDefault();
  canvas.ondblclick = (event) => actions.near(event.offsetX, event.offsetY);
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    actions.zoom(Math.exp(0.0015 * lines * Math.max(Math.min(event.deltaY, 300), -300)), event.offsetX, event.offsetY);
  }, { passive: false });
  addEventListener('keydown', (event) => {
    const { target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || target instanceof HTMLInputElement || target instanceof HTMLSelectElement) return;
    // These press the button that has the focus.
    if (target instanceof HTMLButtonElement && (event.key === ' ' || event.key === 'Enter')) return;
    const [x, y] = [canvas.clientWidth / 2, canvas.clientHeight / 2], step = event.shiftKey ? 40 : 0.12;
    const arrows = /** @type {Record<string, [number, number]>} */ ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] });
    const arrow = arrows[event.key];
    if (arrow) (event.shiftKey ? actions.pan : actions.turn)(arrow[0] * step, arrow[1] * step);
    else if (event.key === '+' || event.key === '=') actions.zoom(0.85, x, y);
    else if (event.key === '-') actions.zoom(1 / 0.85, x, y);
    else if (!actions.key(event.key)) return;
    event.preventDefault();
  });
}
