// The picture that is saved: the canvas with legend and scale bar.

import { css, isDark } from './colors.js';
import { ticks } from './legend.js';

/** Most entries of a legend that are drawn. */
const MOST = 24;

/**
 * @param {HTMLCanvasElement} canvas just drawn @param {import('./colors.js').Colors} colors
 * @param {{ length: number, text: string } | undefined} bar scale bar (pixels of the page) @param {number} ratio pixels for each of the page
 * @returns {HTMLCanvasElement}
 */
export function drawn(canvas, colors, bar, ratio) {
  const picture = document.createElement('canvas');
  [picture.width, picture.height] = [canvas.width, canvas.height];
  const context = /** @type {CanvasRenderingContext2D} */ (picture.getContext('2d'));
  context.drawImage(canvas, 0, 0);
  context.scale(ratio, ratio);
  const [width, height] = [canvas.width / ratio, canvas.height / ratio];
  const ink = isDark(colors.background) ? '#e9ebee' : '#1c1e21';
  context.font = '13px system-ui, sans-serif';
  context.textBaseline = 'middle';
  context.fillStyle = ink;
  if (bar) {
    context.fillRect(width - 20 - bar.length, height - 18, bar.length, 2);
    context.textAlign = 'center';
    context.fillText(bar.text, width - 20 - bar.length / 2, height - 28);
    context.textAlign = 'left';
  }
  if (colors.isScale()) drawScale(context, colors, height, ink);
  else drawEntries(context, colors, height, ink);
  return picture;
}

/** @param {CanvasRenderingContext2D} context @param {import('./colors.js').Colors} colors @param {number} height @param {string} ink */
function drawEntries(context, colors, height, ink) {
  const hidden = colors.hiddenNow(), entries = colors.entries().filter(({ index }) => !hidden.has(index));
  if (entries.length > MOST) return;
  entries.forEach(({ name, color }, k) => {
    const y = height - 22 - 20 * (entries.length - 1 - k);
    context.fillStyle = css(color);
    context.beginPath();
    context.arc(22, y, 5.5, 0, 2 * Math.PI);
    context.fill();
    context.fillStyle = ink;
    context.fillText(name, 36, y);
  });
}

/** @param {CanvasRenderingContext2D} context @param {import('./colors.js').Colors} colors @param {number} height @param {string} ink */
function drawScale(context, colors, height, ink) {
  const { title, range, more } = colors.scale(), size = 150, top = height - 20 - size;
  for (let y = 0; y < size; y++) {
    context.fillStyle = css(colors.ofShare(1 - (y + 0.5) / size));
    context.fillRect(16, top + y, 14, 1.5);
  }
  context.fillStyle = ink;
  context.fillText(title, 16, top - 14);
  for (const [share, text] of ticks(range, more)) context.fillText(text, 37, top + size * (1 - share));
}
