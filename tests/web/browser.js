// Chromium without a window, led over a pipe in its DevTools protocol: no driver, no packages.
'use strict';
const { spawn } = require('node:child_process');
const { mkdtempSync, rmSync } = require('node:fs');
const { tmpdir } = require('node:os');
const { join } = require('node:path');

const OPTIONS = ['--headless', '--no-sandbox', '--disable-dev-shm-usage', '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader', '--no-first-run', '--disable-extensions', '--remote-debugging-pipe'];
const PATIENCE = 120000; // ms, for one answer: a busy machine without a graphics card takes many seconds to draw the ship

class Browser {
  constructor() {
    this.profile = mkdtempSync(join(tmpdir(), 'page-'));
    this.process = spawn('chromium', [...OPTIONS, `--user-data-dir=${this.profile}`, 'about:blank'],
      { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    this.asked = new Map();
    this.number = 0;
    this.complaints = []; // what the page threw or wrote as an error
    let rest = '';
    this.process.stdio[4].setEncoding('utf8').on('data', (text) => {
      const messages = (rest + text).split('\0');
      rest = messages.pop();
      for (const message of messages) this.take(JSON.parse(message));
    });
    this.process.stdio[3].on('error', () => {});
    this.process.on('exit', () => {
      for (const { reject, timer } of this.asked.values()) {
        clearTimeout(timer);
        reject(new Error('the browser has ended'));
      }
    });
  }

  take(message) {
    if (message.method === 'Runtime.exceptionThrown')
      this.complaints.push(message.params.exceptionDetails.exception?.description ?? message.params.exceptionDetails.text);
    if (message.method === 'Log.entryAdded' && message.params.entry.level === 'error')
      this.complaints.push(message.params.entry.text);
    const waiting = this.asked.get(message.id);
    if (!waiting) return;
    this.asked.delete(message.id);
    clearTimeout(waiting.timer);
    if (message.error) waiting.reject(new Error(`${waiting.method}: ${message.error.message}`));
    else waiting.resolve(message.result);
  }

  send(method, params = {}) {
    const id = ++this.number;
    this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId: this.session }) + '\0');
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`${method}: no answer`)), PATIENCE);
      this.asked.set(id, { method, resolve, reject, timer });
    });
  }

  async open(address, width, height) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    this.session = (await this.send('Target.attachToTarget', { targetId, flatten: true })).sessionId;
    for (const domain of ['Page', 'Runtime', 'Log']) await this.send(`${domain}.enable`);
    await this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
    await this.send('Page.navigate', { url: address });
  }

  // The value of an expression in the page.
  async value(expression) {
    const answer = await this.send('Runtime.evaluate', { expression, returnByValue: true, awaitPromise: true });
    if (answer.exceptionDetails) throw new Error(`${expression}: ${answer.exceptionDetails.exception?.description}`);
    return answer.result.value;
  }

  // Waits until an expression holds. While the page changes, the browser may have no place to evaluate it.
  async until(expression, what) {
    const gone = /context was destroyed|Cannot find (default )?(execution )?context|target navigated or closed/i;
    for (const end = Date.now() + PATIENCE; Date.now() < end; await new Promise((done) => setTimeout(done, 50)))
      if (await this.value(expression).catch((error) => { if (!gone.test(error.message)) throw error; })) return;
    throw new Error(`never: ${what}`);
  }

  mouse(type, { x, y }, more = {}) {
    return this.send('Input.dispatchMouseEvent', { type, x, y, ...more });
  }

  // From point to point with a button pressed; it is let go at the last one unless told otherwise.
  async drag(points, button = 'left', letGo = true) {
    const held = { button, buttons: button === 'left' ? 1 : 2, clickCount: 1 };
    await this.mouse('mouseMoved', points[0]);
    await this.mouse('mousePressed', points[0], held);
    for (let i = 1; i < points.length; i++)
      for (let part = 1; part <= 4; part++)
        await this.mouse('mouseMoved', { x: points[i - 1].x + ((points[i].x - points[i - 1].x) * part) / 4,
          y: points[i - 1].y + ((points[i].y - points[i - 1].y) * part) / 4 }, held);
    if (letGo) await this.mouse('mouseReleased', points.at(-1), { ...held, buttons: 0 });
  }

  click(point) {
    return this.drag([point]);
  }

  async key(key, text = '') {
    await this.send('Input.dispatchKeyEvent', { type: 'keyDown', key, code: key, text,
      windowsVirtualKeyCode: { ArrowDown: 40 }[key] ?? key.toUpperCase().charCodeAt(0) });
    await this.send('Input.dispatchKeyEvent', { type: 'keyUp', key, code: key });
  }

  async picture() {
    return Buffer.from((await this.send('Page.captureScreenshot', { format: 'png' })).data, 'base64');
  }

  async close() {
    const ended = new Promise((done) => this.process.on('exit', done));
    const timer = setTimeout(() => this.process.kill('SIGKILL'), 5000);
    this.session = undefined;
    this.send('Browser.close').catch(() => {});
    await ended;
    clearTimeout(timer);
    // Its helpers may still be writing there.
    for (let i = 0; i < 20; i++)
      try {
        return rmSync(this.profile, { recursive: true, force: true });
      } catch {
        await new Promise((done) => setTimeout(done, 200));
      }
  }
}

module.exports = { Browser };
