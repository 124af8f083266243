/// NEON: four floats or two doubles in a vector, 32 registers.
#include "solvers/sparse/factor_kernels.h"

#if defined(MSPRINGI_AARCH64)
#define MSPRINGI_VECTOR_BYTES 16
#define MSPRINGI_TILE_VECTORS 4
#define MSPRINGI_TABLE mspringi_cholesky_neon
#define MSPRINGI_LEVEL MSPRING_SIMD_NEON
#include "solvers/sparse/factor_table.h"
#endif
