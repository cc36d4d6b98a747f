// The core in its worker, asked one thing at a time.

/** @typedef {{ told: any, bytes: Uint8Array }} Answer */

export class Core {
  /** @param {string} script of the worker @param {ArrayBuffer} module */
  constructor(script, module) {
    this.script = URL.createObjectURL(new Blob([script], { type: 'text/javascript' }));
    this.module = WebAssembly.compile(module);
    /** The last question. @type {Promise<unknown>} */
    this.asked = this.module;
  }

  /**
   * Asks when all questions before have their answers.
   * @param {any} call see worker.js @param {Transferable[]} [given] @returns {Promise<Answer>}
   */
  ask(call, given = []) {
    const answer = this.asked.catch(() => null).then(() => this.send(call, given));
    this.asked = answer;
    return answer;
  }

  /** @param {any} call @param {Transferable[]} given @returns {Promise<Answer>} */
  async send(call, given) {
    if (!this.worker) {
      this.worker = new Worker(this.script);
      this.worker.postMessage({ module: await this.module });
    }
    const { worker } = this;
    const answer = await new Promise((resolve) => {
      worker.onmessage = ({ data }) => resolve(data);
      worker.onerror = ({ message }) => resolve({ broken: true, error: message || 'the worker could not be started' });
      worker.postMessage(call, given);
    });
    if (answer.broken) {
      worker.terminate();
      this.worker = undefined;
    }
    if (answer.error) throw new Error(answer.error);
    return answer;
  }
}
