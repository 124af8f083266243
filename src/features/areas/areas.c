#include "features/areas/areas.h"

#include <string.h>

#include "base/assert.h"
#include "builder/builder.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/id_pool.h"
#include "store/springs.h"
#include "store/store.h"

// The table that there is, or NULL.
#define ANGLES(table) &table +
const mspringi_angle_law *const mspringi_angles =
#include "store/features.def"
    0;

mspringi_element_ref mspringi_area_element(const mspring_network *network, const mspringi_area *area) {
    return (mspringi_element_ref){
        .law = area->is_angle ? &mspringi_angles->of_element : &mspringi_law_of_areas,
        .of = area,
        .corners = network->areas->corners + area->first,
        .count = area->count,
        .id = area->id,
        .damping = (double)area->damping,
        .is_ringed = area->is_ringed,
        .owns_sides = area->is_angle,
        .is_paired = area->count == 4,
    };
}

double mspringi_area_size(const mspring_network *network, const mspringi_area *area) {
    const mspringi_element_ref e = mspringi_area_element(network, area);
    return mspringi_element_size(network, &e);
}

/* ----------------------------------------------------------------------------------------------------- outline */

bool mspringi_area_is_open(const mspring_network *network, const mspringi_area *area) {
    const mspringi_topology *t = &network->topology;
    const mspringi_corner *corners = network->areas->corners + area->first;
    for (uint32_t i = 0; i < area->count; ++i) {
        const mspring_id spring = corners[i].spring;
        if (spring == MSPRING_NONE)
            continue;
        if (!mspringi_spring_exists(network, spring) || !mspringi_spring_is_live(network, spring))
            return true;
        // The id may have been given to another spring.
        const uint32_t here = t->slot_of_particle[corners[i].particle];
        const uint32_t next = mspringi_area_slot(network, area, i + 1 < area->count ? i + 1 : 0);
        const mspringi_ends ends = mspringi_spring_ends(network, spring);
        if (!(ends.a == here && ends.b == next) && !(ends.a == next && ends.b == here))
            return true;
    }
    return false;
}

static bool is_ringed(const mspring_network *network, const mspringi_area *area) {
    const uint32_t sides = area->is_angle ? 2 : area->count;
    for (uint32_t i = 0; i < sides; ++i)
        if (network->areas->corners[area->first + i].spring == MSPRING_NONE)
            return false;
    return true;
}

// The one that acts both ways, if there is one, else the first.
static mspring_id spring_between(const mspring_network *network, mspring_id a, mspring_id b) {
    mspringi_springs_between pair = mspringi_springs_between_begin(network, a, b);
    mspring_id found = MSPRING_NONE;
    for (mspring_id s; (s = mspringi_springs_between_next(network, &pair)) != MSPRING_NONE;) {
        if (!mspringi_spring_is_live(network, s))
            continue;
        if (mspringi_side_of(network, s) == 0)
            return s;
        found = found == MSPRING_NONE ? s : found;
    }
    return found;
}

/* ---------------------------------------------------------------------------------------------------- the list */

static const mspringi_array_entry arrays[] = {MSPRINGI_ARRAY_ENTRY(mspringi_areas, list, MSPRINGI_ARRAY),
                                              MSPRINGI_ARRAY_ENTRY(mspringi_areas, corners, MSPRINGI_ARRAY)};
const mspringi_feature_state mspringi_state_of_areas = {MSPRINGI_ARRAY_TABLE(arrays), NULL};

mspring_result mspringi_areas_make(mspring_network *network) {
    if (!network->areas)
        network->areas = mspringi_alloc(&network->memory, 1, sizeof *network->areas);
    return network->areas ? MSPRING_OK
                          : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for areas");
}

mspring_result mspringi_areas_reserve(mspring_network *network, size_t areas, size_t corners, size_t angles) {
    mspring_result result = mspringi_areas_make(network);
    if (result == MSPRING_OK)
        result = mspringi_incidence_reserve(network);
    if (result != MSPRING_OK)
        return result;
    mspringi_areas *a = network->areas;
    void *list = a->list, *all = a->corners;
    bool whole = mspringi_grow(&network->memory, &list, &a->capacity, a->count + areas, sizeof *a->list);
    a->list = list;
    whole = whole && mspringi_grow(&network->memory, &all, &a->corner_capacity, a->corner_count + corners,
                                   sizeof *a->corners);
    a->corners = all;
    whole = whole &&
            (angles == 0 || mspringi_constraints_reserve(network, MSPRINGI_ANGLE_CONSTRAINT,
                                                         a->angle_count + angles, 3 * (a->angle_count + angles)));
    if (whole && mspringi_store_reserve(network, MSPRINGI_STORE_AREAS))
        return MSPRING_OK;
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %zu areas", a->count + areas);
}

void mspringi_areas_append(mspring_network *network, const mspringi_area *area, const mspring_id *particles) {
    mspringi_areas *a = network->areas;
    MSPRINGI_ASSERT(a->count < a->capacity && a->corner_count + area->count <= a->corner_capacity);
    mspringi_area *made = &a->list[a->count++];
    *made = *area;
    made->first = (uint32_t)a->corner_count;
    made->cell = MSPRINGI_NO_CELL;
    a->angle_count += area->is_angle;
    for (uint32_t i = 0; i < area->count; ++i) {
        const mspring_id next = particles[i + 1 < area->count ? i + 1 : 0];
        a->corners[a->corner_count++] = (mspringi_corner){
            .particle = particles[i],
            .spring = area->is_angle && i == 2 ? MSPRING_NONE : spring_between(network, particles[i], next)};
    }
    const mspringi_element_ref e = mspringi_area_element(network, made);
    for (uint32_t i = 0; i < area->count; ++i) {
        const mspringi_vector g = e.law->gradient(&e, &(mspringi_positions){.network = network}, i);
        a->corners[made->first + i].reach = mspringi_bounded(sqrt(g.x * g.x + g.y * g.y));
    }
    a->changes++;
}

// A step goes through the list only while something is in it: what steps have of the last must not stay.
static void note_change(mspring_network *network) {
    mspringi_areas *a = network->areas;
    a->changes++;
    if (a->count > 0)
        return;
    network->cells.swept = a->unswept = a->unringed = 0;
    a->hinge_count = 0;
}

static bool has_all_corners(const mspring_network *network, const mspringi_area *area) {
    bool has_all = area->count > 0;
    for (uint32_t i = 0; i < area->count; ++i)
        has_all &= mspringi_particle_exists(network, network->areas->corners[area->first + i].particle);
    return has_all;
}

void mspringi_areas_forget(mspring_network *network) {
    mspringi_areas *a = network->areas;
    size_t kept = 0, corners = 0;
    for (size_t i = 0; a && i < a->count; ++i) {
        mspringi_area area = a->list[i];
        if (!has_all_corners(network, &area)) {
            a->angle_count -= area.is_angle;
            continue;
        }
        memmove(a->corners + corners, a->corners + area.first, area.count * sizeof *a->corners);
        area.first = (uint32_t)corners;
        corners += area.count;
        a->list[kept++] = area;
    }
    if (!a || kept == a->count)
        return;
    a->count = kept;
    a->corner_count = corners;
    note_change(network);
}

void mspringi_areas_clear(mspring_network *network) {
    network->areas->count = network->areas->corner_count = network->areas->angle_count = 0;
    note_change(network);
}

/* ---------------------------------------------------------------------------------------- what follows of them */

bool mspringi_cell_at(const mspring_network *network, uint32_t slot, uint32_t corners[4]) {
    const mspringi_topology *t = &network->topology;
    const uint32_t block = slot / MSPRINGI_WIDTH - t->lattice_first, lane = slot % MSPRINGI_WIDTH;
    if (slot / MSPRINGI_WIDTH < t->lattice_first || block >= t->lattice_blocks ||
        t->up_of_block[block] == t->lattice_first + block)
        return false;
    const uint32_t up = t->up_of_block[block] * MSPRINGI_WIDTH + lane;
    const uint32_t outline[4][2] = {
        {slot, MSPRINGI_EAST}, {slot, MSPRINGI_NORTH}, {slot + 1, MSPRINGI_NORTH}, {up, MSPRINGI_EAST}};
    for (int i = 0; i < 4; ++i) {
        const uint32_t of = outline[i][0] / MSPRINGI_WIDTH - t->lattice_first;
        const mspringi_spring_slot spring_slot =
            (of * MSPRINGI_DIRECTIONS + outline[i][1]) * MSPRINGI_WIDTH + outline[i][0] % MSPRINGI_WIDTH;
        if (of >= t->lattice_blocks || !mspringi_spring_slot_is_live(network, spring_slot))
            return false;
    }
    const uint32_t next_block = (slot + 1) / MSPRINGI_WIDTH - t->lattice_first;
    if (t->up_of_block[next_block] * MSPRINGI_WIDTH + (slot + 1) % MSPRINGI_WIDTH != up + 1)
        return false;
    corners[0] = slot;
    corners[1] = slot + 1;
    corners[2] = up + 1;
    corners[3] = up;
    return true;
}

// The cell that an area is around, with its first corner at a slot: 1 if its corners are in the cell's order, -1 if
// they are in the other, 0 if there is none.
static int cell_sense(const mspring_network *network, const mspringi_area *area, uint32_t corner) {
    uint32_t cell[4];
    const uint32_t next = mspringi_area_slot(network, area, (corner + 1) % 4);
    const uint32_t opposite = mspringi_area_slot(network, area, (corner + 2) % 4);
    const uint32_t before = mspringi_area_slot(network, area, (corner + 3) % 4);
    if (!mspringi_cell_at(network, mspringi_area_slot(network, area, corner), cell) || cell[2] != opposite)
        return 0;
    return cell[1] == next && cell[3] == before ? 1 : cell[3] == next && cell[1] == before ? -1 : 0;
}

// Enter an area into the sweeps, if they can have it.
static bool enter_cell(mspring_network *network, mspringi_area *area) {
    for (uint32_t corner = 0; area->kind == MSPRING_AREA_ELASTIC && area->count == 4 && corner < 4; ++corner) {
        const int sense = cell_sense(network, area, corner);
        if (sense == 0)
            continue;
        const uint32_t slot = mspringi_area_slot(network, area, corner);
        const uint32_t block = slot / MSPRINGI_WIDTH - network->topology.lattice_first;
        const uint32_t cell = 2 * block * MSPRINGI_WIDTH + slot % MSPRINGI_WIDTH;
        const double stiffness = (double)area->stiffness, fill = (double)area->fill;
        if (network->cells.values[cell] != 0.0f || network->cells.values[cell + MSPRINGI_WIDTH] != 0.0f)
            return false; // another has it
        network->cells.values[cell] = (float)(0.5 * sense * ((double)area->pressure + stiffness * fill));
        network->cells.values[cell + MSPRINGI_WIDTH] = (float)(0.25 * stiffness / area->rest_area);
        area->cell = cell;
        return true;
    }
    return false;
}

// The substep that is stable with forces of areas alone: of all, or of those without springs all around.
static double find_longest(mspring_network *network, bool of_all) {
    mspringi_areas *a = network->areas;
    double largest = 0.0, damped = 0.0;
    mspringi_field_clear(network, network->forces.inner);
    for (size_t i = 0; i < a->count; ++i)
        if (of_all || !a->list[i].is_ringed) {
            const mspringi_element_ref e = mspringi_area_element(network, &a->list[i]);
            mspringi_element_weigh(network, &e, network->forces.inner.x, network->forces.inner.y);
        }
    for (size_t i = 0; i < a->count; ++i)
        if (of_all || !a->list[i].is_ringed) {
            const mspringi_element_ref e = mspringi_area_element(network, &a->list[i]);
            largest = fmax(largest, mspringi_element_largest(network, &e, network->forces.inner.x));
            damped = fmax(damped, mspringi_element_largest(network, &e, network->forces.inner.y));
        }
    // h^2 largest + 2 h damped = 4
    return largest + damped > 0.0 ? 4.0 / (damped + sqrt(damped * damped + 4.0 * largest)) : INFINITY;
}

static mspringi_areas_seen see(const mspring_network *network) {
    const mspringi_edits *e = &network->edits;
    return (mspringi_areas_seen){network->areas->changes, e->links, e->growth, e->layouts, e->masses};
}

// True if nothing has changed that any area's being open follows from.
static bool is_fresh(const mspring_network *network) {
    const mspringi_areas_seen now = see(network), *seen = &network->areas->seen;
    return now.changes == seen->changes && now.links == seen->links && now.growth == seen->growth &&
           now.layouts == seen->layouts && now.masses == seen->masses;
}

void mspringi_areas_refresh(mspring_network *network) {
    mspringi_areas *a = network->areas;
    if (is_fresh(network))
        return;
    a->seen = see(network);
    network->cells.swept = a->unswept = a->unringed = 0;
    a->hinge_count = 0;
    if (!network->cells.values)
        return;
    const size_t cells = (size_t)2 * MSPRINGI_WIDTH * network->topology.lattice_blocks;
    for (size_t i = 0; i < cells; ++i)
        network->cells.values[i] = 0.0f;
    for (size_t i = 0; i < a->corner_count; ++i)
        a->corners[i].slot = network->topology.slot_of_particle[a->corners[i].particle];
    for (size_t i = 0; i < a->count; ++i) {
        mspringi_area *area = &a->list[i];
        area->cell = MSPRINGI_NO_CELL;
        area->is_open = mspringi_area_is_open(network, area);
        area->is_ringed = is_ringed(network, area);
        if (area->is_open)
            continue;
        a->unringed += !area->is_ringed;
        a->hinge_count += area->is_angle && area->is_ringed;
        if (enter_cell(network, area))
            network->cells.swept++;
        else
            a->unswept++;
    }
    a->longest = find_longest(network, false);
    a->longest_of_all = find_longest(network, true);
}

/* ------------------------------------------------------------------------------------------------------- edits */

mspring_result mspringi_areas_check_room(mspring_network *network, size_t areas, size_t corners, size_t angles) {
    const mspring_result result = mspringi_areas_make(network);
    const mspringi_areas *a = network->areas;
    if (result != MSPRING_OK)
        return result;
    if (areas >= MSPRING_NONE - a->next_id || corners >= MSPRING_NONE - a->corner_count)
        return mspringi_fail(&network->message, MSPRING_ERROR_LIMIT,
                             "there are %zu areas and angles already, of %u ever made", a->count,
                             (unsigned)a->next_id);
    return mspringi_areas_reserve(network, areas, corners, angles);
}

void mspringi_area_tell(mspring_network *network, uint32_t edit, const mspringi_area *area) {
    mspringi_fingerprint(network, edit, area->id);
    mspringi_fingerprint_floats(network, area->stiffness, area->is_angle ? area->damping : area->pressure);
    mspringi_fingerprint_floats(network, area->fill, (float)(area->is_angle ? area->rest_angle : area->rest_area));
    mspringi_notify_change(network, MSPRINGI_CHANGED_AREA, 0);
}

void mspringi_area_add(mspring_network *network, mspringi_area made, const mspring_id *particles) {
    made.id = network->areas->next_id++;
    mspringi_areas_append(network, &made, particles);
    for (uint32_t i = 0; i < made.count; ++i)
        mspringi_fingerprint(network, MSPRINGI_EDIT_ADDED_AREA, particles[i]);
    mspringi_area_tell(network, MSPRINGI_EDIT_ADDED_AREA, &made);
}

mspring_result mspringi_areas_of_builder(mspring_network *network, const mspring_builder *builder) {
    if (builder->area_count == 0)
        return MSPRING_OK;
    size_t angles = 0;
    for (size_t i = 0; i < builder->area_count; ++i)
        angles += builder->areas[i].is_angle;
    const mspring_result result =
        mspringi_areas_check_room(network, builder->area_count, builder->corner_count, angles);
    for (size_t i = 0; result == MSPRING_OK && i < builder->area_count; ++i)
        mspringi_area_add(network, builder->areas[i], builder->corners + builder->areas[i].first);
    return result;
}

bool mspringi_areas_act(const mspring_network *network) {
    return mspringi_area_count(network) > 0;
}

/* ------------------------------------------------------------------------------------------------- as elements */

static bool next_element(mspringi_element_walk *walk) {
    const mspring_network *network = walk->network;
    const size_t count = mspringi_area_count(network);
    if (walk->next == 0 && count > 0)
        walk->is_fresh = is_fresh(network);
    while (walk->next < count) {
        const mspringi_area *area = &network->areas->list[walk->next++];
        if (walk->has_open || !(walk->is_fresh ? area->is_open : mspringi_area_is_open(network, area))) {
            walk->element = mspringi_area_element(network, area);
            return true;
        }
    }
    return false;
}

static void refresh(mspring_network *network) {
    if (mspringi_area_count(network) > 0)
        mspringi_areas_refresh(network);
}

// In linear systems, those without springs all around have the forces of the start of a substep.
static double longest_of_unringed(const mspring_network *network) {
    const mspringi_areas *a = network->areas;
    return a && a->unringed > 0 ? a->longest : INFINITY;
}

const mspringi_element_list mspringi_list_of_areas = {next_element, refresh, longest_of_unringed};
