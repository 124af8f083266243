#include "kernels.h"

const mspringi_kernels *mspringi_kernels_of(mspring_simd level) {
    const mspringi_kernels *best = &mspringi_kernels_scalar;
#if defined(MSPRINGI_X86_64)
    const mspringi_kernels *const upward[] = {&mspringi_kernels_sse2, &mspringi_kernels_avx2,
                                              &mspringi_kernels_avx512};
    for (size_t i = 0; i < sizeof upward / sizeof upward[0]; ++i)
        if (upward[i]->level <= level)
            best = upward[i];
#else
    (void)level;
#endif
    return best;
}
