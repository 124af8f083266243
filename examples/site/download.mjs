// The page of downloads: files of the site's folder download, with their sizes and SHA-256.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

const KINDS = [
  [/\.tar\.xz$/, 'the sources, without large pictures', 'cmake -S . -B build && cmake --build build'],
  [/\.tgz$/, 'the npm package', 'npm install ./FILE'],
  [/\.html$/, 'the playground, in one file that opens from a disk', ''],
];

const size = (bytes) => (bytes < 1e6 ? `${Math.round(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`);

/** HTML of the page. */
export function downloads(folder, escape) {
  const rows = KINDS.flatMap(([ends, what, use]) => readdirSync(join(folder, 'download')).filter((name) => ends.test(name)).map((name) => {
    const bytes = readFileSync(join(folder, 'download', name)), hash = createHash('sha256').update(bytes).digest('hex');
    return `<h2>${escape(name)}</h2>
<p><a class="button" href="download/${escape(name)}" download>${size(bytes.length)}</a> ${what}${use ? `: <code>${escape(use.replace('FILE', name))}</code>` : ''}</p>
<p class="hash">SHA-256 <code>${hash}</code></p>`;
  }));
  return `<h1>Download</h1>
<p>The library has no dependencies but libc, libm and threads. <a href="README.html#install">Install</a> it, build a
<a href="examples/guides/building.html">Debian package</a>, or <a href="examples/guides/vendoring.html">paste one file</a>.</p>
${rows.join('\n')}
<p>MIT licence. <a href="CHANGELOG.html">Changes</a></p>`;
}
