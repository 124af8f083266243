/// State of added and removed ids, and the springs of a particle.
#include "store/id_pool.h"

#include <string.h>

#include "base/bytes.h"
#include "layout/emit/spare.h"
#include "store/changed.h"
#include "store/springs.h"
#include "store/store.h"

/* ------------------------------------------------------------------------------------------------------- memory */

static void fill_marks(uint8_t *marks, uint32_t first_spare, uint32_t end) {
    memset(marks, MSPRINGI_THERE, first_spare);
    memset(marks + first_spare, MSPRINGI_SPARE, end - first_spare);
}

mspring_result mspringi_id_pool_reserve(mspring_network *network) {
    mspringi_id_pool *g = &network->growth;
    const mspringi_reserve *reserve = &network->topology.reserve;
    const bool has_spare =
        mspringi_spare_particles(&network->topology) + mspringi_spare_springs(&network->topology) > 0;
    if (g->particles)
        return MSPRING_OK;
    mspring_result result = mspringi_incidence_reserve(network);
    if (result == MSPRING_OK && has_spare)
        result = mspringi_changed_reserve_log(network);
    if (result == MSPRING_OK && mspringi_spare_springs(&network->topology) > 0)
        result = mspringi_added_springs_reserve(network);
    if (result != MSPRING_OK)
        return result;
    if ((has_spare && !mspringi_store_reserve(network, MSPRINGI_STORE_ENDS)) ||
        !mspringi_store_reserve(network, MSPRINGI_STORE_MARKS))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for what is added to and removed from %u particles",
                             (unsigned)reserve->particle_end);
    if (has_spare)
        memset(g->first_end, 0xff, reserve->particle_end * sizeof *g->first_end);
    fill_marks(g->particles, reserve->first_particle, reserve->particle_end);
    fill_marks(g->springs, reserve->first_spring, reserve->spring_end);
    g->lowest_particle = reserve->first_particle;
    g->lowest_spring = reserve->first_spring;
    return MSPRING_OK;
}

/* -------------------------------------------------------------------------------------------------------- slots */

static void clear_slot(const mspringi_state *s, uint32_t slot) {
    s->x[slot] = s->y[slot] = s->low_x[slot] = s->low_y[slot] = 0.0f;
    mspringi_set_velocity(s, slot, 0.0f, 0.0f);
}

void mspringi_id_pool_clear_slots(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const uint8_t *marks = network->growth.particles;
    const mspring_id first = t->reserve.first_particle;
    const size_t end = t->spare_blocks > 0 ? mspringi_used_slots(network) : 0;
    for (uint32_t slot = t->spare_first * MSPRINGI_WIDTH; slot < end; ++slot)
        if (t->particle_of_slot[slot] == MSPRING_NONE)
            clear_slot(&network->state, slot);
    // Where those of the spare particles were that had been laid out with the others.
    for (uint32_t i = 0; i < t->initial_particles; ++i)
        if (t->particle_of_slot[t->initial_slots[i]] == MSPRING_NONE)
            clear_slot(&network->state, t->initial_slots[i]);
    for (mspring_id p = 0; (p = mspringi_find_byte(marks, MSPRINGI_GONE, p, first)) < first; ++p)
        clear_slot(&network->state, t->slot_of_particle[p]);
}

static void clear_field(mspringi_field field, uint32_t slot) {
    if (field.x)
        field.x[slot] = field.y[slot] = 0.0f;
}

void mspringi_id_pool_take_particle(mspring_network *network, mspring_id particle) {
    const uint32_t slot = network->topology.slot_of_particle[particle];
    MSPRINGI_ASSERT(network->growth.particles);
    clear_slot(&network->state, slot);
    clear_slot(&network->backup, slot);
    network->inverse_mass[slot] = 0.0f;
    if (network->inverse_mass_scale)
        network->inverse_mass_scale[particle] = 0.0f;
    clear_field(network->forces.held, slot);
    clear_field(network->forces.first, slot);
    mspringi_notify_change(network, MSPRINGI_CHANGED_SLOT, slot);
    mspringi_spare_remove_particle(&network->topology, particle);
    if (network->is_compact)
        mspringi_spare_remove_particle(&network->whole, particle);
}

/* ------------------------------------------------------------------------------------------------------ numbers */

uint32_t mspringi_id_pool_added_particles(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    uint32_t count = 0;
    for (mspring_id p = t->reserve.first_particle; p < t->particle_count; ++p)
        count +=
            network->growth.particles[p] == MSPRINGI_THERE && t->slot_of_particle[p] == mspringi_spare_slot(t, p);
    return count;
}

uint32_t mspringi_id_pool_added_springs(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    uint32_t count = 0;
    for (mspring_id s = t->reserve.first_spring; s < t->spring_count; ++s)
        count += network->growth.springs[s] == MSPRINGI_THERE &&
                 mspringi_slot_of_spring(t, s) == mspringi_spare_spring_slot(t, s);
    return count;
}

void mspringi_id_pool_count(mspring_network *network, uint32_t particle_count, uint32_t spring_count) {
    mspringi_spare_set_counts(&network->topology, particle_count, spring_count);
    if (network->is_compact)
        mspringi_spare_set_counts(&network->whole, particle_count, spring_count);
    mspringi_notify_change(network, MSPRINGI_CHANGED_COUNTS, 0);
}

/* -------------------------------------------------------------------------------------------------------- ends */

void mspringi_id_pool_link(mspring_network *network, mspring_id spring, mspring_id a, mspring_id b) {
    mspringi_id_pool *g = &network->growth;
    MSPRINGI_ASSERT(g->particles && spring >= network->topology.reserve.first_spring);
    const uint32_t first = 2 * (spring - network->topology.reserve.first_spring);
    const mspring_id ends[] = {a, b};
    for (uint32_t i = 0; i < 2; ++i) {
        const uint32_t end = first + i, next = g->first_end[ends[i]];
        g->particle_of_end[end] = ends[i];
        g->next_end[end] = next;
        g->previous_end[end] = MSPRINGI_NO_END;
        if (next != MSPRINGI_NO_END)
            g->previous_end[next] = end;
        g->first_end[ends[i]] = end;
    }
}

void mspringi_id_pool_unlink(mspring_network *network, mspring_id spring) {
    mspringi_id_pool *g = &network->growth;
    if (spring < network->topology.reserve.first_spring)
        return;
    const uint32_t first = 2 * (spring - network->topology.reserve.first_spring);
    for (uint32_t end = first; end < first + 2; ++end) {
        const uint32_t next = g->next_end[end], previous = g->previous_end[end];
        if (previous == MSPRINGI_NO_END)
            g->first_end[g->particle_of_end[end]] = next;
        else
            g->next_end[previous] = next;
        if (next != MSPRINGI_NO_END)
            g->previous_end[next] = previous;
    }
}

/* ------------------------------------------------------------------------------------ the springs of a particle */

static void find_ends(const mspringi_topology *t, mspringi_spring_slot spring_slot, mspring_id ends[2]) {
    uint32_t base, tip;
    mspringi_topology_ends(t, spring_slot, &base, &tip);
    ends[0] = t->particle_of_slot[base];
    ends[1] = t->particle_of_slot[tip];
}

static void list_springs(const mspringi_incidence *incidence, const mspringi_topology *t) {
    const uint32_t particles = t->reserve.particle_end, springs = t->reserve.first_spring;
    mspring_id ends[2];
    for (mspring_id s = 0; s < springs; ++s) {
        find_ends(t, t->slot_of_spring[s], ends);
        incidence->first[ends[0]]++;
        incidence->first[ends[1]]++;
    }
    for (mspring_id p = 0; p < particles; ++p)
        incidence->first[p + 1] += incidence->first[p];
    // From behind, so that each particle's first is where it belongs at the end, and ids rise.
    for (mspring_id s = springs; s-- > 0;) {
        find_ends(t, t->slot_of_spring[s], ends);
        incidence->springs[--incidence->first[ends[0]]] = s;
        incidence->springs[--incidence->first[ends[1]]] = s;
    }
}

mspring_result mspringi_incidence_reserve(mspring_network *network) {
    if (network->incidence.first)
        return MSPRING_OK;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_INCIDENCE))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to list %u springs by particle",
                             (unsigned)network->topology.reserve.first_spring);
    list_springs(&network->incidence, &network->topology);
    return MSPRING_OK;
}

mspringi_incident_springs mspringi_incident_springs_begin(const mspring_network *network, mspring_id particle) {
    const mspringi_incidence *incidence = &network->incidence;
    MSPRINGI_ASSERT(incidence->first);
    return (mspringi_incident_springs){
        .next = incidence->first[particle],
        .end = incidence->first[particle + 1],
        .spare_end = network->growth.first_end ? network->growth.first_end[particle] : MSPRINGI_NO_END,
    };
}

mspring_id mspringi_incident_springs_next(const mspring_network *network, mspringi_incident_springs *around) {
    while (around->next < around->end) {
        const mspring_id spring = network->incidence.springs[around->next++];
        if (mspringi_spring_exists(network, spring))
            return spring;
    }
    const uint32_t end = around->spare_end;
    if (end == MSPRINGI_NO_END)
        return MSPRING_NONE;
    around->spare_end = network->growth.next_end[end];
    return network->topology.reserve.first_spring + end / 2;
}

mspring_id mspringi_end_beyond(const mspring_network *network, mspring_id spring, mspring_id particle) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    if (spring >= t->reserve.first_spring) {
        const mspring_id *ends = network->growth.particle_of_end + 2 * (size_t)(spring - t->reserve.first_spring);
        return ends[0] == particle ? ends[1] : ends[0];
    }
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, spring), &base, &tip);
    const mspring_id a = t->particle_of_slot[base];
    return a == particle ? t->particle_of_slot[tip] : a;
}

mspringi_springs_between mspringi_springs_between_begin(const mspring_network *network, mspring_id a,
                                                        mspring_id b) {
    return (mspringi_springs_between){
        {mspringi_incident_springs_begin(network, a), mspringi_incident_springs_begin(network, b)}, {a, b}};
}

mspring_id mspringi_springs_between_next(const mspring_network *network, mspringi_springs_between *pair) {
    for (uint32_t i = 0;; i = 1 - i) {
        mspringi_incident_springs *around = &pair->around[i];
        const mspring_id spring = mspringi_incident_springs_next(network, around), from = pair->particles[i];
        if (spring == MSPRING_NONE || mspringi_end_beyond(network, spring, from) == pair->particles[1 - i])
            return spring;
    }
}

mspring_id mspringi_spring_at(const mspring_network *network, mspringi_spring_slot spring_slot) {
    mspring_id ends[2], spring;
    find_ends(&network->topology, spring_slot, ends);
    mspringi_springs_between pair = mspringi_springs_between_begin(network, ends[0], ends[1]);
    do {
        spring = mspringi_springs_between_next(network, &pair);
        MSPRINGI_ASSERT(spring != MSPRING_NONE);
    } while (mspringi_slot_of_spring(&network->topology, spring) != spring_slot);
    return spring;
}
