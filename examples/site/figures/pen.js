// Draws networks and plots on a canvas, in the colours of the page.
const NAMES = ['ink', 'dim', 'line', 'accent', 'calm', 'stretched', 'squeezed', 'paper'];
const SHADES = 6; // of strain, on each side

const rgb = (text) => text.match(/\w\w/g).map((part) => parseInt(part, 16));
const mixed = (from, to, part) => `rgb(${rgb(from).map((value, i) => Math.round(value + (rgb(to)[i] - value) * part))})`;

// 0.5, 10, 2000, 1e5, 1e-7
const short = (value) => (value !== 0 && (Math.abs(value) >= 1e4 || Math.abs(value) < 1e-3) ? value.toExponential(0).replace('e+', 'e')
  : String(Number(value.toPrecision(3))));

export class Pen {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.layouts = new WeakMap();
    this.readColours();
  }

  readColours() {
    const style = getComputedStyle(this.canvas);
    this.colours = Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
    this.shades = [];
    for (let i = -SHADES; i <= SHADES; i++)
      this.shades.push(mixed(this.colours.calm, this.colours[i < 0 ? 'squeezed' : 'stretched'], Math.sqrt(Math.abs(i) / SHADES)));
  }

  begin() {
    const { canvas, context } = this, dots = Math.min(2, window.devicePixelRatio || 1);
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * dots) || canvas.height !== Math.round(height * dots)) {
      canvas.width = Math.round(width * dots);
      canvas.height = Math.round(height * dots);
    }
    context.restore(); // no clip is left
    context.setTransform(dots, 0, 0, dots, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = '12px system-ui, sans-serif';
    context.lineJoin = 'round';
    this.all = { x: 0, y: 0, width, height };
    this.places = [];
  }

  /* ------------------------------------------------------------------------------------------------ places */

  /** Side by side, or one below the other where the canvas is narrow. */
  columns(count) {
    const { width, height } = this.all;
    if (width < 1.3 * height) return this.rows(Array(count).fill(1));
    return Array.from({ length: count }, (_, i) => ({ x: (i * width) / count, y: 0, width: width / count, height }));
  }

  rows(shares) {
    const { width, height } = this.all, sum = shares.reduce((a, b) => a + b);
    let y = 0;
    return shares.map((share) => {
      const place = { x: 0, y, width, height: (share / sum) * height };
      y += place.height;
      return place;
    });
  }

  /** Map this box of the world, in m, to a place on the canvas, for all that is drawn from now on. */
  world(place, { minX, maxX, minY, maxY }) {
    const { context } = this;
    context.restore();
    context.save();
    context.beginPath();
    context.rect(place.x, place.y, place.width, place.height);
    context.clip();
    const scale = Math.min(place.width / (maxX - minX), place.height / (maxY - minY));
    this.scale = scale;
    this.left = place.x + place.width / 2 - (scale * (minX + maxX)) / 2;
    this.base = place.y + place.height / 2 + (scale * (minY + maxY)) / 2;
    this.places.push({ place, scale, left: this.left, base: this.base });
  }

  at(x, y) {
    return [this.left + this.scale * x, this.base - this.scale * y];
  }

  /** The point of the world under a point of the canvas, and which world that is. */
  pick(x, y) {
    const index = this.places.findIndex(({ place }) => x >= place.x && x <= place.x + place.width && y >= place.y &&
      y <= place.y + place.height);
    if (index < 0) return null;
    const { scale, left, base } = this.places[index];
    return { index, x: (x - left) / scale, y: (base - y) / scale, scale };
  }

  /* ----------------------------------------------------------------------------------------------- networks */

  // Ends by slot, which stay while the layout does.
  layoutOf(network, generation) {
    let layout = this.layouts.get(network);
    if (layout?.generation !== generation) {
      layout = { generation, ends: network.get(['slotA', 'slotB']), strains: new Float32Array(network.springCount) };
      this.layouts.set(network, layout);
    }
    return layout;
  }

  /** All springs, in the full colour where strained by limit. */
  network(network, limit, { thick = 0, dots = 0 } = {}) {
    const { ends, strains } = this.layoutOf(network, network.view.layoutGeneration);
    network.get('strain', { first: 0 }, strains);
    const view = network.view, { originX, originY, inverseMass } = view, { x, y } = view;
    const paths = this.shades.map(() => new Path2D());
    for (let s = 0; s < strains.length; s++) {
      const a = ends[2 * s], b = ends[2 * s + 1], shade = Math.max(-1, Math.min(1, strains[s] / limit || 0));
      const path = paths[Math.round(SHADES * shade) + SHADES];
      path.moveTo(...this.at(originX + x[a], originY + y[a]));
      path.lineTo(...this.at(originX + x[b], originY + y[b]));
    }
    const { context } = this;
    context.lineWidth = thick || Math.min(3, Math.max(0.7, 0.09 * this.scale));
    for (let i = 0; i < paths.length; i++) {
      context.strokeStyle = this.shades[i];
      context.stroke(paths[i]);
    }
    for (let i = 0; i < view.slotCount; i++) {
      if (inverseMass[i] !== 0 && !dots) continue;
      if (view.particleOfSlot[i] >= network.particleCount) continue;
      this.dot([originX + x[i], originY + y[i]], inverseMass[i] ? 'ink' : 'accent', dots || Math.max(1.5, 0.2 * this.scale));
    }
  }

  /** A body of plain arrays. */
  plain({ x, y, a, b }) {
    const path = new Path2D(), { context } = this;
    for (let s = 0; s < a.length; s++) {
      path.moveTo(...this.at(x[a[s]], y[a[s]]));
      path.lineTo(...this.at(x[b[s]], y[b[s]]));
    }
    context.lineWidth = Math.min(3, Math.max(0.7, 0.09 * this.scale));
    context.strokeStyle = this.colours.calm;
    context.stroke(path);
  }

  dot([x, y], colour, radius) {
    const { context } = this;
    context.fillStyle = this.colours[colour];
    context.beginPath();
    context.arc(...this.at(x, y), radius, 0, 7);
    context.fill();
  }

  line(points, { colour = 'ink', dash = false, width = 1.5 } = {}) {
    const { context } = this;
    context.beginPath();
    points.forEach(([x, y], i) => (i ? context.lineTo(...this.at(x, y)) : context.moveTo(...this.at(x, y))));
    this.stroke(colour, dash, width);
  }

  stroke(colour, dash, width = 1.5) {
    const { context } = this;
    context.setLineDash(dash ? [5, 4] : []);
    context.lineWidth = width;
    context.strokeStyle = this.colours[colour];
    context.stroke();
    context.setLineDash([]);
  }

  /* -------------------------------------------------------------------------------------------------- words */

  text(words, x, y, { colour = 'dim', align = 'left' } = {}) {
    const { context } = this;
    context.fillStyle = this.colours[colour];
    context.textAlign = align;
    context.fillText(words, x, y);
  }

  word(point, words, { under = false } = {}) {
    const [x, y] = this.at(...point);
    this.text(words, x, under ? y + 15 : y - 5);
  }

  label(place, words) {
    this.text(words, place.x + 10, place.y + 18, { colour: 'ink' });
  }

  /** A line between this place and the one before. */
  divide({ x, y, width, height }) {
    this.context.restore();
    this.context.beginPath();
    this.context.moveTo(x, y);
    this.context.lineTo(x ? x : width, x ? height : y);
    this.stroke('dim', false, 1);
  }

  /* -------------------------------------------------------------------------------------------------- plots */

  plot(place, { x, y, log = false, logX = false, xName, yName, curves }) {
    this.context.restore();
    const frame = { x: place.x + 44, y: place.y + 26, width: place.width - 58, height: place.height - 60 };
    const part = ([from, to], value, isLog) => (isLog ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from));
    const atX = (value) => frame.x + frame.width * part(x, value, logX);
    const atY = (value) => frame.y + frame.height * (1 - part(y, value, log));
    this.axes(frame, { x, y, log, logX, xName, yName }, atX, atY);
    const { context } = this;
    context.save();
    context.beginPath();
    context.rect(frame.x - 5, frame.y - 5, frame.width + 10, frame.height + 10);
    context.clip();
    for (const { points, colour = 'dim', dash, dots } of curves) {
      context.beginPath();
      points.forEach(([px, py], i) => (i ? context.lineTo(atX(px), atY(py)) : context.moveTo(atX(px), atY(py))));
      this.stroke(colour, dash);
      context.fillStyle = this.colours[colour];
      for (const [px, py] of dots ? points : []) context.fillRect(atX(px) - 3, atY(py) - 3, 6, 6);
    }
    context.restore();
    curves.filter(({ name, points }) => name && points.length).forEach(({ name, points, colour }) => {
      const [px, py] = points.at(-1);
      this.text(name, Math.min(atX(px) + 6, frame.x + frame.width), Math.max(frame.y + 8, atY(py) - 8), { colour, align: 'right' });
    });
  }

  axes(frame, { x, y, log, logX, xName, yName }, atX, atY) {
    const { context } = this;
    context.beginPath();
    for (const value of ticks(x, logX, Math.max(2, frame.width / 90))) {
      context.moveTo(atX(value), frame.y);
      context.lineTo(atX(value), frame.y + frame.height);
      this.text(short(value), atX(value), frame.y + frame.height + 15, { align: 'center' });
    }
    for (const value of ticks(y, log, Math.max(2, frame.height / 40))) {
      context.moveTo(frame.x, atY(value));
      context.lineTo(frame.x + frame.width, atY(value));
      this.text(short(value), frame.x - 5, atY(value) + 4, { align: 'right' });
    }
    this.stroke('line', false, 1);
    this.text(xName, frame.x + frame.width, frame.y + frame.height + 29, { align: 'right' });
    this.text(yName, frame.x - 38, frame.y - 12);
  }
}

function ticks([from, to], isLog, most) {
  const low = Math.min(from, to), high = Math.max(from, to), found = [];
  if (isLog) {
    const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9);
    const every = Math.max(1, Math.ceil((last - first + 1) / most));
    for (let power = first; power <= last; power += every) found.push(10 ** power);
    return found;
  }
  const rough = (high - low) / most, ten = 10 ** Math.floor(Math.log10(rough));
  const step = ten * [1, 2, 5, 10].find((times) => times * ten >= rough);
  for (let i = Math.ceil(low / step); i * step <= high + 1e-9; i++) found.push(i * step);
  return found;
}
