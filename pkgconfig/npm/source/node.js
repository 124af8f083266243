// For node, which does not fetch files.
import { readFile } from 'node:fs/promises';
import { open } from './open.js';

export * from './open.js';

const files = {
  simd: () => readFile(new URL('./massspring.wasm', import.meta.url)),
  scalar: () => readFile(new URL('./massspring_scalar.wasm', import.meta.url)),
};

export const load = (options) => open(options, files);
