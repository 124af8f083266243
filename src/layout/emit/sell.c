#include "layout/analysis.h"

#include <string.h>

/// Fewest springs of an interleaved slice column. It costs as much as any other, and each of its springs saves two
/// entries.
#define FEWEST_UPRIGHT 8

static mspring_result out_of_memory(const mspringi_sell_builder *w, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u irregular springs", (unsigned)w->count);
}

static mspring_result begin(mspringi_sell_builder *w, mspringi_memory *memory, mspringi_message *message) {
    const size_t slots = (size_t)w->block_count * MSPRINGI_WIDTH;
    w->degree = mspringi_alloc(memory, slots, sizeof *w->degree);
    w->node_of_slot = mspringi_alloc(memory, slots, sizeof *w->node_of_slot);
    w->upright = mspringi_alloc(memory, w->own_count / MSPRINGI_WIDTH, sizeof *w->upright);
    return w->degree && w->node_of_slot && w->upright ? MSPRING_OK : out_of_memory(w, message);
}

static void count_degrees(const mspringi_sell_builder *w) {
    for (uint32_t s = 0; s < w->count; ++s) {
        w->degree[w->a[s]]++;
        w->degree[w->b[s]]++;
    }
}

// Slice of a spring's lower node if the spring can be interleaved, else MSPRING_NONE.
static uint32_t upright_group(const mspringi_sell_builder *w, uint32_t spring) {
    const uint32_t a = w->a[spring], b = w->b[spring], low = a < b ? a : b, high = a < b ? b : a;
    if (high - low != MSPRINGI_WIDTH || low < w->first_slot || high - w->first_slot >= w->assigned_count ||
        w->degree[low] > 2 || w->degree[high] > 2 ||
        w->strip_of_block[low / MSPRINGI_WIDTH] != w->strip_of_block[high / MSPRINGI_WIDTH])
        return MSPRING_NONE;
    return (low - w->first_slot) / MSPRINGI_WIDTH;
}

static bool is_upright(const mspringi_sell_builder *w, uint32_t spring) {
    const uint32_t slice = upright_group(w, spring);
    return slice != MSPRING_NONE && w->upright[slice] >= FEWEST_UPRIGHT;
}

// Interleave chains. Degrees then exclude their springs, which need no other slice columns.
static void stand_upright(mspringi_sell_builder *w) {
    for (uint32_t s = 0; s < w->count; ++s) {
        const uint32_t slice = upright_group(w, s);
        if (slice != MSPRING_NONE)
            w->upright[slice]++;
    }
    for (uint32_t s = 0; s < w->count; ++s) {
        if (!is_upright(w, s))
            continue;
        w->degree[w->a[s]]--;
        w->degree[w->b[s]]--;
        w->upright_count++;
    }
}

// List the slots with irregular springs in lattice and chain rows, by rising slot; each strip fills whole slices.
// Write them to attached_slot unless it is NULL. Return their number.
static uint32_t list_attached(const mspringi_sell_builder *w, uint32_t *attached_slot) {
    uint32_t attached = 0, strip = MSPRING_NONE;
    for (uint32_t slot = 0; slot < w->block_count * MSPRINGI_WIDTH; ++slot) {
        if (w->degree[slot] == 0 || (slot >= w->first_slot && slot < w->first_slot + w->own_count))
            continue;
        if (w->strip_of_block[slot / MSPRINGI_WIDTH] != strip)
            attached = (attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        strip = w->strip_of_block[slot / MSPRINGI_WIDTH];
        if (attached_slot)
            attached_slot[attached] = slot;
        attached++;
    }
    return attached;
}

static mspring_result reserve_groups(mspringi_sell_builder *w, uint32_t attached, mspringi_memory *memory,
                                     mspringi_message *message) {
    mspringi_sell *irregular = w->irregular;
    irregular->attached_count = (attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    irregular->slice_count = (w->own_count + irregular->attached_count) / MSPRINGI_WIDTH;
    irregular->attached_slot = mspringi_alloc(memory, irregular->attached_count, sizeof *irregular->attached_slot);
    irregular->first_slice_column =
        mspringi_alloc(memory, (size_t)irregular->slice_count + 1, sizeof *irregular->first_slice_column);
    if (!irregular->attached_slot || !irregular->first_slice_column)
        return out_of_memory(w, message);
    if (w->upright_count > 0) {
        irregular->is_interleaved =
            mspringi_alloc(memory, irregular->slice_count, sizeof *irregular->is_interleaved);
        irregular->is_read = mspringi_alloc(memory, irregular->slice_count, sizeof *irregular->is_read);
        if (!irregular->is_interleaved || !irregular->is_read)
            return out_of_memory(w, message);
    }
    memset(irregular->attached_slot, 0xff, irregular->attached_count * sizeof *irregular->attached_slot);
    return MSPRING_OK;
}

mspring_result mspringi_sell_begin(mspringi_sell_builder *w, mspringi_memory *memory, mspringi_message *message) {
    w->irregular->own_count = w->own_count;
    if (w->count == 0 && w->own_count == 0)
        return MSPRING_OK;
    mspring_result result = begin(w, memory, message);
    if (result != MSPRING_OK)
        return result;
    count_degrees(w);
    if (w->assigned_count > 0 && !w->has_parallel)
        stand_upright(w);
    result = reserve_groups(w, list_attached(w, NULL), memory, message);
    if (result == MSPRING_OK)
        (void)list_attached(w, w->irregular->attached_slot);
    return result;
}

static void number_nodes(const mspringi_sell_builder *w) {
    const mspringi_sell *irregular = w->irregular;
    for (uint32_t node = 0; node < irregular->own_count + irregular->attached_count; ++node) {
        const uint32_t slot = node < irregular->own_count ? w->first_slot + node
                                                          : irregular->attached_slot[node - irregular->own_count];
        if (slot != MSPRING_NONE)
            w->node_of_slot[slot] = node;
    }
}

static uint32_t slot_of_node(const mspringi_sell *irregular, uint32_t node, uint32_t first_slot) {
    return node < irregular->own_count ? first_slot + node : irregular->attached_slot[node - irregular->own_count];
}

// Give each slice as many slice columns as its busiest node needs.
static mspring_result count_slice_columns(const mspringi_sell_builder *w, mspringi_message *message) {
    const mspringi_sell *irregular = w->irregular;
    for (uint32_t slice = 0; slice < irregular->slice_count; ++slice) {
        uint32_t slice_columns = 0;
        const bool has_upright =
            slice < irregular->own_count / MSPRINGI_WIDTH && w->upright[slice] >= FEWEST_UPRIGHT;
        if (has_upright)
            irregular->is_interleaved[slice] = 1;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const uint32_t slot = slot_of_node(irregular, slice * MSPRINGI_WIDTH + lane, w->first_slot);
            if (slot != MSPRING_NONE && w->degree[slot] > slice_columns)
                slice_columns = w->degree[slot];
        }
        slice_columns += has_upright;
        if (slice_columns > UINT32_MAX / MSPRINGI_WIDTH - irregular->first_slice_column[slice])
            return mspringi_fail(message, MSPRING_ERROR_LIMIT, "a particle has too many springs");
        irregular->first_slice_column[slice + 1] = irregular->first_slice_column[slice] + slice_columns;
    }
    return MSPRING_OK;
}

static mspring_result reserve_slice_columns(mspringi_sell_builder *w, mspringi_memory *memory,
                                            mspringi_message *message) {
    mspringi_sell *irregular = w->irregular;
    const size_t slice_columns = irregular->first_slice_column[irregular->slice_count];
    irregular->neighbour = mspringi_alloc(memory, slice_columns * MSPRINGI_WIDTH, sizeof *irregular->neighbour);
    irregular->entry = mspringi_alloc(memory, (size_t)2 * w->count, sizeof *irregular->entry);
    w->used = mspringi_alloc(memory, (size_t)irregular->slice_count * MSPRINGI_WIDTH, sizeof *w->used);
    return irregular->neighbour && irregular->entry && w->used ? MSPRING_OK : out_of_memory(w, message);
}

static mspring_result reserve_links(const mspringi_sell_builder *w, mspringi_memory *memory,
                                    mspringi_message *message) {
    mspringi_sell *irregular = w->irregular;
    irregular->first_bundle = w->own_count / MSPRINGI_WIDTH - w->bundle_groups;
    if (w->bundle_groups == 0)
        return MSPRING_OK;
    irregular->first_link = mspringi_alloc(memory, (size_t)w->bundle_groups + 1, sizeof *irregular->first_link);
    irregular->links = mspringi_alloc(memory, w->bundle_springs, sizeof *irregular->links);
    return irregular->first_link && irregular->links ? MSPRING_OK : out_of_memory(w, message);
}

mspring_result mspringi_sell_size_slices(mspringi_sell_builder *w, mspringi_memory *memory,
                                         mspringi_message *message) {
    const mspringi_sell *irregular = w->irregular;
    if (!w->degree)
        return MSPRING_OK;
    number_nodes(w);
    mspring_result result = count_slice_columns(w, message);
    if (result == MSPRING_OK)
        result = reserve_slice_columns(w, memory, message);
    if (result == MSPRING_OK)
        result = reserve_links(w, memory, message);
    if (result != MSPRING_OK)
        return result;
    // Entries without a spring join a node to itself.
    for (uint32_t slice = 0; slice < irregular->slice_count; ++slice)
        for (uint32_t slice_column = irregular->first_slice_column[slice];
             slice_column < irregular->first_slice_column[slice + 1]; ++slice_column)
            for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
                irregular->neighbour[slice_column * MSPRINGI_WIDTH + lane] = slice * MSPRINGI_WIDTH + lane;
    return MSPRING_OK;
}

static uint32_t entry_at(const mspringi_sell *irregular, uint32_t node, uint32_t slice_column) {
    return (irregular->first_slice_column[node / MSPRINGI_WIDTH] + slice_column) * MSPRINGI_WIDTH +
           node % MSPRINGI_WIDTH;
}

// Take the next free entry of a node.
static uint32_t take_entry(const mspringi_sell_builder *w, uint32_t node) {
    const mspringi_sell *irregular = w->irregular;
    const bool has_upright = irregular->is_interleaved && irregular->is_interleaved[node / MSPRINGI_WIDTH];
    return entry_at(irregular, node, has_upright + w->used[node]++);
}

void mspringi_sell_fill(const mspringi_sell_builder *w, uint32_t first, uint32_t end) {
    const mspringi_sell *irregular = w->irregular;
    for (uint32_t s = first; s < end; ++s) {
        const uint32_t node_a = w->node_of_slot[w->a[s]], node_b = w->node_of_slot[w->b[s]];
        if (is_upright(w, s)) {
            const uint32_t low = node_a < node_b ? node_a : node_b;
            irregular->entry[2 * s] = irregular->entry[2 * s + 1] = entry_at(irregular, low, 0);
            irregular->neighbour[irregular->entry[2 * s]] = low + MSPRINGI_WIDTH;
            continue;
        }
        irregular->entry[2 * s] = take_entry(w, node_a);
        irregular->entry[2 * s + 1] = take_entry(w, node_b);
        irregular->neighbour[irregular->entry[2 * s]] = node_b;
        irregular->neighbour[irregular->entry[2 * s + 1]] = node_a;
        if (irregular->is_read)
            irregular->is_read[node_a / MSPRINGI_WIDTH] = irregular->is_read[node_b / MSPRINGI_WIDTH] = 1;
    }
}

// Upper slice of a spring in the first lane of a bundle, from the first slice in bundles; MSPRING_NONE for any
// other spring. All lanes are equal.
static uint32_t slice_above(const mspringi_sell_builder *w, uint32_t spring) {
    const uint32_t a = w->node_of_slot[w->a[spring]], b = w->node_of_slot[w->b[spring]], above = a < b ? a : b;
    const bool is_in_bundle = above < w->own_count && above / MSPRINGI_WIDTH >= w->irregular->first_bundle;
    return is_in_bundle && above % MSPRINGI_WIDTH == 0 ? above / MSPRINGI_WIDTH - w->irregular->first_bundle
                                                       : MSPRING_NONE;
}

void mspringi_sell_link_bundles(const mspringi_sell_builder *w) {
    const mspringi_sell *irregular = w->irregular;
    for (uint32_t s = 0; irregular->links && s < w->count; ++s)
        if (slice_above(w, s) != MSPRING_NONE)
            irregular->first_link[slice_above(w, s) + 1]++;
    for (uint32_t slice = 0; slice < w->bundle_groups; ++slice)
        irregular->first_link[slice + 1] += irregular->first_link[slice];
    // The first link of each slice moves up to its end, the first link of the next one.
    for (uint32_t s = 0; irregular->links && s < w->count; ++s) {
        const uint32_t slice = slice_above(w, s);
        if (slice == MSPRING_NONE)
            continue;
        const uint32_t a = irregular->entry[2 * s], b = irregular->entry[2 * s + 1];
        const uint32_t node_a = w->node_of_slot[w->a[s]], node_b = w->node_of_slot[w->b[s]];
        irregular->links[irregular->first_link[slice]++] = (mspringi_bundle_link){
            .below = node_a < node_b ? node_b - node_a : node_a - node_b,
            .slice_column = (a < b ? a : b) / MSPRINGI_WIDTH,
            .back = (a < b ? b : a) / MSPRINGI_WIDTH,
        };
    }
    for (uint32_t slice = w->bundle_groups; irregular->links && slice > 0; --slice)
        irregular->first_link[slice] = irregular->first_link[slice - 1];
    if (irregular->links)
        irregular->first_link[0] = 0;
}

void mspringi_sell_builder_destroy(mspringi_sell_builder *w, mspringi_memory *memory) {
    mspringi_free(memory, w->strip_of_block);
    mspringi_free(memory, w->degree);
    mspringi_free(memory, w->node_of_slot);
    mspringi_free(memory, w->used);
    mspringi_free(memory, w->upright);
    w->strip_of_block = w->degree = w->node_of_slot = w->used = NULL;
    w->upright = NULL;
}
