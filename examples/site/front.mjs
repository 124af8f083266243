// The first page: something to try, then code, then reasons.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

/** First scene of the playground, by the width of the screen: the ship is too slow for a phone. */
export const WIDE = 'scene=ship&breaking=1&floor=1&cut=396,110,412,20';
export const NARROW = 'scene=bridge&breaking=1&damping=0.1&limit=-2.6&cut=60.5,-60,60.5,60';

const SCENES = [
  ['Ship', WIDE], ['Hanging bridge', NARROW], ['Rubble on a deck', 'scene=rubble'], ['Girder that yields', 'scene=girder'],
  ['Weights on ropes', 'scene=weights'],
];

function block(markdown, language) {
  const found = markdown.match(new RegExp('```' + language + '\\n([^]*?)```'));
  if (!found) throw new Error(`there is no ${language} to begin with`);
  return found[1].trimEnd();
}

// Tabs that need no script: each label belongs to a radio button.
function tabs(list) {
  return `<div class="tabs">${list.map(({ name, code, after }, i) => `
<input type="radio" name="tab" id="tab-${name}"${i ? '' : ' checked'}><label for="tab-${name}">${name}</label>
<div class="tab"><button type="button" data-copy hidden>Copy</button>
<pre><code>${code}</code></pre>${after}</div>`).join('')}
</div>`;
}

/** The page's own part of HTML. root: the repository; figureOf(name, title) gives a live figure; escape makes HTML. */
export function front(root, { figureOf, escape, version, download, playground, caption }) {
  const read = (path) => readFileSync(join(root, path), 'utf8');
  const code = [
    { name: 'C', code: escape(block(read('README.md'), 'c')),
      after: '<p>It writes <a href="README.html">this picture</a>. <a href="README.html#install">Install</a></p>' },
    { name: 'Python', code: escape(block(read('pkgconfig/python/README.md'), 'python')),
      after: '<p><a href="pkgconfig/python/README.html">The Python package</a></p>' },
    { name: 'JavaScript', code: escape(block(read('pkgconfig/npm/README.md'), '(?:js|javascript)')),
      after: '<p><a href="pkgconfig/npm/README.html">The npm package</a></p>' },
  ];
  const scenes = SCENES.map(([name, settings]) => `<button type="button" data-scene="${escape(settings)}">${name}</button>`);
  const play = playground ? `<div class="playground" data-wide="${escape(WIDE)}" data-narrow="${escape(NARROW)}">
<picture><source media="(max-width: 700px)" srcset="examples/pictures/web_bridge.png">
<img src="examples/pictures/web_ship.png" width="1200" height="660" alt="A steamer of springs, coloured by strain"></picture>
</div>
<p class="scenes" hidden>${scenes.join('\n')}
<a class="button" href="massspring.html#${escape(WIDE)}">Full screen</a></p>
<p class="without">This needs JavaScript and WebAssembly.</p>
<p class="try">Pull it. Then choose <em>Cut</em> and draw a line through it. Any image becomes a network: choose full screen and drop yours.</p>`
    : '<p><img src="examples/pictures/web_ship.png" width="1200" height="660" alt="A steamer of springs, coloured by strain"></p>';
  return `<h1>Springs that bend, swing and break</h1>
<p class="lead">A C library for 2D networks of masses, springs and dampers. A ship of 157,962 springs runs in your browser.</p>
${play}
<h2 id="in-your-program">In your program</h2>
${tabs(code)}
<h2 id="why-this-one">Why this one</h2>
<p><strong>Fast.</strong> Half a nanosecond per spring and substep with AVX-512: six to ten times faster than a plain loop.
<a href="examples/site/comparison.html">Compared with Box2D, Rapier and XPBD</a></p>
<p><strong>The same bits everywhere.</strong> In this page, on your server, on a phone. Replays and lockstep games rely on it.
<a href="rollback.html">Two peers, a bad line, one state</a></p>
<p><strong>Right.</strong> It is checked against beams, cables and buckling columns. Below, it checks itself in your browser.
<a href="examples/guides/validation.html">Validation</a></p>
${['jelly', 'bending', 'cure'].map((name) => `<h3>${caption(name)[0]}</h3>\n${caption(name)[1]}\n${figureOf(name, caption(name)[0])}`).join('\n')}
<p><a href="examples/guides/figures.html">All ten figures</a></p>
<h2 id="where-next">Where next</h2>
<div class="table"><table><thead><tr><th>you have</th><th>read</th></tr></thead><tbody>
<tr><td>an idea</td><td><a href="examples/guides/choose.html">Choose a solver</a></td></tr>
<tr><td>spring code of your own</td><td><a href="examples/FROM_YOUR_OWN_CODE.html">What replaces what</a></td></tr>
<tr><td>Box2D, Chipmunk, Verlet</td><td><a href="examples/guides/migration.html">Translate units and joints</a></td></tr>
<tr><td>an engine to ship</td><td><a href="examples/guides/vendoring.html">Vendoring</a>, <a href="examples/bindings/README.html">LÖVE, Unity, Godot</a></td></tr>
<tr><td>numpy, robots, experiments</td><td><a href="pkgconfig/python/README.html">Python</a></td></tr>
<tr><td>an error message</td><td><a href="examples/guides/troubleshooting.html">Troubleshooting</a></td></tr>
</tbody></table></div>
<p class="foot">Version ${version} · MIT${download ? ' · <a href="download.html">Download</a>' : ''} · <a href="CHANGELOG.html">Changes</a></p>`;
}
