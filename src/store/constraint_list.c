#include "store/constraint_list.h"

#include "store/network.h"

bool mspringi_constraints_allocate(mspring_network *network) {
    mspringi_constraints *all = &network->constraints;
    void *list = all->list, *entries = all->entries, *multipliers = all->multipliers, *active = all->active;
    // Other kinds have one particle each: see mspringi_constraint_is_unknown().
    const size_t unknowns = all->reserved[MSPRINGI_ANGLE_CONSTRAINT] + all->reserved[MSPRINGI_CONTACT_CONSTRAINT];
    size_t count = 0, entry_count = 0;
    for (int kind = 0; kind < MSPRINGI_CONSTRAINT_KINDS; ++kind) {
        count += all->reserved[kind];
        entry_count += all->reserved_entries[kind];
    }
    bool whole = mspringi_grow(&network->memory, &list, &all->capacity, count, sizeof *all->list);
    all->list = list;
    whole =
        whole && mspringi_grow(&network->memory, &entries, &all->entry_capacity, entry_count, sizeof *all->entries);
    all->entries = entries;
    whole = whole && mspringi_grow(&network->memory, &multipliers, &all->multiplier_capacity, unknowns,
                                   sizeof *all->multipliers);
    all->multipliers = multipliers;
    whole = whole && mspringi_grow(&network->memory, &active, &all->active_capacity, count, sizeof *all->active);
    all->active = active;
    return whole;
}

bool mspringi_constraints_reserve(mspring_network *network, mspringi_constraint_kind kind, size_t count,
                                  size_t entries) {
    mspringi_constraints *all = &network->constraints;
    const mspringi_solver_ops *solver = network->solver.ops, *fallback = network->fallback.ops;
    // Solvers with a linear system are those that have grips in it.
    const bool has_system = (solver && solver->has_implicit_grips) || (fallback && fallback->has_implicit_grips);
    const size_t had = all->reserved[kind], had_entries = all->reserved_entries[kind];
    all->reserved[kind] = count > had ? count : had;
    all->reserved_entries[kind] = entries > had_entries ? entries : had_entries;
    if (!has_system || mspringi_constraints_allocate(network))
        return true;
    all->reserved[kind] = had;
    all->reserved_entries[kind] = had_entries;
    return false;
}

void mspringi_constraints_begin(mspringi_constraints *all) {
    all->count = all->entry_count = all->active_count = all->element_count = all->element_entry_count = 0;
    all->has_elements = false;
}

mspringi_constraint *mspringi_constraint_add(mspringi_constraints *all, mspringi_constraint_kind kind,
                                             uint32_t source, uint32_t entries) {
    MSPRINGI_ASSERT(all->count < all->capacity && entries <= all->entry_capacity - all->entry_count);
    (void)entries;
    mspringi_constraint *c = &all->list[all->count++];
    *c = (mspringi_constraint){
        .first = all->entry_count, .source = source, .kind = (uint8_t)kind, .activity = MSPRINGI_STIFF};
    return c;
}

const mspringi_constraint *mspringi_next_floor_push(const mspringi_constraints *all,
                                                    const mspringi_constraint *after) {
    if (all->count == all->element_count)
        return NULL;
    const mspringi_constraint *c = after ? after + 1 : all->list + all->element_count;
    while (c < all->list + all->count &&
           (c->kind != MSPRINGI_FLOOR_CONSTRAINT || c->bounded != MSPRINGI_BOUND_PUSH))
        ++c;
    return c < all->list + all->count ? c : NULL;
}
