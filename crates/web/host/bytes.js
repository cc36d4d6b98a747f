// Arrays of the page: see arrays.rs.

/** @typedef {{ at: number, count: number, kind: 'u16' | 'u8' | 'records', records?: [number, number][] }} ArrayRef */

/** The arrays of a page, in one stretch of bytes. */
export class Arrays {
  /** @param {ArrayBuffer} bytes @param {number} first where the arrays begin */
  constructor(bytes, first) {
    this.bytes = bytes;
    this.first = first;
  }

  /** Records, which stand byte by byte. @param {ArrayRef} ref @returns {Uint32Array} */
  records({ at, count, records = [] }) {
    const from = new Uint8Array(this.bytes, this.first + at, 4 * count), made = new Uint8Array(4 * count);
    let read = 0, start = 0;
    for (const [number, size] of records) {
      for (let byte = 0; byte < 4 * size; byte++) {
        let value = 0;
        for (let k = 0; k < number; k++) {
          value += from[read++];
          made[start + 4 * size * k + byte] = value;
        }
      }
      start += 4 * size * number;
    }
    return new Uint32Array(made.buffer);
  }

  /** @param {ArrayRef} ref @returns {Uint8Array} */
  u8s({ at, count }) {
    return new Uint8Array(this.bytes, this.first + at, count);
  }

  /** @param {ArrayRef} ref @returns {Uint16Array} */
  u16s({ at, count }) {
    const bytes = new Uint8Array(this.bytes, this.first + at, 2 * count);
    const values = new Uint16Array(count);
    let value = 0;
    for (let k = 0; k < count; k++) {
      value += bytes[k] | (bytes[count + k] << 8);
      values[k] = value;
    }
    return values;
  }
}
