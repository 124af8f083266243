/// Snapshot of added and removed ids: existing ids, slots of spare ones, and ends of added springs.
#include <string.h>

#include "base/bytes.h"
#include "features/breaking/breaking.h"
#include "layout/analysis.h"
#include "layout/emit/spare.h"
#include "store/changed.h"
#include "store/fractions.h"
#include "store/id_pool.h"
#include "store/sections.h"
#include "store/springs.h"

/// Flags of a spare spring.
enum { IS_RELATIVE = 1, IS_LAID_OUT = 2 };

/// Pointers to the parts of the section.
typedef struct growth {
    uint32_t particle_count, spring_count;
    const uint8_t *particles, *springs; ///< marks of all ids
    const uint8_t *slots;               ///< [spare particles] IS_LAID_OUT, or 0: in its reserved slot
    const uint8_t *kinds;               ///< [spare springs] IS_RELATIVE, IS_LAID_OUT
    const uint8_t *ends;                ///< [2 * spare springs] ids of particles
} growth;

static size_t size_of(const mspringi_topology *t) {
    return 8 + (size_t)t->reserve.particle_end + t->reserve.spring_end + mspringi_spare_particles(t) +
           (size_t)9 * mspringi_spare_springs(t);
}

// Without spare ids the section is needed once an id has been removed.
static size_t growth_size(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const uint8_t *particles = network->growth.particles, *springs = network->growth.springs;
    const mspringi_reserve *r = &t->reserve;
    if (!particles)
        return 0;
    const bool has_spare = mspringi_spare_particles(t) + mspringi_spare_springs(t) > 0;
    return has_spare || mspringi_find_byte(particles, MSPRINGI_GONE, 0, r->particle_end) < r->particle_end ||
                   mspringi_find_byte(springs, MSPRINGI_GONE, 0, r->spring_end) < r->spring_end
               ? size_of(t)
               : 0;
}

static bool particle_is_laid_out(const mspringi_topology *t, mspring_id p) {
    return t->slot_of_particle[p] != mspringi_spare_slot(t, p);
}

static bool spring_is_laid_out(const mspringi_topology *t, mspring_id s) {
    return mspringi_slot_of_spring(t, s) != mspringi_spare_spring_slot(t, s);
}

static void growth_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_topology *t = &network->topology;
    const mspringi_id_pool *g = &network->growth;
    mspringi_put(to, &t->particle_count, 1, sizeof t->particle_count);
    mspringi_put(to, &t->spring_count, 1, sizeof t->spring_count);
    mspringi_put(to, g->particles, t->reserve.particle_end, 1);
    mspringi_put(to, g->springs, t->reserve.spring_end, 1);
    for (mspring_id p = t->reserve.first_particle; p < t->reserve.particle_end; ++p) {
        const uint8_t slot = particle_is_laid_out(t, p) ? IS_LAID_OUT : 0;
        mspringi_put(to, &slot, 1, 1);
    }
    for (mspring_id s = t->reserve.first_spring; s < t->reserve.spring_end; ++s) {
        const bool is_relative = mspringi_spring_exists(network, s) && mspringi_spring_is_relative(network, s);
        const uint8_t kind =
            (uint8_t)((is_relative ? IS_RELATIVE : 0) | (spring_is_laid_out(t, s) ? IS_LAID_OUT : 0));
        mspringi_put(to, &kind, 1, 1);
    }
    for (mspring_id s = t->reserve.first_spring; s < t->reserve.spring_end; ++s) {
        const mspring_id nobody[2] = {0, 0};
        const uint32_t first = 2 * (s - t->reserve.first_spring);
        mspringi_put(to, g->springs[s] == MSPRINGI_THERE ? &g->particle_of_end[first] : nobody, 2, sizeof *nobody);
    }
}

static growth read_growth(const mspringi_topology *t, const uint8_t *from) {
    growth g;
    from = mspringi_get(from, &g.particle_count, 1, sizeof g.particle_count);
    g.particles = mspringi_get(from, &g.spring_count, 1, sizeof g.spring_count);
    g.springs = g.particles + t->reserve.particle_end;
    g.slots = g.springs + t->reserve.spring_end;
    g.kinds = g.slots + mspringi_spare_particles(t);
    g.ends = g.kinds + mspringi_spare_springs(t);
    return g;
}

static mspring_id end_of(const growth *g, uint32_t end) {
    mspring_id particle;
    mspringi_get(g->ends + (size_t)4 * end, &particle, 1, sizeof particle);
    return particle;
}

/* ----------------------------------------------------------------------------------------------------- checking */

static bool marks_are_right(const uint8_t *marks, uint32_t first, uint32_t count, uint32_t end) {
    for (uint32_t i = 0; i < end; ++i)
        if (marks[i] > MSPRINGI_SPARE || (i < first && marks[i] == MSPRINGI_SPARE) ||
            (i >= count && marks[i] != MSPRINGI_SPARE))
            return false;
    return count >= first && count <= end;
}

static mspring_result check_particle(mspring_network *network, const growth *g, mspring_id p) {
    const mspringi_topology *t = &network->topology;
    const mspringi_section *section = &mspringi_section_growth;
    const bool is_spare = p >= t->reserve.first_particle;
    const uint32_t i = p - t->reserve.first_particle;
    if (is_spare && g->slots[i] != 0 &&
        (g->slots[i] != IS_LAID_OUT || t->initial_slots[i] == mspringi_spare_slot(t, p)))
        return mspringi_section_fail(network, section, "particle %u lies where it cannot", (unsigned)p);
    // A compact layout may leave out particles.
    if (g->particles[p] == MSPRINGI_THERE && !is_spare && t->slot_of_particle[p] < MSPRINGI_WIDTH)
        return mspringi_section_fail(network, section, "particle %u is there, which the plan leaves out",
                                     (unsigned)p);
    if (g->particles[p] == MSPRINGI_THERE)
        return MSPRING_OK;
    for (uint32_t j = network->incidence.first[p]; j < network->incidence.first[p + 1]; ++j)
        if (g->springs[network->incidence.springs[j]] == MSPRINGI_THERE)
            return mspringi_section_fail(network, section, "spring %u is there without particle %u",
                                         (unsigned)network->incidence.springs[j], (unsigned)p);
    return MSPRING_OK;
}

static uint32_t slot_in(const mspringi_topology *t, const growth *g, mspring_id p) {
    const uint32_t i = p - t->reserve.first_particle;
    return p < t->reserve.first_particle ? t->slot_of_particle[p]
           : g->slots[i]                 ? t->initial_slots[i]
                                         : mspringi_spare_slot(t, p);
}

static mspring_result check_spring(mspring_network *network, const growth *g, mspring_id s) {
    const mspringi_topology *t = &network->topology;
    const uint32_t i = s - t->reserve.first_spring;
    const mspring_id a = end_of(g, 2 * i), b = end_of(g, 2 * i + 1);
    if (g->kinds[i] > (IS_RELATIVE | IS_LAID_OUT) || (g->kinds[i] & IS_RELATIVE && !network->fractions.values) ||
        (g->kinds[i] & IS_LAID_OUT && t->initial_spring_slots[i] == mspringi_spare_spring_slot(t, s)))
        return mspringi_section_fail(network, &mspringi_section_growth, "spring %u is of kind %u", (unsigned)s,
                                     (unsigned)g->kinds[i]);
    if (g->springs[s] != MSPRINGI_THERE)
        return MSPRING_OK;
    bool fits = a < g->particle_count && b < g->particle_count && a != b;
    fits = fits && g->particles[a] == MSPRINGI_THERE && g->particles[b] == MSPRINGI_THERE;
    if (fits && g->kinds[i] & IS_LAID_OUT) {
        uint32_t base, tip;
        mspringi_topology_ends(t, t->initial_spring_slots[i], &base, &tip);
        const uint32_t slot_a = slot_in(t, g, a), slot_b = slot_in(t, g, b);
        fits = (slot_a == base && slot_b == tip) || (slot_a == tip && slot_b == base);
    }
    return fits ? MSPRING_OK
                : mspringi_section_fail(network, &mspringi_section_growth, "spring %u joins particles %s and %s",
                                        (unsigned)s, MSPRINGI_ID(a), MSPRINGI_ID(b));
}

// A snapshot without this section has all particles. Return an error if a compact layout leaves one out.
static mspring_result check_none_is_left_out(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    for (mspring_id p = 0; network->growth.particles && p < t->particle_count; ++p)
        if (t->slot_of_particle[p] < MSPRINGI_WIDTH)
            return mspringi_section_fail(network, &mspringi_section_growth,
                                         "particle %u is there, which the plan leaves out", (unsigned)p);
    return MSPRING_OK;
}

// True if an added spring keeps its ends, or is absent both now and in the snapshot.
static bool stays(const mspring_network *network, const growth *g, mspring_id s) {
    const mspringi_topology *t = &network->topology;
    const uint32_t i = s - t->reserve.first_spring;
    const bool there = g->springs[s] == MSPRINGI_THERE, is_there = mspringi_spring_exists(network, s);
    if (!there && !is_there)
        return true;
    return there && is_there && !(g->kinds[i] & IS_LAID_OUT) == !spring_is_laid_out(t, s) &&
           end_of(g, 2 * i) == network->growth.particle_of_end[2 * i] &&
           end_of(g, 2 * i + 1) == network->growth.particle_of_end[2 * i + 1];
}

static mspring_result growth_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_growth;
    const mspringi_topology *t = &network->topology;
    mspring_result result = MSPRING_OK;
    if (size == 0 &&
        t->reserve.particle_end + t->reserve.spring_end > t->reserve.first_particle + t->reserve.first_spring)
        return mspringi_section_check_size(network, section, size, size_of(t));
    if (size == 0)
        return check_none_is_left_out(network);
    result = mspringi_section_check_size(network, section, size, size_of(t));
    if (result == MSPRING_OK)
        result = mspringi_id_pool_reserve(network);
    if (result == MSPRING_OK)
        result = mspringi_breaking_reserve(network);
    if (result != MSPRING_OK)
        return result;
    const growth g = read_growth(t, from);
    if (!marks_are_right(g.particles, t->reserve.first_particle, g.particle_count, t->reserve.particle_end) ||
        !marks_are_right(g.springs, t->reserve.first_spring, g.spring_count, t->reserve.spring_end))
        return mspringi_section_fail(network, section, "they count %u particles and %u springs",
                                     (unsigned)g.particle_count, (unsigned)g.spring_count);
    for (mspring_id p = 0; result == MSPRING_OK && p < t->reserve.particle_end; ++p)
        result = check_particle(network, &g, p);
    for (mspring_id s = t->reserve.first_spring; result == MSPRING_OK && s < t->reserve.spring_end; ++s) {
        result = check_spring(network, &g, s);
        if (result == MSPRING_OK && !network->solver.ops->can_add && !stays(network, &g, s))
            result = mspringi_section_fail(network, section,
                                           "spring %u is another one, for which the direct solver "
                                           "would have to be chosen anew",
                                           (unsigned)s);
    }
    return result;
}

/* ----------------------------------------------------------------------------------------------------- loading */

static bool is_put(const mspringi_topology *t, mspring_id p, uint32_t slot) {
    return t->slot_of_particle[p] == slot && t->particle_of_slot[slot] == p;
}

static void put(mspringi_topology *t, mspring_id p, uint32_t slot, bool is_there) {
    t->slot_of_particle[p] = slot;
    if (is_there)
        t->particle_of_slot[slot] = p;
}

// Load the slot of a particle; other sections have its values. In the layout before a compaction, spare particles
// are in their reserved slots.
static void load_particle(mspring_network *network, const growth *g, mspring_id p) {
    mspringi_topology *t = &network->topology, *whole = &network->whole;
    const bool is_spare = p >= t->reserve.first_particle, is_there = g->particles[p] == MSPRINGI_THERE;
    const uint32_t slot = slot_in(t, g, p);
    if (mspringi_particle_exists(network, p) && !(is_there && is_put(t, p, slot)))
        mspringi_id_pool_take_particle(network, p);
    put(t, p, slot, is_there);
    if (network->is_compact)
        put(whole, p, is_spare ? mspringi_spare_slot(whole, p) : whole->slot_of_particle[p], is_there);
    network->growth.particles[p] = g->particles[p];
}

// Remove a spring that is absent in the snapshot, or differs from it.
static void unload_spring(mspring_network *network, const growth *g, mspring_id s) {
    const mspringi_topology *t = &network->topology;
    if (!mspringi_spring_exists(network, s) || stays(network, g, s))
        return;
    (void)mspringi_spring_break(network, s);
    mspringi_id_pool_unlink(network, s);
    network->growth.springs[s] = MSPRINGI_GONE;
    mspringi_solvers_clear_spring(network, mspringi_slot_of_spring(t, s));
}

// Add a spring of the snapshot, broken and without values as yet.
static void load_spring(mspring_network *network, const growth *g, mspring_id s) {
    mspringi_topology *t = &network->topology;
    const uint32_t i = s - t->reserve.first_spring;
    const mspring_id a = end_of(g, 2 * i), b = end_of(g, 2 * i + 1);
    const bool is_new = g->springs[s] == MSPRINGI_THERE && !mspringi_spring_exists(network, s);
    network->growth.springs[s] = g->springs[s];
    if (is_new) {
        mspringi_id_pool_link(network, s, a, b);
        mspringi_spare_add_spring(t, s, a, b);
        if (network->is_compact)
            mspringi_spare_add_spring(&network->whole, s, a, b);
        if (network->fractions.values)
            mspringi_fractions_set(&network->fractions, s,
                                   (mspringi_relative){g->kinds[i] & IS_RELATIVE ? 0.0f : -1.0f, 0.0f});
        network->kept[s] = (mspringi_relative){0.0f, 0.0f};
    }
    t->slot_of_spring[s] =
        g->kinds[i] & IS_LAID_OUT ? t->initial_spring_slots[i] : mspringi_spare_spring_slot(t, s);
}

static mspring_id first_spare(const uint8_t *marks, mspring_id first, mspring_id end) {
    while (first < end && marks[first] != MSPRINGI_SPARE)
        ++first;
    return first;
}

static void load_all(mspring_network *network, const growth *g) {
    const mspringi_reserve *r = &network->topology.reserve;
    for (mspring_id s = r->first_spring; s < r->spring_end; ++s)
        unload_spring(network, g, s);
    for (mspring_id p = 0; p < r->particle_end; ++p)
        load_particle(network, g, p);
    memcpy(network->growth.springs, g->springs, r->first_spring);
    for (mspring_id s = r->first_spring; s < r->spring_end; ++s)
        load_spring(network, g, s);
    network->growth.lowest_particle = first_spare(network->growth.particles, r->first_particle, r->particle_end);
    network->growth.lowest_spring = first_spare(network->growth.springs, r->first_spring, r->spring_end);
    mspringi_id_pool_count(network, g->particle_count, g->spring_count);
    mspringi_notify_change(network, MSPRINGI_CHANGED_GRAFTS, 0);
}

// A snapshot without this section has no spare ids, and nothing was removed.
static void growth_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_topology *t = &network->topology;
    if (!network->growth.particles)
        return;
    if (size > 0) {
        const growth g = read_growth(t, from);
        load_all(network, &g);
        return;
    }
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        put(t, p, t->slot_of_particle[p], true);
        if (network->is_compact)
            put(&network->whole, p, network->whole.slot_of_particle[p], true);
    }
    memset(network->growth.particles, MSPRINGI_THERE, t->particle_count);
    memset(network->growth.springs, MSPRINGI_THERE, t->spring_count);
    mspringi_id_pool_count(network, t->particle_count, t->spring_count);
    mspringi_notify_change(network, MSPRINGI_CHANGED_GRAFTS, 0);
}

/* --------------------------------------------------------------------------------------------- other sections */

bool mspringi_saved_has_particle(const mspringi_saved *saved, mspring_id particle) {
    const mspringi_topology *t = &saved->network->topology;
    return !saved->growth || read_growth(t, saved->growth).particles[particle] == MSPRINGI_THERE;
}

bool mspringi_saved_has_spring(const mspringi_saved *saved, mspring_id spring) {
    const mspringi_topology *t = &saved->network->topology;
    return !saved->growth || read_growth(t, saved->growth).springs[spring] == MSPRINGI_THERE;
}

mspringi_spring_slot mspringi_saved_place(const mspringi_saved *saved, mspring_id spring) {
    const mspringi_topology *t = &saved->network->topology;
    if (spring < t->reserve.first_spring)
        return t->slot_of_spring[spring];
    const uint32_t i = spring - t->reserve.first_spring;
    return read_growth(t, saved->growth).kinds[i] & IS_LAID_OUT ? t->initial_spring_slots[i]
                                                                : mspringi_spare_spring_slot(t, spring);
}

// True if an original spring, broken or not, joins these two.
static bool is_joined(const mspring_network *network, const growth *g, mspring_id a, mspring_id b) {
    const mspringi_topology *t = &network->topology;
    if (a >= t->reserve.first_particle || b >= t->reserve.first_particle)
        return false;
    const uint32_t slot_a = slot_in(t, g, a), slot_b = slot_in(t, g, b);
    for (uint32_t j = network->incidence.first[a]; j < network->incidence.first[a + 1]; ++j) {
        const mspring_id s = network->incidence.springs[j];
        uint32_t base, tip;
        mspringi_topology_ends(t, t->slot_of_spring[s], &base, &tip);
        if (g->springs[s] == MSPRINGI_THERE &&
            ((base == slot_a && tip == slot_b) || (base == slot_b && tip == slot_a)))
            return true;
    }
    return false;
}

// List the added springs by their ends, in *count keys. Returns the first that joins what an original one joins.
static mspring_id list_added(const mspring_network *network, const growth *g, uint64_t *keys, size_t *count) {
    const mspringi_reserve *r = &network->topology.reserve;
    for (mspring_id s = r->first_spring; s < r->spring_end; ++s) {
        const uint32_t i = s - r->first_spring;
        const mspring_id a = end_of(g, 2 * i), b = end_of(g, 2 * i + 1);
        if (g->springs[s] != MSPRINGI_THERE)
            continue;
        if (is_joined(network, g, a, b))
            return s;
        keys[(*count)++] = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    }
    return MSPRING_NONE;
}

// No two springs of which one was added join the same particles. Most often they are the springs that there are.
static mspring_result growth_check_against(mspring_network *network, const mspringi_saved *saved,
                                           const uint8_t *from, size_t size) {
    const mspringi_topology *t = &network->topology;
    const size_t spare = mspringi_spare_springs(t);
    bool same = true;
    (void)saved;
    if (size == 0 || spare == 0)
        return MSPRING_OK;
    const growth g = read_growth(t, from);
    for (mspring_id s = t->reserve.first_spring; same && s < t->reserve.spring_end; ++s)
        same = stays(network, &g, s);
    if (same && memcmp(g.springs, network->growth.springs, t->reserve.first_spring) == 0)
        return MSPRING_OK;
    uint64_t *keys = mspringi_alloc(&network->memory, 2 * spare, sizeof *keys);
    if (!keys)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to compare %zu added springs",
                             spare);
    size_t count = 0, at = 1;
    const mspring_id twice = list_added(network, &g, keys, &count);
    mspringi_sort_keys(keys, keys + spare, count);
    while (at < count && keys[at] != keys[at - 1])
        ++at;
    const uint64_t key = at < count ? keys[at] : 0;
    mspringi_free(&network->memory, keys);
    if (twice != MSPRING_NONE)
        return mspringi_section_fail(network, &mspringi_section_growth, "spring %u joins what another one joins",
                                     (unsigned)twice);
    return at >= count
               ? MSPRING_OK
               : mspringi_section_fail(network, &mspringi_section_growth, "two springs join particles %u and %u",
                                       (unsigned)(key >> 32), (unsigned)(key & UINT32_MAX));
}

const mspringi_section mspringi_section_growth = {"grow",      "added and removed particles and springs",
                                                  false,       growth_size,
                                                  growth_save, growth_check,
                                                  growth_load, growth_check_against};

/* --------------------------------------------------------------------------------------------------- archives */

// Set where the spare ids in use lie.
static void set_places(const mspring_network *network, uint8_t *section, size_t size, bool in_archive) {
    const mspringi_topology *t = &network->topology;
    const size_t slots = size_of(t) - (size_t)9 * mspringi_spare_springs(t) - mspringi_spare_particles(t);
    uint8_t *const of_particle = section + slots, *const of_spring = of_particle + mspringi_spare_particles(t);
    if (size != size_of(t))
        return;
    for (uint32_t i = 0; i < mspringi_spare_particles(t); ++i)
        of_particle[i] = !in_archive && particle_is_laid_out(t, t->reserve.first_particle + i) ? IS_LAID_OUT : 0;
    for (uint32_t i = 0; i < mspringi_spare_springs(t); ++i)
        of_spring[i] =
            (uint8_t)((of_spring[i] & ~IS_LAID_OUT) |
                      (!in_archive && spring_is_laid_out(t, t->reserve.first_spring + i) ? IS_LAID_OUT : 0));
}

static void growth_leave(const mspring_network *network, uint8_t *section, size_t size) {
    set_places(network, section, size, true);
}

static size_t growth_enter(const mspring_network *network, uint8_t *section, size_t size) {
    set_places(network, section, size, false);
    return size;
}

const mspringi_by_id mspringi_by_id_growth = {&mspringi_section_growth, NULL, growth_leave, growth_enter};
