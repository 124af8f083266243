/// Moving a network to another layout of the same particles and springs.
///
/// A second network is made that shares with the first what lies by id, and has what lies by slot or by place anew;
/// when it is complete it takes the first one's place.
#include "move.h"

#include <string.h>

#include "base/mix.h"
#include "contact/floor.h"
#include "edits/strain.h"
#include "implicit/implicit.h"
#include "network/rests.h"
#include "network/springs.h"
#include "sleep/sleep.h"

/* ----------------------------------------------------------------------------------------------- the new parts */

// The rest lengths are shared by blocks as they are at creation, unless the network has them apart already.
static mspring_result make_rests(mspring_network *to, const mspring_network *from) {
    const uint32_t springs = to->topology.spring_count;
    struct mspring_builder lengths = {.spring_count = springs};
    lengths.springs = mspringi_alloc(&to->memory, springs, sizeof *lengths.springs);
    if (!lengths.springs)
        return mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory for the rest lengths of %u springs",
                             (unsigned)springs);
    mspringi_place_reader places, old_places;
    mspringi_places_begin(&places, &to->topology.places, 0);
    mspringi_places_begin(&old_places, &from->topology.places, 0);
    for (mspring_id s = 0; s < springs; ++s) {
        const mspringi_place place = mspringi_places_next(&places), before = mspringi_places_next(&old_places);
        if (place < to->topology.lattice_places)
            lengths.springs[s].rest_length = mspringi_place_get(from, before).rest_length;
    }
    mspring_result result = mspringi_rests_create(&to->rests, &to->topology, &lengths, &to->memory, &to->message);
    if (result == MSPRING_OK && from->rests.shared_count == 0)
        result = mspringi_rests_separate(to);
    mspringi_free(&to->memory, lengths.springs);
    return result;
}

static mspring_result make_fields(mspring_network *to, const mspring_network *from) {
    mspring_result result = MSPRING_OK;
    const mspringi_forces *had = &from->forces;
    if (had->held.x)
        result = mspringi_field_reserve(to, &to->forces.held);
    if (result == MSPRING_OK && had->base.x)
        result = mspringi_field_reserve(to, &to->forces.base);
    if (result == MSPRING_OK && had->driven.x)
        result = mspringi_field_reserve(to, &to->forces.driven);
    if (result == MSPRING_OK && from->hook_capacity > 0) {
        to->hooks = mspringi_alloc(&to->memory, from->hook_capacity, sizeof *to->hooks);
        if (!to->hooks)
            return mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory for %zu hooks", from->hook_count);
    }
    for (size_t i = 0; result == MSPRING_OK && i < from->hook_count; ++i) {
        to->hooks[i] = from->hooks[i];
        to->hooks[i].held = (mspringi_field){NULL, NULL};
        if (from->hooks[i].held.x)
            result = mspringi_field_reserve(to, &to->hooks[i].held);
    }
    return result;
}

static mspring_result make_strain(mspring_network *to, const mspring_network *from) {
    mspring_result result = MSPRING_OK;
    if (from->strain.break_strain)
        result = mspringi_strain_reserve(to);
    if (result == MSPRING_OK && from->strain.stress_strain)
        result = mspringi_strain_reserve_stress(to);
    return result;
}

static mspring_result make_components(mspring_network *to, const mspring_network *from) {
    if (!from->components.number)
        return MSPRING_OK;
    to->components.root = mspringi_alloc(&to->memory, mspringi_slot_count(to), sizeof *to->components.root);
    return to->components.root ? MSPRING_OK
                               : mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory for components");
}

static mspring_result make_floor(mspring_network *to, const mspring_network *from) {
    if (!from->floor)
        return MSPRING_OK;
    to->floor = mspringi_floor_move(to, from);
    return to->floor ? MSPRING_OK : mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory for a floor");
}

static mspring_result make_implicit(mspring_network *to, const mspring_network *from, uint32_t tile_size) {
    const mspringi_implicit *had = from->implicit;
    if (!had)
        return MSPRING_OK;
    mspring_solver_def def;
    (void)mspring_solver_def_init(&def, sizeof def);
    def.solver = had->is_direct ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT;
    def.integrator = had->integrator;
    def.iterations = had->iterations;
    def.tile_size = had->tile_size > 0 ? had->tile_size : tile_size;
    def.coarse_period = had->coarse_period;
    mspring_result result = mspringi_implicit_create(to, &def, &to->implicit);
    if (result == MSPRING_OK)
        to->implicit->tile_size = had->tile_size;
    return result;
}

/* ------------------------------------------------------------------------------------------------------- moving */

static void move_values(const float *from, float *to, const mspring_network *old, const mspring_network *made) {
    const uint32_t *here = old->topology.slot_of_particle, *there = made->topology.slot_of_particle;
    for (mspring_id p = 0; p < old->topology.particle_count; ++p)
        to[there[p]] = from[here[p]];
}

static void move_particles(mspring_network *to, const mspring_network *from) {
    const mspringi_state *s = &from->state, *b = &from->backup;
    const float *const old[] = {s->x, s->y, s->vx, s->vy, b->x, b->y, b->vx, b->vy, from->inverse_mass};
    float *const made[] = {to->state.x,  to->state.y,   to->state.vx,  to->state.vy,    to->backup.x,
                           to->backup.y, to->backup.vx, to->backup.vy, to->inverse_mass};
    for (size_t i = 0; i < sizeof old / sizeof old[0]; ++i)
        move_values(old[i], made[i], from, to);
    if (!from->forces.held_any)
        return;
    move_values(from->forces.held.x, to->forces.held.x, from, to);
    move_values(from->forces.held.y, to->forces.held.y, from, to);
}

static void move_springs(mspring_network *to, const mspring_network *from) {
    const mspringi_topology *t = &to->topology, *old = &from->topology;
    mspringi_place_reader places, old_places;
    mspringi_places_begin(&places, &t->places, 0);
    mspringi_places_begin(&old_places, &old->places, 0);
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        const mspringi_place place = mspringi_places_next(&places), before = mspringi_places_next(&old_places);
        const uint16_t bit = (uint16_t)(1u << place % MSPRINGI_WIDTH);
        mspringi_place_copy(from, before, to, place);
        if (mspringi_place_is_live(from, before))
            to->live[place / MSPRINGI_WIDTH] |= bit;
        if (mspringi_place_is_stressed(from, before))
            to->strain.stressed[place / MSPRINGI_WIDTH] |= bit;
        if (from->strain.break_strain)
            mspringi_strain_store(to, place, false, from->strain.break_strain[before]);
        if (from->strain.stress_strain)
            mspringi_strain_store(to, place, true, from->strain.stress_strain[before]);
    }
}

// A motion goes on: what the integrator remembers of it goes with the particles.
static void move_implicit(mspring_network *to, const mspring_network *from) {
    const mspringi_implicit *had = from->implicit;
    mspringi_implicit *n = to->implicit;
    const size_t slots = mspringi_slot_count(from), made_slots = mspringi_slot_count(to);
    if (from->fallback) {
        mspringi_tiles_set_inertia(&to->fallback->tiles, from->fallback->tiles.turn_inertia, made_slots);
        to->fallback->scale = from->fallback->scale;
    }
    if (!had)
        return;
    if (!n->is_direct)
        mspringi_tiles_set_inertia(&n->tiles, had->tiles.turn_inertia, made_slots);
    n->scale = had->scale;
    n->history.h = had->history.h;
    n->history.restarts = had->history.restarts;
    n->seen.motion = had->seen.motion;
    n->ledger = had->ledger;
    for (size_t i = 0; i < had->history_size / slots; ++i)
        move_values(had->history.low.x + i * slots, n->history.low.x + i * made_slots, from, to);
}

static void take_print(mspring_network *to, uint64_t print) {
    const mspringi_topology *t = &to->topology;
    for (mspring_id p = 0; p < t->particle_count; ++p)
        print = mspringi_mix(print, t->slot_of_particle[p]);
    mspringi_place_reader reader;
    mspringi_places_begin(&reader, &t->places, 0);
    for (mspring_id s = 0; s < t->spring_count; ++s)
        print = mspringi_mix(print, mspringi_places_next(&reader));
    to->topology_print = print;
}

/* ----------------------------------------------------------------------------------------------- the exchange */

// Free what lies by slot or by place, with the memory of whoever is left.
static void free_layout(const mspring_network *network, mspringi_memory *memory) {
    mspringi_layout_free(network, memory);
    mspringi_free(memory, network->rests.of_block);
    mspringi_free(memory, network->rests.lengths);
    mspringi_free(memory, network->forces.held.x);
    mspringi_free(memory, network->forces.base.x);
    mspringi_free(memory, network->forces.driven.x);
    for (size_t i = 0; network->hooks && i < network->hook_count; ++i)
        mspringi_free(memory, network->hooks[i].held.x);
    mspringi_free(memory, network->hooks);
    if (network->strain.least != network->strain.break_strain)
        mspringi_free(memory, network->strain.least);
    mspringi_free(memory, network->strain.break_strain);
    mspringi_free(memory, network->strain.stress_strain);
    mspringi_free(memory, network->strain.stressed);
    mspringi_free(memory, network->strain.hits);
    mspringi_free(memory, network->components.root);
    mspringi_free(memory, network->extents.scratch);
    mspringi_free(memory, network->extents.reversed);
    mspringi_sleep_free(&network->sleep, memory);
    mspringi_floor_free_layout(network->floor, memory);
    mspringi_implicit_destroy(network->implicit, memory);
    mspringi_implicit_destroy(network->fallback, memory);
}

// The network with its parts by slot and by place taken out, and this topology put in.
static mspring_network without_layout(const mspring_network *network, const mspringi_topology *topology) {
    mspring_network to = *network;
    to.topology = *topology;
    mspringi_layout_forget(&to);
    to.rests = (mspringi_rests){0};
    to.forces.held = to.forces.base = to.forces.driven = (mspringi_field){NULL, NULL};
    to.hooks = NULL;
    to.strain = (mspringi_strain){.relax = network->strain.relax};
    to.components.root = NULL;
    to.extents = (mspringi_extents){0};
    mspringi_sleep_forget(&to.sleep);
    to.implicit = to.fallback = NULL;
    to.floor = NULL;
    return to;
}

mspring_result mspringi_move(mspring_network *network, const mspringi_topology *topology, uint32_t tile_size,
                             uint32_t fallback_size) {
    mspring_network to = without_layout(network, topology);
    mspring_result result = mspringi_layout_reserve(&to);
    if (result == MSPRING_OK)
        result = make_rests(&to, network);
    if (result == MSPRING_OK)
        result = make_fields(&to, network);
    if (result == MSPRING_OK)
        result = make_strain(&to, network);
    if (result == MSPRING_OK)
        result = make_components(&to, network);
    if (result == MSPRING_OK)
        result = make_floor(&to, network);
    if (result == MSPRING_OK && network->sleep.state)
        result = mspringi_sleep_reserve(&to);
    if (result == MSPRING_OK) {
        move_particles(&to, network);
        move_springs(&to, network);
        mspringi_sleep_move(&to, network);
        result = make_implicit(&to, network, tile_size);
        if (result == MSPRING_OK && network->fallback)
            result = mspringi_fallback_reserve(&to, fallback_size);
    }
    if (result != MSPRING_OK) {
        free_layout(&to, &to.memory);
        network->memory = to.memory;
        network->message = to.message;
        return result;
    }
    move_implicit(&to, network);
    mspringi_graft_forget(&to.graft);
    take_print(&to, network->is_compact ? network->whole_print : network->topology_print);
    const mspring_network old = *network;
    *network = to;
    free_layout(&old, &network->memory);
    return MSPRING_OK;
}
