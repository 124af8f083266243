/// @file test_tune_laws.c
/// Tuning of networks with areas and angles: the reference has their laws, in double precision.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "support.h"
#include "tunes.h"

// A bar with cell areas, a gas and angles along its lowest row, that hangs from its left end.
static mspring_network *made(bool has_laws) {
    mspring_network_def def = support_def(-9.8f, 8);
    mspring_network *network = tunes_bar(TUNES_STIFFNESS / 8, 50, 0, &def);
    const mspring_id ring[] = {0, 13, 41, 28};
    mspring_area_def area;
    mspring_angle_def angle;
    if (!has_laws)
        return network;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
    area.stiffness = (float)TUNES_STIFFNESS / 8;
    check_ok(mspring_network_add_cell_areas(network, &area, NULL, NULL));
    area.kind = MSPRING_AREA_GAS;
    area.stiffness = 0;
    area.pressure = 2000;
    check_ok(mspring_network_add_area(network, &area, ring, 4, NULL));
    angle.stiffness = 1e5f;
    angle.damping = 100;
    for (mspring_id p = 0; p < 12; p++) {
        const mspring_id three[] = {p, p + 1, p + 2};
        check_ok(mspring_network_add_angles(network, &angle, three, 1, 3, NULL));
    }
    return network;
}

// The explicit method is of second order but for dampers, and of first with these: with twice the substeps the
// error is between half and a quarter, if what both are compared with has the same laws. With those left out it
// would not be.
static void the_reference_has_the_laws(void **state) {
    (void)state;
    tunes_watch watch = {0};
    mspring_network *network = made(true);
    mspring_tune_def def = tunes_def(&watch);
    const mspring_settings settings[] = {tunes_setting(MSPRING_SOLVER_EXPLICIT, 32, 1),
                                           tunes_setting(MSPRING_SOLVER_EXPLICIT, 64, 1)};
    def.settings = settings;
    def.setting_count = 2;
    def.measure = MSPRING_TUNE_BY_TRAJECTORY;
    def.dt = 1.0 / 64;
    const tunes_table table = tunes_run(network, &def);
    double shares[2] = {0, 0};
    for (uint32_t i = 0; i < table.count; i++) {
        assert_true(tunes_has(&table.rows[i], MSPRING_TUNE_HAS_TRAJECTORY));
        shares[table.rows[i].setting] = table.rows[i].trajectory_share;
        check_near(table.rows[i].energy_drift, 0, 0.05);
    }
    printf("errors of 32 and 64 substeps: %g, %g of the motion\n", shares[0], shares[1]);
    // The fine run takes 192 substeps: (1 - 1/36) / (1/4 - 1/36) is 4.4. Rounding, 1e-6, adds to both.
    assert_true(shares[0] / shares[1] > 1.7 && shares[0] / shares[1] < 4.4);
    assert_true(shares[1] < 1e-5);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_reference_has_the_laws)};
    return cmocka_run_group_tests_name("tune_laws", tests, NULL, NULL);
}
