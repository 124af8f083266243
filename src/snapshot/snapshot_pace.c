/// Snapshot of mspring_settings.substep_length. Networks without one write nothing.
#include <float.h>

#include "store/sections.h"

static void substep_length_save(const mspring_network *network, mspringi_writer *to) {
    if (network->substep_length > 0.0)
        mspringi_put(to, &network->substep_length, 1, sizeof network->substep_length);
}

// The length is a float, so that whole numbers of substeps are exact.
static mspring_result substep_length_check(mspring_network *network, const uint8_t *from, size_t size) {
    double value = 0.0;
    if (size == 0)
        return MSPRING_OK;
    mspring_result result =
        mspringi_section_check_size(network, &mspringi_section_substep_length, size, sizeof value);
    if (result != MSPRING_OK)
        return result;
    (void)mspringi_get(from, &value, 1, sizeof value);
    return value >= (double)FLT_MIN && value <= 1e30 && (double)(float)value == value
               ? MSPRING_OK
               : mspringi_section_fail(network, &mspringi_section_substep_length, "it is %g s", value);
}

static void substep_length_load(mspring_network *network, const uint8_t *from, size_t size) {
    network->substep_length = 0.0;
    if (size > 0)
        (void)mspringi_get(from, &network->substep_length, 1, sizeof network->substep_length);
}

const mspringi_section mspringi_section_substep_length = {
    "tick", "length of substeps", false, NULL, substep_length_save, substep_length_check, substep_length_load,
    NULL};
