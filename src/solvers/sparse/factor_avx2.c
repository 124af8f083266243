/// AVX2: eight floats or four doubles in a vector, 16 registers.
#include "solvers/sparse/factor_kernels.h"

#if defined(MSPRINGI_X86)
#define MSPRINGI_VECTOR_BYTES 32
#define MSPRINGI_TILE_VECTORS 2
#define MSPRINGI_TABLE mspringi_cholesky_avx2
#define MSPRINGI_LEVEL MSPRING_SIMD_AVX2
#include "solvers/sparse/factor_table.h"
#endif
