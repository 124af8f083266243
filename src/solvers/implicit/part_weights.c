/// The masks of lanes as factors, for kernels of the linear solvers.
#include "kernels/kernels.h"

#define LANES_OF(b)                                                                                                \
    { (b) & 1, (b) >> 1 & 1, (b) >> 2 & 1, (b) >> 3 & 1, (b) >> 4 & 1, (b) >> 5 & 1, (b) >> 6 & 1, (b) >> 7 }
#define LANES_OF_4(b) LANES_OF(b), LANES_OF((b) + 1), LANES_OF((b) + 2), LANES_OF((b) + 3)
#define LANES_OF_16(b) LANES_OF_4(b), LANES_OF_4((b) + 4), LANES_OF_4((b) + 8), LANES_OF_4((b) + 12)
#define LANES_OF_64(b) LANES_OF_16(b), LANES_OF_16((b) + 16), LANES_OF_16((b) + 32), LANES_OF_16((b) + 48)

_Alignas(64) const float mspringi_part_weights[1 << MSPRINGI_PART][MSPRINGI_PART] = {
    LANES_OF_64(0), LANES_OF_64(64), LANES_OF_64(128), LANES_OF_64(192)};
