/// Moving a network to another layout of the same particles and springs.
///
/// A second network is made that shares with the first what lies by id, and has what lies by slot or by place anew;
/// when it is complete it takes the first one's place.
#include "move.h"

#include <math.h>
#include <string.h>

#include "contact/floor.h"
#include "edits/strain.h"
#include "network/rests.h"
#include "network/springs.h"
#include "sleep/sleep.h"
#include "stability/border.h"
#include "store/store.h"

/* ----------------------------------------------------------------------------------------------- the new parts */

// The rest lengths are shared by blocks as they are at creation, unless the network has them apart already.
static mspring_result make_rests(mspring_network *to, const mspring_network *from) {
    const uint32_t springs = to->topology.spring_count;
    struct mspring_builder lengths = {.spring_count = springs};
    lengths.springs = mspringi_alloc(&to->memory, springs, sizeof *lengths.springs);
    if (!lengths.springs)
        return mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory for the rest lengths of %u springs",
                             (unsigned)springs);
    for (mspring_id s = 0; s < springs; ++s) {
        const mspringi_place place = to->topology.place_of_spring[s], before = from->topology.place_of_spring[s];
        if (place < to->topology.lattice_places)
            lengths.springs[s].rest_length = mspringi_place_get(from, before).rest_length;
    }
    mspring_result result = mspringi_rests_create(&to->rests, &to->topology, &lengths, &to->memory, &to->message);
    if (result == MSPRING_OK && from->rests.shared_count == 0)
        result = mspringi_rests_separate(to);
    mspringi_free(&to->memory, lengths.springs);
    return result;
}

// What follows from the layout alone, and the forces of hooks.
static mspring_result make_others(mspring_network *to, const mspring_network *from) {
    mspring_result result = MSPRING_OK;
    if (!mspringi_store_match_layout(to, from))
        return mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory to move %u particles",
                             (unsigned)to->topology.particle_count);
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

// What the guard has learnt goes with the particles.
static mspring_result make_looks(mspring_network *to, const mspring_network *from) {
    return from->looks ? mspringi_border_reserve(to) : MSPRING_OK;
}

static mspring_result make_floor(mspring_network *to, const mspring_network *from) {
    if (!from->floor)
        return MSPRING_OK;
    to->floor = mspringi_floor_move(to, from);
    return to->floor ? MSPRING_OK : mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory for a floor");
}

/* ------------------------------------------------------------------------------------------------------- moving */

static void move_values(const float *from, float *to, const mspring_network *old, const mspring_network *made) {
    const uint32_t *here = old->topology.slot_of_particle, *there = made->topology.slot_of_particle;
    MSPRINGI_ASSERT(made->topology.particle_count == old->topology.particle_count);
    for (mspring_id p = 0; p < old->topology.particle_count; ++p)
        to[there[p]] = from[here[p]];
}

// Copy all that there is of a spring, from its place here to its place there, whatever is there.
static void copy_spring(mspring_network *to, mspringi_place place, const mspring_network *from,
                        mspringi_place before) {
    mspringi_place_copy(from, before, to, place);
    mspringi_store_copy_spring(to, place, from, before);
    if (to->strain.least)
        to->strain.least[place] = fminf(to->strain.break_strain[place], to->strain.stress_strain[place]);
}

static void move_springs(mspring_network *to, const mspring_network *from) {
    const mspringi_topology *t = &to->topology, *old = &from->topology;
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        const mspringi_place place = t->place_of_spring[s], before = old->place_of_spring[s];
        copy_spring(to, place, from, before);
    }
}

/* ----------------------------------------------------------------------------------------------- the exchange */

// Free what lies by slot or by place, with the memory of whoever is left.
static void free_layout(mspring_network *network, mspringi_memory *memory) {
    for (size_t i = 0; network->hooks && i < network->hook_count; ++i)
        mspringi_free(memory, network->hooks[i].held.x);
    mspringi_store_free_layout(network, memory);
    mspringi_floor_free_layout(network->floor, memory);
    mspringi_solver_destroy(&network->solver, memory);
    mspringi_solver_destroy(&network->fallback, memory);
}

// The network with its parts by slot and by place taken out, and this topology put in.
static mspring_network without_layout(const mspring_network *network, const mspringi_topology *topology) {
    mspring_network to = *network;
    to.topology = *topology;
    mspringi_store_forget_layout(&to);
    to.seams = (mspringi_seams){0};
    to.rests = (mspringi_rests){0};
    mspringi_sleep_forget(&to.sleep);
    to.solver.object = to.fallback.object = NULL;
    to.floor = NULL;
    to.mover = NULL;
    return to;
}

/* ------------------------------------------------------------------------------------------------ in advance */

struct mspringi_mover {
    mspring_network to;    ///< what has been made so far; its memory is the network's plan_memory
    mspringi_place *there; ///< by place, where its spring has been copied to; MSPRING_NONE: it has not been yet
    mspringi_rest_pattern *of_block; ///< [lattice blocks] while rest lengths are looked at
};

static mspring_result no_memory_to_move(mspring_network *network) {
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to move %u springs",
                         (unsigned)network->topology.spring_count);
}

// What is done to the network that is being made allocates in the plan's memory, and may have a message.
static mspring_result with_plan_memory(mspring_network *network,
                                       mspring_result (*make)(mspring_network *, const mspring_network *)) {
    mspring_network *to = &network->mover->to;
    to->memory = network->plan_memory;
    mspring_result result = make(to, network);
    network->plan_memory = to->memory;
    if (result != MSPRING_OK)
        network->message = to->message;
    return result;
}

mspring_result mspringi_mover_begin(mspring_network *network, const mspringi_topology *topology) {
    const size_t places = mspringi_place_words(&network->topology) * MSPRINGI_WIDTH;
    MSPRINGI_ASSERT(!network->mover);
    mspringi_mover *mover = mspringi_alloc(&network->plan_memory, 1, sizeof *mover);
    if (!mover)
        return no_memory_to_move(network);
    network->mover = mover;
    mover->to = without_layout(network, topology);
    mover->there = mspringi_alloc(&network->plan_memory, places, sizeof *mover->there);
    mover->of_block = mspringi_alloc(&network->plan_memory, topology->lattice_blocks, sizeof *mover->of_block);
    if (!mover->there || !mover->of_block)
        return no_memory_to_move(network);
    memset(mover->there, 0xff, places * sizeof *mover->there);
    return MSPRING_OK;
}

static mspring_result make_layout(mspring_network *to, const mspring_network *from) {
    (void)from;
    return mspringi_layout_reserve(to);
}

mspring_result mspringi_mover_reserve(mspring_network *network) {
    return with_plan_memory(network, make_layout);
}

void mspringi_mover_note_rests(const mspring_network *network, const mspring_id *ids, const mspringi_place *places,
                               uint32_t first, uint32_t end) {
    const mspringi_topology *t = &network->mover->to.topology;
    for (uint32_t i = first; i < end; ++i)
        if (places[i] < t->lattice_places)
            mspringi_rests_note(network->mover->of_block, places[i],
                                mspringi_spring_get(network, ids[i]).rest_length);
}

static mspring_result make_shared_rests(mspring_network *to, const mspring_network *from) {
    mspring_result result = mspringi_rests_reserve(&to->rests, from->mover->of_block, to->topology.lattice_blocks,
                                                   &to->memory, &to->message);
    return result == MSPRING_OK && from->rests.shared_count == 0 ? mspringi_rests_separate(to) : result;
}

mspring_result mspringi_mover_reserve_rests(mspring_network *network) {
    return with_plan_memory(network, make_shared_rests);
}

mspring_result mspringi_mover_reserve_strain(mspring_network *network) {
    return with_plan_memory(network, make_strain);
}

void mspringi_mover_copy(const mspring_network *network, const mspringi_place *places, uint32_t first,
                         uint32_t end) {
    mspringi_mover *mover = network->mover;
    for (mspring_id s = first; s < end; ++s) {
        const mspringi_place before = network->topology.place_of_spring[s];
        copy_spring(&mover->to, places[s], network, before);
        mover->there[before] = places[s];
    }
}

void mspringi_mover_follow(const mspring_network *network, mspringi_place place) {
    mspringi_mover *mover = network->mover;
    MSPRINGI_ASSERT(mover);
    if (mover->there[place] != MSPRING_NONE)
        copy_spring(&mover->to, mover->there[place], network, place);
}

void mspringi_mover_drop(mspring_network *network) {
    mspringi_mover *mover = network->mover;
    if (!mover)
        return;
    free_layout(&mover->to, &network->plan_memory);
    mspringi_free(&network->plan_memory, mover->there);
    mspringi_free(&network->plan_memory, mover->of_block);
    mspringi_free(&network->plan_memory, mover);
    network->mover = NULL;
}

// Take over what a mover has made. Its memory has been handed over.
static void take_layout(mspring_network *to, const mspring_network *made) {
    mspringi_store_take_layout(to, made);
    to->alike.changes = made->alike.changes;
    to->rests = made->rests;
    to->seams = made->seams;
    to->carry_rows = made->carry_rows;
    to->depth = made->depth;
}

/* ------------------------------------------------------------------------------------------------- at once */

// What lies by place, and room for the state.
static mspring_result make_springs(mspring_network *to, const mspring_network *from) {
    mspring_result result = mspringi_layout_reserve(to);
    if (result == MSPRING_OK)
        result = make_rests(to, from);
    if (result == MSPRING_OK)
        result = make_strain(to, from);
    if (result == MSPRING_OK)
        move_springs(to, from);
    return result;
}

mspring_result mspringi_move(mspring_network *network, const mspringi_topology *topology, uint32_t tile_size,
                             uint32_t fallback_size) {
    mspring_network to = without_layout(network, topology);
    mspringi_mover *mover = network->mover;
    mspring_result result = MSPRING_OK;
    if (mover) {
        take_layout(&to, &mover->to);
        mspringi_free(&to.memory, mover->there);
        mspringi_free(&to.memory, mover->of_block);
        mspringi_free(&to.memory, mover);
        network->mover = NULL;
    } else {
        result = make_springs(&to, network);
    }
    if (result == MSPRING_OK)
        result = make_looks(&to, network);
    if (result == MSPRING_OK)
        result = make_others(&to, network);
    if (result == MSPRING_OK)
        result = make_floor(&to, network);
    if (result == MSPRING_OK) {
        mspringi_store_move_slots(&to, network);
        if (network->looks)
            move_values(network->looks, to.looks, network, &to);
        mspringi_sleep_move(&to, network);
        result = mspringi_solver_remake(&to, &to.solver, &network->solver, tile_size);
        if (result == MSPRING_OK)
            result = mspringi_solver_remake(&to, &to.fallback, &network->fallback, fallback_size);
    }
    if (result != MSPRING_OK) {
        free_layout(&to, &to.memory);
        network->memory = to.memory;
        network->message = to.message;
        return result;
    }
    mspringi_solver_take_over(&to, &to.solver, network, &network->solver);
    mspringi_solver_take_over(&to, &to.fallback, network, &network->fallback);
    mspringi_graft_forget(&to.graft);
    mspring_network old = *network;
    *network = to;
    free_layout(&old, &network->memory);
    return MSPRING_OK;
}
