// Shrinks a picture and replaces the kept one, unless both show the same.
//
//   node shrink.mjs NEW.png KEPT.png
//
// NEW, still or moving, gets as few colours as look the same; an animation also gets fewer frames, until it has at most 300 kB.
// Pixels that stay from frame to frame are left out. KEPT stays as it is if it shows the same and is not much larger.
// Pictures with a digit of a clock in a corner show the same.
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { constants, crc32, deflateSync, inflateSync } from 'node:zlib';

const MOST = 300e3; // bytes of an animation
const HARM = 1.5; // of 255: RMS change of a still picture by fewer colours
const SAME = 2.5; // of 255: RMS difference of two pictures that show the same
const MUCH = 1.1; // times as large
const TRIES = [[128, 1], [64, 1], [32, 1], [32, 2], [24, 2], [20, 2], [32, 3], [16, 3]]; // colours; keep every n-th frame

/* --------------------------------------------------------------------------------------------------------- read */

function unfilter(bytes, width, height, size) {
  const stride = width * size, out = new Uint8Array(stride * height);
  for (let row = 0; row < height; row++) {
    const filter = bytes[row * (stride + 1)], from = row * (stride + 1) + 1, to = row * stride;
    for (let i = 0; i < stride; i++) {
      const left = i >= size ? out[to + i - size] : 0, up = row ? out[to + i - stride] : 0;
      const corner = row && i >= size ? out[to + i - stride - size] : 0;
      const p = left + up - corner, a = Math.abs(p - left), b = Math.abs(p - up), c = Math.abs(p - corner);
      const guess = [0, left, up, (left + up) >> 1, a <= b && a <= c ? left : b <= c ? up : corner][filter];
      out[to + i] = bytes[from + i] + guess;
    }
  }
  return out;
}

// Places of a palette may have less than a byte.
function unpack(bytes, width, height, bits) {
  if (bits === 8) return unfilter(bytes, width, height, 1);
  const packed = Math.ceil((width * bits) / 8), rows = unfilter(bytes, packed, height, 1), out = new Uint8Array(width * height);
  for (let row = 0; row < height; row++)
    for (let x = 0; x < width; x++) {
      const bit = x * bits;
      out[row * width + x] = (rows[row * packed + (bit >> 3)] >> (8 - bits - (bit & 7))) & ((1 << bits) - 1);
    }
  return out;
}

/** Frames as RGB, each whole, and how long each is shown, ms. */
function read(path) {
  const file = readFileSync(path), frames = [];
  let width, height, bits, type, plte, clear = -1, part, data = [];
  const paint = () => {
    if (!data.length) return;
    const channels = { 2: 3, 3: 1, 6: 4 }[type], raw = inflateSync(Buffer.concat(data));
    const pixels = type === 3 ? unpack(raw, part.width, part.height, bits) : unfilter(raw, part.width, part.height, channels);
    const rgb = frames.length ? frames.at(-1).rgb.slice() : new Uint8Array(3 * width * height);
    for (let y = 0; y < part.height; y++)
      for (let x = 0; x < part.width; x++) {
        const from = y * part.width + x, to = 3 * ((part.y + y) * width + part.x + x);
        if (type === 3 && pixels[from] === clear) continue;
        for (let c = 0; c < 3; c++) rgb[to + c] = type === 3 ? plte[3 * pixels[from] + c] : pixels[channels * from + c];
      }
    frames.push({ rgb, delay: part.delay });
    data = [];
  };
  for (let at = 8; at < file.length;) {
    const length = file.readUInt32BE(at), name = file.toString('latin1', at + 4, at + 8), body = file.subarray(at + 8, at + 8 + length);
    if (name === 'IHDR') {
      [width, height, bits, type] = [body.readUInt32BE(0), body.readUInt32BE(4), body[8], body[9]];
      part = { x: 0, y: 0, width, height, delay: 0 };
    } else if (name === 'PLTE') plte = body;
    else if (name === 'tRNS' && type === 3) clear = body.indexOf(0);
    else if (name === 'fcTL') {
      paint();
      part = { width: body.readUInt32BE(4), height: body.readUInt32BE(8), x: body.readUInt32BE(12), y: body.readUInt32BE(16),
        delay: (1000 * body.readUInt16BE(20)) / (body.readUInt16BE(22) || 100) };
    } else if (name === 'IDAT') data.push(body);
    else if (name === 'fdAT') data.push(body.subarray(4));
    at += 12 + length;
  }
  paint();
  return { width, height, frames };
}

/* ------------------------------------------------------------------------------------------------------ colours */

// Rare colours get more weight: they often show the subject.
const weightOf = (count) => count ** 0.35;

// The box of colours that is spread widest is cut at its mean, until there are enough.
function chooseColours(frames, most) {
  const counts = new Map();
  for (const { rgb } of frames)
    for (let i = 0; i < rgb.length; i += 3) {
      const colour = (rgb[i] << 16) | (rgb[i + 1] << 8) | rgb[i + 2];
      counts.set(colour, (counts.get(colour) ?? 0) + 1);
    }
  const all = [...counts].map(([colour, count]) => ({ rgb: [colour >> 16, (colour >> 8) & 255, colour & 255], count }));
  const measured = (colours) => {
    const weight = colours.reduce((sum, { count }) => sum + weightOf(count), 0);
    const means = [0, 1, 2].map((c) => colours.reduce((sum, { rgb, count }) => sum + weightOf(count) * rgb[c], 0) / weight);
    const spreads = means.map((mean, c) => colours.reduce((sum, { rgb, count }) => sum + weightOf(count) * (rgb[c] - mean) ** 2, 0));
    const channel = spreads.indexOf(Math.max(...spreads));
    return { colours, means, channel, spread: colours.length > 1 ? spreads[channel] : 0 };
  };
  const boxes = [measured(all)];
  while (boxes.length < most) {
    const widest = boxes.reduce((best, box) => (box.spread > best.spread ? box : best));
    if (!(widest.spread > 1e-6)) break;
    const low = ({ rgb }) => rgb[widest.channel] <= widest.means[widest.channel];
    boxes.splice(boxes.indexOf(widest), 1, measured(widest.colours.filter(low)), measured(widest.colours.filter((colour) => !low(colour))));
  }
  const place = new Map();
  boxes.forEach(({ colours }, i) => colours.forEach(({ rgb }) => place.set((rgb[0] << 16) | (rgb[1] << 8) | rgb[2], i)));
  // The commonest colour of a box, so that grounds stay what they are.
  const common = boxes.map(({ colours }) => colours.reduce((best, colour) => (colour.count > best.count ? colour : best)).rgb);
  const mean = boxes.map(({ means }, i) => (Math.hypot(...means.map((value, c) => value - common[i][c])) < 12 ? common[i] : means.map(Math.round)));
  return { colours: mean, place };
}

const placesOf = ({ rgb }, { place }) => Uint8Array.from({ length: rgb.length / 3 }, (_, i) =>
  place.get((rgb[3 * i] << 16) | (rgb[3 * i + 1] << 8) | rgb[3 * i + 2]));

/* -------------------------------------------------------------------------------------------------------- write */

function chunk(name, ...parts) {
  const body = Buffer.concat([Buffer.from(name, 'latin1'), ...parts]), out = Buffer.alloc(body.length + 8);
  out.writeUInt32BE(body.length - 4);
  body.copy(out, 4);
  out.writeUInt32BE(checksum(body), body.length + 4);
  return out;
}

// node has zlib.crc32 from 20.15 on.
function checksum(bytes) {
  if (crc32) return crc32(bytes);
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit++) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
  }
  return ~crc >>> 0;
}

function numbers(...values) {
  const out = Buffer.alloc(4 * values.length);
  values.forEach((value, i) => out.writeUInt32BE(value, 4 * i));
  return out;
}

function packed(places, width, part, bits) {
  const stride = Math.ceil((part.width * bits) / 8), rows = Buffer.alloc((stride + 1) * part.height);
  for (let y = 0; y < part.height; y++)
    for (let x = 0; x < part.width; x++)
      rows[y * (stride + 1) + 1 + ((x * bits) >> 3)] |= places[(part.y + y) * width + part.x + x] << (8 - bits - ((x * bits) & 7));
  const each = [constants.Z_DEFAULT_STRATEGY, constants.Z_FILTERED].map((strategy) => deflateSync(rows, { level: 9, memLevel: 9, strategy }));
  return each.reduce((best, one) => (one.length < best.length ? one : best));
}

// Rectangle that has changed since the frame before; unchanged pixels get the clear colour if that is smaller.
function change(now, before, width, height, clear) {
  let left = width, right = 0, top = height, bottom = 0;
  for (let i = 0; i < now.length; i++) {
    if (now[i] === before[i]) continue;
    const x = i % width, y = Math.floor(i / width);
    [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)];
  }
  const part = left > right ? { x: 0, y: 0, width: 1, height: 1 } : { x: left, y: top, width: right - left + 1, height: bottom - top + 1 };
  return { part, cleared: now.map((place, i) => (place === before[i] ? clear : place)) };
}

function write({ width, height, frames }, most) {
  const chosen = chooseColours(frames, frames.length > 1 ? most - 1 : most), count = chosen.colours.length, clear = count;
  const bits = count + (frames.length > 1) <= 16 ? 4 : 8, out = [Buffer.from('\x89PNG\r\n\x1a\n', 'latin1')];
  out.push(chunk('IHDR', numbers(width, height), Buffer.from([bits, 3, 0, 0, 0])));
  if (frames.length > 1) out.push(chunk('acTL', numbers(frames.length, 0)));
  out.push(chunk('PLTE', Buffer.from([...chosen.colours.flat(), ...(frames.length > 1 ? [0, 0, 0] : [])])));
  if (frames.length > 1) out.push(chunk('tRNS', Buffer.from([...Array(count).fill(255), 0])));
  let sequence = 0, before;
  frames.forEach((frame, i) => {
    const places = placesOf(frame, chosen), all = { x: 0, y: 0, width, height };
    const { part, cleared } = i ? change(places, before, width, height, clear) : { part: all };
    const whole = packed(places, width, part, bits), over = i ? packed(cleared, width, part, bits) : whole, isOver = over.length < whole.length;
    if (frames.length > 1) {
      const delay = Buffer.alloc(6);
      delay.writeUInt16BE(Math.round(frame.delay), 0);
      delay.writeUInt16BE(1000, 2);
      delay[5] = isOver ? 1 : 0;
      out.push(chunk('fcTL', numbers(sequence++, part.width, part.height, part.x, part.y), delay));
    }
    out.push(i ? chunk('fdAT', numbers(sequence++), isOver ? over : whole) : chunk('IDAT', whole));
    before = places;
  });
  out.push(chunk('IEND'));
  return Buffer.concat(out);
}

/* ---------------------------------------------------------------------------------------------------------- all */

// Every n-th frame, and the last; times add up.
function thinned(picture, every) {
  const frames = [], last = picture.frames.length - 1;
  let time = 0;
  picture.frames.forEach((frame, i) => {
    if (i === last && i % every) frames.push({ rgb: frame.rgb, delay: 0 });
    else if (i % every === 0) frames.push({ rgb: frame.rgb, delay: 0 });
    frames.at(-1).delay += frame.delay;
    time += frame.delay;
  });
  return { ...picture, frames };
}

function difference(a, b) {
  if (a.width !== b.width || a.height !== b.height || a.frames.length !== b.frames.length) return Infinity;
  let sum = 0, count = 0;
  a.frames.forEach(({ rgb }, f) => {
    const other = b.frames[f].rgb;
    for (let i = 0; i < rgb.length; i++) sum += (rgb[i] - other[i]) ** 2;
    count += rgb.length;
  });
  return Math.sqrt(sum / count);
}

function harm(picture, colours) {
  const { colours: list, place } = chooseColours(picture.frames, colours);
  let sum = 0;
  for (const { rgb } of picture.frames)
    for (let i = 0; i < rgb.length; i += 3) {
      const to = list[place.get((rgb[i] << 16) | (rgb[i + 1] << 8) | rgb[i + 2])];
      sum += (to[0] - rgb[i]) ** 2 + (to[1] - rgb[i + 1]) ** 2 + (to[2] - rgb[i + 2]) ** 2;
    }
  return Math.sqrt(sum / (picture.frames.length * picture.frames[0].rgb.length));
}

function shrunk(picture) {
  if (picture.frames.length === 1) return write(picture, [16, 32, 64, 128].find((colours) => harm(picture, colours) < HARM) ?? 256);
  let smallest;
  for (const [colours, every] of TRIES) {
    const bytes = write(thinned(picture, every), colours);
    if (!smallest || bytes.length < smallest.length) smallest = bytes;
    if (bytes.length <= MOST) break;
  }
  return smallest;
}

const [from, to] = process.argv.slice(2);
if (!from || !to) {
  console.error('usage: node shrink.mjs NEW.png KEPT.png');
  process.exit(2);
}
const made = shrunk(read(from)), old = existsSync(to) ? readFileSync(to) : null;
const temporary = `${to}.new`;
writeFileSync(temporary, made);
const isSame = old && old.length < MUCH * made.length && difference(read(temporary), read(to)) < SAME;
const { rmSync, renameSync } = await import('node:fs');
if (isSame) rmSync(temporary);
else renameSync(temporary, to);
console.log(`${to.replace(/.*\//, '')}: ${isSame ? 'kept' : 'renewed'}, ${Math.round((isSame ? old : made).length / 1000)} kB`);
