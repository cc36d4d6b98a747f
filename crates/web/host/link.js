// What the page shows, in its address: a link opens the same view.

/** @param {Record<string, string | number | null>} state @returns {string} */
export const written = (state) => '#' + Object.entries(state).filter(([, value]) => value !== null && value !== '')
  .map(([name, value]) => `${name}=${encodeURIComponent(String(value)).replaceAll('%2C', ',')}`).join('&');

/** @param {string} hash @returns {Record<string, string>} */
export const read = (hash) => Object.fromEntries(new URLSearchParams(hash.replace(/^#/, '')));

/** @param {string | undefined} text @param {number} count @returns {number[] | null} */
export function numbers(text, count) {
  const all = (text ?? '').split(',').map(Number);
  return text && all.length === count && all.every(Number.isFinite) ? all : null;
}

/** A number with six digits, without a power. @param {number} value @returns {number} */
export const short = (value) => +value.toPrecision(6);
