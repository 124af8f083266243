// Every link and picture of every page leads to a file of the site, and to a mark that is there.
//
//   node links.mjs SITE
import { existsSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { dirname, join, normalize } from 'node:path';

const [site] = process.argv.slice(2);
const pages = readdirSync(site, { recursive: true }).filter((name) => name.endsWith('.html'));
const decode = (text) => decodeURIComponent(text.replace(/&amp;/g, '&').replace(/&quot;/g, '"'));
const marks = new Map(pages.map((page) => [page, new Set([...readFileSync(join(site, page), 'utf8')
  .matchAll(/\b(?:id|name)="([^"]+)"/g)].map(([, mark]) => decode(mark)))]));

let links = 0, elsewhere = 0;
const wrong = new Set();
for (const page of pages) {
  const text = readFileSync(join(site, page), 'utf8').replace(/<pre[^]*?<\/pre>/g, '').replace(/<script(?! src)[^]*?<\/script>/g, '');
  for (const [, , link] of text.matchAll(/<(?:a|img|script|link)\b[^>]*?\b(href|src)="([^"]*)"/g)) {
    if (/^(https?:|mailto:)/.test(link)) {
      // Words may name other places, but nothing is loaded from there.
      elsewhere++;
      if (new RegExp(`<(img|script|link)[^>]*"${link.replace(/[^\w]/g, '.')}"`).test(text)) wrong.add(`${page}: loads ${link}`);
      continue;
    }
    if (link.startsWith('data:') || link.startsWith('javascript:')) continue;
    links++;
    if (/^massspring\.html#/.test(link)) continue; // settings of the playground
    const [path, mark] = decode(link).split('#'), goal = path ? normalize(join(dirname(page), path)) : page;
    if (!existsSync(join(site, goal)) || !statSync(join(site, goal)).isFile()) wrong.add(`${page}: there is no ${link}`);
    else if (mark && !marks.get(goal)?.has(mark)) wrong.add(`${page}: ${goal} has no mark ${mark}`);
  }
}
// Entries of the search.
const found = JSON.parse(readFileSync(join(site, 'search_index.js'), 'utf8').match(/= (\[.*\]);/)[1]);
for (const [words, link] of found) {
  const [path, mark] = link.split('#');
  if (!existsSync(join(site, path)) || (mark && !marks.get(path)?.has(mark))) wrong.add(`search: ${words} leads to ${link}`);
}
if (pages.length < 40 || links < 1000 || found.length < 100) wrong.add('hardly anything was found');
console.log(`${pages.length} pages, ${links} links within, ${elsewhere} to elsewhere, ${found.length} to search, ${wrong.size} wrong`,
  ...[...wrong].map((text) => `\nWRONG: ${text}`));
process.exit(wrong.size ? 1 : 0);
