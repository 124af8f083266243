/// Whether a network sleeps, or for how long it has been still, in a snapshot.
#include <math.h>

#include "sections.h"
#include "sleep/sleep.h"

typedef struct sleep_head {
    double still;
    float speed, time;
    uint32_t is_asleep, has_force;
} sleep_head;
#define HEAD_BYTES ((size_t)24)

// What has been disturbed wakes before the next step.
static bool sleeps_on(const mspring_network *network) {
    return network->sleep.is_asleep && !mspringi_sleep_is_disturbed(network);
}

static size_t force_floats(const mspring_network *network, bool is_asleep, bool has_force) {
    return is_asleep && has_force ? 2 * mspringi_slot_count(network) : 0;
}

static size_t sleep_size(const mspring_network *network) {
    if (!(network->sleep.speed > 0.0f))
        return 0;
    return HEAD_BYTES + force_floats(network, sleeps_on(network), network->sleep.has_force) * sizeof(float);
}

static void sleep_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_sleep *sleep = &network->sleep;
    const bool is_asleep = sleeps_on(network);
    const double still = sleep->is_asleep && !is_asleep ? 0.0 : sleep->still;
    const float settings[] = {sleep->speed, sleep->time};
    const uint32_t words[] = {is_asleep, is_asleep && sleep->has_force};
    mspringi_put(to, &still, 1, sizeof still);
    mspringi_put(to, settings, 2, sizeof settings[0]);
    mspringi_put(to, words, 2, sizeof words[0]);
    mspringi_put(to, sleep->force.x, force_floats(network, words[0], words[1]), sizeof *sleep->force.x);
}

static const uint8_t *read_head(const uint8_t *from, sleep_head *head) {
    from = mspringi_get(from, &head->still, 1, sizeof head->still);
    from = mspringi_get(from, &head->speed, 1, sizeof head->speed);
    from = mspringi_get(from, &head->time, 1, sizeof head->time);
    from = mspringi_get(from, &head->is_asleep, 1, sizeof head->is_asleep);
    return mspringi_get(from, &head->has_force, 1, sizeof head->has_force);
}

static mspring_result sleep_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_sleep;
    sleep_head head;
    if (size == 0)
        return MSPRING_OK;
    if (size < HEAD_BYTES)
        return mspringi_section_check_size(network, section, size, HEAD_BYTES);
    from = read_head(from, &head);
    if (!(head.still >= 0.0 && head.still <= 1e300 && head.speed > 0.0f && head.speed <= 1e15f &&
          head.time >= 0.0f && head.time <= 1e6f) ||
        head.is_asleep > 1 || head.has_force > head.is_asleep)
        return mspringi_section_fail(network, section, "below %g m/s, after %g s, for %g s", (double)head.speed,
                                     (double)head.time, head.still);
    const size_t floats = force_floats(network, head.is_asleep, head.has_force);
    mspring_result result =
        mspringi_section_check_size(network, section, size, HEAD_BYTES + floats * sizeof(float));
    for (size_t i = 0; result == MSPRING_OK && i < floats; ++i)
        if (!isfinite(mspringi_float_at(from, i)))
            result = mspringi_section_fail(network, section, "a force is %g N", (double)mspringi_float_at(from, i));
    return result == MSPRING_OK ? mspringi_sleep_reserve(network) : result;
}

// After all that could disturb it.
static void sleep_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_sleep *sleep = &network->sleep;
    sleep_head head = {0};
    if (size > 0)
        from = read_head(from, &head);
    sleep->speed = head.speed;
    sleep->time = head.time;
    mspringi_wake(network);
    if (head.is_asleep) {
        mspringi_sleep_fall(network, (mspringi_field){NULL, NULL});
        mspringi_get(from, sleep->force.x, force_floats(network, true, head.has_force), sizeof *sleep->force.x);
        sleep->has_force = head.has_force;
    }
    sleep->still = head.still;
}

const mspringi_section mspringi_section_sleep = {"slee",     "sleep",     false,     sleep_size,
                                                 sleep_save, sleep_check, sleep_load};
