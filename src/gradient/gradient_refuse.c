/// Rejection of networks that have no gradient.
#include <string.h>

#include <massspring/massspring.h>

#include "gradient/gradient.h"
#include "store/feature.h"

/// Springs that are read together.
#define MSPRINGI_GRADIENT_CHUNK 256u

// Reject everything that acts besides springs, gravity and global damping (store/features.def). The message names
// the folder in features/, which the name of the function begins with. refuse_floor() checks contact and floor.
static mspring_result refuse_features(mspring_network *network) {
    static const struct {
        const char *name;
        bool (*acts)(const mspring_network *network);
    } features[] = {
#define ACTS(function) {&#function[sizeof "mspringi_" - 1], function},
#include "store/features.def"
    };
    for (size_t i = 0; i < sizeof features / sizeof features[0]; ++i) {
        const char *name = features[i].name;
        if (features[i].acts != mspringi_contact_acts && features[i].acts(network)) {
            char text[32] = {0};
            for (size_t c = 0; c + 1 < sizeof text && name[c] && name[c] != '_'; ++c)
                text[c] = name[c];
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "the network has %s, which have no gradient yet",
                                 memcmp(text, "areas", sizeof "areas") == 0 ? "areas or angles" : text);
        }
    }
    return MSPRING_OK;
}

static mspring_result refuse_floor(mspring_network *network) {
    mspring_contact_def contact = {.struct_size = sizeof contact};
    mspring_floor_def floor = {.struct_size = sizeof floor};
    mspring_result result = mspring_network_get_contact(network, &contact);
    if (result == MSPRING_OK)
        result = mspring_network_get_floor(network, &floor);
    if (result != MSPRING_OK)
        return result;
    const char *what = contact.capacity > 0       ? "contact or colliders"
                       : floor.height_count > 0   ? "a floor with heights"
                       : floor.friction > 0.0f    ? "a floor with friction"
                       : floor.restitution > 0.0f ? "a floor with restitution"
                                                  : NULL;
    for (uint32_t i = 0; i < floor.plane_count && !what; ++i) {
        if (floor.plane_frictions && floor.plane_frictions[i] > 0.0f)
            what = "a floor with friction";
        if (floor.plane_restitutions && floor.plane_restitutions[i] > 0.0f)
            what = "a floor with restitution";
    }
    return what ? mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                "the network has %s, which has no gradient yet", what)
                : MSPRING_OK;
}

static mspring_result refuse_settings(mspring_network *network) {
    const char *what = network->solver.ops->lags ? NULL : "an implicit or direct solver";
    if (network->settings.sleep_speed > 0.0f)
        what = "a sleep_speed above 0";
    if (network->job)
        what = "a job for another layout";
    return what ? mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                "the network has %s, which has no gradient yet", what)
                : MSPRING_OK;
}

static mspring_result refuse_flags(mspring_network *network, mspring_id first, uint32_t count) {
    uint32_t flags[MSPRINGI_GRADIENT_CHUNK];
    const mspring_result result =
        mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, first, count, flags, 1);
    for (uint32_t i = 0; i < count && result == MSPRING_OK; ++i) {
        const char *kind = flags[i] & MSPRING_SPRING_BROKEN     ? NULL
                           : flags[i] & MSPRING_SPRING_RELATIVE ? "relative"
                           : flags[i] & (MSPRING_SPRING_PULL_ONLY | MSPRING_SPRING_PUSH_ONLY)
                               ? "one-way or a strain limit"
                               : NULL;
        if (kind)
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "spring %u is %s, which has no gradient yet", (unsigned)(first + i), kind);
    }
    return result;
}

// Springs that break or yield, and those on ramps.
static mspring_result refuse_laws(mspring_network *network, mspring_id first, uint32_t count) {
    float breaking[MSPRINGI_GRADIENT_CHUNK], yielding[MSPRINGI_GRADIENT_CHUNK], plastic[MSPRINGI_GRADIENT_CHUNK],
        length[MSPRINGI_GRADIENT_CHUNK], active[MSPRINGI_GRADIENT_CHUNK];
    mspring_result result = mspring_network_get(network, MSPRING_BREAK_STRAIN, NULL, first, count, breaking, 1);
    if (result == MSPRING_OK)
        result = mspring_network_get(network, MSPRING_YIELD_STRAIN, NULL, first, count, yielding, 1);
    if (result == MSPRING_OK)
        result = mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, first, count, plastic, 1);
    if (result == MSPRING_OK)
        result = mspring_network_get(network, MSPRING_REST_LENGTH, NULL, first, count, length, 1);
    if (result == MSPRING_OK)
        result = mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, first, count, active, 1);
    for (uint32_t i = 0; i < count && result == MSPRING_OK; ++i) {
        const mspring_id spring = first + i;
        const char *what = !mspringi_spring_exists(network, spring) ? NULL
                           : breaking[i] < MSPRING_NEVER            ? "a break strain"
                           : yielding[i] < MSPRING_NEVER            ? "a yield strain"
                           : plastic[i] != 0.0f                     ? "a plastic strain"
                           : length[i] != active[i]                 ? "a ramp"
                                                                    : NULL;
        if (what)
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "spring %u has %s, which has no gradient yet", (unsigned)spring, what);
    }
    return result;
}

static mspring_result refuse_springs(mspring_network *network) {
    const uint32_t all = mspring_network_count(network, MSPRING_SPRINGS);
    mspring_result result = MSPRING_OK;
    for (uint32_t first = 0; first < all && result == MSPRING_OK; first += MSPRINGI_GRADIENT_CHUNK) {
        const uint32_t count = all - first < MSPRINGI_GRADIENT_CHUNK ? all - first : MSPRINGI_GRADIENT_CHUNK;
        result = refuse_flags(network, first, count);
        if (result == MSPRING_OK)
            result = refuse_laws(network, first, count);
    }
    return result;
}

mspring_result mspringi_gradient_check(mspring_network *network) {
    mspring_result result = refuse_settings(network);
    if (result == MSPRING_OK)
        result = refuse_features(network);
    if (result == MSPRING_OK)
        result = refuse_floor(network);
    return result == MSPRING_OK ? refuse_springs(network) : result;
}
