// What JavaScript has to know of the headers, from a compiler that reads them: tables.js and tables.d.ts.
//
//   node tables.js INCLUDE CLANG FOLDER
//
// Structs come from clang's dump of their layout, values of enums and macros from a module that holds them.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [include, clang, folder] = process.argv.slice(2);
const headers = ['massspring', 'massspring_contact', 'massspring_laws', 'massspring_tools'];
const scratch = mkdtempSync(join(tmpdir(), 'tables-'));
const text = headers.map((name) => readFileSync(join(include, 'massspring', `${name}.h`), 'utf8')).join('\n');
const prelude = headers.map((name) => `#include <massspring/${name}.h>\n`).join('');

function compile(source, ...options) {
  return execFileSync(clang, ['--target=wasm32', '-std=c11', '-ffreestanding', `-I${include}`, '-x', 'c', '-', ...options],
    { input: prelude + source, encoding: 'utf8', maxBuffer: 1 << 26 });
}

const camel = (name) => name.toLowerCase().replace(/_([a-z0-9])/g, (_, letter) => letter.toUpperCase());
const title = (name) => camel(`_${name}`);

/* ------------------------------------------------------------------------------------------------------- values */

function valuesOf(names) {
  const file = join(scratch, 'values.wasm');
  compile(`__attribute__((visibility("default"))) const double values[] = {${names.map((name) => `(double)${name}`)}};`,
    '-nostdlib', '-Wl,--no-entry', '-Wl,--export=values', '-o', file);
  const { memory, values } = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(file))).exports;
  const numbers = new Float64Array(memory.buffer, values.value, names.length);
  return Object.fromEntries(names.map((name, i) => [name, numbers[i]]));
}

// What all names begin with, up to an underscore.
function commonStart(names) {
  let start = names[0].slice(0, names[0].lastIndexOf('_') + 1);
  while (!names.every((name) => name.startsWith(start))) start = start.slice(0, start.lastIndexOf('_', start.length - 2) + 1);
  return start;
}

// Of calls that the package does not have.
const UNUSED = /^MSPRING_(TUNE|HOOK|CLONE|FEATURE|PHASE|LAYOUT)_|_WORKERS$/;

const code = text.replace(/\/\*[^]*?\*\/|\/\/.*/g, '');
const enums = {}, constants = {}, wanted = [];
for (const [, name, body] of code.matchAll(/enum(?: mspring_(\w+))? \{([^}]*)\}/g)) {
  const names = [...body.matchAll(/^ *(MSPRING_\w+)/gm)].map((match) => match[1])
    .filter((found) => !found.endsWith('_INT') && !UNUSED.test(found));
  wanted.push(...names);
  if (name && names.length) enums[name] = names;
  else for (const found of names) constants[found.slice('MSPRING_'.length)] = found;
}
for (const [, name] of code.matchAll(/^#define (MSPRING_\w+) +\(?[-0-9]/gm)) {
  if (UNUSED.test(name)) continue;
  wanted.push(name);
  constants[name.slice('MSPRING_'.length)] = name;
}
const values = valuesOf(wanted);
for (const name in constants) constants[name] = values[constants[name]];
for (const [name, names] of Object.entries(enums)) {
  const start = name === 'result' ? 'MSPRING_' : commonStart(names);
  enums[name] = Object.fromEntries(names.map((found) =>
    [camel(found.slice(start.length).replace(/^ERROR_/, '')), values[found]]));
}

/* ------------------------------------------------------------------------------------------------------ structs */

const NUMBERS = { uint32_t: 'u32', mspring_id: 'u32', size_t: 'u32', uint64_t: 'u64', float: 'f32', double: 'f64' };
const ARRAYS = { float: 'f32', double: 'f64', uint16_t: 'u16', uint32_t: 'u32', mspring_id: 'u32', mspring_material: 'material' };

// 'f32', 'f32*' for an array of them, the name of an enum, or nothing for what only C can use.
function kindOf(type) {
  if (NUMBERS[type]) return NUMBERS[type];
  const plain = type.replace(/^(const|enum) /, '');
  if (plain.startsWith('mspring_') && enums[plain.slice('mspring_'.length)]) return plain.slice('mspring_'.length);
  const array = plain.match(/^(\w+) \*$/);
  return array && ARRAYS[array[1]] ? `${ARRAYS[array[1]]}*` : undefined;
}

const structs = {};
const dump = compile('', '-fsyntax-only', '-Xclang', '-fdump-record-layouts-complete');
for (const [, name, body, size] of dump.matchAll(/0 \| struct mspring_(\w+)\n([^[]*)\| \[sizeof=(\d+)/g)) {
  const fields = {};
  for (const [, offset, type, field] of body.matchAll(/(\d+) \| +(.+?) (\w+)\n/g)) {
    const kind = kindOf(type);
    if (kind && !/^(struct_size|reserved.*)$/.test(field)) fields[camel(field)] = [kind, Number(offset)];
  }
  if (!/tune|hook|clone|tasks|allocator|mutable/.test(name)) structs[name] = { size: Number(size), fields };
}
// A change of clang's format must not end in a package without structs.
for (const [name, field] of [['network_def', 'gravityY'], ['lattice_def', 'cells'], ['view', 'originX'], ['event', 'strain']])
  if (!structs[name]?.fields[field]) throw new Error(`the dump of clang has no ${name}.${field}`);

writeFileSync(join(folder, 'tables.js'), `// Made from the headers of the library.
export const STRUCTS = ${JSON.stringify(structs)};
export const ENUMS = ${JSON.stringify(enums)};
${Object.entries(constants).map(([name, value]) => `export const ${name} = ${value};\n`).join('')}`);

/* -------------------------------------------------------------------------------------------------------- types */

// What the header says behind each field.
function commentsOf(name) {
  const body = text.match(new RegExp(`typedef struct mspring_${name} \\{\\n([^]*?)\\n\\} mspring_${name};`))?.[1] ?? '';
  const comments = {};
  let above = '', last = [];
  for (const line of body.split('\n')) {
    const code = line.replace(/\/\/\/.*/, '').trim(), comment = line.match(/\/\/\/<? ?(.*)/)?.[1] ?? '';
    if (code) {
      last = [...code.matchAll(/(\w+)(?=[,;])/g)].map((match) => camel(match[1]));
      for (const field of last) comments[field] = `${above} ${comment}`.trim();
      above = '';
    } else if (/\/\/\/ {2,}/.test(line) || line.match(/^ {8,}\/\/\/</)) {
      for (const field of last) comments[field] += ` ${comment}`;
    } else if (last.length && line.trim().startsWith('///<')) {
      for (const field of last) comments[field] += ` ${comment.trim()}`;
    } else above += ` ${comment}`;
  }
  return comments;
}

// Lengths of arrays follow from the arrays.
const COUNTS = ['planeCount', 'heightCount', 'pointCount', 'vertexCount', 'triangleCount', 'materialCount'];

function typeOf(kind) {
  if (kind === 'material*') return 'readonly Material[]';
  if (kind.endsWith('*')) return 'ArrayLike<number>';
  return /^([uf]\d+)$/.test(kind) ? 'number' : title(kind);
}

const isInput = (name) => name.endsWith('_def') || name === 'material' || name === 'settings';
// Not Event, which browsers have.
const typeName = (name) => name.replace(/_def$/, '_options').replace(/^event$/, 'network_event');
let types = '// Made from the headers of the library.\n';
for (const [name, names] of Object.entries(enums))
  types += `export type ${title(name)} = ${Object.keys(names).map((value) => `'${value}'`).join(' | ')};\n`;
for (const [name, { fields }] of Object.entries(structs)) {
  if (name === 'view') continue;
  const comments = commentsOf(name);
  types += `\nexport interface ${title(typeName(name))} {\n`;
  for (const [field, [kind]] of Object.entries(fields)) {
    if (isInput(name) ? COUNTS.includes(field) : kind.endsWith('*')) continue;
    if (comments[field]) types += `  /** ${comments[field].replace(/\s+/g, ' ').replace(/\*\//g, '')} */\n`;
    types += isInput(name) ? `  ${field}?: ${typeOf(kind)};\n` : `  ${field}: ${typeOf(kind)};\n`;
  }
  types += '}\n';
}
types += '\n' + Object.keys(constants).map((name) => `export const ${name}: number;\n`).join('');
writeFileSync(join(folder, 'tables.d.ts'), types);
rmSync(scratch, { recursive: true });
