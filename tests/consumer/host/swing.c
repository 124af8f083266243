#include "swing.h"

#include <massspring/massspring.h>

int swing_version(void) {
    return (int)mspring_version();
}
