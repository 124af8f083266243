/// Sleep, which a build may lack.
#include "support.h"

void support_fall_asleep(mspring_network *network, double dt) {
    for (int i = 0; i < 6400 && !support_is_asleep(network); i++) {
        support_steps(network, 1, dt);
    }
    assert_int_equal(support_is_asleep(network), 1);
}

bool support_sleeps(const mspring_network *network, mspring_id particle) {
    uint8_t asleep = 2;
    check_ok(support_get_sleepers(network, particle, 1, &asleep, 1));
    assert_true(asleep <= 1);
    return asleep == 1;
}
