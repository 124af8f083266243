#include "kernels.h"

const mspringi_kernels *mspringi_kernels_of(mspring_simd level) {
    switch (level) {
#if defined(MSPRINGI_X86)
    case MSPRING_SIMD_SSE2:
        return &mspringi_kernels_sse2;
    case MSPRING_SIMD_AVX2:
        return &mspringi_kernels_avx2;
    case MSPRING_SIMD_AVX512:
        return &mspringi_kernels_avx512;
#elif defined(MSPRINGI_AARCH64)
    case MSPRING_SIMD_NEON:
        return &mspringi_kernels_neon;
#endif
    default:
        return &mspringi_kernels_scalar;
    }
}
