// Pictures of the repository are small, and drawing one anew leaves it as it is unless it shows something else.
//
//   node pictures.mjs SOURCE WORK
import { strict as assert } from 'node:assert';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';

const [source, work] = process.argv.slice(2), MOST = 300e3, MOST_OF_ALL = 5e6;
const pictures = join(source, 'examples/pictures');
let sum = 0;
for (const name of readdirSync(pictures).filter((file) => file.endsWith('.png'))) {
  const { size } = statSync(join(pictures, name));
  assert(size <= MOST, `${name} has ${size} bytes: examples/pictures/shrink.mjs makes it small`);
  sum += size;
}
assert(sum <= MOST_OF_ALL, `the pictures have ${sum} bytes`);

mkdirSync(work, { recursive: true });
const kept = join(work, 'kept.png'), shrink = (from) => execFileSync(process.execPath, [join(pictures, 'shrink.mjs'), from, kept], { encoding: 'utf8' });
for (const [name, other] of [['03_bar_rubber', '03_bar_iron'], ['03_bar_rubber_animation', '19_box2d']]) {
  const file = join(pictures, `${name}.png`);
  copyFileSync(file, kept);
  assert.match(shrink(file), /: kept,/, `${name} shows the same`);
  assert(readFileSync(kept).equals(readFileSync(file)));
  assert.match(shrink(join(pictures, `${other}.png`)), /: renewed,/, `${other} is another picture`);
}
console.log(`${Math.round(sum / 1000)} kB of pictures`);
