/// WebAssembly SIMD: four floats or two doubles in a vector.
#include "solvers/sparse/factor_kernels.h"

#if defined(MSPRINGI_WASM)
#define MSPRINGI_VECTOR_BYTES 16
#define MSPRINGI_TILE_VECTORS 2
#define MSPRINGI_TABLE mspringi_cholesky_wasm
#define MSPRINGI_LEVEL MSPRING_SIMD_WASM
#include "solvers/sparse/factor_table.h"
#endif
