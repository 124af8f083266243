/// Storage of fractions that many springs share.
#include "store/fractions.h"

/// Most that a byte can tell apart.
#define MOST_SHARED 256

static mspringi_relative fractions_of(const mspringi_spring *spring) {
    return spring->flags & MSPRING_SPRING_RELATIVE ? (mspringi_relative){spring->stiffness, spring->damping}
                                                   : (mspringi_relative){-1.0f, 0.0f};
}

static bool are_equal(mspringi_relative a, mspringi_relative b) {
    return a.stiffness == b.stiffness && a.damping == b.damping;
}

// Number the fractions of all springs in the order in which they appear. Returns how many there are, or one more
// than can be told apart.
static uint32_t number(const mspring_builder *builder, mspringi_relative *shared, uint8_t *of_spring) {
    uint32_t count = 0, last = 0;
    for (size_t s = 0; s < builder->spring_count; ++s) {
        const mspringi_relative value = fractions_of(&builder->springs[s]);
        if (count == 0 || !are_equal(shared[last], value)) // most are what the one before is
            for (last = 0; last < count && !are_equal(shared[last], value);)
                ++last;
        if (last == MOST_SHARED)
            return MOST_SHARED + 1;
        if (last == count)
            shared[count++] = value;
        of_spring[s] = (uint8_t)last;
    }
    return count;
}

mspring_result mspringi_fractions_create(mspringi_fractions *fractions, const mspring_builder *builder, size_t room,
                                         mspringi_memory *memory, mspringi_message *message) {
    mspringi_relative shared[MOST_SHARED];
    const bool may_share = room == builder->spring_count;
    if (may_share)
        fractions->of_spring = mspringi_alloc(memory, builder->spring_count, sizeof *fractions->of_spring);
    const uint32_t count = fractions->of_spring ? number(builder, shared, fractions->of_spring) : 0;
    const bool is_shared = may_share && count <= MOST_SHARED;
    if (!is_shared) {
        mspringi_free(memory, fractions->of_spring);
        fractions->of_spring = NULL;
    }
    const size_t kept = is_shared ? count : room;
    fractions->values = mspringi_alloc(memory, kept, sizeof *fractions->values);
    if (!fractions->values || (is_shared && !fractions->of_spring))
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for what %zu springs are like",
                             builder->spring_count);
    for (size_t i = 0; i < kept; ++i)
        fractions->values[i] = is_shared                   ? shared[i]
                               : i < builder->spring_count ? fractions_of(&builder->springs[i])
                                                           : (mspringi_relative){-1.0f, 0.0f};
    return MSPRING_OK;
}

mspring_result mspringi_fractions_separate(mspring_network *network) {
    mspringi_fractions *fractions = &network->fractions;
    const uint32_t springs = network->topology.spring_count;
    if (!fractions->of_spring)
        return MSPRING_OK;
    mspringi_relative *values = mspringi_alloc(&network->memory, springs, sizeof *values);
    if (!values)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for fractions of its own for each of %u springs", (unsigned)springs);
    for (mspring_id s = 0; s < springs; ++s)
        values[s] = mspringi_fractions_of(fractions, s);
    mspringi_free(&network->memory, fractions->values);
    mspringi_free(&network->memory, fractions->of_spring);
    *fractions = (mspringi_fractions){.values = values};
    return MSPRING_OK;
}
