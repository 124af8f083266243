// What the site's menu has, in its order.
export const CONTENTS = [
  { title: 'Begin', links: [
    ['What it is', 'index.html'],
    ['Ten live figures', 'examples/guides/figures.html'],
    ['Choose a solver', 'examples/guides/choose.html'],
    ['The whole README', 'README.html'],
    ['Install and link', 'README.html#install'],
    ['Examples', 'examples/README.html'],
  ] },
  { title: 'Guide', links: [
    ['Solvers', 'examples/guides/solvers.html'],
    ['Guards', 'examples/guides/solvers.html#guards'],
    ['Materials', 'examples/guides/materials.html'],
    ['Floor', 'examples/guides/floor.html'],
    ['Contact', 'examples/guides/contact.html'],
    ['Grips', 'examples/guides/grips.html'],
    ['Edits', 'examples/guides/edits.html'],
    ['Sleep', 'examples/guides/sleep.html'],
    ['Batches', 'examples/guides/batches.html'],
    ['Determinism', 'examples/guides/determinism.html'],
  ] },
  { title: 'Move here', links: [
    ['From Box2D, Chipmunk, Verlet', 'examples/guides/migration.html'],
    ['From your own code', 'examples/FROM_YOUR_OWN_CODE.html'],
    ['JavaScript', 'pkgconfig/npm/README.html'],
    ['Python', 'pkgconfig/python/README.html'],
  ] },
  { title: 'Look up', links: [
    ['Reference', 'reference/index.html'],
    ['Troubleshooting', 'examples/guides/troubleshooting.html'],
    ['Glossary', 'examples/guides/glossary.html'],
    ['Validation', 'examples/guides/validation.html'],
    ['Measurements', 'bench/RESULTS.html'],
    ['Changes', 'CHANGELOG.html'],
  ] },
];
