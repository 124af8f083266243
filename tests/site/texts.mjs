// The headings of troubleshooting.md that are code are texts of the library, and no result lacks one.
//
//   node texts.mjs SOURCE
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

const [source] = process.argv.slice(2);
const page = readFileSync(join(source, 'examples/guides/troubleshooting.md'), 'utf8');

// Strings that follow each other are one. What a format prints is "...".
const LITERALS = /"((?:[^"\\\n]|\\.)*)"(?:\s*"(?:[^"\\\n]|\\.)*")*/g;
const texts = [];
for (const file of readdirSync(join(source, 'src'), { recursive: true }).filter((name) => name.endsWith('.c')))
  for (const [found] of readFileSync(join(source, 'src', file), 'utf8').matchAll(LITERALS))
    texts.push(found.replace(/"\s*"/g, '').slice(1, -1).replace(/%[-+#0-9.]*(?:z|l|ll)?[a-zA-Z]/g, '...'));

const headings = [...page.matchAll(/^(##+) `(.*)`$/gm)].map(([, level, text]) => ({ level: level.length, text }));
const wrong = headings.filter(({ text }) => !texts.some((known) => known.includes(text))).map(({ text }) => `nothing says "${text}"`);

const message = readFileSync(join(source, 'src/base/message.c'), 'utf8');
const results = [...message.slice(message.indexOf('*mspring_result_string(')).matchAll(/case (MSPRING_ERROR_\w+):\s*return "(.*)";/g)];
for (const [, name, text] of results) {
  if (!headings.some((heading) => heading.level === 2 && heading.text === text)) wrong.push(`no heading is "${text}"`);
  if (!page.includes(name)) wrong.push(`it lacks ${name}`);
}
if (results.length < 10 || headings.length < 20) wrong.push('hardly anything was found');
console.log(`${headings.length} headings, ${results.length} results, ${wrong.length} wrong`,
  ...wrong.map((text) => `\nWRONG: ${text}`));
process.exit(wrong.length ? 1 : 0);
