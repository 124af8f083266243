/// Copies of spring values that the host sends again and again.
///
/// They hold for one parameter_fingerprint. Every other edit of springs changes it, and so ends them. What changes
/// without it forgets its copy: rest lengths within steps, and all that a snapshot brings.
#include <string.h>

#include "base/cpu.h"
#include "edits/edit_values.h"
#include "features/ramps/ramps.h"

/// Fewest values of a call that makes a copy, and values that are compared at once.
#define RUN 64u

/// Prefetch distance in values: both arrays come from the third-level cache, as a step needs the second one.
#define AHEAD 1024u

// Copy of a property; NULL: it has none. To set a rest length ends a ramp.
static mspringi_sent *copy_of(mspring_network *network, mspring_property property) {
    const bool is_fixed = property != MSPRING_REST_LENGTH || mspringi_ramp_count(network) == 0;
    return property >= MSPRING_STIFFNESS && property <= MSPRING_RELAX_STRAIN && is_fixed
               ? &network->sent[mspringi_sent_index(property)]
               : NULL;
}

static bool holds(const mspring_network *network, const mspringi_sent *sent) {
    return sent && sent->first < sent->end && sent->fingerprint == network->parameter_fingerprint;
}

static inline uint32_t bits_of(const float *value) {
    uint32_t bits;
    memcpy(&bits, value, sizeof bits);
    return bits;
}

// Index of the first run, from index i on, whose bits differ, or that is too short.
static uint32_t skip_runs(const float *sent, const float *given, uint32_t i, uint32_t count) {
    for (; count - i >= RUN; i += RUN) {
        for (uint32_t k = 0; count - i >= AHEAD + RUN && k < RUN; k += MSPRINGI_WIDTH) {
            MSPRINGI_PREFETCH(sent + i + AHEAD + k);
            MSPRINGI_PREFETCH(given + i + AHEAD + k);
        }
        if (memcmp(sent + i, given + i, RUN * sizeof *sent) != 0)
            break;
    }
    return i;
}

const float *mspringi_sent_range(mspring_network *network, const mspringi_selection *at,
                                 mspring_property property) {
    const mspringi_sent *sent = copy_of(network, property);
    const bool is_known = !at->list && holds(network, sent) && at->first >= sent->first && at->first <= sent->end &&
                          at->count <= sent->end - at->first;
    return is_known ? sent->values + at->first : NULL;
}

uint32_t mspringi_sent_skip(const float *sent, const mspringi_values *values, uint32_t i, uint32_t count) {
    const float *given = values->first;
    const size_t stride = values->stride;
    if (stride == 1)
        i = skip_runs(sent, given, i, count);
    while (i < count && bits_of(sent + i) == bits_of(given + i * stride))
        ++i;
    return i;
}

bool mspringi_sent_again(mspring_network *network, const mspringi_selection *at, const mspringi_values *values) {
    const mspringi_sent *sent = copy_of(network, values->property);
    if (!at->list) {
        const float *range = mspringi_sent_range(network, at, values->property);
        return range && mspringi_sent_skip(range, values, 0, at->count) == at->count;
    }
    if (!holds(network, sent))
        return false;
    for (uint32_t i = 0; i < at->count; ++i)
        if (at->list[i] < sent->first || at->list[i] >= sent->end ||
            bits_of(sent->values + at->list[i]) != bits_of(values->first + i * values->stride))
            return false;
    return true;
}

// Allocate the copy at the second call for a range. Without memory all calls only take longer.
static bool can_copy(mspring_network *network, mspringi_sent *sent, uint32_t count) {
    if (!sent->values && count >= RUN && sent->calls++ > 0)
        sent->values = mspringi_alloc(&network->memory, network->topology.reserve.spring_end, sizeof(float));
    return sent->values != NULL;
}

// Ids that are known after a range has been set: both if they touch each other, else the longer one.
static void add_range(mspringi_sent *sent, mspring_id first, mspring_id end) {
    if (sent->first < sent->end && first <= sent->end && end >= sent->first) {
        sent->first = first < sent->first ? first : sent->first;
        sent->end = end > sent->end ? end : sent->end;
    } else if (end - first > sent->end - sent->first) {
        sent->first = first;
        sent->end = end;
    }
}

mspringi_sent_edit mspringi_sent_begin(mspring_network *network, mspring_property property) {
    mspringi_sent_edit edit = {.fingerprint = network->parameter_fingerprint};
    const mspringi_sent *sent = copy_of(network, property);
    if (holds(network, sent)) {
        edit.first = sent->first;
        edit.end = sent->end;
    }
    return edit;
}

// Copy the values whose ids are known.
static void copy_values(mspringi_sent *sent, const mspringi_selection *at, const mspringi_values *values,
                        uint32_t i) {
    if (!at->list && values->stride == 1 && at->first >= sent->first && at->first < sent->end) {
        memcpy(sent->values + at->first + i, values->first + i, (at->count - i) * sizeof(float));
        return;
    }
    for (; i < at->count; ++i) {
        const mspring_id id = mspringi_selected(at, i);
        if (id >= sent->first && id < sent->end)
            memcpy(sent->values + id, values->first + i * values->stride, sizeof(float));
    }
}

void mspringi_sent_end(mspring_network *network, const mspringi_selection *at, const mspringi_values *values,
                       mspringi_sent_edit edit) {
    mspringi_sent *sent = copy_of(network, values->property);
    for (mspringi_sent *each = network->sent; each < network->sent + MSPRINGI_SENT_COUNT; ++each)
        if (each->fingerprint == edit.fingerprint)
            each->fingerprint = network->parameter_fingerprint;
    if (!sent || (at->list ? !sent->values : !can_copy(network, sent, at->count)))
        return;
    sent->fingerprint = network->parameter_fingerprint;
    sent->first = edit.first;
    sent->end = edit.end;
    if (!at->list && edit.changed > at->count / 2 && at->count >= (edit.end - edit.first) / 2) {
        mspringi_sent_forget(sent); // who changes most of them will do so again
        return;
    }
    if (!at->list)
        add_range(sent, at->first, at->first + at->count);
    copy_values(sent, at, values, edit.equal);
}
