/// AVX-512: 16 floats or eight doubles in a vector, 32 registers.
#include "solvers/sparse/factor_kernels.h"

#if defined(MSPRINGI_X86)
#define MSPRINGI_VECTOR_BYTES 64
#define MSPRINGI_TILE_VECTORS 4
#define MSPRINGI_TABLE mspringi_cholesky_avx512
#define MSPRINGI_LEVEL MSPRING_SIMD_AVX512
#include "solvers/sparse/factor_table.h"
#endif
