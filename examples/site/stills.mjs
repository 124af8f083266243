// Still pictures of the figures, as SVG, for browsers that cannot run them, and until they start.
//
// A figure draws with the Pen of pen.js, which knows a canvas. Here it gets one that writes down what is drawn.
const WIDTH = 780, HEIGHT = 390, FAR = 1500;
const COLOURS = { ink: '#1c2229', dim: '#5b6672', line: '#dbe0e5', accent: '#c2410c', calm: '#8592a0', stretched: '#ef6c00',
  squeezed: '#1769d2', paper: '#fcfcfa' };

const short = (value) => String(Math.round(10 * value) / 10);

class Path {
  constructor() {
    this.d = [];
  }

  moveTo(x, y) {
    this.last = [x, y];
    this.isOn = false;
  }

  // Most of an exploded network is outside the picture, and left out.
  lineTo(x, y) {
    if (Math.max(...[x, y, ...this.last].map(Math.abs)) < FAR) {
      this.d.push(`${this.isOn ? '' : `M${this.last.map(short).join(' ')}`}L${short(x)} ${short(y)}`);
      this.isOn = true;
    } else this.isOn = false;
    this.last = [x, y];
  }
}

class Context extends Path {
  constructor() {
    super();
    Object.assign(this, { out: [], clips: 0, open: 0, saved: [] });
  }

  setTransform() {}
  clearRect() {}

  beginPath() {
    this.d = [];
    this.box = undefined;
  }

  save() {
    this.saved.push(this.open);
  }

  restore() {
    const open = this.saved.pop() ?? this.open;
    for (; this.open > open; this.open--) this.out.push('</g>');
  }

  rect(x, y, width, height) {
    this.box = `x="${short(x)}" y="${short(y)}" width="${short(width)}" height="${short(height)}"`;
  }

  clip() {
    const id = `c${this.clips++}`;
    this.out.push(`<clipPath id="${id}"><rect ${this.box}/></clipPath><g clip-path="url(#${id})">`);
    this.open++;
  }

  setLineDash(dash) {
    this.dash = dash;
  }

  stroke(path = this) {
    if (!path.d.length) return;
    const dash = this.dash?.length ? ` stroke-dasharray="${this.dash.join(' ')}"` : '';
    this.out.push(`<path d="${path.d.join('')}" fill="none" stroke="${this.strokeStyle}" stroke-width="${short(this.lineWidth)}"${dash}/>`);
  }

  arc(x, y, radius) {
    this.round = [x, y, radius];
  }

  fill() {
    const [x, y, radius] = this.round.map(short);
    this.out.push(`<circle cx="${x}" cy="${y}" r="${radius}" fill="${this.fillStyle}"/>`);
  }

  fillRect(x, y, width, height) {
    this.rect(x, y, width, height);
    this.out.push(`<rect ${this.box} fill="${this.fillStyle}"/>`);
  }

  fillText(words, x, y) {
    const anchor = { center: 'middle', right: 'end' }[this.textAlign] ?? 'start';
    const text = words.replace(/&/g, '&amp;').replace(/</g, '&lt;');
    this.out.push(`<text x="${short(x)}" y="${short(y)}" fill="${this.fillStyle}" text-anchor="${anchor}">${text}</text>`);
  }

  svg() {
    for (; this.open; this.open--) this.out.push('</g>');
    return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" font-family="system-ui, sans-serif" font-size="12">` +
      `<rect width="${WIDTH}" height="${HEIGHT}" fill="${COLOURS.paper}"/>${this.out.join('')}</svg>\n`;
  }
}

/** An SVG of each figure after some steps, by name. */
export function stills(figures, Pen, ms) {
  globalThis.window = { devicePixelRatio: 1 };
  globalThis.getComputedStyle = () => ({ getPropertyValue: (name) => COLOURS[name.slice(2)] });
  globalThis.Path2D = Path;
  return Object.fromEntries(Object.entries(figures).map(([name, figure]) => {
    const context = new Context();
    const pen = new Pen({ clientWidth: WIDTH, clientHeight: HEIGHT, width: WIDTH, height: HEIGHT, getContext: () => context });
    const values = Object.fromEntries(figure.controls.filter(({ press }) => !press).map((control) => [control.name, control.value]));
    const running = figure.start(ms, values);
    for (let step = 0; step < (figure.still ?? 100); step++) running.step();
    pen.begin();
    running.draw(pen);
    running.free();
    return [name, context.svg()];
  }));
}
