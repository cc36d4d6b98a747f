// Runs the core: see memory.rs of bindings/wasm. Each message is a call, and has one answer.

/**
 * What the core exports.
 * @typedef {{ memory: WebAssembly.Memory, take: (length: number) => number, open: (name: number) => number, mesh: (level: number) => number,
 *   tracing: () => number, draw: (view: number) => number, pick: (view: number, x: number, y: number) => number, told: () => number, told_length: () => number, bytes: () => number, bytes_length: () => number }} Core
 */

/** @type {Promise<Core> | undefined} */
let core;

/** @param {Core} core @param {number} at @param {number} length @returns {Uint8Array} a view: memory may grow in any call */
const view = ({ memory }, at, length) => new Uint8Array(memory.buffer, at, length);

/** @param {Core} core @param {Uint8Array[]} parts */
function write(core, ...parts) {
  let at = core.take(parts.reduce((sum, { length }) => sum + length, 0));
  for (const part of parts) {
    view(core, at, part.length).set(part);
    at += part.length;
  }
}

/** @param {Core} core @returns {string} */
const told = (core) => new TextDecoder().decode(view(core, core.told(), core.told_length()));

/** @param {Core} core @param {any} call @returns {number} 1 if it failed */
function run(core, { open, file, mesh, level, view, colors, at }) {
  const bytes = (/** @type {string} */ text) => new TextEncoder().encode(text);
  if (open !== undefined) {
    const name = bytes(open);
    write(core, new Uint8Array(file), name);
    return core.open(name.length);
  }
  if (view !== undefined) {
    const text = bytes(JSON.stringify(view));
    write(core, colors, text);
    return at ? core.pick(text.length, at[0], at[1]) : core.draw(text.length);
  }
  if (mesh === undefined) return core.tracing();
  write(core, bytes(mesh));
  return core.mesh(level);
}

onmessage = async ({ data }) => {
  if (data.module) {
    core = WebAssembly.instantiate(/** @type {WebAssembly.Module} */ (data.module), {}).then(({ exports }) => /** @type {any} */ (exports));
    return;
  }
  /** @type {Core | undefined} */
  let ready;
  try {
    ready = /** @type {Core} */ (await core);
    if (run(ready, data)) {
      postMessage({ error: told(ready) });
      return;
    }
    const bytes = view(ready, ready.bytes(), ready.bytes_length()).slice();
    /** @type {any} */ (self).postMessage({ told: JSON.parse(told(ready)), bytes }, [bytes.buffer]);
  } catch (error) {
    // A panic leaves its text. Without one, there was no memory left.
    const panic = ready && told(ready);
    postMessage({ broken: true, error: panic
      ? `a bug of neurotess (${panic}): please report it with the file`
      : `more memory is needed than a page has (${/** @type {Error} */ (error).message}): use the command, neurotess html` });
  }
};
