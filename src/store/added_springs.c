/// Springs that were added after the topology was made, for the explicit solver.
#include "store/added_springs.h"

#include "layout/analysis.h"
#include "layout/emit/spare.h"
#include "store/precise.h"
#include "store/springs.h"
#include "store/store.h"

mspring_result mspringi_added_springs_reserve(mspring_network *network) {
    mspringi_added_springs *graft = &network->added_springs;
    const uint32_t springs = mspringi_spare_springs(&network->topology);
    const uint32_t groups = (uint32_t)(((uint64_t)2 * springs + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH);
    const size_t capacity = (size_t)groups * MSPRINGI_WIDTH;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_GRAFT))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u spare springs",
                             (unsigned)springs);
    for (uint32_t group = 0; group <= groups; ++group)
        graft->irregular.first_slice_column[group] = group;
    for (uint32_t quarter = 0; quarter < capacity / MSPRINGI_QUARTER; ++quarter)
        graft->irregular.end_column[quarter] = quarter / (MSPRINGI_WIDTH / MSPRINGI_QUARTER) + 1;
    graft->capacity = (uint32_t)capacity;
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------ making */

// List the ends of the live added springs, by slot; those at one slot by rising ids.
static void list_nodes(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_added_springs *graft = &network->added_springs;
    uint32_t count = 0;
    for (mspring_id s = t->reserve.first_spring; s < t->spring_count; ++s) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, s);
        if (spring_slot != mspringi_spare_spring_slot(t, s) || !mspringi_spring_is_live(network, s))
            continue;
        const uint32_t end = 2 * (s - t->reserve.first_spring);
        graft->keys[count++] = (uint64_t)t->irregular_a[spring_slot - t->row_spring_slots] << 32 | end;
        graft->keys[count++] = (uint64_t)t->irregular_b[spring_slot - t->row_spring_slots] << 32 | (end + 1);
    }
    mspringi_sort_keys(graft->keys, graft->scratch, count);
    graft->count = count;
}

static void number_nodes(mspring_network *network) {
    mspringi_added_springs *graft = &network->added_springs;
    mspringi_sell *irregular = &graft->irregular;
    const mspring_id first = network->topology.reserve.first_spring;
    for (uint32_t node = 0; node < graft->count; ++node) {
        const uint32_t end = (uint32_t)graft->keys[node];
        irregular->attached_slot[node] = (uint32_t)(graft->keys[node] >> 32);
        graft->springs[node] = first + end / 2;
        graft->node_of_end[end] = node;
    }
    for (uint32_t node = 0; node < graft->count; ++node)
        irregular->neighbour[node] = graft->node_of_end[(uint32_t)graft->keys[node] ^ 1u];
    irregular->slice_count = (graft->count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    irregular->attached_count = irregular->slice_count * MSPRINGI_WIDTH;
    const size_t half = mspringi_gathered_distance(network, irregular);
    for (uint32_t node = graft->count; node < irregular->attached_count; ++node) {
        irregular->attached_slot[node] = MSPRING_NONE;
        irregular->neighbour[node] = node;
        float *gathered = graft->gathered + 4 * (size_t)node;
        for (uint32_t i = 0; i < 4; ++i)
            gathered[i] = gathered[half + i] = 0.0f;
    }
}

static void store_record(const mspring_network *network, uint32_t node, const mspringi_spring_values *values) {
    float *record = network->added_springs.records +
                    (size_t)(node / MSPRINGI_WIDTH) * network->parts * MSPRINGI_WIDTH + node % MSPRINGI_WIDTH;
    record[MSPRINGI_REST_LENGTH * MSPRINGI_WIDTH] = values->rest_length;
    record[MSPRINGI_STIFFNESS * MSPRINGI_WIDTH] = values->stiffness;
    if (network->parts > MSPRINGI_DAMPING)
        record[MSPRINGI_DAMPING * MSPRINGI_WIDTH] = values->damping;
}

// The values change by edits of several kinds, by ramps and with the substep: copying them all costs less than
// finding out which.
static void copy_values(const mspring_network *network) {
    const mspringi_added_springs *graft = &network->added_springs;
    const mspringi_spring_values nothing = {0};
    for (uint32_t node = 0; node < graft->count; ++node) {
        const mspringi_spring_values values = mspringi_spring_get(network, graft->springs[node]);
        store_record(network, node, &values);
    }
    for (uint32_t node = graft->count; node < graft->irregular.attached_count; ++node)
        store_record(network, node, &nothing);
}

void mspringi_added_springs_update(mspring_network *network) {
    mspringi_added_springs *graft = &network->added_springs;
    const mspringi_edits *edits = &network->edits;
    if (graft->growth != edits->growth || (graft->links != edits->links && edits->growth > 0)) {
        list_nodes(network);
        number_nodes(network);
        graft->growth = edits->growth;
        graft->links = edits->links;
    }
    if (graft->count > 0)
        copy_values(network);
}

void mspringi_added_springs_reset(mspringi_added_springs *graft) {
    graft->growth = UINT64_MAX;
}

/* ----------------------------------------------------------------------------------------------------- substeps */

void mspringi_added_springs_begin(const mspring_network *network, const mspringi_sweep *sweep) {
    const mspringi_added_springs *graft = &network->added_springs;
    mspringi_sweep own = *sweep;
    own.irregular = &graft->irregular;
    own.irregular_springs = graft->records;
    own.gathered = graft->gathered;
    float *gathered = graft->gathered;
    for (uint32_t node = 0; node < graft->count; ++node, gathered += 4)
        mspringi_pack_slot(network, &graft->irregular, gathered, graft->irregular.attached_slot[node]);
    mspringi_attached_kernel(network)(&own, 0, graft->irregular.attached_count, graft->pulls,
                                      graft->pulls + graft->capacity);
}

// The first node at this slot or a higher one.
static uint32_t find_node(const mspringi_added_springs *graft, uint32_t slot) {
    uint32_t low = 0, high = graft->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (graft->irregular.attached_slot[middle] < slot)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void mspringi_added_springs_pull(const mspring_network *network, const mspringi_sweep *sweep, uint32_t first_slot,
                                 uint32_t end_slot) {
    const mspringi_added_springs *graft = &network->added_springs;
    const uint32_t *slots = graft->irregular.attached_slot;
    const float *pull_x = graft->pulls, *pull_y = graft->pulls + graft->capacity;
    for (uint32_t node = find_node(graft, first_slot); node < graft->count && slots[node] < end_slot;) {
        const uint32_t slot = slots[node];
        float force_x = pull_x[node], force_y = pull_y[node];
        // Sum the forces at one slot before they act: they may be much larger than their sum.
        for (++node; node < graft->count && slots[node] == slot; ++node) {
            force_x = force_x + pull_x[node];
            force_y = force_y + pull_y[node];
        }
        if (!(sweep->inverse_mass[slot] > 0.0f))
            continue;
        const float change = sweep->inverse_mass[slot] * sweep->kick; // of velocity, per newton
        const float dvx = force_x * change, dvy = force_y * change;
        mspringi_push_by(&network->state, slot, dvx, dvy);
        mspringi_move_by(&network->state, slot, dvx * sweep->h, dvy * sweep->h);
    }
}

uint32_t mspringi_added_springs_find_block(const mspringi_added_springs *graft, uint32_t first_block,
                                           uint32_t end_block, bool pulled) {
    uint32_t block = first_block;
    uint32_t node = find_node(graft, first_block * MSPRINGI_WIDTH);
    if (pulled)
        block = node < graft->count ? graft->irregular.attached_slot[node] / MSPRINGI_WIDTH : end_block;
    for (; !pulled && node < graft->count && graft->irregular.attached_slot[node] / MSPRINGI_WIDTH <= block; ++node)
        block = graft->irregular.attached_slot[node] / MSPRINGI_WIDTH + 1;
    return block < end_block ? block : end_block;
}
