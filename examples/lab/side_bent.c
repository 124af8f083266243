/// @file side_bent.c
/// Springs that yield: what bends stays bent.
///
/// SPDX-License-Identifier: MIT
#include "lab/side.h"

#include <stdio.h>
#include <stdlib.h>

#include <massspring/massspring.h>

// Scenes that say nothing of it yield at this strain.
static const float usual_yield_strain = 0.02f;

static bool accepted(lab_side *side, mspring_result result) {
    const char *detail = mspring_network_error(side->network);
    if (result != MSPRING_OK)
        snprintf(side->complaint, sizeof side->complaint, "%s", *detail ? detail : mspring_result_string(result));
    return result == MSPRING_OK;
}

bool side_set_yielding(lab_side *side, bool yielding) {
    const lab_stage *stage = side->stage;
    float *values = malloc((stage->spring_count ? stage->spring_count : 1) * sizeof *values);
    if (!values)
        return accepted(side, MSPRING_ERROR_MEMORY);
    for (uint32_t i = 0; i < stage->spring_count; i++)
        values[i] = !yielding ? MSPRING_NEVER : stage->yields ? stage->yield_strain[i] : usual_yield_strain;
    const mspring_result result =
        mspring_network_set(side->network, MSPRING_YIELD_STRAIN, NULL, 0, stage->spring_count, values, 1);
    free(values);
    return accepted(side, result);
}

void side_measure_bent(lab_side *side) {
    const uint32_t count = side->stage->spring_count;
    if (mspring_network_get(side->network, MSPRING_PLASTIC_STRAIN, NULL, 0, count, side->plastic, 1) != MSPRING_OK)
        return;
    side->bent_count = 0;
    for (uint32_t i = 0; i < count; i++)
        side->bent_count += side->plastic[i] != 0;
}

bool side_copy_bent(lab_side *side, const lab_side *from) {
    if (from->bent_count == 0)
        return true;
    const mspring_result result = mspring_network_set(side->network, MSPRING_PLASTIC_STRAIN, NULL, 0,
                                                      side->stage->spring_count, from->plastic, 1);
    side_measure_bent(side);
    return accepted(side, result);
}
