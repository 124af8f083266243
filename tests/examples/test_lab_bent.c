/// @file test_lab_bent.c
/// Springs that yield in the lab: what is bent stays so, in the car and in any other scene.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "lab_player.h"
#include "support.h"

// The wall stops the car within half a second. More substeps change a blow's plastic strain by less than 0.2 %; the
// number of springs that it bends at all differs by more, as many are at the edge.
static void the_car_stays_bent(void **state) {
    (void)state;
    static lab_model model;
    start(&model, "car");
    assert_true(model.settings.yielding && model.look.colour == COLOUR_BENT);
    frames(&model, 4);
    assert_true(model.sides[0].bent_count < 10); // but for corners that the street scrapes
    frames(&model, 92);
    const double bent[2] = {model.sides[0].bent_count, model.sides[1].bent_count};
    assert_true(bent[0] > 200 && fabs(bent[1] / bent[0] - 1) < 0.1);
    must_do(&model, "yielding off");
    frames(&model, 1);
    const uint32_t now = model.sides[0].bent_count;
    frames(&model, 32);
    assert_int_equal(model.sides[0].bent_count, now); // and no more
    assert_true(now >= bent[0]);
    must_do(&model, "sides 1");
    frames(&model, 1);
    assert_int_equal(model.sides[0].bent_count, now); // the new network is bent as well
    must_do(&model, "scene bar");
    frames(&model, 1);
    assert_true(model.sides[0].bent_count == 0 && model.look.colour == COLOUR_STRAIN);
    model_end(&model);
}

static void any_scene_can_yield_and_undo_straightens_it(void **state) {
    (void)state;
    static lab_model model;
    start(&model, "bar");
    must_do(&model, "sides 1");
    must_do(&model, "yielding on");
    must_do(&model, "blast 40 2 8 60");
    frames(&model, 32);
    assert_true(model.sides[0].bent_count > 0);
    must_do(&model, "undo");
    frames(&model, 1);
    assert_int_equal(model.sides[0].bent_count, 0);
    must_do(&model, "undo");
    assert_false(model.settings.yielding);
    model_end(&model);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_car_stays_bent),
        cmocka_unit_test(any_scene_can_yield_and_undo_straightens_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
