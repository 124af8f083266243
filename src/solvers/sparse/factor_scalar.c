/// One number at a time: what the other levels compute, they compute in this order.
#include "solvers/sparse/factor_kernels.h"

#if !defined(MSPRINGI_WITHOUT_SCALAR)

#define MSPRINGI_VECTOR_BYTES 0
#define MSPRINGI_TILE_VECTORS 4
#define MSPRINGI_TABLE mspringi_cholesky_scalar
#define MSPRINGI_LEVEL MSPRING_SIMD_SCALAR
#include "solvers/sparse/factor_table.h"

#endif
