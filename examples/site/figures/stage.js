// Runs the figures of a page: those in sight move, and check their numbers once.
import { open } from 'massspring';
import { figures } from './all.js';
import { Pen } from './pen.js';

const DT = 1 / 64, LONGEST = 0.1; // s; after a pause, time is left out

/** The library from the text that massspring.wasm.js has left here; without SIMD from the other one. */
async function openLibrary() {
  const bytesOf = (text) => {
    const letters = atob(text), bytes = new Uint8Array(letters.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
    return bytes;
  };
  try {
    return await open({ wasm: bytesOf(globalThis.massspringSimd) });
  } catch {
    await new Promise((done, failed) => {
      const script = document.createElement('script');
      script.src = new URL('massspring_scalar.wasm.js', document.querySelector('script[src$="figures.js"]').src);
      script.onload = done;
      script.onerror = failed;
      document.head.append(script);
    });
    return open({ wasm: bytesOf(globalThis.massspringScalar) });
  }
}

// Gives way to the page each 8 ms, so that long checks disturb nothing.
function makeBreathe() {
  const channel = new MessageChannel();
  let until = performance.now() + 8, wake;
  channel.port1.onmessage = () => wake();
  return async () => {
    if (performance.now() < until) return;
    await new Promise((done) => {
      wake = done;
      channel.port2.postMessage(0);
    });
    until = performance.now() + 8;
  };
}

// what: a sentence with {} for the number that was found; unit follows each number. A time depends on the computer, too.
export function judge({ what, found, wanted, within, least, most, digits = 2, unit = '', timed = false }) {
  const ok = least !== undefined ? found >= least : most !== undefined ? found <= most : Math.abs(found - wanted) <= within;
  const number = (value) => (Number.isInteger(value) && !digits ? String(value) : value.toFixed(digits)) + unit;
  const [low, high] = [wanted - within, wanted + within].map(number);
  const limit = least !== undefined ? `at least ${least}${unit}` : most !== undefined ? `at most ${most}${unit}`
    : low === high ? `must be ${number(wanted)}` : `must be ${low} to ${high}`;
  return { ok, timed, text: `${ok ? '✓' : '✗'} ${what.replace('{}', number(found))} (${limit})` };
}

class Stage {
  constructor(element, figure, ms) {
    Object.assign(this, { element, figure, ms, time: 0, visible: false, checked: null, steps: 0 });
    this.canvas = element.querySelector('canvas');
    this.pen = new Pen(this.canvas);
    this.playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.play = element.querySelector('[data-play]');
    this.play.onclick = () => this.setPlaying(!this.playing);
    element.querySelector('[data-restart]').onclick = () => this.restart();
    for (const control of element.querySelectorAll('[data-control]')) this.bind(control);
    this.bindPointer();
    this.setPlaying(this.playing);
    this.restart();
  }

  get values() {
    const sliders = [...this.element.querySelectorAll('input')];
    return Object.fromEntries(sliders.map(({ dataset, value }) => [dataset.control, Number(value)]));
  }

  bind(control) {
    const name = control.dataset.control;
    if (control.tagName === 'BUTTON') {
      control.onclick = () => (this.running.press ? this.running.press(name) : this.restart());
      return;
    }
    const shown = control.closest('label').querySelector('output');
    control.oninput = () => {
      shown.textContent = control.value;
      this.restart();
    };
  }

  setPlaying(playing) {
    this.playing = playing;
    this.play.textContent = playing ? 'Pause' : 'Play';
    this.play.setAttribute('aria-pressed', String(playing));
  }

  restart() {
    this.letGo();
    this.running?.free();
    this.running = this.figure.start(this.ms, this.values);
    this.show();
  }

  // As many steps as fit the time that has passed, but no more than the machine can take.
  advance(seconds) {
    this.time = Math.min(this.time + seconds, LONGEST);
    const end = performance.now() + 14;
    while (this.time >= DT) {
      this.time -= DT;
      this.running.step();
      this.steps++;
      if (performance.now() > end) this.time = 0;
    }
    this.show();
  }

  show() {
    this.element.classList.add('running');
    this.pen.begin();
    this.running.draw(this.pen);
    this.element.querySelector('[data-now]').textContent = this.running.say();
  }

  /* --------------------------------------------------------------------------------------------------- pointer */

  bindPointer() {
    const { canvas } = this;
    const at = (event) => {
      const box = canvas.getBoundingClientRect();
      return this.pen.pick(event.clientX - box.left, event.clientY - box.top);
    };
    // A finger that takes hold does not scroll the page.
    canvas.addEventListener('touchstart', (event) => this.near(at(event.touches[0])) && event.preventDefault(), { passive: false });
    canvas.addEventListener('pointerdown', (event) => {
      const held = this.near(at(event));
      if (!held) return;
      canvas.setPointerCapture(event.pointerId);
      const grip = held.network.addGrip({ particle: held.particle, x: held.x, y: held.y, stiffness: 2e4, damping: 800 });
      this.held = { ...held, grip };
    });
    canvas.addEventListener('pointermove', (event) => {
      const point = this.held && at(event);
      if (point && point.index === this.held.index) this.held.network.moveGrip(this.held.grip, point.x, point.y);
    });
    for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, () => this.letGo());
  }

  near(point) {
    const network = point && this.running.grips?.[point.index];
    const found = network?.nearestParticle(point.x, point.y, 24 / point.scale);
    return found ? { ...point, network, particle: found.particle } : null;
  }

  letGo() {
    this.held?.network.removeGrip(this.held.grip);
    this.held = undefined;
  }

  /* ----------------------------------------------------------------------------------------------------- check */

  check() {
    this.checked ??= this.runCheck();
    return this.checked;
  }

  async runCheck() {
    const list = this.element.querySelector('[data-check]');
    let results;
    try {
      results = (await this.figure.check(this.ms, makeBreathe())).map(judge);
    } catch (error) {
      results = [{ ok: false, text: `✗ ${error}` }];
    }
    list.replaceChildren(...results.map(({ ok, text }) => {
      const line = document.createElement('li');
      line.className = ok ? 'passed' : 'failed';
      line.textContent = text;
      return line;
    }));
    return results;
  }
}

async function run() {
  const ms = await openLibrary(), stages = {};
  // A figure is made when it first comes into sight.
  const sight = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const { figure } = target.dataset;
      if (isIntersecting) stages[figure] ??= new Stage(target, figures[figure], ms);
      if (stages[figure]) stages[figure].visible = isIntersecting;
    }
  });
  for (const element of document.querySelectorAll('[data-figure]')) sight.observe(element);
  globalThis.figureStages = stages;
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () =>
    Object.values(stages).forEach((stage) => (stage.pen.readColours(), stage.show())));
  addEventListener('resize', () => Object.values(stages).forEach((stage) => stage.show()));

  let before = performance.now(), frames = 0;
  const frame = (now) => {
    const seen = Object.values(stages).filter(({ visible }) => visible);
    for (const stage of seen) if (stage.playing) stage.advance(Math.max(0, (now - before) / 1000));
    before = now;
    if (seen.some(({ steps }) => steps > 0)) globalThis.firstMotion ??= performance.now();
    // Checks begin once something has moved for a while, one after the other.
    if (++frames % 30 === 0) seen.find(({ checked }) => !checked)?.check();
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

run().catch((error) => {
  for (const place of document.querySelectorAll('[data-now]')) place.textContent = `This browser cannot run it: ${error.message}`;
  for (const place of document.querySelectorAll('[data-check]')) place.replaceChildren();
  console.error(error);
});
