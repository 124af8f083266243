/// Services of the list of constraints: assembly, products, the coarse matrix and the active set.
#include "solvers/constraints/constraint_services.h"

#include <float.h>
#include <math.h>

#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"
#include "store/elements.h"

/// Solutions of a substep that may release constraints or let them slide. Later ones only add constraints or make
/// them stick, so the active set settles.
#define FREE_PASSES 12u
/// Solutions in which each contact counts. In later ones a change of force below the next share of the largest push
/// is worth no further solution: mspringi_implicit_contact_kept_energy() accepts as much of what is wrong. (A heap
/// of 100 fragments at rest took 10 or 11 solutions a substep until the friction of its lightest contacts had
/// settled. With three times the share it came to rest later. With the share in the first solutions, too, a light
/// block stuck to a slope, as a heavy body lay elsewhere; after two of them it slid by 2.5 % too far.)
#define PASSES_OF_ALL 4u
#define NEGLIGIBLE_SHARE 1e-3
/// Change of a friction's bound, as a share of it, that is worth another solution. Other kinds have no friction.
/// (With 0.1 for the floor, friction on each stretch of it was off by 5 %; with 0.02 for bodies, beams on each
/// other took 1.05 to 1.1 times as long.)
static const double settled_share[MSPRINGI_CONSTRAINT_KINDS] = {
    [MSPRINGI_FLOOR_CONSTRAINT] = 0.02,
    [MSPRINGI_CONTACT_CONSTRAINT] = 0.1,
};

typedef mspringi_constraint constraint;
typedef mspringi_jacobian_entry entry;

/* ---------------------------------------------------------------------------------------------------- products */

// Clamp to single precision: the guard rejects values this large. (fmin and fmax are calls.)
static inline float clamped(double value) {
    return value > (double)FLT_MAX ? FLT_MAX : value < -(double)FLT_MAX ? -FLT_MAX : (float)value;
}

// J u; direct_constraints.c has it in double precision. A closed constraint takes differences from its first entry,
// so rigid motion gives exactly 0.
static inline double gather(const constraint *c, const entry *e, mspringi_field from) {
    const uint32_t count = c->count;
    double sum = 0.0;
    if (!c->is_closed) {
        for (uint32_t i = 0; i < count; ++i) {
            sum += e[i].x * (double)from.x[e[i].slot];
            sum += e[i].y * (double)from.y[e[i].slot];
        }
        return sum;
    }
    const double x = (double)from.x[e->slot], y = (double)from.y[e->slot];
    for (uint32_t i = 1; i < count; ++i) {
        sum += e[i].x * ((double)from.x[e[i].slot] - x);
        sum += e[i].y * ((double)from.y[e[i].slot] - y);
    }
    return sum;
}

// to += J' f. The first entry of a closed constraint gets minus the rounded sum of the others. Clamped, as forces
// may exceed single precision: those of an angle with short arms.
static inline void scatter(const constraint *c, const entry *e, double force, mspringi_field to) {
    const uint32_t count = c->count;
    double x = 0.0, y = 0.0;
    for (uint32_t i = c->is_closed; i < count; ++i) {
        const float fx = clamped(force * e[i].x), fy = clamped(force * e[i].y);
        to.x[e[i].slot] += fx;
        to.y[e[i].slot] += fy;
        x += (double)fx;
        y += (double)fy;
    }
    if (!c->is_closed)
        return;
    to.x[e->slot] -= clamped(x);
    to.y[e->slot] -= clamped(y);
}

void mspringi_constraints_activate(mspringi_constraints *all) {
    all->active_count = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        const constraint *c = &all->list[i];
        if (c->count > 0 && mspringi_constraint_is_stiff(c))
            all->active[all->active_count++] =
                (mspringi_active_constraint){c->stiffness, c->first, (uint32_t)c->count << 1 | c->is_closed};
    }
}

// One particle: the floor, grips, colliders.
static inline void multiply_one(const entry *e, double stiffness, const mspringi_product *p) {
    if (!mspringi_product_has(p, e->slot))
        return;
    const double way = e->x * (double)p->from.x[e->slot] + e->y * (double)p->from.y[e->slot];
    const double force = stiffness * way;
    mspringi_product_add(p, e->slot, (float)(force * e->x), (float)(force * e->y));
    mspringi_product_count(p, e->slot, way * force);
}

static inline bool has_any_of_three(const mspringi_product *p, const entry *e) {
    return mspringi_product_has(p, e[0].slot) || mspringi_product_has(p, e[1].slot) ||
           mspringi_product_has(p, e[2].slot);
}

// A point and the ends of an edge.
static inline void multiply_three(const entry *e, double stiffness, const mspringi_product *p) {
    const uint32_t a = e[0].slot, b = e[1].slot, c = e[2].slot;
    const mspringi_field from = p->from;
    if (!has_any_of_three(p, e))
        return;
    const double way = e[0].x * (double)from.x[a] + e[0].y * (double)from.y[a] + e[1].x * (double)from.x[b] +
                       e[1].y * (double)from.y[b] + e[2].x * (double)from.x[c] + e[2].y * (double)from.y[c];
    const double force = stiffness * way;
    for (int i = 0; i < 3; ++i)
        mspringi_product_add(p, e[i].slot, (float)(force * e[i].x), (float)(force * e[i].y));
    mspringi_product_count(p, a, way * force);
}

// An angle.
static inline void multiply_closed_three(const entry *e, double stiffness, const mspringi_product *p) {
    const uint32_t a = e[0].slot, b = e[1].slot, c = e[2].slot;
    const mspringi_field from = p->from;
    if (!has_any_of_three(p, e))
        return;
    const double x = (double)from.x[a], y = (double)from.y[a];
    const double way = e[1].x * ((double)from.x[b] - x) + e[1].y * ((double)from.y[b] - y) +
                       e[2].x * ((double)from.x[c] - x) + e[2].y * ((double)from.y[c] - y);
    const double force = stiffness * way;
    const float bx = (float)(force * e[1].x), by = (float)(force * e[1].y);
    const float cx = (float)(force * e[2].x), cy = (float)(force * e[2].y);
    mspringi_product_add(p, b, bx, by);
    mspringi_product_add(p, c, cx, cy);
    mspringi_product_add(p, a, -(float)((double)bx + (double)cx), -(float)((double)by + (double)cy));
    mspringi_product_count(p, a, way * force);
}

// Any number of particles.
static void multiply_any(const mspringi_active_constraint *a, const entry *e, const mspringi_product *p) {
    const constraint c = {.count = (uint8_t)(a->shape >> 1), .is_closed = a->shape & 1};
    bool has_any = false;
    for (uint32_t i = 0; i < c.count; ++i)
        has_any = has_any || mspringi_product_has(p, e[i].slot);
    if (!has_any)
        return;
    const double way = gather(&c, e, p->from), force = a->stiffness * way;
    double x = 0.0, y = 0.0;
    for (uint32_t i = c.is_closed; i < c.count; ++i) {
        const float fx = (float)(force * e[i].x), fy = (float)(force * e[i].y);
        mspringi_product_add(p, e[i].slot, fx, fy);
        x += (double)fx;
        y += (double)fy;
    }
    if (c.is_closed)
        mspringi_product_add(p, e->slot, -(float)x, -(float)y);
    mspringi_product_count(p, e->slot, way * force);
}

// With the active ones only, and loops for one and for three particles, contact takes 0.80 to 0.90 of the time;
// with that for angles, a beam 0.92.
void mspringi_constraints_multiply(const mspringi_constraints *all, const mspringi_product *product) {
    for (uint32_t i = 0; i < all->active_count; ++i) {
        const mspringi_active_constraint *a = &all->active[i];
        const entry *e = all->entries + a->first;
        if (a->shape == 2 * 1)
            multiply_one(e, a->stiffness, product);
        else if (a->shape == 2 * 3)
            multiply_three(e, a->stiffness, product);
        else if (a->shape == 2 * 3 + 1)
            multiply_closed_three(e, a->stiffness, product);
        else
            multiply_any(a, e, product);
    }
}

/* ---------------------------------------------------------------------------------------------------- assembly */

void mspringi_constraints_assemble(const mspringi_constraints *all, uint32_t first, uint32_t end,
                                   const mspringi_system *to, bool is_factored) {
    for (uint32_t i = first; i < end; ++i) {
        const constraint *c = &all->list[i];
        const entry *entries = all->entries + c->first;
        if (!mspringi_constraint_is_active(c) || (is_factored && mspringi_constraint_is_unknown(c)))
            continue;
        const bool is_stiff = mspringi_constraint_is_stiff(c);
        scatter(c, entries, is_stiff ? c->effort : c->bound_force, (mspringi_field){to->force_x, to->force_y});
        for (const entry *e = entries; e < entries + c->count && is_stiff; ++e) {
            to->xx[e->slot] += clamped(c->stiffness * e->x * e->x);
            to->xy[e->slot] += clamped(c->stiffness * e->x * e->y);
            to->yy[e->slot] += clamped(c->stiffness * e->y * e->y);
        }
    }
}

void mspringi_constraints_add_nodes(const mspringi_constraints *all, double *xx, double *xy, double *yy) {
    for (uint32_t i = all->element_count; i < all->count; ++i) {
        const constraint *c = &all->list[i];
        const entry *e = &all->entries[c->first];
        if (!mspringi_constraint_is_diagonal(c) || !mspringi_constraint_is_stiff(c))
            continue;
        xx[e->slot] += c->stiffness * e->x * e->x;
        xy[e->slot] += c->stiffness * e->x * e->y;
        yy[e->slot] += c->stiffness * e->y * e->y;
    }
}

// Find the action of a constraint on tiles, a row for each. Return false if it acts on too many.
static bool pull_tiles(const mspringi_implicit *n, const mspringi_active_constraint *a, const entry *entries,
                       mspringi_coarse_rank_one *pulls) {
    const double root = sqrt(a->stiffness);
    for (const entry *e = entries; e < entries + (a->shape >> 1); ++e) {
        const uint32_t tile = n->tiles.of_slot[e->slot];
        const double x = root * e->x, y = root * e->y;
        uint32_t i = 0;
        if (tile == MSPRING_NONE)
            continue;
        while (i < pulls->count && pulls->tiles[i] != tile)
            ++i;
        if (i == MSPRINGI_COARSE_PULLS)
            return false;
        if (i == pulls->count) {
            pulls->count++;
            pulls->tiles[i] = tile;
            pulls->rows[i][0] = pulls->rows[i][1] = pulls->rows[i][2] = 0.0;
        }
        pulls->rows[i][0] += x;
        pulls->rows[i][1] += y;
        pulls->rows[i][2] += (double)n->arm.x[e->slot] * y - (double)n->arm.y[e->slot] * x;
    }
    return true;
}

// Contact between bodies is in it, too: without, each took an iteration or two more, stacks twice the time. A
// constraint of too many tiles is left out, which costs iterations only.
void mspringi_constraints_stiffen(const mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_constraints *all = &network->constraints;
    for (uint32_t i = 0; i < all->active_count; ++i) {
        mspringi_coarse_rank_one pulls;
        pulls.count = 0;
        if (pull_tiles(n, &all->active[i], all->entries + all->active[i].first, &pulls))
            mspringi_coarse_add_rank_one(&n->coarse, &pulls);
    }
}

/* -------------------------------------------------------------------------------------------------- active set */

// Update a push from the force that it would have if it were stiff. Return true if it begins or ends by more than a
// negligible force.
static bool update_push(constraint *c, double force, double negligible, bool is_free) {
    const bool was_stiff = c->activity == MSPRINGI_STIFF;
    const bool is_stiff = was_stiff ? force >= 0.0 || !is_free : force > c->bound;
    c->was_active = was_stiff;
    c->force = was_stiff ? force : 0.0;
    c->activity = is_stiff ? MSPRINGI_STIFF : MSPRINGI_IDLE;
    return is_stiff != was_stiff && fabs(force) > negligible;
}

// Update friction likewise: it slides beyond the cone, and sticks again if it would push the wrong way. Friction of
// a push that was idle keeps its activity: its bound would be 0, and it would begin by sliding.
static bool update_friction(constraint *c, double force, double negligible, bool is_free) {
    const double most = c->bound * fmax(c[-1].force, 0.0), before = c->bound_force;
    if (!c[-1].was_active)
        return false;
    const bool slid = c->activity == MSPRINGI_AT_BOUND, is_forwards = slid ? !signbit(before) : force >= 0.0;
    bool slides = slid;
    if (is_free && !slid)
        slides = fabs(force) > most;
    else if (slid && (is_forwards ? force < 0.0 : force > 0.0))
        slides = false;
    c->force = slid ? before : force;
    c->bound_force = is_forwards ? most : -most;
    c->activity = slides ? MSPRINGI_AT_BOUND : MSPRINGI_STIFF;
    if (c[-1].activity == MSPRINGI_IDLE)
        return false;
    if (slides != slid)
        return fabs((slides ? c->bound_force : force) - c->force) > negligible;
    return slides && is_free && fabs(c->bound_force - before) > fmax(settled_share[c->kind] * most, negligible);
}

// Update both constraints of a pair likewise: clamp the vector of their forces. Once at its bound it stays there.
static bool update_pair(constraint *c, double force, double other) {
    const double size = sqrt(force * force + other * other);
    if (c->activity == MSPRINGI_AT_BOUND)
        return false;
    const bool is_more = size > c->bound;
    c[0].force = c[0].bound_force = is_more ? force * (c->bound / size) : force;
    c[1].force = c[1].bound_force = is_more ? other * (c->bound / size) : other;
    c[0].activity = c[1].activity = is_more ? MSPRINGI_AT_BOUND : MSPRINGI_STIFF;
    return is_more;
}

// Force of a constraint at the solution, if it were stiff.
static double force_at(const mspringi_constraints *all, const constraint *c, mspringi_field u,
                       mspringi_field direction, float alpha) {
    const entry *entries = all->entries + c->first;
    double way = gather(c, entries, u);
    if (alpha != 0.0f)
        way += (double)alpha * gather(c, entries, direction);
    return c->effort - c->stiffness * way;
}

// Largest push of a contact at the solution.
static double largest_push(const mspringi_constraints *all, mspringi_field u, mspringi_field direction,
                           float alpha) {
    double largest = 0.0;
    for (uint32_t i = all->element_count; i < all->count; ++i) {
        const constraint *c = &all->list[i];
        if (c->kind == MSPRINGI_CONTACT_CONSTRAINT && c->bounded == MSPRINGI_BOUND_PUSH &&
            c->activity == MSPRINGI_STIFF)
            largest = fmax(largest, force_at(all, c, u, direction, alpha));
    }
    return largest;
}

uint32_t mspringi_constraints_update_active_set(mspringi_constraints *all, mspringi_field u,
                                                mspringi_field direction, float alpha, uint32_t pass) {
    const bool is_free = pass < FREE_PASSES;
    const double negligible_contact =
        pass < PASSES_OF_ALL ? 0.0 : NEGLIGIBLE_SHARE * largest_push(all, u, direction, alpha);
    uint32_t changed = 0;
    for (uint32_t i = all->element_count; i < all->count; ++i) {
        constraint *c = &all->list[i];
        const double negligible = c->kind == MSPRINGI_CONTACT_CONSTRAINT ? negligible_contact : 0.0;
        bool has_changed = false;
        if (c->bounded == MSPRINGI_BOUND_PUSH)
            has_changed = update_push(c, force_at(all, c, u, direction, alpha), negligible, is_free);
        else if (c->bounded == MSPRINGI_BOUND_FRICTION)
            has_changed = update_friction(c, force_at(all, c, u, direction, alpha), negligible, is_free);
        else if (c->bounded == MSPRINGI_BOUND_OF_PAIR)
            has_changed =
                update_pair(c, force_at(all, c, u, direction, alpha), force_at(all, c + 1, u, direction, alpha));
        changed |= (uint32_t)has_changed << c->kind;
    }
    return changed;
}

// Contacts are at the end of the list: their kind is the last.
bool mspringi_contact_constraint_is_active(const mspringi_constraints *all) {
    for (uint32_t i = all->count; i-- > all->element_count && all->list[i].kind == MSPRINGI_CONTACT_CONSTRAINT;)
        if (mspringi_constraint_is_active(&all->list[i]))
            return true;
    return false;
}

/* ------------------------------------------------------------------------------------------- terms of a substep */

void mspringi_elements_list_and_assemble(mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_constraints *all = &network->constraints;
    if (!all->has_elements) {
        mspringi_elements_list_constraints(network);
        all->element_count = all->count;
        all->element_entry_count = all->entry_count;
        all->has_elements = true;
        mspringi_constraints_activate(all);
    }
    mspringi_constraints_assemble(all, 0, all->element_count, &n->system, n->is_direct);
}

static bool is_any_active(const mspringi_constraints *all) {
    for (uint32_t i = all->element_count; i < all->count; ++i)
        if (mspringi_constraint_is_active(&all->list[i]))
            return true;
    return false;
}

bool mspringi_constraints_add_terms(mspring_network *network, float h, uint32_t pass) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_constraints *all = &network->constraints;
    if (pass == 0) {
        if (network->floor && !mspringi_floor_list_constraints(network, h))
            return false;
#define SYSTEM(name) mspringi_##name##_list_constraints(network, h);
#include "store/features.def"
        mspringi_implicit_contact_list_constraints(network, h);
    }
    // Factor the coarse matrix in each solution with active constraints, which come and go, and in the next one.
    const bool are_active = is_any_active(all);
    mspringi_constraints_activate(all);
    n->age = are_active || n->has_constraints_in_coarse ? 0 : n->age;
    n->has_constraints_in_coarse = are_active;
    mspringi_constraints_assemble(all, all->element_count, all->count, &n->system, n->is_direct);
    return true;
}
