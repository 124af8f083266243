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
const scratch = mkdtempSync(join(tmpdir(), 'tables-'));
const text = ['core', 'contact', 'laws', 'lab']
  .map((name) => readFileSync(join(include, 'massspring', `${name}.h`), 'utf8')).join('\n');
const prelude = '#define MSPRING_EXPERIMENTAL\n#include <massspring/massspring.h>\n';

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

// Numbers of fields that have a meaning of their own, and the words for them here.
const WORDS = {
  'settings.substeps': { auto: 'MSPRING_SUBSTEPS_AUTO', even: 'MSPRING_SUBSTEPS_EVEN' },
  'spring_def.rest_length': { auto: 'MSPRING_REST_LENGTH_DISTANCE' },
  'spring_def.relax_strain': { auto: 'MSPRING_RELAX_STRAIN_DEFAULT' },
  'material.relax_strain': { auto: 'MSPRING_RELAX_STRAIN_DEFAULT' },
  'angle_def.rest_angle': { auto: 'MSPRING_REST_ANGLE_PRESENT' },
  'contact_def.push_speed': { auto: '-1' },
  'property.relax_strain': { auto: 'MSPRING_RELAX_STRAIN_DEFAULT' },
  'property.friction': { auto: '-1' },
  'property.restitution': { auto: '-1' },
};
const spelt = Object.values(WORDS).flatMap((words) => Object.values(words));

// Of calls that the package does not have.
const UNUSED = /^MSPRING_(TUNE|HOOK|CLONE|FEATURE|PHASE|LAYOUT|GROUPS?|ACTUATORS?|SIGNAL|ALL)(_|$)|_WORKERS$/;
const isUsed = (name) => !name.endsWith('_INT') && !UNUSED.test(name) && !spelt.includes(name);

const code = text.replace(/\/\*[^]*?\*\/|\/\/.*/g, '');
const enums = {}, constants = {}, wanted = [...spelt];
for (const [, name, body] of code.matchAll(/enum mspring_(\w+) \{([^}]*)\}/g)) {
  const names = [...body.matchAll(/^ *(MSPRING_\w+)/gm)].map((match) => match[1]).filter(isUsed);
  wanted.push(...names);
  if (names.length && !name.endsWith('_flags')) enums[name] = names;
  else for (const found of names) constants[found.slice('MSPRING_'.length)] = found;
}
for (const [, name] of code.matchAll(/^#define (MSPRING_\w+) +\(?[-0-9]/gm)) {
  if (!isUsed(name)) continue;
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
const kinds = enums.struct;
delete enums.struct;

const wordsOf = (key) => WORDS[key] &&
  Object.fromEntries(Object.entries(WORDS[key]).map(([word, name]) => [word, values[name]]));
const autos = Object.keys(WORDS).filter((key) => key.startsWith('property.'))
  .map((key) => [camel(key.slice('property.'.length)), wordsOf(key)]);

/* ------------------------------------------------------------------------------------------------------ structs */

const NUMBERS = { uint32_t: 'u32', mspring_id: 'id', size_t: 'u32', uint64_t: 'u64', float: 'f32', double: 'f64' };
const ARRAYS = { float: 'f32', double: 'f64', uint16_t: 'u16', uint32_t: 'u32', mspring_id: 'u32', mspring_material: 'material' };

// 'f32', 'f32*' for an array of them, 'material&' for one behind a pointer, the name of an enum, or nothing for what only
// C can use.
function kindOf(type, field) {
  if (NUMBERS[type]) return field.startsWith('is_') ? 'bool' : NUMBERS[type];
  const plain = type.replace(/^(const|enum) /, '');
  if (enums[plain.replace('mspring_', '')]) return plain.replace('mspring_', '');
  const array = ARRAYS[plain.match(/^(\w+) \*$/)?.[1]];
  return array && array + (field === 'material' ? '&' : '*');
}

const structs = {};
const dump = compile('', '-fsyntax-only', '-Xclang', '-fdump-record-layouts-complete');
for (const [, name, body, size] of dump.matchAll(/0 \| struct mspring_(\w+)\n([^[]*(?:\[\d+\][^[]*)*)\| \[sizeof=(\d+)/g)) {
  if (/tune|hook|clone|tasks|allocator|column|observation/.test(name)) continue;
  const made = { size: Number(size), kind: kinds[camel(name)], fields: {} };
  for (const [, offset, type, field] of body.matchAll(/(\d+) \| {3}(\S.*?) (\w+)\n/g)) {
    const kind = kindOf(type, field), words = wordsOf(`${name}.${field}`);
    if (type === 'struct mspring_settings') made.settings = Number(offset);
    else if (kind && !/^(struct_size|reserved.*)$/.test(field))
      made.fields[camel(field)] = [kind, Number(offset), ...(words ? [words] : [])];
  }
  structs[name] = made;
}
// A change of clang's format must not end in a package without structs.
for (const [name, field] of [['settings', 'gravityY'], ['lattice_def', 'cells'], ['view', 'originX'], ['event', 'strain']])
  if (!structs[name]?.fields[field]) throw new Error(`the dump of clang has no ${name}.${field}`);

writeFileSync(join(folder, 'tables.js'), `// Made from the headers of the library.
export const STRUCTS = ${JSON.stringify(structs)};
export const ENUMS = ${JSON.stringify(enums)};
export const PROPERTY_WORDS = ${JSON.stringify(Object.fromEntries(autos))};
${Object.entries(constants).map(([name, value]) => `export const ${name} = ${value};\n`).join('')}`);

/* -------------------------------------------------------------------------------------------------------- types */

// What the header says above and behind each field or value.
function commentsOf(name) {
  const body = text.match(new RegExp(`typedef (?:struct|enum) mspring_${name} \\{\\n([^]*?)\\n\\} mspring_${name};`))?.[1] ?? '';
  const comments = {};
  let above = '', last = [];
  for (const line of body.split('\n')) {
    const code = line.replace(/\/\/\/.*/, '').trim(), comment = line.match(/\/\/\/<? ?(.*)/)?.[1] ?? '';
    if (code) {
      last = [...code.matchAll(/(\w+)(?=[,;]| = )/g)].map((match) => camel(match[1].replace(/^MSPRING_/, '')));
      for (const field of last) comments[field] = `${above} ${comment}`.trim();
      above = '';
    } else if (/\/\/\/ {2,}/.test(line) || line.trim().startsWith('///<')) {
      for (const field of last) comments[field] += ` ${comment.trim()}`;
    } else above += ` ${comment}`;
  }
  return comments;
}

// Lengths of arrays follow from the arrays.
const COUNTS = ['planeCount', 'heightCount', 'pointCount', 'vertexCount', 'triangleCount', 'materialCount'];

const isInput = (name) => name.endsWith('_def') || name === 'material' || name === 'settings';
// Not Event, which browsers have.
const typeName = (name) => name.replace(/_def$/, '_options').replace(/^event$/, 'network_event');
const union = (names) => names.map((name) => `'${name}'`).join(' | ');

function typeOf(kind, words = {}, nothing = '') {
  if (kind === 'material*') return 'readonly Material[]';
  if (kind === 'material&') return 'Material';
  if (kind.endsWith('*')) return 'ArrayLike<number>';
  if (kind === 'bool') return 'boolean';
  if (kind === 'id') return `number${nothing}`;
  return /^[uf]\d+$/.test(kind) ? ['number', ...Object.keys(words).map((word) => `'${word}'`)].join(' | ') : title(kind);
}

let types = '// Made from the headers of the library.\n';
for (const [name, names] of Object.entries(enums))
  if (name !== 'property') types += `export type ${title(name)} = ${union(Object.keys(names))};\n`;

const properties = Object.entries(enums.property), comments = commentsOf('property');
const those = (name, choose) => {
  const found = properties.filter(([property, value]) => choose(value, comments[property])).map(([property]) => property);
  return `export type ${name} = ${union(found)};\n`;
};
types += those('ParticleProperty', (value) => value >> 8 === enums.kind.particles);
types += those('SpringProperty', (value) => value >> 8 === enums.kind.springs);
types += those('ElementProperty', (value) => value >> 8 === enums.kind.elements);
types += those('IntegerProperty', (value) => value & 128);
types += those('ReadOnlyProperty', (_, comment) => comment.includes('[read]'));
types += `export type AutoProperty = ${union(autos.map(([name]) => name))};\n`;
types += 'export type Property = ParticleProperty | SpringProperty | ElementProperty;\n';

for (const [name, { fields }] of Object.entries(structs)) {
  if (name === 'view') continue;
  const comments = commentsOf(name);
  types += `\nexport interface ${title(typeName(name))} {\n`;
  for (const [field, [kind, , words]] of Object.entries(fields)) {
    if (isInput(name) ? COUNTS.includes(field) : kind.endsWith('*')) continue;
    if (comments[field]) types += `  /** ${comments[field].replace(/\s+/g, ' ').replace(/\*\//g, '')} */\n`;
    const optional = /\bset (it|both)\b(?! for)/.test(comments[field]) ? '' : '?';
    types += isInput(name) ? `  ${field}${optional}: ${typeOf(kind, words)};\n`
      : `  ${field}: ${typeOf(kind, words, field === 'id' ? '' : ' | null')};\n`;
  }
  types += '}\n';
}
types += '\n' + Object.keys(constants).map((name) => `export const ${name}: number;\n`).join('');
writeFileSync(join(folder, 'tables.d.ts'), types);
rmSync(scratch, { recursive: true });
