/// @file test_turn.c
/// The library's own cosine and sine, which colliders turn by: C libraries differ in the last bit of theirs.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "base/rotation.h"
#include "support.h"

/// Error that the header promises, plus the error of libm. (Windows has pi to 66 bits: at an angle of 1e6 that is
/// 1e-14.)
#ifdef _WIN32
#define ERROR (2e-16 + 5e-14)
#else
#define ERROR (2e-16 + 1.2e-16)
#endif

static void check_turn(double angle) {
    const mspringi_rotation turn = mspringi_rotation_by(angle);
    check_near(turn.cosine, cos(angle), ERROR);
    check_near(turn.sine, sin(angle), ERROR);
}

static void it_is_cosine_and_sine(void **state) {
    (void)state;
    uint64_t seed = 78;
    const double limits[] = {1, 10, 1e4, MSPRINGI_MAX_ANGLE};
    for (int i = 0; i < 200000; i++)
        check_turn(support_random_between(&seed, -1, 1) * limits[i % 4]);
    for (int i = -1000; i <= 1000; i++) {
        const double quarter = i * 1.5707963267948966 / 2;
        check_turn(quarter);
        check_turn(nextafter(quarter, 1e9));
        check_turn(nextafter(quarter, -1e9));
    }
}

static void it_is_exact_at_0(void **state) {
    (void)state;
    const mspringi_rotation turn = mspringi_rotation_by(0);
    assert_true(turn.cosine == 1 && turn.sine == 0);
    check_turn(MSPRINGI_MAX_ANGLE);
    check_turn(-MSPRINGI_MAX_ANGLE);
    assert_true(mspringi_rotation_by(1e-300).sine == 1e-300);
}

// The angle of a turn is what it was turned by, within half a turn.
static void it_has_its_angle(void **state) {
    (void)state;
    uint64_t seed = 79;
    for (int i = 0; i < 200000; i++) {
        const double angle = support_random_between(&seed, -1, 1) * 3.141592653589793;
        check_near(mspringi_angle_of(mspringi_rotation_by(angle)), angle, 1e-15);
    }
    const mspringi_rotation turns[] = {{1, 0}, {0, 1}, {0, -1}, {-1, 0}, {-1, -1e-300}};
    const double angles[] = {0, 1.5707963267948966, -1.5707963267948966, 3.141592653589793, -3.141592653589793};
    for (size_t i = 0; i < COUNT_OF(turns); i++)
        check_near(mspringi_angle_of(turns[i]), angles[i], 1e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_has_its_angle),
        cmocka_unit_test(it_is_cosine_and_sine),
        cmocka_unit_test(it_is_exact_at_0),
    };
    return cmocka_run_group_tests_name("turn", tests, NULL, NULL);
}
