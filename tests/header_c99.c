// The public headers alone, as strict C99: they name everything that they use, and need no other header before
// them. SPDX-License-Identifier: MIT
#include <massspring/massspring_gradient.h>

#define MSPRING_EXPERIMENTAL // later than it might be
#include <massspring/massspring.h>

int main(void) {
    mspring_network_def def = mspring_network_def_default();
    mspring_tune_def tune = mspring_tune_def_default();
    if (def.struct_size != sizeof def || def.settings.struct_size != sizeof def.settings || tune.struct_size != sizeof tune)
        return 1;
    return mspring_version() == MSPRING_VERSION ? 0 : 2;
}
