#include "web.h"

#include <string.h>

// The slots of other rows than the web's that have springs, in slot order, each strip's filled up to whole groups:
// count them, and write them to attached_slot if that is there.
static uint32_t list_attached(const mspringi_web *web, const uint32_t *degree_of_slot, uint32_t first_slot,
                              uint32_t slot_count, const uint32_t *strip_of_block, uint32_t *attached_slot) {
    uint32_t attached = 0, strip = MSPRING_NONE;
    for (uint32_t slot = 0; slot < slot_count; ++slot) {
        if (degree_of_slot[slot] == 0 || (slot >= first_slot && slot < first_slot + web->own_count))
            continue;
        if (strip_of_block[slot / MSPRINGI_WIDTH] != strip)
            attached = (attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        strip = strip_of_block[slot / MSPRINGI_WIDTH];
        if (attached_slot)
            attached_slot[attached] = slot;
        attached++;
    }
    return (attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
}

static void number_nodes(const mspringi_web *web, uint32_t first_slot, uint32_t *node_of_slot) {
    for (uint32_t node = 0; node < web->own_count; ++node)
        node_of_slot[first_slot + node] = node;
    for (uint32_t i = 0; i < web->attached_count; ++i)
        if (web->attached_slot[i] != MSPRING_NONE)
            node_of_slot[web->attached_slot[i]] = web->own_count + i;
}

static uint32_t slot_of_node(const mspringi_web *web, uint32_t node, uint32_t first_slot) {
    return node < web->own_count ? first_slot + node : web->attached_slot[node - web->own_count];
}

// Give every group the rungs of its busiest node; false if their entries are more than can be numbered.
static bool count_rungs(mspringi_web *web, const uint32_t *degree_of_slot, uint32_t first_slot) {
    for (uint32_t group = 0; group < web->group_count; ++group) {
        uint32_t rungs = 0;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const uint32_t slot = slot_of_node(web, group * MSPRINGI_WIDTH + lane, first_slot);
            if (slot != MSPRING_NONE && degree_of_slot[slot] > rungs)
                rungs = degree_of_slot[slot];
        }
        if (rungs > UINT32_MAX / MSPRINGI_WIDTH - web->first_rung[group])
            return false;
        web->first_rung[group + 1] = web->first_rung[group] + rungs;
    }
    return true;
}

// The next free entry of a node; used counts those that are taken.
static uint32_t take_entry(const mspringi_web *web, uint32_t node, uint32_t *used) {
    const uint32_t rung = web->first_rung[node / MSPRINGI_WIDTH] + used[node]++;
    return rung * MSPRINGI_WIDTH + node % MSPRINGI_WIDTH;
}

static mspring_result fill(mspringi_web *web, const uint32_t *a, const uint32_t *b, uint32_t count,
                           const uint32_t *node_of_slot, mspringi_memory *memory) {
    const uint32_t rungs = web->first_rung[web->group_count];
    web->neighbour = mspringi_alloc(memory, (size_t)rungs * MSPRINGI_WIDTH, sizeof *web->neighbour);
    web->entry = mspringi_alloc(memory, (size_t)2 * count, sizeof *web->entry);
    uint32_t *used = mspringi_alloc(memory, (size_t)web->group_count * MSPRINGI_WIDTH, sizeof *used);
    const bool have_memory = web->neighbour && web->entry && used;
    if (have_memory) {
        for (uint32_t group = 0; group < web->group_count; ++group)
            for (uint32_t rung = web->first_rung[group]; rung < web->first_rung[group + 1]; ++rung)
                for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
                    web->neighbour[rung * MSPRINGI_WIDTH + lane] = group * MSPRINGI_WIDTH + lane;
        for (uint32_t s = 0; s < count; ++s) {
            const uint32_t node_a = node_of_slot[a[s]], node_b = node_of_slot[b[s]];
            web->entry[2 * s] = take_entry(web, node_a, used);
            web->entry[2 * s + 1] = take_entry(web, node_b, used);
            web->neighbour[web->entry[2 * s]] = node_b;
            web->neighbour[web->entry[2 * s + 1]] = node_a;
        }
    }
    mspringi_free(memory, used);
    return have_memory ? MSPRING_OK : MSPRING_ERROR_MEMORY;
}

mspring_result mspringi_web_create(mspringi_web *web, const uint32_t *a, const uint32_t *b, uint32_t count,
                                   uint32_t first_slot, uint32_t own_count, uint32_t block_count,
                                   const uint32_t *strip_of_block, mspringi_memory *memory,
                                   mspringi_message *message) {
    const uint32_t slot_count = block_count * MSPRINGI_WIDTH;
    *web = (mspringi_web){.own_count = own_count};
    if (count == 0 && own_count == 0)
        return MSPRING_OK;
    uint32_t *degree = mspringi_alloc(memory, slot_count, sizeof *degree);
    uint32_t *node_of_slot = mspringi_alloc(memory, slot_count, sizeof *node_of_slot);
    mspring_result result = degree && node_of_slot ? MSPRING_OK : MSPRING_ERROR_MEMORY;
    if (result == MSPRING_OK) {
        for (uint32_t s = 0; s < count; ++s) {
            degree[a[s]]++;
            degree[b[s]]++;
        }
        web->attached_count = list_attached(web, degree, first_slot, slot_count, strip_of_block, NULL);
        web->group_count = (own_count + web->attached_count) / MSPRINGI_WIDTH;
        web->attached_slot = mspringi_alloc(memory, web->attached_count, sizeof *web->attached_slot);
        web->first_rung = mspringi_alloc(memory, (size_t)web->group_count + 1, sizeof *web->first_rung);
        result = web->attached_slot && web->first_rung ? MSPRING_OK : MSPRING_ERROR_MEMORY;
    }
    if (result == MSPRING_OK) {
        memset(web->attached_slot, 0xff, web->attached_count * sizeof *web->attached_slot);
        (void)list_attached(web, degree, first_slot, slot_count, strip_of_block, web->attached_slot);
        number_nodes(web, first_slot, node_of_slot);
        result = count_rungs(web, degree, first_slot) ? fill(web, a, b, count, node_of_slot, memory)
                                                      : MSPRING_ERROR_LIMIT;
    }
    mspringi_free(memory, degree);
    mspringi_free(memory, node_of_slot);
    if (result == MSPRING_ERROR_LIMIT)
        return mspringi_fail(message, result,
                             "some particles have so many springs that the web's entries cannot be numbered");
    if (result == MSPRING_ERROR_MEMORY)
        return mspringi_fail(message, result, "no memory for a web of %u springs", (unsigned)count);
    return result;
}

void mspringi_web_destroy(mspringi_web *web, mspringi_memory *memory) {
    mspringi_free(memory, web->attached_slot);
    mspringi_free(memory, web->first_rung);
    mspringi_free(memory, web->neighbour);
    mspringi_free(memory, web->entry);
    *web = (mspringi_web){0};
}
