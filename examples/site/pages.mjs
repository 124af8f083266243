// Makes the pages of the site from the Markdown of the repository, and whatever they lead to.
//
//   node pages.mjs SOURCE FIGURES PACKAGE FOLDER [ADDRESS]
//
// A page lies where its Markdown does: examples/guides/solvers.md becomes examples/guides/solvers.html. So links stay what
// they are, but for the ending. Sources that a page links to become pages, too. FIGURES is a folder with the figures'
// modules beside which node finds the package massspring. Shared links show a picture if ADDRESS says where the site will be.
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { dirname, join, posix, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { bundle } from './bundle.mjs';
import { CONTENTS } from './contents.mjs';
import { downloads } from './download.mjs';
import { front } from './front.mjs';
import { stills } from './stills.mjs';

const [source, figureFolder, library, folder, address = ''] = process.argv.slice(2);
const load = (name) => import(pathToFileURL(resolve(name)));
const { figures } = await load(join(figureFolder, 'all.js'));
const here = join(source, 'examples/site');
const hasReference = existsSync(join(folder, 'reference/annotated.html'));
const { version } = JSON.parse(readFileSync(join(library, 'package.json'), 'utf8'));
const hasDownload = existsSync(join(folder, 'download'));
const DESCRIPTION = 'A fast, deterministic C library for 2D mass-spring-damper networks. Drag, cut and break a ship of 157,962 ' +
  'springs in your browser.';
// A square with its diagonals, as lattices have them.
const ICON = `data:image/svg+xml,${encodeURIComponent('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 16 16">' +
  '<path d="M2 2h12v12H2zL14 14M14 2L2 14" fill="none" stroke="#e2621b" stroke-width="2" stroke-linejoin="round"/></svg>')}`;
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

function figureOf(name, title, from) {
  const figure = figures[name];
  if (!figure) throw new Error(`there is no figure ${name}`);
  const root = posix.relative(from, '.') || '.';
  return `<figure class="live" data-figure="${name}">
<img class="still" loading="lazy" width="780" height="390" src="${root}/stills/${name}.svg" alt="${escape(title)}: a still picture">
<canvas role="img" aria-label="Live figure: ${escape(title)}"></canvas>
<p class="now" data-now aria-live="off">Scroll here to start it. It needs JavaScript and WebAssembly.</p>
<div class="controls">${figure.controls.map(control).join('\n')}
<span class="buttons"><button type="button" data-play aria-pressed="true">Pause</button>
<button type="button" data-restart>Restart</button></span></div>
<ul class="check" data-check aria-live="polite"><li>checking ...</li></ul>
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
  if (goal === 'examples/site/rollback/page.html') return posix.relative(from, 'rollback.html');
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
    })
    .replace(/<img loading="lazy" [^>]*?src="([^"]*)"[^>]*>/g, '<a class="picture" href="$1">$&</a>'); // to see it larger
}

// Pictures have their room before they are there.
function sizeOf(path) {
  const file = join(source, path);
  if (!existsSync(file)) return '';
  if (path.endsWith('.png')) {
    const bytes = readFileSync(file);
    return `width="${bytes.readUInt32BE(16)}" height="${bytes.readUInt32BE(20)}"`;
  }
  const [, width, height] = readFileSync(file, 'utf8').match(/<svg[^>]*?width=["']([\d.]+)[^>]*?height=["']([\d.]+)/) ?? [];
  return width ? `width="${width}" height="${height}"` : '';
}

/* --------------------------------------------------------------------------------------------------------- pages */

function marked(markdown) {
  return execFileSync('cmark-gfm', ['--unsafe', '-e', 'table'], { input: markdown, encoding: 'utf8', maxBuffer: 1 << 26 });
}

// Headings get the marks that a forge gives them. Of pages in the menu all text can be searched, by sections.
const inMenu = new Set(CONTENTS.flatMap(({ links }) => links.map(([, goal]) => goal.split('#')[0])));
const index = [];
function withMarks(html, to) {
  const seen = new Map();
  return html.replace(/<h([1-6])>([^]*?)<\/h\1>/g, (_, level, words) => {
    const mark = plain(words).toLowerCase().replace(/[^\p{L}\p{N}_ -]/gu, '').replace(/ /g, '-'), times = seen.get(mark) ?? 0;
    seen.set(mark, times + 1);
    const id = `${mark}${times ? `-${times}` : ''}`;
    return `<h${level} id="${id}">${words}</h${level}>`;
  });
}

// Signs of equations and tables are no words, and code is shown in part: what is found must be readable.
const wordsOf = (html) => plain(html.replace(/<pre[^]*?<\/pre>/g, ' ').replace(/<(?:\/?(?:p|li|t[dhr]|br)\b)[^>]*>/g, ' '))
  .replace(/&quot;/g, '"').replace(/\s+/g, ' ').trim();

function addToIndex(html, to) {
  if (!inMenu.has(to)) return;
  const title = plain(html.match(/<h1[^>]*>([^]*?)<\/h1>/)?.[1] ?? '');
  for (const [, id, words, text] of html.matchAll(/<h[1-6] id="([^"]+)">([^]*?)<\/h[1-6]>([^]*?)(?=<h[1-6] id|$)/g))
    index.push([plain(words), `${to}#${id}`, wordsOf(text), title]);
}

function navigation(path) {
  const from = posix.dirname(path), link = ([words, goal]) => {
    const [page] = goal.split('#'), current = page === path ? ' aria-current="page"' : '';
    return `<li><a href="${posix.relative(from, page)}${goal.slice(page.length)}"${current}>${words}</a></li>`;
  };
  const has = ([, goal]) => goal !== 'download.html' || hasDownload;
  return CONTENTS.filter(({ title }) => hasReference || title !== 'Reference')
    .map(({ title, links }) => `<h2>${title}</h2>\n<ul>${links.filter(has).map(link).join('\n')}</ul>`).join('\n');
}

// Header and menu of a page.
function surroundings(path) {
  const root = posix.relative(posix.dirname(path), '.') || '.', home = `${root}/index.html`;
  const menu = `<input type="search" data-search placeholder="Search" aria-label="Search guides and functions">
${navigation(path)}`;
  return `<a class="skip" href="#content">Skip to the text</a>
<header><a class="home" href="${home}">libmassspring <small>${version}</small></a>
<span class="top"><a href="${root}/examples/guides/README.html">Guides</a>
${hasReference ? `<a href="${root}/reference/massspring_8h.html">Reference</a>` : ''}
<a href="${root}/examples/guides/figures.html">Figures</a>
${hasDownload ? `<a href="${root}/download.html">Source</a>` : ''}</span>
<details class="menu"><summary>Pages</summary><nav aria-label="Pages">${menu}</nav></details></header>
<nav class="side" aria-label="All pages">${menu}</nav>
<script src="${root}/search.js" defer></script>
<script src="${root}/site.js" defer></script>`;
}

// Title, description and picture that a shared link shows.
function shared(path, title, body) {
  const words = wordsOf(body.match(/<p[^>]*>([^]*?)<\/p>/)?.[1] ?? ''), at = words.search(/[.:] /);
  const about = path === 'index.html' ? DESCRIPTION : (at > 40 ? words.slice(0, at + 1) : words).slice(0, 200);
  const meta = { 'og:type': 'website', 'og:site_name': 'libmassspring', 'og:title': title, 'og:description': about,
    'og:image': `${address}${address ? '' : `${posix.relative(posix.dirname(path), '.') || '.'}/`}preview.png`,
    'og:image:width': '1200', 'og:image:height': '660', ...(address && { 'og:url': address + path }) };
  return `<meta name="description" content="${escape(about)}">
${Object.entries(meta).map(([name, value]) => `<meta property="${name}" content="${escape(value)}">`).join('\n')}
<meta name="twitter:card" content="summary_large_image">`;
}

function page(path, title, body) {
  const root = posix.relative(posix.dirname(path), '.') || '.', live = body.includes('data-figure=');
  const script = (name) => `<script src="${root}/${name}.js" defer></script>\n`;
  const scripts = live ? script('massspring.wasm') + script('figures')
    : body.includes('data-rollback') ? script('massspring.wasm') + script('rollback') : '';
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>${escape(title)}${title.startsWith('libmassspring') ? '' : ' · libmassspring'}</title>
${shared(path, title, body)}
<link rel="icon" href="${ICON}">
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

// Tables of many columns of words: on a phone each row becomes a list, whose lines begin with the column's title.
function stacked(table) {
  const titles = [...table.matchAll(/<th(?: [^>]*)?>([^]*?)<\/th>/g)].map(([, title]) => title);
  if (titles.length < 5 || table.includes('align="right"')) return table;
  let cell = 0;
  return table.replace('<table>', '<table class="stack">')
    .replace(/<td/g, () => `<td data-title="${titles[cell++ % titles.length]}"`);
}

function write(path, title, html) {
  const wide = html.replace(/<table>[^]*?<\/table>/g, stacked).replace(/<code>([^<]*)<\/code>(?!<\/pre>)/g, (_, words) => `<code>${words.replace(/_/g, '_<wbr>')}</code>`)
    .replace(/<table( class="stack")?>/g, '<div class="table" tabindex="0"><table$1>').replace(/<\/table>/g, '</table></div>');
  mkdirSync(join(folder, posix.dirname(path)), { recursive: true });
  const body = wide.replace(/<!-- figure (\w+) -->/g, (_, name, at) =>
    figureOf(name, plain([...wide.slice(0, at).matchAll(/<h[1-3][^>]*>([^]*?)<\/h/g)].at(-1)?.[1] ?? title), posix.dirname(path)));
  writeFileSync(join(folder, path), page(path, title, body));
}

function fromMarkdown(path, markdown, to = path.replace(/\.md$/, '.html')) {
  const html = withMarks(redirect(marked(markdown), posix.dirname(path)), to);
  addToIndex(html, to);
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

// Title and first paragraphs of a figure, from the guide.
function caption(name) {
  const guide = readFileSync(join(source, 'examples/guides/figures.md'), 'utf8');
  const section = guide.split(/^## /m).find((text) => text.includes(`<!-- figure ${name} -->`));
  const [title, ...text] = section.slice(0, section.indexOf('<!--')).split('\n');
  return [escape(title), redirect(marked(text.join('\n')), 'examples/guides')];
}

for (const name of ['web_ship', 'web_bridge']) copy(`examples/pictures/${name}.png`);
copyFileSync(join(source, 'examples/pictures/web_ship.png'), join(folder, 'preview.png'));
write('index.html', 'libmassspring: springs, masses and dampers in C', front(source, { escape, version, caption, download: hasDownload,
  playground: existsSync(join(folder, 'massspring.html')), figureOf: (name, title) => figureOf(name, title, '.') }));
if (hasDownload) write('download.html', 'Download', downloads(folder, escape));
write('rollback.html', 'Two peers, a bad line, one state', readFileSync(join(here, 'rollback/page.html'), 'utf8'));
waiting.push('README.md', 'examples/13_rollback.cpp', ...CONTENTS.flatMap(({ links }) => links.map(([, goal]) => goal.split('#')[0]))
  .filter((goal) => goal.includes('/') || goal === 'README.html' || goal === 'CHANGELOG.html').filter((goal) => !goal.startsWith('reference/'))
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
for (const name of ['site.css', 'search.js', 'site.js']) copyFileSync(join(here, name), join(folder, name));
writeFileSync(join(folder, 'search_index.js'), `globalThis.siteIndex = ${JSON.stringify([...index, ...referenceIndex()])};\n`);
writeFileSync(join(folder, 'figures.js'), bundle(join(here, 'figures/stage.js'), library));
writeFileSync(join(folder, 'rollback.js'), bundle(join(here, 'rollback/demo.js'), library));
for (const [name, variable] of [['massspring', 'massspringSimd'], ['massspring_scalar', 'massspringScalar']]) {
  const text = readFileSync(join(library, `${name}.wasm`)).toString('base64');
  writeFileSync(join(folder, `${name}.wasm.js`), `globalThis.${variable} = '${text}';\n`);
}
const { Pen } = await load(join(figureFolder, 'pen.js')), node = await load(join(library, 'node.js'));
mkdirSync(join(folder, 'stills'), { recursive: true });
for (const [name, svg] of Object.entries(stills(figures, Pen, await node.load())))
  writeFileSync(join(folder, 'stills', `${name}.svg`), svg);
console.log(`${made.size + 3} pages, ${Object.keys(figures).length} figures${hasReference ? '' : ', no reference'}`);
