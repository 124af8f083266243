#include "web.h"

#include <string.h>

/// Springs of a group that make an upright rung worth it, which costs as much as another: each of these saves two
/// entries of others.
#define FEWEST_UPRIGHT 8

static mspring_result out_of_memory(const mspringi_weaving *w, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a web of %u springs", (unsigned)w->count);
}

mspring_result mspringi_web_begin(mspringi_weaving *w, mspringi_pace *pace, mspringi_memory *memory,
                                  mspringi_message *message) {
    const size_t slots = (size_t)w->block_count * MSPRINGI_WIDTH;
    w->web->own_count = w->own_count;
    if (w->count == 0 && w->own_count == 0)
        return MSPRING_OK;
    w->degree = mspringi_pace_alloc(pace, memory, slots, sizeof *w->degree);
    w->node_of_slot = mspringi_pace_alloc(pace, memory, slots, sizeof *w->node_of_slot);
    w->upright = mspringi_pace_alloc(pace, memory, w->own_count / MSPRINGI_WIDTH, sizeof *w->upright);
    w->strip = MSPRING_NONE;
    return w->degree && w->node_of_slot && w->upright ? MSPRING_OK : out_of_memory(w, message);
}

void mspringi_web_count_degrees(mspringi_weaving *w, mspringi_pace *pace) {
    uint32_t first, end;
    mspringi_pace_take(pace, w->count, 2, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        w->degree[w->a[s]]++;
        w->degree[w->b[s]]++;
    }
}

// Where a spring could stand upright: the group of its lower node; MSPRING_NONE if it could not.
static uint32_t upright_group(const mspringi_weaving *w, uint32_t spring) {
    const uint32_t a = w->a[spring], b = w->b[spring], low = a < b ? a : b, high = a < b ? b : a;
    if (high - low != MSPRINGI_WIDTH || low < w->first_slot || high - w->first_slot >= w->homed_count ||
        w->degree[low] > 2 || w->degree[high] > 2 ||
        w->strip_of_block[low / MSPRINGI_WIDTH] != w->strip_of_block[high / MSPRINGI_WIDTH])
        return MSPRING_NONE;
    return (low - w->first_slot) / MSPRINGI_WIDTH;
}

static bool is_upright(const mspringi_weaving *w, uint32_t spring) {
    const uint32_t group = upright_group(w, spring);
    return group != MSPRING_NONE && w->upright[group] >= FEWEST_UPRIGHT;
}

void mspringi_web_count_upright(mspringi_weaving *w, mspringi_pace *pace) {
    uint32_t first, end;
    mspringi_pace_take(pace, w->homed_count > 0 ? w->count : 0, 2, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        const uint32_t group = upright_group(w, s);
        if (group != MSPRING_NONE)
            w->upright[group]++;
    }
}

// What stands upright needs no other rungs: from here on degrees are without it.
void mspringi_web_take_upright(mspringi_weaving *w, mspringi_pace *pace) {
    uint32_t first, end;
    mspringi_pace_take(pace, w->homed_count > 0 ? w->count : 0, 2, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        if (!is_upright(w, s))
            continue;
        w->degree[w->a[s]]--;
        w->degree[w->b[s]]--;
        w->upright_count++;
    }
}

// The slots of other rows than the web's that have springs, in slot order, each strip's filled up to whole groups:
// count them, and write them to attached_slot if that is there.
void mspringi_web_list_attached(mspringi_weaving *w, mspringi_pace *pace) {
    uint32_t *attached_slot = w->web->attached_slot, attached = w->attached, first, end;
    mspringi_pace_take(pace, w->degree ? w->block_count : 0, 4, &first, &end);
    for (uint32_t slot = first * MSPRINGI_WIDTH; slot < end * MSPRINGI_WIDTH; ++slot) {
        // Without degrees there are no blocks to take.
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference)
        if (w->degree[slot] == 0 || (slot >= w->first_slot && slot < w->first_slot + w->own_count))
            continue;
        if (w->strip_of_block[slot / MSPRINGI_WIDTH] != w->strip)
            attached = (attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
        w->strip = w->strip_of_block[slot / MSPRINGI_WIDTH];
        if (attached_slot)
            attached_slot[attached] = slot;
        attached++;
    }
    w->attached = attached;
}

mspring_result mspringi_web_reserve(mspringi_weaving *w, mspringi_pace *pace, mspringi_memory *memory,
                                    mspringi_message *message) {
    mspringi_web *web = w->web;
    if (!w->degree)
        return MSPRING_OK;
    web->attached_count = (w->attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    web->group_count = (w->own_count + web->attached_count) / MSPRINGI_WIDTH;
    web->attached_slot = mspringi_pace_alloc(pace, memory, web->attached_count, sizeof *web->attached_slot);
    web->first_rung = mspringi_pace_alloc(pace, memory, (size_t)web->group_count + 1, sizeof *web->first_rung);
    if (!web->attached_slot || !web->first_rung)
        return out_of_memory(w, message);
    if (w->upright_count > 0) {
        web->is_upright = mspringi_pace_alloc(pace, memory, web->group_count, sizeof *web->is_upright);
        web->is_read = mspringi_pace_alloc(pace, memory, web->group_count, sizeof *web->is_read);
        if (!web->is_upright || !web->is_read)
            return out_of_memory(w, message);
    }
    memset(web->attached_slot, 0xff, web->attached_count * sizeof *web->attached_slot);
    w->attached = 0;
    w->strip = MSPRING_NONE;
    return MSPRING_OK;
}

void mspringi_web_number_nodes(mspringi_weaving *w, mspringi_pace *pace) {
    const mspringi_web *web = w->web;
    uint32_t first, end;
    mspringi_pace_take(pace, web->own_count + web->attached_count, 1, &first, &end);
    for (uint32_t node = first; node < end; ++node) {
        const uint32_t slot =
            node < web->own_count ? w->first_slot + node : web->attached_slot[node - web->own_count];
        if (slot != MSPRING_NONE)
            w->node_of_slot[slot] = node;
    }
}

static uint32_t slot_of_node(const mspringi_web *web, uint32_t node, uint32_t first_slot) {
    return node < web->own_count ? first_slot + node : web->attached_slot[node - web->own_count];
}

// Give every group the rungs of its busiest node.
mspring_result mspringi_web_count_rungs(mspringi_weaving *w, mspringi_pace *pace, mspringi_message *message) {
    const mspringi_web *web = w->web;
    uint32_t first, end;
    mspringi_pace_take(pace, web->group_count, MSPRINGI_WIDTH, &first, &end);
    for (uint32_t group = first; group < end; ++group) {
        uint32_t rungs = 0;
        const bool has_upright = group < web->own_count / MSPRINGI_WIDTH && w->upright[group] >= FEWEST_UPRIGHT;
        if (has_upright)
            web->is_upright[group] = 1;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const uint32_t slot = slot_of_node(web, group * MSPRINGI_WIDTH + lane, w->first_slot);
            if (slot != MSPRING_NONE && w->degree[slot] > rungs)
                rungs = w->degree[slot];
        }
        rungs += has_upright;
        if (rungs > UINT32_MAX / MSPRINGI_WIDTH - web->first_rung[group])
            return mspringi_fail(message, MSPRING_ERROR_LIMIT,
                                 "some particles have so many springs that the web's entries cannot be numbered");
        web->first_rung[group + 1] = web->first_rung[group] + rungs;
    }
    return MSPRING_OK;
}

mspring_result mspringi_web_reserve_rungs(mspringi_weaving *w, mspringi_pace *pace, mspringi_memory *memory,
                                          mspringi_message *message) {
    mspringi_web *web = w->web;
    if (!w->degree)
        return MSPRING_OK;
    const size_t rungs = web->first_rung[web->group_count];
    web->neighbour = mspringi_pace_alloc(pace, memory, rungs * MSPRINGI_WIDTH, sizeof *web->neighbour);
    web->entry = mspringi_pace_alloc(pace, memory, (size_t)2 * w->count, sizeof *web->entry);
    w->used = mspringi_pace_alloc(pace, memory, (size_t)web->group_count * MSPRINGI_WIDTH, sizeof *w->used);
    return web->neighbour && web->entry && w->used ? MSPRING_OK : out_of_memory(w, message);
}

// Every node is its own neighbour at first.
void mspringi_web_lay_rungs(mspringi_weaving *w, mspringi_pace *pace) {
    const mspringi_web *web = w->web;
    uint32_t group = pace->at;
    for (; group < web->group_count && pace->left > 0; ++group) {
        mspringi_pace_spend(pace, 1 + (uint64_t)MSPRINGI_WIDTH / 4 *
                                          (web->first_rung[group + 1] - web->first_rung[group]));
        for (uint32_t rung = web->first_rung[group]; rung < web->first_rung[group + 1]; ++rung)
            for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
                web->neighbour[rung * MSPRINGI_WIDTH + lane] = group * MSPRINGI_WIDTH + lane;
    }
    pace->at = group;
    pace->is_halfway = group < web->group_count;
}

static uint32_t entry_at(const mspringi_web *web, uint32_t node, uint32_t rung) {
    return (web->first_rung[node / MSPRINGI_WIDTH] + rung) * MSPRINGI_WIDTH + node % MSPRINGI_WIDTH;
}

// The next free entry of a node.
static uint32_t take_entry(const mspringi_weaving *w, uint32_t node) {
    const mspringi_web *web = w->web;
    const bool has_upright = web->is_upright && web->is_upright[node / MSPRINGI_WIDTH];
    return entry_at(web, node, has_upright + w->used[node]++);
}

// The entry of a node for the spring to another. Those of herds are where the shape of their trees has them.
static uint32_t find_entry(const mspringi_weaving *w, uint32_t node, uint32_t other) {
    const uint32_t group = node / MSPRINGI_WIDTH, group_below = other / MSPRINGI_WIDTH;
    if (node >= w->own_count || group < w->herd_first)
        return take_entry(w, node);
    return entry_at(w->web, node, group_below < group ? 0 : w->rung_above[group_below - w->herd_first]);
}

void mspringi_web_fill(mspringi_weaving *w, mspringi_pace *pace, mspringi_memory *memory) {
    const mspringi_web *web = w->web;
    uint32_t first, end;
    mspringi_pace_take(pace, w->count, 8, &first, &end);
    for (uint32_t s = first; s < end; ++s) {
        const uint32_t node_a = w->node_of_slot[w->a[s]], node_b = w->node_of_slot[w->b[s]];
        if (is_upright(w, s)) {
            const uint32_t low = node_a < node_b ? node_a : node_b;
            web->entry[2 * s] = web->entry[2 * s + 1] = entry_at(web, low, 0);
            web->neighbour[web->entry[2 * s]] = low + MSPRINGI_WIDTH;
            continue;
        }
        web->entry[2 * s] = find_entry(w, node_a, node_b);
        web->entry[2 * s + 1] = find_entry(w, node_b, node_a);
        web->neighbour[web->entry[2 * s]] = node_b;
        web->neighbour[web->entry[2 * s + 1]] = node_a;
        if (web->is_read)
            web->is_read[node_a / MSPRINGI_WIDTH] = web->is_read[node_b / MSPRINGI_WIDTH] = 1;
    }
    if (!pace->is_halfway)
        mspringi_weaving_destroy(w, memory);
}

void mspringi_weaving_destroy(mspringi_weaving *w, mspringi_memory *memory) {
    mspringi_free(memory, w->strip_of_block);
    mspringi_free(memory, w->degree);
    mspringi_free(memory, w->node_of_slot);
    mspringi_free(memory, w->used);
    mspringi_free(memory, w->upright);
    w->strip_of_block = w->degree = w->node_of_slot = w->used = NULL;
    w->upright = NULL;
}
