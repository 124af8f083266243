// The public headers alone, as strict C99: they name everything that they use, and need no other header before
// them. SPDX-License-Identifier: MIT
#include <massspring/massspring_batch.h>
#include <massspring/massspring_contact.h>
#include <massspring/massspring_gradient.h>
#include <massspring/massspring_laws.h>
#include <massspring/massspring_tools.h>

int main(void) {
    mspring_network_def def;
    mspring_tune_def tune;
    if (mspring_tune_def_init(&tune, sizeof tune) != MSPRING_OK)
        return 1;
    return mspring_network_def_init(&def, sizeof def) == MSPRING_OK && mspring_version() == MSPRING_VERSION ? 0 : 1;
}
