#include "kernels.h"

#define LANES_OF(b)                                                                                                \
    { (b) & 1, (b) >> 1 & 1, (b) >> 2 & 1, (b) >> 3 & 1, (b) >> 4 & 1, (b) >> 5 & 1, (b) >> 6 & 1, (b) >> 7 }
#define LANES_OF_4(b) LANES_OF(b), LANES_OF((b) + 1), LANES_OF((b) + 2), LANES_OF((b) + 3)
#define LANES_OF_16(b) LANES_OF_4(b), LANES_OF_4((b) + 4), LANES_OF_4((b) + 8), LANES_OF_4((b) + 12)
#define LANES_OF_64(b) LANES_OF_16(b), LANES_OF_16((b) + 16), LANES_OF_16((b) + 32), LANES_OF_16((b) + 48)

_Alignas(64) const float mspringi_part_weights[1 << MSPRINGI_PART][MSPRINGI_PART] = {
    LANES_OF_64(0), LANES_OF_64(64), LANES_OF_64(128), LANES_OF_64(192)};

// The lowest level is that of all that is not built in.
#if defined(MSPRINGI_WITHOUT_SCALAR)
#define LOWEST default:
#else
#define LOWEST
#endif

const mspringi_kernels *mspringi_kernels_of(mspring_simd level) {
    switch (level) {
#if defined(MSPRINGI_X86)
    case MSPRING_SIMD_SSE2:
        LOWEST
        return &mspringi_kernels_sse2;
#if !defined(MSPRINGI_WITHOUT_AVX2)
    case MSPRING_SIMD_AVX2:
        return &mspringi_kernels_avx2;
#endif
#if !defined(MSPRINGI_WITHOUT_AVX512)
    case MSPRING_SIMD_AVX512:
        return &mspringi_kernels_avx512;
#endif
#elif defined(MSPRINGI_AARCH64)
    case MSPRING_SIMD_NEON:
        LOWEST
        return &mspringi_kernels_neon;
#elif defined(MSPRINGI_WASM)
    case MSPRING_SIMD_WASM:
        LOWEST
        return &mspringi_kernels_wasm;
#endif
#if !defined(MSPRINGI_WITHOUT_SCALAR)
    default:
        return &mspringi_kernels_scalar;
#endif
    }
}
