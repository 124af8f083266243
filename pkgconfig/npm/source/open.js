// The module for this machine, and the classes that belong to it.
import { Builder } from './builder.js';
import { Core, MassSpringError, choice, fail, number } from './core.js';
import { Network } from './network.js';
import { ENUMS } from './tables.js';

export { MassSpringError };
export * from './tables.js';

// A module of one function that needs SIMD.
const PROBE = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253,
  15, 253, 98, 11]);

async function compile(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof Response === 'function' && source instanceof Response) {
    if (!source.ok) throw new Error(`the module of massspring: ${source.url} answers ${source.status}`);
    source = await source.arrayBuffer();
  }
  return WebAssembly.compile(source);
}

class MassSpring {
  #core;

  constructor(core) {
    this.#core = core;
    this.version = core.text(core.exports.mspring_version_string());
    this.simd = core.exports.mspring_simd_available(ENUMS.simd.wasm) === 1;
    this.Builder = class extends Builder {
      constructor() {
        super(core);
      }
    };
    this.Network = class extends Network {
      constructor(builder, settings, options) {
        super(core, builder, settings, options);
      }
    };
  }

  get memoryUsed() {
    return this.#core.memory.buffer.byteLength;
  }

  material(preset, spacing, substep) {
    const core = this.#core, index = choice('preset', preset);
    return core.call(() => {
      const found = core.begin('material');
      const result = core.exports.mspring_material_preset(found, index, number(spacing, 'spacing'), number(substep, 'substep'));
      if (result < 0) fail(`spacing ${spacing} m or substep ${substep} s is out of range`);
      return core.read('material', found);
    });
  }
}

/** files: how to read the module with SIMD, and the one without. */
export async function open({ simd = true, wasm } = {}, files) {
  const module = await compile(await (wasm ?? (simd && WebAssembly.validate(PROBE) ? files.simd() : files.scalar())));
  return new MassSpring(new Core(await WebAssembly.instantiate(module, {})));
}
