/// Snapshot of actuators.
#include "features/actuators/actuators.h"
#include "store/metres.h"
#include "store/properties.h"
#include "store/sections.h"
#include "store/spring_limits.h"
#include "store/springs.h"

// Values of an actuator: the present rest length, the one that signals ask for, and the one before any flow.
enum { VALUES = 3 };
static void actuators_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_actuators *a = network->actuators;
    const uint32_t head[] = {a && a->are_pending, 0};
    if (!a)
        return;
    mspringi_put(to, head, 2, sizeof head[0]);
    for (uint32_t i = 0; i < a->count; ++i) {
        const float *nominal = network->tested.nominal;
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, a->spring[i]);
        const float now = mspringi_spring_slot_get(network, spring_slot).rest_length;
        const float values[VALUES] = {now, a->to[i], nominal ? nominal[spring_slot] : now};
        mspringi_put(to, values, VALUES, sizeof values[0]);
    }
}

// Signals keep within this range, and so does the host, who may set the rest length of an actuator as of any
// spring.
static bool is_length(float value) {
    return mspringi_is_spring_value(MSPRINGI_REST_LENGTH, value);
}

static mspring_result actuators_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_actuators;
    const size_t count = mspringi_actuator_count(network);
    uint32_t head[2];
    mspring_result result = mspringi_section_check_size(
        network, section, size, count > 0 ? sizeof head + count * VALUES * sizeof(float) : 0);
    if (result != MSPRING_OK || count == 0)
        return result;
    from = mspringi_get(from, head, 2, sizeof head[0]);
    if (head[0] > 1 || head[1] != 0)
        return mspringi_section_fail(network, section, "they are pending by %u", (unsigned)head[0]);
    for (size_t i = 0; i < count; ++i) {
        float values[VALUES];
        from = mspringi_get(from, values, VALUES, sizeof values[0]);
        if (!is_length(values[0]) || !is_length(values[1]) || !is_length(values[2]))
            return mspringi_section_fail(network, section, "actuator %zu has lengths %g, %g, %g m", i,
                                         (double)values[0], (double)values[1], (double)values[2]);
    }
    return MSPRING_OK;
}

// Load after the springs' values and plastic strains.
static void actuators_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_actuators *a = network->actuators;
    uint32_t head[2];
    if (size == 0)
        return;
    from = mspringi_get(from, head, 2, sizeof head[0]);
    a->are_pending = head[0] != 0;
    for (uint32_t i = 0; i < a->count; ++i) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, a->spring[i]);
        float values[VALUES];
        from = mspringi_get(from, values, VALUES, sizeof values[0]);
        a->to[i] = values[1];
        mspringi_note_rest_length(network, values[1]);
        mspringi_spring_slot_set_rest_length(network, spring_slot, values[0]);
        if (network->tested.nominal)
            network->tested.nominal[spring_slot] = values[2];
        mspringi_metres_renew(network, a->spring[i]);
        if (!network->tested.nominal)
            continue;
        mspringi_limits_renew(network, spring_slot);
    }
}

const mspringi_section mspringi_section_actuators = {"actu",         "actuators",     false,          NULL,
                                                     actuators_save, actuators_check, actuators_load, NULL};
