// For browsers and bundlers.
import { open } from './open.js';

export * from './open.js';

const files = {
  simd: () => fetch(new URL('./massspring.wasm', import.meta.url)),
  scalar: () => fetch(new URL('./massspring_scalar.wasm', import.meta.url)),
};

export const load = (options) => open(options, files);
