// Measuring: two clicks give the straight distance and the length along the tree.

/** @typedef {import('./scene.js').Place} Place */

const ORANGE = '#ff8a00';

export class Measuring {
  /** @param {import('./scene.js').Scene} scene @param {(text: string) => void} say */
  constructor(scene, say) {
    this.scene = scene;
    this.say = say;
    this.active = false;
    /** @type {Place[]} */
    this.places = [];
  }

  /** Begins or ends. */
  toggle() {
    this.active = !this.active;
    this.places = [];
    this.say(this.active ? 'Click where it begins.' : '');
  }

  /** @param {Place} place */
  add(place) {
    this.places = this.places.length === 2 ? [place] : [...this.places, place];
    const [a, b] = this.places;
    this.say(b ? this.told(a, b) : 'Click where it ends.');
  }

  /** @param {Place} a @param {Place} b @returns {string} */
  told(a, b) {
    const way = this.scene.way(a, b), straight = `${this.scene.straight(a, b).toFixed(2)} µm straight`;
    if (way !== null) return `${straight}, ${way.toFixed(2)} µm along the tree`;
    return a.cell === b.cell && a.section >= 0 && b.section >= 0 ? `${straight}, in different neurites` : straight;
  }

  /** Draws what is measured over the picture. @param {Element} svg @param {import('./camera.js').Camera} camera */
  draw(svg, camera) {
    const { clientWidth: width, clientHeight: height } = svg;
    const at = this.places.map(({ center }) => camera.project(center, width, height));
    const shown = /** @type {[number, number][]} */ (at.filter((place) => place));
    const line = shown.length === 2 ? `<path d="M${shown.join('L')}" stroke="${ORANGE}" stroke-width="2"/>` : '';
    svg.innerHTML = line + shown.map(([x, y]) => `<circle cx="${x}" cy="${y}" r="4" fill="${ORANGE}" stroke="#fff"/>`).join('');
  }
}

/**
 * What there is to say of a place.
 * @param {Place} place @param {import('./scene.js').Scene} scene @param {import('./colors.js').Colors} colors @returns {string}
 */
export function described(place, scene, colors) {
  const lines = [], type = colors.typeOf(place.key);
  if (scene.cells.length > 1) lines.push(scene.cells[place.cell].name);
  lines.push(place.section < 0 ? type : `${type}, section ${place.section}`);
  if (place.section >= 0) lines.push(`${place.distance.toFixed(1)} µm along its neurite, radius ${place.radius.toPrecision(2)} µm`);
  if (colors.scheme.recording) {
    const share = colors.shareOf(place.key), { title, range: [low, high] } = colors.scale();
    if (share >= 0) lines.push(`${title}: ${(low + share * (high - low)).toPrecision(4)}`);
  }
  return lines.join('\n');
}
