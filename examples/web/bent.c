/// @file bent.c
/// Springs that yield: what bends stays bent, and is seen.
///
/// SPDX-License-Identifier: MIT
#include "internal.h"

// Springs whose materials say nothing of it yield at this strain.
static const float usual_yield_strain = 0.02f;

mspring_result page_set_yielding(uint32_t on) {
    if (!on && !page.yields)
        return MSPRING_OK;
    const float strain = page.yield_strain > 0 ? page.yield_strain : usual_yield_strain;
    const float value = on ? strain : MSPRING_NEVER;
    page.yields = page.yields || on;
    return page_done(mspring_network_set(page.network, MSPRING_YIELD_STRAIN, NULL, 0, MSPRING_ALL, &value, 0));
}

mspring_result page_straighten(void) {
    if (!page.yields)
        return MSPRING_OK;
    const float none = 0;
    const mspring_result result =
        mspring_network_set(page.network, MSPRING_PLASTIC_STRAIN, NULL, 0, MSPRING_ALL, &none, 0);
    page_find_bent();
    return page_done(result);
}

void page_find_bent(void) {
    if (mspring_network_get(page.network, MSPRING_PLASTIC_STRAIN, NULL, 0, page.spring_count, page.plastic, 1) !=
        MSPRING_OK)
        return;
    page.bent_count = 0;
    for (uint32_t i = 0; i < page.spring_count; i++) {
        page.bent_count += page.plastic[i] != 0;
        if (page.springs[i].rest_length != 0)
            page.springs[i].rest_length = page_rest_length(i);
    }
    page.changes++;
}

float page_rest_length(uint32_t spring) {
    return page.rest_length[spring] * (1 + page.plastic[spring]);
}

const float *page_plastic(void) {
    return page.plastic;
}

uint32_t page_bent_count(void) {
    return page.bent_count;
}
