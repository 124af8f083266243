// The figures, in the order in which pages may name them.
import bending from './bending.js';
import border from './border.js';
import cost from './cost.js';
import cure from './cure.js';
import damping from './damping.js';
import jelly from './jelly.js';
import plasticity from './plasticity.js';
import precision from './precision.js';
import rejected from './rejected.js';
import size from './size.js';

export const figures = Object.fromEntries([size, jelly, damping, bending, border, cure, cost, rejected, precision, plasticity]
  .map((figure) => [figure.name, figure]));
