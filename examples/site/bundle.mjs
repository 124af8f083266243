// The figures and the npm package as one plain script: modules do not load from a folder on a disk.
//
// It knows the forms of import and export that these sources use, and fails at any other.
import { existsSync, readFileSync } from 'node:fs';
import { dirname, resolve } from 'node:path';

const names = (list) => list.split(',').map((name) => name.trim()).filter(Boolean);

function wrap(file, variable, text) {
  const exported = [];
  let body = text
    .replace(/^import (\w+) from '(.+)';$/gm, (_, name, from) => `const { default: ${name} } = ${variable(from)};`)
    .replace(/^import \{([^}]*)\} from '(.+)';$/gm, (_, list, from) => `const {${list.replace(/ as /g, ': ')}} = ${variable(from)};`)
    .replace(/^export \* from '(.+)';$/gm, (_, from) => (exported.push(`...${variable(from)}`), ''))
    .replace(/^export \{([^}]*)\};$/gm, (_, list) => (exported.push(...names(list)), ''))
    .replace(/^export default /gm, () => (exported.push('default: standard'), 'const standard = '))
    .replace(/^export ((?:async )?function|class|const) (\w+)/gm, (_, kind, name) => (exported.push(name), `${kind} ${name}`));
  const left = body.match(/^(import|export)\b.*|import\.meta/m);
  if (left) throw new Error(`${file}: cannot bundle "${left[0]}"`);
  return `(() => {\n${body}\nreturn { ${exported.join(', ')} };\n})()`;
}

/** All that the module needs, in one script. library: the folder of the npm package. */
export function bundle(entry, library) {
  const made = new Map(), parts = [];
  function add(file) {
    if (made.has(file)) return made.get(file);
    if (!existsSync(file)) throw new Error(`there is no ${file}`);
    const text = readFileSync(file, 'utf8');
    const pathOf = (from) => (from === 'massspring' ? resolve(library, 'open.js') : resolve(dirname(file), from));
    // Modules that it imports come before it.
    for (const [, from] of text.matchAll(/^(?:import|export) [^;]*? from '(.+)';$/gm)) add(pathOf(from));
    const name = `module${made.size}`;
    made.set(file, name);
    parts.push(`const ${name} = ${wrap(file, (from) => made.get(pathOf(from)), text)};`);
    return name;
  }
  add(resolve(entry));
  return `'use strict';\n(() => {\n${parts.join('\n')}\n})();\n`;
}
