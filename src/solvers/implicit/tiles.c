/// Tiles: components of the cells, and their update after edits.
#include "solvers/implicit/tiles.h"

#include <string.h>

#include "base/assert.h"
#include "base/hash.h"
#include "base/union_find.h"
#include "store/springs.h"

/// Spare capacity for divided cells: tiles beyond twice the cells; entries of the coarse matrix beyond four times
/// those of undivided cells; springs to pinned particles beyond a quarter of all.
#define SPARE_TILES 64u
#define SPARE_VALUES ((size_t)4096)
#define SPARE_ANCHORS 1024u

// True if a spring can pull. One-way springs can, even if slack in this step. Tiles must not depend on when they
// are made, because loading a snapshot makes them, too.
static bool is_live(const mspring_network *network, mspring_id spring, mspringi_spring_slot spring_slot) {
    return mspringi_spring_slot_is_live(network, spring_slot) &&
           (mspringi_side_of(network, spring) != 0 ||
            mspringi_spring_get_nominal(network, spring, spring_slot).stiffness > 0.0f);
}

static bool is_free(const mspring_network *network, uint32_t slot) {
    return mspringi_active_inverse_mass(network)[slot] > 0.0f;
}

// The other end of the added spring number end / 2, if the spring can pull; else MSPRING_NONE.
static uint32_t slot_pulled_at(const mspring_network *network, uint32_t end) {
    const mspringi_topology *t = &network->topology;
    const mspring_id spring = t->reserve.first_spring + end / 2;
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, spring);
    if (mspringi_spring_slot_is_laid_out(t, spring_slot) || !is_live(network, spring, spring_slot))
        return MSPRING_NONE;
    return t->slot_of_particle[network->growth.particle_of_end[end ^ 1u]];
}

// The first of the added springs' ends at a slot.
static uint32_t first_end_at(const mspring_network *network, uint32_t slot) {
    const mspring_id particle = network->topology.particle_of_slot[slot];
    return particle == MSPRING_NONE || !network->growth.first_end ? MSPRINGI_NO_END
                                                                  : network->growth.first_end[particle];
}

static bool is_loose(const mspring_network *network, uint32_t slot) {
    return slot >= network->topology.loose_first * MSPRINGI_WIDTH;
}

// True if a slot's particle may lie in a tile. A loose one does while an added spring acts on it.
static bool is_in_tile(const mspring_network *network, uint32_t slot) {
    if (!is_free(network, slot) || !is_loose(network, slot))
        return is_free(network, slot);
    uint32_t end = first_end_at(network, slot);
    while (end != MSPRINGI_NO_END && slot_pulled_at(network, end) == MSPRING_NONE)
        end = network->growth.next_end[end];
    return end != MSPRINGI_NO_END;
}

/* ------------------------------------------------------------------------------------------------- components */

// Join the loose particles of a cell that added springs connect.
static void join_loose(mspringi_tiles *tiles, const mspring_network *network, uint32_t cell) {
    const mspringi_cells *cells = &tiles->cells;
    for (uint32_t i = cells->first_slot[cell]; i < cells->first_slot[cell + 1]; ++i) {
        const uint32_t slot = cells->slots[i];
        for (uint32_t end = first_end_at(network, slot); end != MSPRINGI_NO_END;
             end = network->growth.next_end[end]) {
            const uint32_t other = slot_pulled_at(network, end);
            if (other != MSPRING_NONE && cells->of_slot[other] == cell && is_free(network, slot) &&
                is_free(network, other))
                mspringi_union_find_join(tiles->parent, slot, other);
        }
    }
}

// Join the free particles of a cell that live springs connect. The root of a component is its lowest slot.
static void join_springs(mspringi_tiles *tiles, const mspring_network *network, uint32_t cell) {
    const mspringi_cells *cells = &tiles->cells;
    const mspringi_topology *t = &network->topology;
    for (uint32_t i = cells->first_slot[cell]; i < cells->first_slot[cell + 1]; ++i)
        tiles->parent[cells->slots[i]] = cells->slots[i];
    for (uint32_t i = cells->first_inner[cell]; i < cells->first_inner[cell + 1]; ++i) {
        const mspring_id spring = cells->inner[i];
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, spring);
        uint32_t a, b;
        mspringi_topology_ends(t, spring_slot, &a, &b);
        // The id may be that of a spring that was added since, which lies elsewhere.
        if (!mspringi_spring_slot_is_laid_out(t, spring_slot) || !is_free(network, a) || !is_free(network, b) ||
            !is_live(network, spring, spring_slot))
            continue;
        mspringi_union_find_join(tiles->parent, a, b);
    }
}

static void find_components(mspringi_tiles *tiles, const mspring_network *network, uint32_t cell) {
    const mspringi_cells *cells = &tiles->cells;
    join_springs(tiles, network, cell);
    if (is_loose(network, cells->slots[cells->first_slot[cell]]))
        join_loose(tiles, network, cell);
}

// Number the components of a cell, in the order of their lowest slots, from first on; all of them as one tile if
// they are more than most. Returns the end of the numbers.
static uint32_t number_cell(mspringi_tiles *tiles, const mspring_network *network, uint32_t cell, uint32_t first,
                            uint32_t most) {
    const mspringi_cells *cells = &tiles->cells;
    uint32_t end = first;
    for (uint32_t i = cells->first_slot[cell]; i < cells->first_slot[cell + 1]; ++i) {
        const uint32_t slot = cells->slots[i];
        tiles->of_slot[slot] = MSPRING_NONE;
        if (!is_in_tile(network, slot))
            continue;
        const uint32_t root = mspringi_union_find_root(tiles->parent, slot);
        tiles->of_slot[slot] = root == slot ? end++ : tiles->of_slot[root];
    }
    if (end - first <= most)
        return end;
    for (uint32_t i = cells->first_slot[cell]; i < cells->first_slot[cell + 1]; ++i)
        if (tiles->of_slot[cells->slots[i]] != MSPRING_NONE)
            tiles->of_slot[cells->slots[i]] = first;
    return first + 1;
}

// Number the tiles of a range of cells, in the order of the cells, behind those of the cells before.
static void number_tiles(mspringi_tiles *tiles, const mspring_network *network, uint32_t first, uint32_t end,
                         uint32_t most) {
    tiles->count = first == 0 ? 0 : tiles->first_of_cell[first];
    for (uint32_t cell = first; cell < end; ++cell) {
        tiles->first_of_cell[cell] = tiles->count;
        tiles->count = number_cell(tiles, network, cell, tiles->count, most);
    }
    tiles->first_of_cell[end] = tiles->count;
}

size_t mspringi_tiles_coarse_values(const mspringi_tiles *tiles) {
    size_t entries = 0;
    for (uint32_t cell = 0; cell < tiles->cells.count; ++cell) {
        const size_t count = tiles->first_of_cell[cell + 1] - tiles->first_of_cell[cell];
        entries += count * mspringi_tiles_before(tiles, cell) + count * (count + 1) / 2;
    }
    return 9 * entries;
}

size_t mspringi_tiles_cell_values(const mspringi_tiles *tiles) {
    const mspringi_cells *cells = &tiles->cells;
    return 9 * ((size_t)cells->first_before[cells->count] + cells->count);
}

/* ------------------------------------------------------------------------------------------------------- parts */

// List the particles of a cell's tiles, some slots at a time.
static uint32_t list_cell_parts(mspringi_tiles *tiles, uint32_t cell, uint32_t first) {
    const mspringi_cells *cells = &tiles->cells;
    const uint32_t *const begin = cells->slots + cells->first_slot[cell];
    const uint32_t *const end = cells->slots + cells->first_slot[cell + 1];
    uint32_t part = first;
    for (uint32_t t = tiles->first_of_cell[cell]; t < tiles->first_of_cell[cell + 1]; ++t) {
        tiles->first_part[t] = part;
        for (const uint32_t *slot = begin; slot < end; ++slot) {
            if (tiles->of_slot[*slot] != t)
                continue;
            const uint32_t at = *slot / MSPRINGI_PART * MSPRINGI_PART;
            if (part == tiles->first_part[t] || tiles->parts[part - 1].first_slot != at)
                tiles->parts[part++] = (mspringi_tile_part){.first_slot = at, .tile = t};
            tiles->parts[part - 1].lanes |= 1u << (*slot - at);
        }
    }
    return part;
}

// Sort the parts by slot; those at the same slots stay in the order of their tiles.
static void sort_parts(mspringi_tiles *tiles, size_t slots) {
    const size_t groups = slots / MSPRINGI_PART;
    const uint32_t count = tiles->first_part[tiles->count];
    uint32_t *const first = tiles->first_by_slot;
    memset(first, 0, (groups + 1) * sizeof *first);
    for (uint32_t p = 0; p < count; ++p)
        first[tiles->parts[p].first_slot / MSPRINGI_PART + 1]++;
    for (size_t group = 0; group < groups; ++group)
        first[group + 1] += first[group];
    // From the last one on, so that first ends up at the beginnings.
    for (uint32_t p = count; p-- > 0;)
        tiles->parts_by_slot[--first[tiles->parts[p].first_slot / MSPRINGI_PART + 1]] = tiles->parts[p];
    for (size_t group = 0; group < groups; ++group)
        first[group] = first[group + 1];
    first[groups] = count;
}

// Those of a range of cells, behind those of the cells before.
static void list_parts(mspringi_tiles *tiles, uint32_t first, uint32_t end) {
    uint32_t part = first == 0 ? 0 : tiles->first_part[tiles->first_of_cell[first]];
    for (uint32_t cell = first; cell < end; ++cell)
        part = list_cell_parts(tiles, cell, part);
    tiles->first_part[tiles->first_of_cell[end]] = part;
}

// Note a spring if just one of its ends is pinned, as far as there is room.
static void add_anchor(mspringi_tiles *tiles, const mspring_network *network, uint32_t a, uint32_t b,
                       uint32_t factors) {
    const bool a_free = is_free(network, a);
    if (a_free == is_free(network, b) || tiles->pin_edge_count == tiles->pin_edge_capacity)
        return;
    tiles->pin_edges[tiles->pin_edge_count++] =
        (mspringi_cell_edge){.slot = a_free ? a : b, .other_slot = a_free ? b : a, .factors = factors};
}

// Note both ends of an added spring, each as if the other were pinned: the coarse matrix has no room for what joins
// any two tiles. Where the two are in one tile, they are left out of it.
static void add_grafted(mspringi_tiles *tiles, const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, spring);
    if (mspringi_spring_slot_is_laid_out(t, spring_slot) || !mspringi_spring_exists(network, spring) ||
        tiles->pin_edge_count + 2 > tiles->pin_edge_capacity)
        return;
    const uint32_t factors = mspringi_factors_of_spring_slot(spring_slot);
    uint32_t a, b;
    mspringi_topology_ends(t, spring_slot, &a, &b);
    tiles->pin_edges[tiles->pin_edge_count++] =
        (mspringi_cell_edge){.slot = a, .other_slot = b, .factors = factors};
    tiles->pin_edges[tiles->pin_edge_count++] =
        (mspringi_cell_edge){.slot = b, .other_slot = a, .factors = factors};
}

// Springs to pinned particles inside cells.
static void add_inner_anchors(mspringi_tiles *tiles, const mspring_network *network, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &network->topology;
    for (uint32_t i = first; i < end; ++i) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, tiles->cells.inner[i]);
        uint32_t a, b;
        mspringi_topology_ends(t, spring_slot, &a, &b);
        if (!mspringi_spring_slot_is_laid_out(t, spring_slot))
            continue;
        add_anchor(tiles, network, a, b, mspringi_factors_of_spring_slot(spring_slot));
    }
}

// Those between cells, and springs that were added.
static void add_other_anchors(mspringi_tiles *tiles, const mspring_network *network) {
    const mspringi_cells *cells = &tiles->cells;
    const mspringi_topology *t = &network->topology;
    for (const mspringi_cell_edge *joint = cells->cell_edges; joint < cells->cell_edges + cells->cell_edge_count;
         ++joint)
        add_anchor(tiles, network, joint->slot, joint->other_slot, joint->factors);
    for (mspring_id s = t->reserve.first_spring; s < t->spring_count; ++s)
        add_grafted(tiles, network, s);
}

static void list_anchors(mspringi_tiles *tiles, const mspring_network *network) {
    tiles->pin_edge_count = 0;
    add_inner_anchors(tiles, network, 0, tiles->cells.first_inner[tiles->cells.count]);
    add_other_anchors(tiles, network);
}

/* ------------------------------------------------------------------------------------------------------- edits */

static void mark_dirty(mspringi_tiles *tiles, uint32_t cell) {
    if (tiles->is_dirty[cell])
        return;
    tiles->is_dirty[cell] = 1;
    MSPRINGI_ASSERT(tiles->dirty_count < tiles->cells.count);
    tiles->dirty[tiles->dirty_count++] = cell;
}

static void mark_changed_links(mspringi_tiles *tiles, const mspring_network *network, uint64_t seen) {
    const mspringi_topology *t = &network->topology;
    for (uint64_t n = seen; n < network->edits.links; ++n) {
        uint32_t a, b;
        mspringi_topology_ends(t, mspringi_slot_of_spring(t, mspringi_edits_link(&network->edits, n)), &a, &b);
        if (tiles->cells.of_slot[a] != MSPRING_NONE && tiles->cells.of_slot[a] == tiles->cells.of_slot[b])
            mark_dirty(tiles, tiles->cells.of_slot[a]);
    }
}

// Sleeping particles count as pinned.
static bool pins_have_changed(const mspringi_tiles *tiles, const mspring_network *network,
                              const mspringi_edits *seen) {
    if (seen->masses == network->edits.masses && seen->sleep_changes == network->edits.sleep_changes)
        return false;
    const size_t slots = mspringi_slot_count(network);
    size_t changed = 0;
    for (size_t slot = 0; slot < slots; ++slot)
        changed += tiles->cells.of_slot[slot] != MSPRING_NONE &&
                   is_in_tile(network, (uint32_t)slot) != (tiles->of_slot[slot] != MSPRING_NONE);
    return changed > 0;
}

// Cells whose particles are in tiles by what was added.
static void mark_loose(mspringi_tiles *tiles, const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    for (uint32_t block = t->loose_first; block < t->spare_first + t->spare_blocks; ++block)
        if (tiles->cells.of_slot[block * MSPRINGI_WIDTH] != MSPRING_NONE)
            mark_dirty(tiles, tiles->cells.of_slot[block * MSPRINGI_WIDTH]);
}

static bool fits(const mspringi_tiles *tiles) {
    return tiles->count <= tiles->capacity && mspringi_tiles_coarse_values(tiles) <= tiles->value_capacity;
}

// If the tiles are too many, the most that a cell may be cut into next; else 0. With a tile to a cell they always
// fit.
static uint32_t next_most(const mspringi_tiles *tiles, uint32_t most) {
    return fits(tiles) ? 0 : most > 16 ? 16 : most / 4;
}

// Look again at the dirty cells. Everything else is a matter of counting.
static void renew(mspringi_tiles *tiles, const mspring_network *network) {
    for (uint32_t i = 0; i < tiles->dirty_count; ++i) {
        find_components(tiles, network, tiles->dirty[i]);
        tiles->is_dirty[tiles->dirty[i]] = 0;
    }
    tiles->dirty_count = 0;
    for (uint32_t most = UINT32_MAX; most > 0; most = next_most(tiles, most))
        number_tiles(tiles, network, 0, tiles->cells.count, most);
    list_parts(tiles, 0, tiles->cells.count);
    sort_parts(tiles, mspringi_slot_count(network));
}

bool mspringi_tiles_are_outdated(const mspringi_tiles *tiles, const mspring_network *network,
                                 const mspringi_edits *seen) {
    const mspringi_edits *edits = &network->edits;
    return seen->links != edits->links || seen->values != edits->values || seen->grafts != edits->grafts ||
           pins_have_changed(tiles, network, seen);
}

void mspringi_tiles_update(mspringi_tiles *tiles, const mspring_network *network, const mspringi_edits *seen) {
    const mspringi_edits *edits = &network->edits;
    const bool pins = pins_have_changed(tiles, network, seen);
    const bool has_grafts = network->topology.spring_count > network->topology.reserve.first_spring;
    if (pins || seen->grafts != edits->grafts)
        list_anchors(tiles, network);
    if (seen->grafts != edits->grafts || (has_grafts && seen->links != edits->links))
        mark_loose(tiles, network);
    const bool outdated = network->is_compact && seen->grafts != edits->grafts; // what the cells list may be gone
    if (pins || outdated || seen->values != edits->values || !mspringi_edits_have_link(edits, seen->links))
        for (uint32_t cell = 0; cell < tiles->cells.count; ++cell)
            mark_dirty(tiles, cell);
    else
        mark_changed_links(tiles, network, seen->links);
    if (tiles->dirty_count > 0)
        renew(tiles, network);
}

/* ---------------------------------------------------------------------------------------------------- the whole */

// Everything that edits do not change.
static void take_fingerprint(mspringi_tiles *tiles, size_t slots) {
    tiles->fingerprint = mspringi_hash_floats(MSPRINGI_HASH_START, tiles->turn_inertia, 0.0f);
    for (size_t slot = 0; slot < slots; ++slot)
        tiles->fingerprint = mspringi_hash(tiles->fingerprint, tiles->cells.of_slot[slot]);
    for (uint32_t node = 0; node < tiles->paths->node_count; ++node)
        tiles->fingerprint = mspringi_hash(tiles->fingerprint, tiles->paths->slots[node]);
}

static mspring_result no_memory(const mspringi_tile_builder *m) {
    return mspringi_fail(m->message, MSPRING_ERROR_MEMORY, "no memory to cut %u particles into tiles",
                         (unsigned)m->network->topology.particle_count);
}

static mspring_result cut_cells(mspringi_tile_builder *m) {
    bool is_done;
    const mspring_result result = mspringi_cells_run(&m->cutting, &is_done);
    m->cursor.again = !is_done;
    return result;
}

static mspring_result reserve(mspringi_tile_builder *m) {
    mspringi_tiles *tiles = m->tiles;
    const mspring_network *network = m->network;
    mspringi_memory *memory = m->memory;
    const size_t slots = mspringi_slot_count(network), cells = tiles->cells.count;
    tiles->capacity = 2 * (uint32_t)cells + SPARE_TILES;
    tiles->value_capacity = 4 * mspringi_tiles_cell_values(tiles) + SPARE_VALUES;
    tiles->pin_edge_capacity = network->topology.spring_count / 4 + SPARE_ANCHORS +
                               2 * (network->topology.irregular_capacity - network->topology.laid_out_count);
    tiles->of_slot = mspringi_alloc(memory, slots, sizeof *tiles->of_slot);
    tiles->parent = mspringi_alloc(memory, slots, sizeof *tiles->parent);
    tiles->first_of_cell = mspringi_alloc(memory, cells + 1, sizeof *tiles->first_of_cell);
    tiles->dirty = mspringi_alloc(memory, cells, sizeof *tiles->dirty);
    tiles->is_dirty = mspringi_alloc(memory, cells, sizeof *tiles->is_dirty);
    tiles->parts = mspringi_alloc(memory, network->topology.reserve.particle_end, sizeof *tiles->parts);
    tiles->parts_by_slot =
        mspringi_alloc(memory, network->topology.reserve.particle_end, sizeof *tiles->parts_by_slot);
    tiles->first_by_slot = mspringi_alloc(memory, slots / MSPRINGI_PART + 1, sizeof *tiles->first_by_slot);
    tiles->first_part = mspringi_alloc(memory, (size_t)tiles->capacity + 1, sizeof *tiles->first_part);
    tiles->pin_edges = mspringi_alloc(memory, tiles->pin_edge_capacity, sizeof *tiles->pin_edges);
    if (!tiles->of_slot || !tiles->parent || !tiles->first_of_cell || !tiles->dirty || !tiles->is_dirty ||
        !tiles->parts || !tiles->parts_by_slot || !tiles->first_by_slot || !tiles->first_part || !tiles->pin_edges)
        return no_memory(m);
    for (size_t slot = 0; slot < slots; ++slot)
        tiles->of_slot[slot] = MSPRING_NONE;
    return MSPRING_OK;
}

static mspring_result list_inner_anchors(mspringi_tile_builder *m, uint32_t first, uint32_t end) {
    add_inner_anchors(m->tiles, m->network, first, end);
    return MSPRING_OK;
}

static mspring_result list_other_anchors(mspringi_tile_builder *m) {
    add_other_anchors(m->tiles, m->network);
    return MSPRING_OK;
}

// The first cell whose list of slots begins there or behind.
static uint32_t cell_from(const mspringi_cells *cells, uint32_t at) {
    if (at >= cells->first_slot[cells->count])
        return cells->count;
    const uint32_t cell = cells->of_slot[cells->slots[at]];
    return cells->first_slot[cell] < at ? cell + 1 : cell;
}

static mspring_result find_all_components(mspringi_tile_builder *m, uint32_t first, uint32_t end) {
    const uint32_t end_cell = cell_from(&m->tiles->cells, end);
    for (uint32_t cell = cell_from(&m->tiles->cells, first); cell < end_cell; ++cell)
        find_components(m->tiles, m->network, cell);
    return MSPRING_OK;
}

static mspring_result number_some(mspringi_tile_builder *m, uint32_t first, uint32_t end) {
    const mspringi_cells *cells = &m->tiles->cells;
    number_tiles(m->tiles, m->network, cell_from(cells, first), cell_from(cells, end), m->most);
    return MSPRING_OK;
}

// If they do not fit, they are numbered again.
static mspring_result judge_number(mspringi_tile_builder *m) {
    m->most = next_most(m->tiles, m->most);
    m->cursor.again = m->most > 0;
    m->cursor.pass -= m->cursor.again;
    return MSPRING_OK;
}

static mspring_result list_all_parts(mspringi_tile_builder *m, uint32_t first, uint32_t end) {
    list_parts(m->tiles, cell_from(&m->tiles->cells, first), cell_from(&m->tiles->cells, end));
    return MSPRING_OK;
}

static mspring_result add_lengths(mspringi_tile_builder *m, uint32_t first, uint32_t end) {
    for (mspring_id s = first; s < end; ++s) {
        if (!mspringi_spring_exists(m->network, s))
            continue;
        const float rest_length = mspringi_spring_get(m->network, s).rest_length;
        m->length += (double)mspringi_read_length(rest_length);
        m->counted += rest_length != MSPRINGI_WELD;
    }
    return MSPRING_OK;
}

// Each body turns as if it were at least about as large as a spring.
static mspring_result finish(mspringi_tile_builder *m) {
    const size_t slots = mspringi_slot_count(m->network);
    const double mean = m->counted > 0 ? m->length / (double)m->counted : 1.0;
    sort_parts(m->tiles, slots);
    mspringi_tiles_set_inertia(m->tiles, (float)(0.02 * mean * mean), slots);
    return MSPRING_OK;
}

static uint32_t inner_of(const mspringi_tile_builder *m) {
    return m->tiles->cells.first_inner[m->tiles->cells.count];
}

static uint32_t slots_of(const mspringi_tile_builder *m) {
    return m->tiles->cells.first_slot[m->tiles->cells.count];
}

static uint32_t springs_of(const mspringi_tile_builder *m) {
    return m->network->topology.spring_count;
}

MSPRINGI_PASSES(tiles, mspringi_tile_builder)
static const tiles_pass tiles_passes[] = {
    MSPRINGI_ONCE(cut_cells),
    MSPRINGI_ONCE(reserve),
    MSPRINGI_EACH(list_inner_anchors, inner_of, 32000),
    MSPRINGI_ONCE(list_other_anchors),
    MSPRINGI_EACH(find_all_components, slots_of, 8000),
    MSPRINGI_EACH(number_some, slots_of, 8000),
    MSPRINGI_ONCE(judge_number),
    MSPRINGI_EACH(list_all_parts, slots_of, 16000),
    MSPRINGI_EACH(add_lengths, springs_of, 32000),
    MSPRINGI_ONCE(finish),
};

void mspringi_tiles_begin(mspringi_tile_builder *m, mspringi_tiles *tiles, const mspring_network *network,
                          const mspringi_paths *paths, uint32_t size, double most_cost, mspringi_memory *memory,
                          mspringi_message *message) {
    *tiles = (mspringi_tiles){.paths = paths};
    *m = (mspringi_tile_builder){
        .network = network, .memory = memory, .message = message, .tiles = tiles, .most = UINT32_MAX};
    mspringi_cells_begin(&m->cutting, &tiles->cells, network, paths, size, most_cost, memory, message);
}

mspring_result mspringi_tiles_run(mspringi_tile_builder *m, bool *is_done) {
    const mspring_result result = tiles_run(m, tiles_passes, &m->cursor);
    *is_done = m->cursor.pass == MSPRINGI_PASS_COUNT(tiles_passes);
    return result;
}

void mspringi_tiles_end(mspringi_tile_builder *m) {
    mspringi_cells_end(&m->cutting);
}

void mspringi_tiles_set_inertia(mspringi_tiles *tiles, float turn_inertia, size_t slots) {
    tiles->turn_inertia = turn_inertia;
    take_fingerprint(tiles, slots);
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_tiles, member, MSPRINGI_ARRAY)
static const mspringi_array_entry columns[] = {
    ARRAY(first_part),    ARRAY(parts),  ARRAY(parts_by_slot), ARRAY(first_by_slot), ARRAY(of_slot),
    ARRAY(first_of_cell), ARRAY(parent), ARRAY(pin_edges),     ARRAY(dirty),         ARRAY(is_dirty),
};
const mspringi_array_table mspringi_tiles_columns = MSPRINGI_ARRAY_TABLE(columns);

void mspringi_tiles_destroy(mspringi_tiles *tiles, mspringi_memory *memory) {
    mspringi_cells_destroy(&tiles->cells, memory);
    mspringi_array_table_free(mspringi_tiles_columns, tiles, memory);
    *tiles = (mspringi_tiles){0};
}
