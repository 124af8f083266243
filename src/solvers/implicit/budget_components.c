/// Components of the energy budget, and blocks that lie in a single one.
#include <string.h>

#include "solvers/implicit/energy_budget.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"
#include "store/roots.h"

mspring_result mspringi_budget_create(mspringi_budget *budget, mspring_network *network) {
    mspringi_memory *memory = &network->memory;
    const size_t slots = mspringi_slot_count(network), blocks = network->topology.block_count;
    *budget = (mspringi_budget){0};
    budget->components = mspringi_alloc_unset(memory, slots / 2 + 1, sizeof *budget->components);
    budget->of_slot = mspringi_alloc(memory, slots, sizeof *budget->of_slot);
    budget->of_block = mspringi_alloc(memory, blocks, sizeof *budget->of_block);
    budget->of_springs = mspringi_alloc(memory, blocks, sizeof *budget->of_springs);
    budget->pins = mspringi_alloc(memory, slots, sizeof *budget->pins);
    budget->state = mspringi_alloc(memory, mspringi_state_arrays(network) * slots, sizeof *budget->state);
    budget->impulse.x = mspringi_alloc(memory, 2 * slots, sizeof *budget->impulse.x);
    budget->runs = mspringi_alloc(memory, blocks, sizeof *budget->runs);
    budget->elastic = mspringi_alloc(memory, blocks, sizeof *budget->elastic);
    if (!budget->components || !budget->of_slot || !budget->of_block || !budget->of_springs || !budget->pins ||
        !budget->state || !budget->impulse.x || !budget->runs || !budget->elastic) {
        mspringi_budget_destroy(budget, memory);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the energy of %u particles",
                             (unsigned)network->topology.particle_count);
    }
    budget->impulse.y = budget->impulse.x + slots;
    return MSPRING_OK;
}

void mspringi_budget_clear(const mspringi_budget *budget, uint32_t first, uint32_t end) {
    memset(budget->components + first, 0, (end - first) * sizeof *budget->components);
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_budget, member, MSPRINGI_ARRAY)
#define VIEW(member) MSPRINGI_ARRAY_ENTRY(mspringi_budget, member, MSPRINGI_VIEW)
static const mspringi_array_entry columns[] = {
    ARRAY(components), ARRAY(of_slot),   ARRAY(of_block), ARRAY(of_springs), ARRAY(pins),
    ARRAY(state),      ARRAY(impulse.x), VIEW(impulse.y), ARRAY(runs),       ARRAY(elastic),
};
const mspringi_array_table mspringi_budget_columns = MSPRINGI_ARRAY_TABLE(columns);

void mspringi_budget_destroy(mspringi_budget *budget, mspringi_memory *memory) {
    mspringi_array_table_free(mspringi_budget_columns, budget, memory);
    *budget = (mspringi_budget){0};
}

// Number the components in the order of their lowest slots. Until it has its number, a lowest slot is marked.
static void number_components(const mspring_network *network, mspringi_budget *budget) {
    const uint32_t slots = (uint32_t)mspringi_slot_count(network), mark = UINT32_C(1) << 31;
    uint32_t *of_slot = budget->of_slot, count = 0;
    mspringi_find_roots(network, of_slot);
    for (uint32_t slot = 0; slot < slots; ++slot)
        if ((of_slot[slot] & ~mark) != slot)
            of_slot[of_slot[slot]] |= mark;
    for (uint32_t slot = 0; slot < slots; ++slot) {
        if (of_slot[slot] & mark) {
            budget->components[count].first_slot = slot;
            of_slot[slot] = count++;
        } else {
            of_slot[slot] = of_slot[slot] == slot ? MSPRINGI_NO_COMPONENT : of_slot[of_slot[slot]];
        }
    }
    budget->count = count;
}

// Among the slots before the loose row.
static bool find_alone(const mspring_network *network, const mspringi_budget *budget) {
    const size_t end = (size_t)network->topology.loose_first * MSPRINGI_WIDTH;
    for (size_t slot = 0; slot < end; ++slot)
        if (mspringi_budget_is_isolated(budget, slot) && network->topology.particle_of_slot[slot] != MSPRING_NONE)
            return true;
    return false;
}

// Component of all particles of a block, or MSPRINGI_SEVERAL_COMPONENTS.
static uint32_t component_of_block(const mspring_network *network, const mspringi_budget *budget, size_t block) {
    uint32_t account = MSPRINGI_NO_COMPONENT;
    bool any = false;
    for (size_t slot = block * MSPRINGI_WIDTH; slot < (block + 1) * MSPRINGI_WIDTH; ++slot) {
        if (network->topology.particle_of_slot[slot] == MSPRING_NONE)
            continue;
        if (any && budget->of_slot[slot] != account)
            return MSPRINGI_SEVERAL_COMPONENTS;
        account = budget->of_slot[slot];
        any = true;
    }
    return account;
}

// The springs of a row's block begin or end at its slots, but for one that leads from the block above to the next.
static uint32_t component_of_springs(const mspring_network *network, const mspringi_budget *budget, size_t block) {
    const mspringi_topology *t = &network->topology;
    const uint32_t account = budget->of_block[block];
    if (block < t->lattice_first || block >= (size_t)t->lattice_first + t->lattice_blocks)
        return account;
    const uint16_t *live = network->live + (block - t->lattice_first) * MSPRINGI_DIRECTIONS;
    const bool leads_on = live[MSPRINGI_SOUTH_EAST] >> (MSPRINGI_WIDTH - 1) & 1;
    return leads_on && budget->of_slot[(block + 1) * MSPRINGI_WIDTH] != account ? MSPRINGI_SEVERAL_COMPONENTS
                                                                                : account;
}

static void list_pins(const mspring_network *network, mspringi_budget *budget) {
    const size_t slots = mspringi_slot_count(network);
    for (uint32_t i = 0; i < budget->count; ++i)
        budget->components[i].is_pinned = false;
    budget->pin_count = 0;
    for (size_t slot = 0; slot < slots; ++slot) {
        if (budget->of_slot[slot] == MSPRINGI_NO_COMPONENT || network->inverse_mass[slot] > 0.0f)
            continue;
        budget->components[budget->of_slot[slot]].is_pinned = true;
        budget->pins[budget->pin_count++] = (uint32_t)slot;
    }
}

void mspringi_budget_update(mspring_network *network) {
    mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_edits *edits = &network->edits;
    const bool same = budget->is_known && budget->links == edits->links && budget->growth == edits->growth;
    if (same && budget->masses == edits->masses)
        return;
    if (!same) {
        number_components(network, budget);
        budget->has_isolated = find_alone(network, budget);
        for (size_t block = 0; block < network->topology.block_count; ++block)
            budget->of_block[block] = component_of_block(network, budget, block);
        for (size_t block = 0; block < network->topology.block_count; ++block)
            budget->of_springs[block] = component_of_springs(network, budget, block);
    }
    list_pins(network, budget);
    budget->is_known = true;
    budget->links = edits->links;
    budget->growth = edits->growth;
    budget->masses = edits->masses;
}

void mspringi_budget_find_frames(const mspring_network *network) {
    (void)network; // a build may have no such feature
#define SYSTEM(name) mspringi_##name##_find_frames(network);
#include "store/features.def"
}
