#include "kernels/kernels.h"

static const mspringi_kernels *const levels[] = {
#define LEVEL(name, number) &mspringi_kernels_##name,
#include "base/levels.def"
#undef LEVEL
};

// Levels that are not built in fall back to the lowest.
const mspringi_kernels *mspringi_kernels_of(mspring_simd level) {
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; ++i)
        if (levels[i]->level == level)
            return levels[i];
    return levels[0];
}
