// Makes the pages of the site from the Markdown of the repository, and whatever they lead to.
//
//   node pages.mjs SOURCE FIGURES PACKAGE FOLDER
//
// A page lies where its Markdown does: examples/guides/solvers.md becomes examples/guides/solvers.html. So links stay what
// they are, but for the ending. Sources that a page links to become pages, too. FIGURES is a folder with the figures'
// modules beside which node finds the package massspring.
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { dirname, join, posix, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { bundle } from './bundle.mjs';
import { CONTENTS } from './contents.mjs';

const [source, figureFolder, library, folder] = process.argv.slice(2);
const { figures } = await import(pathToFileURL(resolve(figureFolder, 'all.js')));
const here = join(source, 'examples/site');
const hasReference = existsSync(join(folder, 'reference/annotated.html'));
const { version } = JSON.parse(readFileSync(join(library, 'package.json'), 'utf8'));
const REPOSITORY_ONLY = /^(build|out|\.git)\//;

const escape = (text) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;').replace(/"/g, '&quot;');
const plain = (html) => html.replace(/<[^>]*>/g, '').replace(/&lt;/g, '<').replace(/&gt;/g, '>').replace(/&quot;/g, '"')
  .replace(/&amp;/g, '&');

/* ------------------------------------------------------------------------------------------------------- figures */

function control({ name, label, press, min, max, step, value }) {
  if (press) return `<button type="button" data-control="${name}">${label}</button>`;
  const range = `min="${min}" max="${max}" step="${step}" value="${value}"`;
  return `<label>${label} <output>${value}</output><input type="range" data-control="${name}" ${range}></label>`;
}

function figureOf(name, title) {
  const figure = figures[name];
  if (!figure) throw new Error(`there is no figure ${name}`);
  return `<figure class="live" data-figure="${name}">
<canvas role="img" aria-label="Live figure: ${escape(title)}"></canvas>
<p class="now" data-now aria-live="off">It starts when it is in sight, with JavaScript and WebAssembly.</p>
<div class="controls">${figure.controls.map(control).join('\n')}
<span class="buttons"><button type="button" data-play aria-pressed="true">Pause</button>
<button type="button" data-restart>Restart</button></span></div>
<ul class="check" data-check aria-live="polite"><li>not checked yet</li></ul>
</figure>`;
}

/* --------------------------------------------------------------------------------------------------------- links */

const waiting = [], made = new Set();

function copy(path) {
  mkdirSync(join(folder, dirname(path)), { recursive: true });
  copyFileSync(join(source, path), join(folder, path));
}

// Where a link leads in the site, from a page in that folder of the repository; undefined: nowhere.
function target(from, link) {
  if (/^(https?:|mailto:|#)/.test(link)) return link;
  const [, path, mark = ''] = link.match(/^([^#]*)(#.*)?$/), goal = posix.normalize(posix.join(from, path)).replace(/\/$/, '');
  const back = (to) => posix.relative(from, to) + mark;
  if (REPOSITORY_ONLY.test(goal) || !existsSync(join(source, goal))) return undefined;
  if (statSync(join(source, goal)).isDirectory()) {
    if (!existsSync(join(source, goal, 'README.md'))) return undefined;
    return target(from, posix.join(path, 'README.md') + mark);
  }
  if (/^include\/massspring\/.*\.h$/.test(goal) && hasReference) return posix.relative(from, `reference/${referenceOf(goal)}`);
  if (/\.(png|svg|csv)$/.test(goal)) {
    copy(goal);
    return back(goal);
  }
  waiting.push(goal);
  return back(goal.endsWith('.md') ? goal.replace(/\.md$/, '.html') : `${goal}.html`);
}

// Doxygen's name of a header's page.
const referenceOf = (path) => `${path.split('/').at(-1).replace(/_/g, '__').replace(/\./g, '_8')}.html`;

function redirect(html, from) {
  return html
    .replace(/<a href="([^"]*)">([^]*?)<\/a>/g, (_, link, words) => {
      const goal = target(from, plain(link));
      return goal === undefined ? `<span class="elsewhere" title="${link} in the repository">${words}</span>`
        : `<a href="${escape(goal)}">${words.replace(/^[\w/]*?(\w+)\.md$/, '$1')}</a>`;
    })
    .replace(/<img src="([^"]*)" alt="([^"]*)"/g, (_, link, alt) => {
      const goal = escape(target(from, plain(link)) ?? link);
      return `<img loading="lazy" ${sizeOf(posix.join(from, link))} src="${goal}" alt="${alt}"`;
    });
}

// Pictures have their room before they are there.
function sizeOf(path) {
  const file = join(source, path);
  if (!existsSync(file)) return '';
  if (path.endsWith('.png')) {
    const bytes = readFileSync(file);
    return `width="${bytes.readUInt32BE(16)}" height="${bytes.readUInt32BE(20)}"`;
  }
  const [, width, height] = readFileSync(file, 'utf8').match(/<svg[^>]*?width="([\d.]+)[^"]*"[^>]*?height="([\d.]+)/) ?? [];
  return width ? `width="${width}" height="${height}"` : '';
}

/* --------------------------------------------------------------------------------------------------------- pages */

function marked(markdown) {
  return execFileSync('cmark-gfm', ['--unsafe', '-e', 'table'], { input: markdown, encoding: 'utf8', maxBuffer: 1 << 26 });
}

// Headings get the marks that a forge gives them. Those of pages in the menu can be searched.
const inMenu = new Set(CONTENTS.flatMap(({ links }) => links.map(([, goal]) => goal.split('#')[0])));
const index = [];
function withMarks(html, to) {
  const seen = new Map();
  return html.replace(/<h([1-6])>([^]*?)<\/h\1>/g, (_, level, words) => {
    const mark = plain(words).toLowerCase().replace(/[^\p{L}\p{N}_ -]/gu, '').replace(/ /g, '-'), times = seen.get(mark) ?? 0;
    seen.set(mark, times + 1);
    const id = `${mark}${times ? `-${times}` : ''}`;
    if (inMenu.has(to)) index.push([plain(words), `${to}#${id}`]);
    return `<h${level} id="${id}">${words}</h${level}>`;
  });
}

function navigation(path) {
  const from = posix.dirname(path), link = ([words, goal]) => {
    const [page] = goal.split('#'), current = page === path ? ' aria-current="page"' : '';
    return `<li><a href="${posix.relative(from, page)}${goal.slice(page.length)}"${current}>${words}</a></li>`;
  };
  return CONTENTS.filter(({ title }) => hasReference || title !== 'Reference')
    .map(({ title, links }) => `<h2>${title}</h2>\n<ul>${links.map(link).join('\n')}</ul>`).join('\n');
}

// What is above and beside the text of a page.
function surroundings(path) {
  const root = posix.relative(posix.dirname(path), '.') || '.', home = `${root}/index.html`;
  const menu = `<input type="search" data-search placeholder="Search" aria-label="Search guides and reference">
${navigation(path)}`;
  return `<a class="skip" href="#content">Skip to the text</a>
<header><a class="home" href="${home}">libmassspring <small>${version}</small></a>
<details class="menu"><summary>Pages</summary><nav aria-label="Pages">${menu}</nav></details></header>
<nav class="side" aria-label="All pages">${menu}</nav>
<script src="${root}/search_index.js" defer></script>
<script src="${root}/search.js" defer></script>`;
}

function page(path, title, body) {
  const root = posix.relative(posix.dirname(path), '.') || '.', live = body.includes('data-figure=');
  const script = (name) => `<script src="${root}/${name}.js" defer></script>\n`;
  const scripts = live ? script('massspring.wasm') + script('figures') : '';
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>${escape(title)}${title === 'libmassspring' ? '' : ' · libmassspring'}</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="${root}/site.css">
${scripts}</head>
<body>
${surroundings(path)}
<main id="content">
${body}
</main>
</body>
</html>
`;
}

function write(path, title, html) {
  const wide = html.replace(/<code>([^<]*)<\/code>(?!<\/pre>)/g, (_, words) => `<code>${words.replace(/_/g, '_<wbr>')}</code>`)
    .replace(/<table>/g, '<div class="table" tabindex="0"><table>').replace(/<\/table>/g, '</table></div>');
  mkdirSync(join(folder, posix.dirname(path)), { recursive: true });
  const body = wide.replace(/<!-- figure (\w+) -->/g, (_, name, at) =>
    figureOf(name, plain([...wide.slice(0, at).matchAll(/<h[1-3][^>]*>([^]*?)<\/h/g)].at(-1)?.[1] ?? title)));
  writeFileSync(join(folder, path), page(path, title, body));
}

function fromMarkdown(path, markdown, to = path.replace(/\.md$/, '.html')) {
  const html = withMarks(redirect(marked(markdown), posix.dirname(path)), to);
  write(to, plain(html.match(/<h1[^>]*>([^]*?)<\/h1>/)?.[1] ?? path), html);
}

function fromSource(path) {
  const text = readFileSync(join(source, path), 'utf8');
  write(`${path}.html`, path, `<h1 class="path">${escape(path)}</h1>\n<pre><code>${escape(text)}</code></pre>`);
}

// Functions, values and structs of the reference.
function referenceIndex() {
  if (!hasReference) return [];
  const found = [], read = (name) => readFileSync(join(folder, 'reference', name), 'utf8');
  for (const name of ['globals_func.html', 'globals_eval.html', 'globals_defs.html'])
    for (const [, words, goal] of read(name).matchAll(/<li>(\w+)(?:\(\))?&#160;:&#160;<a class="el" href="([^"]+)"/g))
      found.push([words, `reference/${goal}`]);
  for (const [, goal, words] of read('annotated.html').matchAll(/<a class="el" href="(struct[^"]+)"[^>]*>(\w+)<\/a>/g))
    found.push([words, `reference/${goal}`]);
  return found;
}

/* ---------------------------------------------------------------------------------------------------------- all */

// The first page is the README down to its commands.
const readme = readFileSync(join(source, 'README.md'), 'utf8'), opening = readme.slice(0, readme.indexOf('\n## Two commands'));
fromMarkdown('README.md', opening.replace(/^(# .*\n\n[^]*?\n\n)/, '$1<!-- figure jelly -->\n\n'), 'index.html');
waiting.push('README.md', ...CONTENTS.flatMap(({ links }) => links.map(([, goal]) => goal.split('#')[0]))
  .filter((goal) => goal.endsWith('.html') && goal !== 'index.html' && !goal.startsWith('reference/'))
  .map((goal) => goal.replace(/\.html$/, '.md')));
while (waiting.length) {
  const path = waiting.shift();
  if (made.has(path)) continue;
  made.add(path);
  if (path.endsWith('.md')) fromMarkdown(path, readFileSync(join(source, path), 'utf8'));
  else fromSource(path);
}

for (const name of hasReference ? readdirSync(join(folder, 'reference')).filter((found) => found.endsWith('.html')) : []) {
  const file = join(folder, 'reference', name);
  writeFileSync(file, readFileSync(file, 'utf8').replace('<!-- navigation -->', surroundings(`reference/${name}`)));
}
for (const name of ['site.css', 'search.js']) copyFileSync(join(here, name), join(folder, name));
writeFileSync(join(folder, 'search_index.js'), `globalThis.siteIndex = ${JSON.stringify([...index, ...referenceIndex()])};\n`);
writeFileSync(join(folder, 'figures.js'), bundle(join(here, 'figures/stage.js'), library));
for (const [name, variable] of [['massspring', 'massspringSimd'], ['massspring_scalar', 'massspringScalar']]) {
  const text = readFileSync(join(library, `${name}.wasm`)).toString('base64');
  writeFileSync(join(folder, `${name}.wasm.js`), `globalThis.${variable} = '${text}';\n`);
}
console.log(`${made.size + 1} pages, ${Object.keys(figures).length} figures${hasReference ? '' : ', no reference'}`);
