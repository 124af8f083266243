/// Room for pairs and constraints of contact: at first by the size of the outline, later what steps lack.
#include "base/assert.h"
#include "features/contact/contacts.h"
#include "store/feature.h"

/// Room for pairs at first: for each particle, for each particle of the outline, and a constant. (Wrecks have 2 to
/// 4 for a particle of the outline; soft discs that fall at 25 m/s with one or two substeps a step have 45.)
#define PAIRS_OF_PARTICLE 2
#define PAIRS_OF_OUTLINE 16
#define PAIRS_BESIDES 4096

/// The room at first times these is the most, unless the host gives another. Bodies that fall onto a heap in one
/// long substep a step are near many others: 60 bars of 12 x 3 at 36 m/s, implicit at 60 Hz, have 90 pairs for a
/// particle of the outline. Crowds that need more constraints would take seconds a step. (30 lattices of 5 x 5 that
/// begin in the same place took six.)
#define TIMES_USUAL 16
#define TIMES_TOUCHING 4

/// Room for pairs of each collider point.
#define PAIRS_OF_POINT 8

/// Room for constraints: pairs for each of them, and a constant.
#define PAIRS_OF_CONSTRAINT 8
#define CONSTRAINTS_BESIDES 1024

static bool has_implicit_contact_solver(const mspring_network *network) {
    const mspringi_solver_ops *fallback = network->fallback.ops;
    return network->solver.ops->has_implicit_contact || (fallback && fallback->has_implicit_contact);
}

static bool reserve_implicit_constraints(mspringi_contacts *contacts, mspringi_memory *memory) {
    if (!contacts->implicit_constraints)
        contacts->implicit_constraints =
            mspringi_alloc(memory, contacts->constraint_capacity, sizeof *contacts->implicit_constraints);
    return contacts->implicit_constraints != NULL;
}

// Room by the size of the outline, and of what it may become.
static uint64_t usual_pairs(const mspringi_contacts *contacts) {
    const uint32_t own = contacts->outline.point_count - contacts->colliders.listed_points;
    return PAIRS_OF_OUTLINE * (uint64_t)own + PAIRS_OF_PARTICLE * (uint64_t)contacts->particles + PAIRS_BESIDES;
}

// The most pairs: what the host allows, or that many times the usual ones.
static uint32_t most_of(const mspringi_contacts *contacts, uint32_t times) {
    const mspring_contact_def *def = &contacts->def;
    const uint64_t by_outline = times * usual_pairs(contacts);
    const uint64_t most = by_outline > def->capacity ? by_outline : def->capacity;
    return def->max_capacity > 0        ? def->max_capacity
           : most < MSPRINGI_MOST_PAIRS ? (uint32_t)most
                                        : MSPRINGI_MOST_PAIRS;
}

uint32_t mspringi_contacts_most_pairs(const mspringi_contacts *contacts) {
    return most_of(contacts, TIMES_USUAL);
}

static uint32_t constraints_for(const mspringi_contacts *contacts, uint32_t pairs) {
    const uint32_t most = most_of(contacts, TIMES_TOUCHING) + PAIRS_OF_POINT * contacts->colliders.point_capacity;
    return (pairs < most ? pairs : most) / PAIRS_OF_CONSTRAINT + CONSTRAINTS_BESIDES;
}

// Reserve pairs. Constraints are fewer: most pairs do not touch.
static bool reserve_pairs(mspringi_contacts *made, mspringi_memory *memory) {
    const uint64_t usual = usual_pairs(made);
    const uint32_t most = mspringi_contacts_most_pairs(made);
    if (made->def.capacity == 0)
        made->def.capacity = usual < most ? (uint32_t)usual : most;
    made->capacity = made->def.capacity + PAIRS_OF_POINT * made->colliders.point_capacity;
    const uint32_t constraints = constraints_for(made, made->capacity);
    made->constraint_capacity = constraints < made->capacity ? constraints : made->capacity;
    made->list = mspringi_alloc(memory, made->capacity, sizeof *made->list);
    made->candidates = mspringi_alloc(memory, made->capacity, sizeof *made->candidates);
    made->is_seen = mspringi_alloc(memory, made->capacity, sizeof *made->is_seen);
    made->near_misses = mspringi_alloc(memory, made->capacity, sizeof *made->near_misses);
    made->constraints = mspringi_alloc(memory, made->constraint_capacity, sizeof *made->constraints);
    made->pending = mspringi_alloc(memory, made->constraint_capacity, sizeof *made->pending);
    made->due.is_due = mspringi_alloc(memory, (size_t)made->constraint_capacity + 8, sizeof *made->due.is_due);
    made->due.next = mspringi_alloc(memory, (size_t)3 * made->constraint_capacity, sizeof *made->due.next);
    return made->list && made->candidates && made->constraints && made->pending && made->is_seen &&
           made->near_misses && made->due.is_due && made->due.next;
}

// Reserve constraints of linear systems.
static bool reserve_constraints(mspring_network *network, const mspringi_contacts *contacts) {
    return mspringi_constraints_reserve(network, MSPRINGI_CONTACT_CONSTRAINT,
                                        (size_t)2 * contacts->constraint_capacity,
                                        (size_t)6 * contacts->constraint_capacity);
}

bool mspringi_contacts_reserve_room(mspring_network *network, mspringi_contacts *made) {
    mspringi_memory *memory = &network->memory;
    return reserve_pairs(made, memory) &&
           (!has_implicit_contact_solver(network) || reserve_implicit_constraints(made, memory)) &&
           reserve_constraints(network, made);
}

// Drop the lists that grow, of which another copy of the struct has the pointers.
static void drop_lists(mspringi_contacts *contacts) {
    contacts->list = NULL;
    contacts->candidates = NULL;
    contacts->is_seen = NULL;
    contacts->near_misses = NULL;
    contacts->constraints = NULL;
    contacts->pending = NULL;
    contacts->due.is_due = NULL;
    contacts->due.next = NULL;
    contacts->implicit_constraints = NULL;
}

static void free_lists(const mspringi_contacts *contacts, mspringi_memory *memory) {
    mspringi_free(memory, contacts->list);
    mspringi_free(memory, contacts->candidates);
    mspringi_free(memory, contacts->is_seen);
    mspringi_free(memory, contacts->near_misses);
    mspringi_free(memory, contacts->constraints);
    mspringi_free(memory, contacts->pending);
    mspringi_free(memory, contacts->due.is_due);
    mspringi_free(memory, contacts->due.next);
    mspringi_free(memory, contacts->implicit_constraints);
}

// True if the step was rejected for lack of room that there may be.
static bool may_grow(const mspringi_contacts *contacts) {
    if (contacts->def.capacity >= mspringi_contacts_most_pairs(contacts))
        return false;
    return contacts->rejection == MSPRINGI_CONTACT_LACKS_PAIRS ||
           (contacts->rejection == MSPRINGI_CONTACT_LACKS_CONSTRAINTS &&
            contacts->constraint_capacity < constraints_for(contacts, UINT32_MAX));
}

mspring_result mspringi_contact_grow(mspring_network *network) {
    mspringi_contacts *contacts = network->contacts;
    if (!contacts || !may_grow(contacts))
        return MSPRING_ERROR_LIMIT;
    mspringi_memory *memory = &network->memory;
    mspringi_contacts grown = *contacts;
    drop_lists(&grown);
    const uint32_t most = mspringi_contacts_most_pairs(contacts);
    grown.def.capacity = contacts->def.capacity < most / 2 ? 2 * contacts->def.capacity : most;
    if (!mspringi_contacts_reserve_room(network, &grown)) {
        free_lists(&grown, memory);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for %u pairs of an outline point and an outline edge that are near each "
                             "other: use less thickness, or free memory",
                             (unsigned)grown.def.capacity);
    }
    MSPRINGI_ASSERT(grown.capacity > contacts->capacity ||
                    grown.constraint_capacity > contacts->constraint_capacity);
    free_lists(contacts, memory);
    *contacts = grown;
    contacts->count = contacts->candidate_count = 0;
    contacts->is_listed = contacts->is_fresh = false;
    return MSPRING_OK;
}

mspring_result mspringi_contacts_reserve_implicit(mspring_network *network) {
    if (!network->contacts || reserve_implicit_constraints(network->contacts, &network->memory))
        return MSPRING_OK;
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for contact in the solver's system");
}
