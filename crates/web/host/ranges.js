// Ranges of a part's slots whose patches have grids of one size: laterals, somata, other quads, caps. See part.rs.

/**
 * @typedef {object} Range
 * @property {import('./scene.js').Part} part
 * @property {number} first slot
 * @property {number} slots
 * @property {number} columns of vertices
 * @property {boolean} round whether diagonals run towards the corners
 */

/**
 * The ranges of a part at a level, in stretches of at most so many vertices.
 * @param {import('./scene.js').Part} part @param {number} level @param {number} highest @param {number} most vertices
 * @returns {Range[]}
 */
export function ranges(part, level, highest, most) {
  const [, points, , , , , , somata, , caps, keys] = part.base;
  const laterals = 4 * points, end = part.slots - (keys - caps);
  // A half sphere turns by 180 degrees where a ring's side turns by 90.
  const finer = level > 1 ? Math.min(2 * level, highest) : 1;
  const all = [[0, laterals, level, false], [laterals, laterals + somata, level, true], [laterals + somata, end, level, false],
    [end, part.slots, finer, true]];
  const made = [];
  for (const [first, last, grid, round] of /** @type {[number, number, number, boolean][]} */ (all)) {
    const columns = grid + 1, together = Math.max(Math.floor(most / columns ** 2), 1);
    for (let at = first; at < last; at += together) made.push({ part, first: at, slots: Math.min(together, last - at), columns, round });
  }
  return made;
}
