/// Snapshot of springs on the way to their rest lengths.
#include "features/ramps/ramps.h"
#include "store/properties.h"
#include "store/sections.h"
#include "store/springs.h"

#define LONGEST_SPRING 1e13 // m, diagonal of the square of valid positions

static void hand_ramp(mspringi_io *io, mspringi_ramp *ramp) {
    MSPRINGI_HAND(io, ramp->spring);
    MSPRINGI_HAND(io, ramp->to);
    MSPRINGI_HAND(io, ramp->from);
    MSPRINGI_HAND(io, ramp->seconds);
    MSPRINGI_HAND(io, ramp->passed);
}

static void ramps_save(const mspring_network *network, mspringi_writer *to) {
    mspringi_io io = mspringi_io_to(to);
    for (size_t i = 0; i < mspringi_ramp_count(network); ++i)
        hand_ramp(&io, &network->ramps->list[i]);
}

static mspring_result ramps_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_ramps;
    mspringi_io io = mspringi_io_from(from, size);
    uint32_t count = 0;
    for (; io.left > 0 && !io.is_short && count <= network->topology.reserve.spring_end; ++count) {
        mspringi_ramp ramp;
        hand_ramp(&io, &ramp);
        if (!(ramp.spring < network->topology.reserve.spring_end && ramp.from > 0.0 &&
              ramp.from <= LONGEST_SPRING && mspringi_is_spring_value(MSPRINGI_REST_LENGTH, ramp.to) &&
              ramp.seconds > 0.0 && ramp.seconds <= MSPRINGI_LONGEST_RAMP && ramp.passed >= 0.0 &&
              ramp.passed < ramp.seconds))
            return mspringi_section_fail(network, section, "spring %u goes from %g to %g m, for %g of %g s",
                                         (unsigned)ramp.spring, ramp.from, (double)ramp.to, ramp.passed,
                                         ramp.seconds);
    }
    const mspring_result result = mspringi_section_end(network, section, &io);
    return result == MSPRING_OK && count > 0 ? mspringi_ramps_reserve(network, count) : result;
}

static void ramps_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    if (network->ramps)
        network->ramps->count = 0;
    while (io.left > 0) {
        mspringi_ramp ramp;
        hand_ramp(&io, &ramp);
        mspringi_ramp_add(network, &ramp);
    }
    mspringi_ramps_apply(network, 0.0);
}

// Each is of another spring, which is whole.
static mspring_result ramps_check_against(mspring_network *network, const mspringi_saved *saved,
                                          const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    mspring_result result = MSPRING_OK;
    if (size == 0)
        return MSPRING_OK;
    uint8_t *has_one = mspringi_alloc(&network->memory, network->topology.reserve.spring_end, sizeof *has_one);
    if (!has_one)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to compare %zu bytes of ramps",
                             size);
    while (result == MSPRING_OK && io.left > 0) {
        mspringi_ramp ramp;
        hand_ramp(&io, &ramp);
        if (has_one[ramp.spring]++ || !mspringi_saved_is_whole(saved, ramp.spring))
            result = mspringi_section_fail(network, &mspringi_section_ramps,
                                           "spring %u goes to its rest length twice, or is not whole",
                                           (unsigned)ramp.spring);
    }
    mspringi_free(&network->memory, has_one);
    return result;
}

const mspringi_section mspringi_section_ramps = {"ramp",     "springs on the way to their rest lengths",
                                                 false,      NULL,
                                                 ramps_save, ramps_check,
                                                 ramps_load, ramps_check_against};
