#include "layout/analysis.h"

#include <string.h>

/// Springs of a group that make an upright rung worth it, which costs as much as another: each of these saves two
/// entries of others.
#define FEWEST_UPRIGHT 8

static mspring_result out_of_memory(const mspringi_weaving *w, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a web of %u springs", (unsigned)w->count);
}

static mspring_result begin(mspringi_weaving *w, mspringi_memory *memory, mspringi_message *message) {
    const size_t slots = (size_t)w->block_count * MSPRINGI_WIDTH;
    w->degree = mspringi_alloc(memory, slots, sizeof *w->degree);
    w->node_of_slot = mspringi_alloc(memory, slots, sizeof *w->node_of_slot);
    w->upright = mspringi_alloc(memory, w->own_count / MSPRINGI_WIDTH, sizeof *w->upright);
    return w->degree && w->node_of_slot && w->upright ? MSPRING_OK : out_of_memory(w, message);
}

static void count_degrees(const mspringi_weaving *w) {
    for (uint32_t s = 0; s < w->count; ++s) {
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

// What stands upright needs no other rungs: from then on degrees are without it.
static void stand_upright(mspringi_weaving *w) {
    for (uint32_t s = 0; s < w->count; ++s) {
        const uint32_t group = upright_group(w, s);
        if (group != MSPRING_NONE)
            w->upright[group]++;
    }
    for (uint32_t s = 0; s < w->count; ++s) {
        if (!is_upright(w, s))
            continue;
        w->degree[w->a[s]]--;
        w->degree[w->b[s]]--;
        w->upright_count++;
    }
}

// The slots of other rows than the web's that have springs, in slot order, each strip's filled up to whole groups:
// write them to attached_slot, if that is there. Returns how many they are.
static uint32_t list_attached(const mspringi_weaving *w, uint32_t *attached_slot) {
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

static mspring_result reserve_groups(mspringi_weaving *w, uint32_t attached, mspringi_memory *memory,
                                     mspringi_message *message) {
    mspringi_web *web = w->web;
    web->attached_count = (attached + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    web->group_count = (w->own_count + web->attached_count) / MSPRINGI_WIDTH;
    web->attached_slot = mspringi_alloc(memory, web->attached_count, sizeof *web->attached_slot);
    web->first_rung = mspringi_alloc(memory, (size_t)web->group_count + 1, sizeof *web->first_rung);
    if (!web->attached_slot || !web->first_rung)
        return out_of_memory(w, message);
    if (w->upright_count > 0) {
        web->is_upright = mspringi_alloc(memory, web->group_count, sizeof *web->is_upright);
        web->is_read = mspringi_alloc(memory, web->group_count, sizeof *web->is_read);
        if (!web->is_upright || !web->is_read)
            return out_of_memory(w, message);
    }
    memset(web->attached_slot, 0xff, web->attached_count * sizeof *web->attached_slot);
    return MSPRING_OK;
}

mspring_result mspringi_web_begin(mspringi_weaving *w, mspringi_memory *memory, mspringi_message *message) {
    w->web->own_count = w->own_count;
    if (w->count == 0 && w->own_count == 0)
        return MSPRING_OK;
    mspring_result result = begin(w, memory, message);
    if (result != MSPRING_OK)
        return result;
    count_degrees(w);
    if (w->homed_count > 0 && !w->has_seconds)
        stand_upright(w);
    result = reserve_groups(w, list_attached(w, NULL), memory, message);
    if (result == MSPRING_OK)
        (void)list_attached(w, w->web->attached_slot);
    return result;
}

static void number_nodes(const mspringi_weaving *w) {
    const mspringi_web *web = w->web;
    for (uint32_t node = 0; node < web->own_count + web->attached_count; ++node) {
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
static mspring_result count_rungs(const mspringi_weaving *w, mspringi_message *message) {
    const mspringi_web *web = w->web;
    for (uint32_t group = 0; group < web->group_count; ++group) {
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

static mspring_result reserve_rungs(mspringi_weaving *w, mspringi_memory *memory, mspringi_message *message) {
    mspringi_web *web = w->web;
    const size_t rungs = web->first_rung[web->group_count];
    web->neighbour = mspringi_alloc(memory, rungs * MSPRINGI_WIDTH, sizeof *web->neighbour);
    web->entry = mspringi_alloc(memory, (size_t)2 * w->count, sizeof *web->entry);
    w->used = mspringi_alloc(memory, (size_t)web->group_count * MSPRINGI_WIDTH, sizeof *w->used);
    return web->neighbour && web->entry && w->used ? MSPRING_OK : out_of_memory(w, message);
}

static mspring_result reserve_links(const mspringi_weaving *w, mspringi_memory *memory, mspringi_message *message) {
    mspringi_web *web = w->web;
    web->first_herd = w->own_count / MSPRINGI_WIDTH - w->herd_groups;
    if (w->herd_groups == 0)
        return MSPRING_OK;
    web->first_link = mspringi_alloc(memory, (size_t)w->herd_groups + 1, sizeof *web->first_link);
    web->links = mspringi_alloc(memory, w->herd_springs, sizeof *web->links);
    return web->first_link && web->links ? MSPRING_OK : out_of_memory(w, message);
}

mspring_result mspringi_web_lay_rungs(mspringi_weaving *w, mspringi_memory *memory, mspringi_message *message) {
    const mspringi_web *web = w->web;
    if (!w->degree)
        return MSPRING_OK;
    number_nodes(w);
    mspring_result result = count_rungs(w, message);
    if (result == MSPRING_OK)
        result = reserve_rungs(w, memory, message);
    if (result == MSPRING_OK)
        result = reserve_links(w, memory, message);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t group = 0; group < web->group_count; ++group) // every node is its own neighbour at first
        for (uint32_t rung = web->first_rung[group]; rung < web->first_rung[group + 1]; ++rung)
            for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
                web->neighbour[rung * MSPRINGI_WIDTH + lane] = group * MSPRINGI_WIDTH + lane;
    return MSPRING_OK;
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

void mspringi_web_fill(const mspringi_weaving *w, uint32_t first, uint32_t end) {
    const mspringi_web *web = w->web;
    for (uint32_t s = first; s < end; ++s) {
        const uint32_t node_a = w->node_of_slot[w->a[s]], node_b = w->node_of_slot[w->b[s]];
        if (is_upright(w, s)) {
            const uint32_t low = node_a < node_b ? node_a : node_b;
            web->entry[2 * s] = web->entry[2 * s + 1] = entry_at(web, low, 0);
            web->neighbour[web->entry[2 * s]] = low + MSPRINGI_WIDTH;
            continue;
        }
        web->entry[2 * s] = take_entry(w, node_a);
        web->entry[2 * s + 1] = take_entry(w, node_b);
        web->neighbour[web->entry[2 * s]] = node_b;
        web->neighbour[web->entry[2 * s + 1]] = node_a;
        if (web->is_read)
            web->is_read[node_a / MSPRINGI_WIDTH] = web->is_read[node_b / MSPRINGI_WIDTH] = 1;
    }
}

// The group above of a spring in the first lane of a herd, counted from the first that is in one; MSPRING_NONE if
// the spring lies elsewhere. All lanes are alike.
static uint32_t group_above(const mspringi_weaving *w, uint32_t spring) {
    const uint32_t a = w->node_of_slot[w->a[spring]], b = w->node_of_slot[w->b[spring]], above = a < b ? a : b;
    const bool is_in_herd = above < w->own_count && above / MSPRINGI_WIDTH >= w->web->first_herd;
    return is_in_herd && above % MSPRINGI_WIDTH == 0 ? above / MSPRINGI_WIDTH - w->web->first_herd : MSPRING_NONE;
}

void mspringi_web_link(const mspringi_weaving *w) {
    const mspringi_web *web = w->web;
    for (uint32_t s = 0; web->links && s < w->count; ++s)
        if (group_above(w, s) != MSPRING_NONE)
            web->first_link[group_above(w, s) + 1]++;
    for (uint32_t group = 0; group < w->herd_groups; ++group)
        web->first_link[group + 1] += web->first_link[group];
    // Each group's first moves up to its end, which is where the next one begins.
    for (uint32_t s = 0; web->links && s < w->count; ++s) {
        const uint32_t group = group_above(w, s);
        if (group == MSPRING_NONE)
            continue;
        const uint32_t a = web->entry[2 * s], b = web->entry[2 * s + 1];
        const uint32_t node_a = w->node_of_slot[w->a[s]], node_b = w->node_of_slot[w->b[s]];
        web->links[web->first_link[group]++] = (mspringi_link){
            .below = node_a < node_b ? node_b - node_a : node_a - node_b,
            .rung = (a < b ? a : b) / MSPRINGI_WIDTH,
            .back = (a < b ? b : a) / MSPRINGI_WIDTH,
        };
    }
    for (uint32_t group = w->herd_groups; web->links && group > 0; --group)
        web->first_link[group] = web->first_link[group - 1];
    if (web->links)
        web->first_link[0] = 0;
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
