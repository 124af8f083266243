// What lies above the springs: pins, and the spring under the pointer.
'use strict';

const TIP_RADIUS = 10; // pixels
const PIN = 0.4, LARGEST_PIN = 4; // m, pixels

class Marks {
  constructor(canvas, tip) {
    this.canvas = canvas;
    this.tip = tip;
    this.pins = null; // slots; null: to be found
    this.spring = -1; // that the pointer rests on, or that was clicked
    this.kept = false; // by a click
  }

  // Pins have come or gone, or the network is another one.
  forget() {
    this.pins = null;
    this.kept = false;
    this.leave();
  }

  leave() {
    this.spring = -1;
    this.tip.style.display = 'none';
  }

  // Slots without springs have no mass, either: only ends of springs count.
  findPins(ends, inverseMass) {
    const found = new Set();
    for (let i = 0; i < ends.length; i += 3)
      for (const slot of [ends[i], ends[i + 1]]) if (inverseMass[slot] === 0) found.add(slot);
    this.pins = [...found];
  }

  draw(core, relative) {
    const { canvas } = this, { width, height } = drawing.canvas, pen = canvas.getContext('2d');
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    pen.clearRect(0, 0, width, height);
    const slots = core.slots(), x = floats(core.x(), slots), y = floats(core.y(), slots);
    const ends = new Uint32Array(core.memory.buffer, core.springs(), 3 * core.spring_count());
    if (!this.pins) this.findPins(ends, floats(core.inverse_mass(), slots));
    const place = (slot) => [(x[slot] - relative.x) * relative.scale + width / 2,
      height / 2 - (y[slot] - relative.y) * relative.scale];
    const radius = Math.max(1, Math.min(LARGEST_PIN * devicePixelRatio, PIN * relative.scale));
    pen.fillStyle = '#f4f6fa';
    for (const slot of this.pins) {
      const [px, py] = place(slot);
      pen.beginPath();
      pen.arc(px, py, radius, 0, 7);
      pen.fill();
    }
    if (this.spring < 0) return;
    const at = 3 * this.spring, a = ends[at], b = ends[at + 1];
    pen.strokeStyle = '#f4f6fa';
    pen.lineWidth = 2 * devicePixelRatio;
    pen.beginPath();
    pen.moveTo(...place(a));
    pen.lineTo(...place(b));
    pen.stroke();
    this.say(core, Math.hypot(x[b] - x[a], y[b] - y[a]), floats(core.springs(), ends.length)[at + 2],
      floats(core.plastic(), ends.length / 3)[this.spring]);
  }

  say(core, length, rest, plastic) {
    const strain = length / rest - 1, much = Math.abs(100 * strain).toPrecision(2);
    const how = rest === 0 ? 'broken' : `${strain < 0 ? 'squeezed' : 'stretched'} by ${much} %`;
    const bent = plastic === 0 ? '' : `, bent by ${(100 * plastic).toPrecision(2)} % for good`;
    const force = rest === 0 ? '' : `, ${withPrefix(Math.abs(core.force(this.spring)), 'N')}`;
    const [from, to] = [0, 1].map((which) => core.end(this.spring, which).toLocaleString('en'));
    this.tip.textContent = `spring ${this.spring.toLocaleString('en')} of particles ${from} and ${to}: ` +
      `${length.toFixed(3)} m, ${how}${force}${bent}`;
  }

  // Rest on the nearest spring within some pixels of a place (m, relative to the origin), if there is one.
  rest(core, at, event, scale) {
    const slots = core.slots(), x = floats(core.x(), slots), y = floats(core.y(), slots);
    const ends = new Uint32Array(core.memory.buffer, core.springs(), 3 * core.spring_count());
    let least = (TIP_RADIUS * devicePixelRatio) / scale;
    this.leave();
    for (let i = 0; i < ends.length; i += 3) {
      const ax = x[ends[i]] - at.x, ay = y[ends[i]] - at.y, dx = x[ends[i + 1]] - x[ends[i]],
        dy = y[ends[i + 1]] - y[ends[i]];
      const along = Math.min(1, Math.max(0, -(ax * dx + ay * dy) / (dx * dx + dy * dy || 1)));
      const distance = Math.hypot(ax + along * dx, ay + along * dy);
      if (distance < least) [least, this.spring] = [distance, i / 3];
    }
    if (this.spring < 0) return;
    const wide = 320, left = Math.max(8, Math.min(event.clientX + 14, innerWidth - wide));
    Object.assign(this.tip.style, { display: 'block', top: event.clientY + 14 + 'px', left: left + 'px' });
  }
}
