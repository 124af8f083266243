/// Builder of sliced ELLPACK storage: nodes, slices, interleaved ropes, entries, links of bundles.
#include "layout/analysis.h"

#include <string.h>

/// Fewest springs of an interleaved slice column. It costs as much as any other, and each of its springs saves two
/// entries.
#define MIN_INTERLEAVED 8

static mspring_result out_of_memory(const mspringi_sell_builder *builder, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u irregular springs",
                         (unsigned)builder->count);
}

static mspring_result reserve(mspringi_sell_builder *builder, mspringi_memory *memory, mspringi_message *message) {
    const size_t slots = (size_t)builder->block_count * MSPRINGI_WIDTH;
    builder->degree = mspringi_alloc(memory, slots, sizeof *builder->degree);
    builder->node_of_slot = mspringi_alloc(memory, slots, sizeof *builder->node_of_slot);
    builder->interleaved =
        mspringi_alloc(memory, builder->own_count / MSPRINGI_WIDTH, sizeof *builder->interleaved);
    return builder->degree && builder->node_of_slot && builder->interleaved ? MSPRING_OK
                                                                            : out_of_memory(builder, message);
}

static void count_degrees(const mspringi_sell_builder *builder) {
    for (uint32_t s = 0; s < builder->count; ++s) {
        builder->degree[builder->a[s]]++;
        builder->degree[builder->b[s]]++;
    }
}

// Slice of a spring's lower node if the spring can be interleaved, else MSPRING_NONE.
static uint32_t interleaved_slice(const mspringi_sell_builder *builder, uint32_t spring) {
    const uint32_t a = builder->a[spring], b = builder->b[spring], low = a < b ? a : b, high = a < b ? b : a;
    if (high - low != MSPRINGI_WIDTH || low < builder->first_slot ||
        high - builder->first_slot >= builder->assigned_count || builder->degree[low] > 2 ||
        builder->degree[high] > 2 ||
        builder->strip_of_block[low / MSPRINGI_WIDTH] != builder->strip_of_block[high / MSPRINGI_WIDTH])
        return MSPRING_NONE;
    return (low - builder->first_slot) / MSPRINGI_WIDTH;
}

static bool is_interleaved(const mspringi_sell_builder *builder, uint32_t spring) {
    const uint32_t slice = interleaved_slice(builder, spring);
    return slice != MSPRING_NONE && builder->interleaved[slice] >= MIN_INTERLEAVED;
}

// Interleave chains. Degrees then exclude their springs, which need no other slice columns.
static void interleave_chains(mspringi_sell_builder *builder) {
    for (uint32_t s = 0; s < builder->count; ++s) {
        const uint32_t slice = interleaved_slice(builder, s);
        if (slice != MSPRING_NONE)
            builder->interleaved[slice]++;
    }
    for (uint32_t s = 0; s < builder->count; ++s) {
        if (!is_interleaved(builder, s))
            continue;
        builder->degree[builder->a[s]]--;
        builder->degree[builder->b[s]]--;
        builder->interleaved_count++;
    }
}

// List the slots with irregular springs in lattice and chain rows, by rising slot; each strip fills whole slices.
// Write them to attached_slot unless it is NULL. Return their number.
static uint32_t list_attached(const mspringi_sell_builder *builder, uint32_t *attached_slot) {
    uint32_t attached = 0, strip = MSPRING_NONE;
    for (uint32_t slot = 0; slot < builder->block_count * MSPRINGI_WIDTH; ++slot) {
        if (builder->degree[slot] == 0 ||
            (slot >= builder->first_slot && slot < builder->first_slot + builder->own_count))
            continue;
        if (builder->strip_of_block[slot / MSPRINGI_WIDTH] != strip)
            attached = (attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        strip = builder->strip_of_block[slot / MSPRINGI_WIDTH];
        if (attached_slot)
            attached_slot[attached] = slot;
        attached++;
    }
    return attached;
}

static mspring_result reserve_slices(mspringi_sell_builder *builder, uint32_t attached, mspringi_memory *memory,
                                     mspringi_message *message) {
    mspringi_sell *sell = builder->sell;
    sell->attached_count = (attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    sell->slice_count = (builder->own_count + sell->attached_count) / MSPRINGI_WIDTH;
    sell->attached_slot = mspringi_alloc(memory, sell->attached_count, sizeof *sell->attached_slot);
    sell->first_slice_column =
        mspringi_alloc(memory, (size_t)sell->slice_count + 1, sizeof *sell->first_slice_column);
    sell->end_column = mspringi_alloc(memory, (size_t)sell->slice_count * (MSPRINGI_WIDTH / MSPRINGI_QUARTER),
                                      sizeof *sell->end_column);
    if (!sell->attached_slot || !sell->first_slice_column || !sell->end_column)
        return out_of_memory(builder, message);
    if (builder->interleaved_count > 0) {
        sell->is_interleaved = mspringi_alloc(memory, sell->slice_count, sizeof *sell->is_interleaved);
        sell->is_read = mspringi_alloc(memory, sell->slice_count, sizeof *sell->is_read);
        if (!sell->is_interleaved || !sell->is_read)
            return out_of_memory(builder, message);
    }
    memset(sell->attached_slot, 0xff, sell->attached_count * sizeof *sell->attached_slot);
    return MSPRING_OK;
}

mspring_result mspringi_sell_begin(mspringi_sell_builder *builder, mspringi_memory *memory,
                                   mspringi_message *message) {
    builder->sell->own_count = builder->own_count;
    if (builder->count == 0 && builder->own_count == 0)
        return MSPRING_OK;
    mspring_result result = reserve(builder, memory, message);
    if (result != MSPRING_OK)
        return result;
    count_degrees(builder);
    if (builder->assigned_count > 0 && !builder->has_parallel)
        interleave_chains(builder);
    result = reserve_slices(builder, list_attached(builder, NULL), memory, message);
    if (result == MSPRING_OK)
        (void)list_attached(builder, builder->sell->attached_slot);
    return result;
}

static void number_nodes(const mspringi_sell_builder *builder) {
    const mspringi_sell *sell = builder->sell;
    for (uint32_t node = 0; node < sell->own_count + sell->attached_count; ++node) {
        const uint32_t slot =
            node < sell->own_count ? builder->first_slot + node : sell->attached_slot[node - sell->own_count];
        if (slot != MSPRING_NONE)
            builder->node_of_slot[slot] = node;
    }
}

static uint32_t slot_of_node(const mspringi_sell *sell, uint32_t node, uint32_t first_slot) {
    return node < sell->own_count ? first_slot + node : sell->attached_slot[node - sell->own_count];
}

// Give each slice as many slice columns as its busiest node needs.
static mspring_result count_slice_columns(const mspringi_sell_builder *builder, mspringi_message *message) {
    const mspringi_sell *sell = builder->sell;
    for (uint32_t slice = 0; slice < sell->slice_count; ++slice) {
        uint32_t slice_columns = 0, *const end = sell->end_column + slice * (MSPRINGI_WIDTH / MSPRINGI_QUARTER);
        const bool has_interleaved =
            slice < sell->own_count / MSPRINGI_WIDTH && builder->interleaved[slice] >= MIN_INTERLEAVED;
        if (has_interleaved)
            sell->is_interleaved[slice] = 1;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const uint32_t slot = slot_of_node(sell, slice * MSPRINGI_WIDTH + lane, builder->first_slot);
            const uint32_t needed = slot != MSPRING_NONE ? builder->degree[slot] : 0;
            if (needed > end[lane / MSPRINGI_QUARTER])
                end[lane / MSPRINGI_QUARTER] = needed;
            if (needed > slice_columns)
                slice_columns = needed;
        }
        for (uint32_t quarter = 0; quarter < MSPRINGI_WIDTH / MSPRINGI_QUARTER; ++quarter)
            end[quarter] += sell->first_slice_column[slice] + has_interleaved;
        slice_columns += has_interleaved;
        if (slice_columns > UINT32_MAX / MSPRINGI_WIDTH - sell->first_slice_column[slice])
            return mspringi_fail(message, MSPRING_ERROR_LIMIT, "a particle has too many springs");
        sell->first_slice_column[slice + 1] = sell->first_slice_column[slice] + slice_columns;
    }
    return MSPRING_OK;
}

static mspring_result reserve_slice_columns(mspringi_sell_builder *builder, mspringi_memory *memory,
                                            mspringi_message *message) {
    mspringi_sell *sell = builder->sell;
    const size_t slice_columns = sell->first_slice_column[sell->slice_count];
    sell->neighbour = mspringi_alloc(memory, slice_columns * MSPRINGI_WIDTH, sizeof *sell->neighbour);
    sell->entry = mspringi_alloc(memory, (size_t)2 * builder->count, sizeof *sell->entry);
    builder->used = mspringi_alloc(memory, (size_t)sell->slice_count * MSPRINGI_WIDTH, sizeof *builder->used);
    return sell->neighbour && sell->entry && builder->used ? MSPRING_OK : out_of_memory(builder, message);
}

static mspring_result reserve_links(const mspringi_sell_builder *builder, mspringi_memory *memory,
                                    mspringi_message *message) {
    mspringi_sell *sell = builder->sell;
    sell->first_bundle = builder->own_count / MSPRINGI_WIDTH - builder->bundle_slices;
    if (builder->bundle_slices == 0)
        return MSPRING_OK;
    sell->first_link = mspringi_alloc(memory, (size_t)builder->bundle_slices + 1, sizeof *sell->first_link);
    sell->links = mspringi_alloc(memory, builder->bundle_springs, sizeof *sell->links);
    return sell->first_link && sell->links ? MSPRING_OK : out_of_memory(builder, message);
}

mspring_result mspringi_sell_size_slices(mspringi_sell_builder *builder, mspringi_memory *memory,
                                         mspringi_message *message) {
    const mspringi_sell *sell = builder->sell;
    if (!builder->degree)
        return MSPRING_OK;
    number_nodes(builder);
    mspring_result result = count_slice_columns(builder, message);
    if (result == MSPRING_OK)
        result = reserve_slice_columns(builder, memory, message);
    if (result == MSPRING_OK)
        result = reserve_links(builder, memory, message);
    if (result != MSPRING_OK)
        return result;
    // Entries without a spring join a node to itself.
    for (uint32_t slice = 0; slice < sell->slice_count; ++slice)
        for (uint32_t slice_column = sell->first_slice_column[slice];
             slice_column < sell->first_slice_column[slice + 1]; ++slice_column)
            for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
                sell->neighbour[slice_column * MSPRINGI_WIDTH + lane] = slice * MSPRINGI_WIDTH + lane;
    return MSPRING_OK;
}

static uint32_t entry_at(const mspringi_sell *sell, uint32_t node, uint32_t slice_column) {
    return (sell->first_slice_column[node / MSPRINGI_WIDTH] + slice_column) * MSPRINGI_WIDTH +
           node % MSPRINGI_WIDTH;
}

// Take the next free entry of a node.
static uint32_t take_entry(const mspringi_sell_builder *builder, uint32_t node) {
    const mspringi_sell *sell = builder->sell;
    const bool has_interleaved = sell->is_interleaved && sell->is_interleaved[node / MSPRINGI_WIDTH];
    return entry_at(sell, node, has_interleaved + builder->used[node]++);
}

void mspringi_sell_fill(const mspringi_sell_builder *builder, uint32_t first, uint32_t end) {
    const mspringi_sell *sell = builder->sell;
    for (uint32_t s = first; s < end; ++s) {
        const uint32_t node_a = builder->node_of_slot[builder->a[s]], node_b = builder->node_of_slot[builder->b[s]];
        if (is_interleaved(builder, s)) {
            const uint32_t low = node_a < node_b ? node_a : node_b;
            sell->entry[2 * s] = sell->entry[2 * s + 1] = entry_at(sell, low, 0);
            sell->neighbour[sell->entry[2 * s]] = low + MSPRINGI_WIDTH;
            continue;
        }
        sell->entry[2 * s] = take_entry(builder, node_a);
        sell->entry[2 * s + 1] = take_entry(builder, node_b);
        sell->neighbour[sell->entry[2 * s]] = node_b;
        sell->neighbour[sell->entry[2 * s + 1]] = node_a;
        if (sell->is_read)
            sell->is_read[node_a / MSPRINGI_WIDTH] = sell->is_read[node_b / MSPRINGI_WIDTH] = 1;
    }
}

// Upper slice of a spring in the first lane of a bundle, from the first slice in bundles; MSPRING_NONE for any
// other spring. All lanes are equal.
static uint32_t upper_slice(const mspringi_sell_builder *builder, uint32_t spring) {
    const uint32_t a = builder->node_of_slot[builder->a[spring]], b = builder->node_of_slot[builder->b[spring]],
                   upper = a < b ? a : b;
    const bool is_in_bundle = upper < builder->own_count && upper / MSPRINGI_WIDTH >= builder->sell->first_bundle;
    return is_in_bundle && upper % MSPRINGI_WIDTH == 0 ? upper / MSPRINGI_WIDTH - builder->sell->first_bundle
                                                       : MSPRING_NONE;
}

void mspringi_sell_link_bundles(const mspringi_sell_builder *builder) {
    const mspringi_sell *sell = builder->sell;
    for (uint32_t s = 0; sell->links && s < builder->count; ++s)
        if (upper_slice(builder, s) != MSPRING_NONE)
            sell->first_link[upper_slice(builder, s) + 1]++;
    for (uint32_t slice = 0; slice < builder->bundle_slices; ++slice)
        sell->first_link[slice + 1] += sell->first_link[slice];
    // The first link of each slice moves up to its end, the first link of the next one.
    for (uint32_t s = 0; sell->links && s < builder->count; ++s) {
        const uint32_t slice = upper_slice(builder, s);
        if (slice == MSPRING_NONE)
            continue;
        const uint32_t a = sell->entry[2 * s], b = sell->entry[2 * s + 1];
        const uint32_t node_a = builder->node_of_slot[builder->a[s]], node_b = builder->node_of_slot[builder->b[s]];
        sell->links[sell->first_link[slice]++] = (mspringi_bundle_link){
            .below = node_a < node_b ? node_b - node_a : node_a - node_b,
            .slice_column = (a < b ? a : b) / MSPRINGI_WIDTH,
            .back = (a < b ? b : a) / MSPRINGI_WIDTH,
        };
    }
    for (uint32_t slice = builder->bundle_slices; sell->links && slice > 0; --slice)
        sell->first_link[slice] = sell->first_link[slice - 1];
    if (sell->links)
        sell->first_link[0] = 0;
}

void mspringi_sell_builder_destroy(mspringi_sell_builder *builder, mspringi_memory *memory) {
    mspringi_free(memory, builder->strip_of_block);
    mspringi_free(memory, builder->degree);
    mspringi_free(memory, builder->node_of_slot);
    mspringi_free(memory, builder->used);
    mspringi_free(memory, builder->interleaved);
    builder->strip_of_block = builder->degree = builder->node_of_slot = builder->used = NULL;
    builder->interleaved = NULL;
}
