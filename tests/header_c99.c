// The public header alone, as strict C99: it names everything that it uses, and needs no other header before it.
// SPDX-License-Identifier: MIT
#include <massspring/massspring.h>

int main(void) {
    mspring_network_def def;
    return mspring_network_def_init(&def, sizeof def) == MSPRING_OK && mspring_version() == MSPRING_VERSION ? 0 : 1;
}
