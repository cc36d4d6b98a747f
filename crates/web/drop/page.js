// The page that takes tracings: its parts put together.

import { Core } from './core.js';
import { Frame } from './frame.js';
import { save } from '../host/files.js';

/** Levels that meshes are saved at; the command's is chosen. */
const LEVELS = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64], LEVEL = 4;
const TYPES = { html: 'text/html', swc: 'text/plain' };

/** @template {HTMLElement} T @param {string} id @returns {T} */
const byId = (id) => /** @type {T} */ (document.getElementById(id));

export class Page {
  /** @param {{ shaders: any, cells: any, bytes: ArrayBuffer, first: number }} data see dropping.rs */
  constructor({ shaders: { form, worker, sample, sample_name: name }, cells: { licenses }, bytes, first }) {
    this.core = new Core(worker, bytes.slice(first));
    this.frame = new Frame(byId('frame'), form, this.core);
    this.sample = /** @type {[string, string]} */ ([name, sample]);
    /** The cell that is shown. @type {{ name: string, cells: string } | undefined} */
    this.cell = undefined;
    byId('licenses').textContent = licenses;
    /** When the last file is shown, or its fault. */
    this.turn = Promise.resolve();
    /** Files that were taken. */
    this.turns = 0;
    /** Times (ms) of the last file: read and meshed, then shown. */
    this.took = { meshed: 0, shown: 0 };
  }

  /** Listens, and shows the sample: so all is compiled when a file comes. */
  async open() {
    byId('level').replaceChildren(...LEVELS.map((level) => new Option(String(level), String(level), level === LEVEL, level === LEVEL)));
    const file = /** @type {HTMLInputElement} */ (byId('file'));
    file.onchange = () => {
      if (file.files?.length) this.take(file.files[0]);
      // The same file may be chosen again.
      file.value = '';
    };
    this.frame.onopen = (inner) => this.listen(inner);
    this.listen(window);
    const press = (/** @type {string} */ id, /** @type {() => Promise<void>} */ act) => { byId(id).onclick = () => this.attempt(act); };
    press('save-page', () => this.savePage());
    press('save-mesh', () => this.saveMesh());
    press('save-tracing', () => this.saveTracing());
    const [name, text] = this.sample;
    this.turn = this.attempt(() => this.show(name, new TextEncoder().encode(text).buffer, 'A sample, grown by the computer.'));
    await this.turn;
  }

  /** Takes files that are dropped on a window. @param {Window} target the page's, or the frame's */
  listen(target) {
    let inside = 0;
    const mark = (/** @type {boolean} */ over) => document.body.classList.toggle('dropping', over);
    target.addEventListener('dragenter', () => mark(++inside > 0));
    target.addEventListener('dragleave', () => mark(--inside > 0));
    target.addEventListener('dragover', (event) => event.preventDefault());
    target.addEventListener('drop', (event) => {
      event.preventDefault();
      inside = 0;
      mark(false);
      const file = event.dataTransfer?.files[0];
      if (file) this.take(file);
    });
  }

  /** @param {File} file @returns {Promise<void>} when it is shown, or its fault */
  take(file) {
    const begin = performance.now();
    this.turns++;
    this.turn = this.turn.then(() => this.attempt(async () => {
      this.say(`Reading ${file.name} …`);
      await this.show(file.name, await file.arrayBuffer(), '');
      this.took.shown = performance.now() - begin;
    }));
    return this.turn;
  }

  /** Does something; what goes wrong is told. @param {() => Promise<void>} act */
  async attempt(act) {
    byId('fault').hidden = true;
    document.body.setAttribute('aria-busy', 'true');
    try {
      await act();
    } catch (error) {
      this.say('');
      byId('fault').hidden = false;
      byId('fault').textContent = /** @type {Error} */ (error).message;
    }
    document.body.setAttribute('aria-busy', 'false');
  }

  /** @param {string} text */
  say(text) {
    byId('status').textContent = text;
  }

  /** Reads, meshes and shows a file. @param {string} name @param {ArrayBuffer} file @param {string} said at the end */
  async show(name, file, said) {
    const begin = performance.now();
    const { told, bytes } = await this.core.ask({ open: name, file }, [file]);
    this.took.meshed = performance.now() - begin;
    const cells = new TextDecoder().decode(bytes);
    this.cell = { name: told.name, cells };
    this.tell(name, told);
    this.say(said || `Drawing ${told.name} …`);
    await this.frame.show(told.name, cells);
    this.say(said);
  }

  /** @param {string} file @param {any} told of it: see `Told` in cell.rs */
  tell(file, told) {
    document.title = `${told.name} – neurotess`;
    const named = (/** @type {string} */ tag, /** @type {string} */ text) => Object.assign(document.createElement(tag), { textContent: text });
    byId('cell').hidden = false;
    byId('file-name').textContent = `${file} (${told.format})`;
    byId('warnings').hidden = !told.warnings.length;
    byId('warning-list').replaceChildren(...told.warnings.map((/** @type {string} */ text) => named('li', text)));
    byId('measures').replaceChildren(...told.measures.flatMap((/** @type {[string, string]} */ [name, value]) => [named('dt', name), named('dd', value)]));
    byId('sholl').hidden = !told.sholl;
    byId('sholl-step').textContent = `crossings of spheres ${told.sholl_step} µm apart`;
    byId('plot').innerHTML = told.sholl;
    byId('plot').querySelector('svg')?.setAttribute('aria-hidden', 'true');
  }

  /** @param {BlobPart} content @param {string} extension */
  keep(content, extension) {
    const type = /** @type {Record<string, string>} */ (TYPES)[extension] ?? 'application/octet-stream';
    save(new Blob([content], { type }), `${this.cell?.name ?? 'cell'}.${extension}`);
  }

  async savePage() {
    if (this.cell) this.keep(this.frame.page(this.cell.name, this.cell.cells), 'html');
  }

  async saveMesh() {
    const [format, level] = ['format', 'level'].map((id) => /** @type {HTMLSelectElement} */ (byId(id)).value);
    this.say(`Making the surface at level ${level} …`);
    const { told, bytes } = await this.core.ask({ mesh: format, level: +level });
    this.keep(/** @type {any} */ (bytes), format);
    this.say(`Saved ${told.vertices.toLocaleString('en')} vertices and ${told.faces.toLocaleString('en')} triangles.`);
  }

  async saveTracing() {
    const { told, bytes } = await this.core.ask({ tracing: true });
    this.keep(/** @type {any} */ (bytes), 'swc');
    this.say(['Saved the tracing.', ...told].join(' '));
  }
}

const data = /** @type {any} */ (window).neurotess;
data.page = new Page(data);
data.ready = data.page.open();
