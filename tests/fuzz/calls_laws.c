/// @file calls_laws.c
/// Areas, angle springs, groups and actuators for fuzz_calls.c.
///
/// SPDX-License-Identifier: MIT
#include "calls.h"

#include <math.h>

#include <massspring/massspring.h>

#include "fuzz.h"
#include "support.h"

enum { MOST = 64 };

static mspring_area_def area_of(const call *c) {
    mspring_area_def def;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def) == MSPRING_OK);
    def.kind = c->spring % 4 == 3 ? MSPRING_AREA_GAS : MSPRING_AREA_ELASTIC;
    def.stiffness = def.kind == MSPRING_AREA_GAS ? 0 : c->a;
    def.pressure = c->b;
    def.fill = c->count == 2 ? 1.25f : 1;
    def.rest_area = c->count == 1 ? fabsf(c->b) : 0;
    return def;
}

// One property: of several, a later one that is refused would not undo the first.
static mspring_result set_element(mspring_network *network, const call *c, mspring_id element) {
    static const mspring_property properties[] = {MSPRING_ELEMENT_STIFFNESS, MSPRING_ELEMENT_DAMPING, MSPRING_PRESSURE,
                                                  MSPRING_FILL,              MSPRING_REST_AREA,       MSPRING_REST_ANGLE};
    const float value = c->count == 2 ? 1.25f : c->count == 1 ? fabsf(c->b) : c->a;
    return mspring_network_set(network, properties[c->spring / 5 % COUNT_OF(properties)], NULL, element, 1, &value, 1);
}

static mspring_result change_area(mspring_network *network, const call *c) {
    const mspring_area_def def = area_of(c);
    const mspring_id corners[4] = {c->particle, c->particle + 1, c->particle + 2 + c->spring % 9, c->spring};
    switch (c->spring % 5) {
    case 0:
        return mspring_network_add_cell_areas(network, &def, NULL, NULL);
    case 1:
        return set_element(network, c, c->particle % 32);
    case 2:
        return mspring_network_remove_elements(network, NULL, c->particle % 32, 1);
    default:
        return mspring_network_add_area(network, &def, corners, 3 + c->count % 2, NULL);
    }
}

static mspring_result change_angle(mspring_network *network, const call *c) {
    const mspring_id arms[6] = {c->particle,     c->particle + 1, c->particle + 2,
                                c->particle + 1, c->spring,       c->particle};
    const double rest[2] = {(double)c->a, (double)c->b};
    mspring_angle_def def;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &def, sizeof def) == MSPRING_OK);
    def.stiffness = c->a;
    def.damping = c->spring % 3 ? 0 : c->b;
    def.rest_angle = c->count == 1 ? c->b : MSPRING_REST_ANGLE_PRESENT;
    switch (c->spring % 5) {
    case 0:
        return set_element(network, c, c->particle % 8);
    case 1:
        return support_set_rest_angles(network, c->particle % 8, c->count, rest, 1);
    case 2:
        return mspring_network_remove_elements(network, NULL, c->particle % 8, 1);
    default:
        return mspring_network_add_angles(network, &def, arms, c->count, 3, NULL);
    }
}

mspring_result call_laws(mspring_network *network, const call *c) {
    return c->kind % 2 ? change_angle(network, c) : change_area(network, c);
}

bool call_has_laws(const mspring_network *network) {
    uint32_t areas = 0, angles = 0;
    FUZZ_CHECK(support_get_areas(network, NULL, NULL, NULL, 0, &areas) == MSPRING_OK);
    FUZZ_CHECK(support_get_angles(network, NULL, NULL, NULL, 0, &angles) == MSPRING_OK);
    return areas + angles > 0;
}

mspring_result call_batch(mspring_network *network, const call *c) {
    const uint32_t all = mspring_network_count(network, MSPRING_PARTICLES);
    const mspring_id firsts[3] = {0, c->count == 2 ? c->particle : all, all}, springs[2] = {c->spring, c->spring / 2};
    const uint32_t groups[2] = {c->particle % 3, c->spring % 2};
    const float signals[2] = {c->a, c->b};
    switch (c->spring % 7) {
    case 0:
        return mspring_network_set_groups(network, firsts, c->count);
    case 1:
        return mspring_network_set_actuators(network, springs, c->count, c->particle % 4);
    case 2:
        return mspring_network_mark_groups(network, groups, 0, c->count);
    case 3:
        return mspring_network_reset_groups(network, (mspring_reset)(c->particle % 2), groups, 0, c->count);
    default:
        return mspring_network_set(network, MSPRING_SIGNAL, NULL, c->particle % 2, c->count, signals, 1);
    }
}

void call_look(const mspring_network *network, uint64_t *look, void (*mix)(uint64_t *, const void *, size_t)) {
    static mspring_id ids[MOST];
    static double first[MOST], second[MOST];
    uint32_t count = 0;
    mspring_energy bent = {.struct_size = sizeof bent};
    FUZZ_CHECK(support_get_areas(network, NULL, NULL, NULL, 0, &count) == MSPRING_OK);
    count = count < MOST ? count : MOST;
    FUZZ_CHECK(support_get_areas(network, ids, first, second, count, &count) == MSPRING_OK);
    count = count < MOST ? count : MOST;
    mix(look, ids, count * sizeof *ids);
    mix(look, first, count * sizeof *first);
    FUZZ_CHECK(support_get_angles(network, ids, first, second, MOST, &count) == MSPRING_OK);
    count = count < MOST ? count : MOST;
    mix(look, ids, count * sizeof *ids);
    mix(look, first, count * sizeof *first);
    FUZZ_CHECK(mspring_network_get_energy(network, &bent) == MSPRING_OK);
    FUZZ_CHECK(bent.dissipated >= 0);
    mix(look, &bent, sizeof bent);
    for (uint32_t group = 0; group < mspring_network_count(network, MSPRING_GROUPS); group++) {
        uint32_t flags = 0;
        FUZZ_CHECK(mspring_network_get_integers(network, MSPRING_GROUP_FLAGS, NULL, group, 1, &flags, 1) == MSPRING_OK);
        mix(look, &flags, sizeof flags);
    }
}
