// The cell's own page, in a frame: the page that `neurotess html` writes, whose host stays while cells change.

import { ProcessorRenderer } from './processor.js';

export class Frame {
  /** @param {HTMLIFrameElement} element @param {string} form of a page: see `page_form` in page.rs @param {import('./core.js').Core} core */
  constructor(element, form, core) {
    this.element = element;
    // Its page finds here who draws where the browser's graphics cannot.
    Object.assign(element, { processor: (/** @type {any[]} */ ...given) => new ProcessorRenderer(core, .../** @type {[any, any, any]} */ (given)) });
    this.form = form;
  }

  /** A whole page. Twin of `Page::of`. @param {string} title @param {string} cells @returns {string} */
  page(title, cells) {
    const escaped = title.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('"', '&quot;');
    return this.form.split('{cells}').join(cells).split('{title}').join(escaped);
  }

  /** What runs in the frame; none before its page is there. @returns {any} */
  inner() {
    return /** @type {any} */ (this.element.contentWindow)?.neurotess;
  }

  /** Shows cells; resolves when there is a picture. @param {string} title @param {string} cells */
  async show(title, cells) {
    this.element.title = `${title}, in three dimensions`;
    try {
      const app = this.inner()?.app;
      if (app?.renderer) {
        await app.replace(cells);
        return;
      }
    } catch {
      // Such as a device that was lost: all anew.
    }
    await this.open(this.page(title, cells));
  }

  /** @param {string} page */
  async open(page) {
    await new Promise((resolve) => {
      this.element.onload = resolve;
      this.element.srcdoc = page;
    });
    const { element } = this, until = async (/** @type {() => boolean} */ is) => {
      while (!is()) await new Promise((resolve) => setTimeout(resolve, 10));
    };
    await until(() => this.inner()?.ready);
    this.onopen?.(/** @type {Window} */ (element.contentWindow));
    // Where nothing can be drawn, its page says so, and is ready.
    let ready = false;
    this.inner().ready.then(() => { ready = true; });
    await until(() => ready || this.inner().app.shown !== undefined);
  }

  /** Called when a page is there, before its picture. @type {((inner: Window) => void) | undefined} */
  onopen;
}
