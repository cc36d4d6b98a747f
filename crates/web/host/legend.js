// The legend: categories that one hides and isolates, or a scale of numbers; and the scale bar.

import { css } from './colors.js';

/** Most entries that are listed; of more, colors repeat. */
const MOST = 400;

/** @param {number} most @returns {number} the largest of 1, 2 and 5 times a power of ten that is not above */
export function niceLength(most) {
  const power = 10 ** Math.floor(Math.log10(Math.max(most, 1e-9)));
  return ([5, 2, 1].find((factor) => factor * power <= most * (1 + 1e-9)) ?? 1) * power;
}

/** @param {number} value @param {number} step @returns {string} with as many digits as steps of this size need */
export const digits = (value, step) => value.toFixed(Math.min(Math.max(Math.ceil(-Math.log10(step) - 1e-9), 0), 6));

/** Round numbers on a scale with their place, 0 to 1. @param {[number, number]} range @param {boolean} more @returns {[number, string][]} */
export function ticks([low, high], more) {
  let step = niceLength((high - low) / 2);
  if ((high - low) / step < 4) step = niceLength(step / 2);
  const all = /** @type {[number, string][]} */ ([]);
  for (let tick = Math.ceil(low / step - 1e-6) * step; tick <= high + 1e-6 * step; tick += step) {
    const share = (tick - low) / (high - low);
    if (!more || share < 0.9) all.push([share, digits(tick + 0, step)]);
  }
  if (more) all.push([1, `≥ ${digits(high, step / 10)}`]);
  return all;
}

/**
 * @param {HTMLElement} element @param {import('./colors.js').Colors} colors
 * @param {(index: number, alone: boolean, again: boolean) => void} toggle `again`: the second click of two
 */
export function showLegend(element, colors, toggle) {
  element.replaceChildren(...(colors.isScale() ? scale(colors) : categories(colors, toggle)));
  for (const [color, name] of colors.scene.data.markers?.legend ?? []) {
    const line = document.createElement('div');
    line.className = 'marker';
    line.append(dotOf(color), name);
    element.append(line);
  }
}

/** @param {import('./colors.js').Rgb} color @returns {HTMLElement} */
function dotOf(color) {
  const dot = document.createElement('i');
  dot.style.background = css(color);
  return dot;
}

/**
 * @param {import('./colors.js').Colors} colors @param {(index: number, alone: boolean, again: boolean) => void} toggle
 * @returns {HTMLElement[]}
 */
function categories(colors, toggle) {
  const made = [], entries = colors.entries(), hidden = colors.hiddenNow();
  if (entries.length > colors.palette.distinct.length && colors.scheme.id !== 'type') {
    made.push(heading(`${entries.length} ${colors.scheme.label}s, colors repeat`));
  }
  for (const { name, color, index } of entries.slice(0, MOST)) {
    const button = document.createElement('button');
    button.append(dotOf(color), name);
    button.setAttribute('aria-pressed', String(!hidden.has(index)));
    button.title = 'Click to hide or show, double-click or Shift to see it alone';
    button.onclick = (event) => toggle(index, event.shiftKey || event.detail === 2, event.detail === 2);
    made.push(button);
  }
  return made;
}

/** @param {string} text @returns {HTMLElement} */
function heading(text) {
  const made = document.createElement('h2');
  made.textContent = text;
  return made;
}

/** @param {import('./colors.js').Colors} colors @returns {HTMLElement[]} */
function scale(colors) {
  const { title, range, more } = colors.scale();
  const bar = document.createElement('div'), canvas = document.createElement('canvas'), numbers = document.createElement('div');
  bar.className = 'bar';
  numbers.className = 'ticks';
  [canvas.width, canvas.height] = [1, 150];
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  for (let y = 0; y < 150; y++) {
    context.fillStyle = css(colors.ofShare(1 - (y + 0.5) / 150));
    context.fillRect(0, y, 1, 1);
  }
  for (const [share, text] of ticks(range, more)) {
    const label = document.createElement('span');
    label.textContent = text;
    label.style.bottom = `${100 * share}%`;
    numbers.append(label);
  }
  bar.append(canvas, numbers);
  return [heading(title), bar];
}

/**
 * The scale bar. @param {HTMLElement} element @param {number} pixel µm, of the page @param {number} width of the page
 * @returns {{ length: number, text: string }}
 */
export function showScale(element, pixel, width) {
  const length = niceLength(Math.min(width / 5, 180) * pixel), text = `${digits(length, length)} µm`;
  element.style.width = `${length / pixel}px`;
  /** @type {HTMLElement} */ (element.firstElementChild).textContent = text;
  return { length: length / pixel, text };
}
