// The bars of 80 x 5 of tests/kernels/golden.c, one for each solver, and the hash over their steps.
const SCENES = [
  ['bar_80x5', { solver: 'explicit', substeps: 30 }],
  ['implicit_bar', { solver: 'implicit', substeps: 1 }],
  ['direct_bar', { solver: 'direct', substeps: 1 }],
];

function bar(ms, { PARTICLE_PINNED }, settings) {
  const width = 80, height = 5, iron = { mass: 73.3975, stiffness: 6.7643e7 };
  const builder = new ms.Builder(), cells = new Uint16Array(width * height);
  for (let i = 0; i < height; i++) cells[i * width] = 1;
  builder.addLattice({ width, height, cells, materials: [iron, { ...iron, particleFlags: PARTICLE_PINNED }] });
  return new ms.Network(builder, settings);
}

// A line for each, as in tests/golden/hashes.txt.
export function goldenBars(ms, massspring) {
  return SCENES.map(([name, settings]) => {
    const network = bar(ms, massspring, settings);
    let hash = network.stateHash;
    for (let i = 0; i < 64; i++) {
      network.step(1 / 64);
      hash = BigInt.asUintN(64, (hash << 7n) | (hash >> 57n)) ^ network.stateHash;
    }
    return `${name} ${hash.toString(16).padStart(16, '0')}`;
  });
}
