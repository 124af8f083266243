#include "triangle.h"

#include <math.h>
#include <string.h>

#include "solvers/implicit/implicit.h"
#include "store/changed.h"
#include "store/element_laws.h"
#include "store/elements.h"
#include "store/stages.h"

typedef struct triangle {
    mspring_id corners[3];
    double inverse[2][2]; ///< of the matrix of the rest shape, whose columns are two sides
    double area, lambda, mu;
} triangle;

/// A strain of a triangle as an element.
typedef struct strain {
    uint32_t triangle, which;
    double stiffness;
    mspringi_corner corners[3];
} strain;

static triangle triangles[PROOF_TRIANGLES];
static strain strains[PROOF_STRAINS * PROOF_TRIANGLES];
static uint32_t triangle_count;
static mspringi_field force;

static uint32_t slot_of(const mspring_network *network, uint32_t i, int corner) {
    return network->topology.slot_of_particle[triangles[i].corners[corner]];
}

/* --------------------------------------------------------------------------------------------------------- law */

proof_strains proof_strains_at(uint32_t i, const double position[3][2]) {
    const triangle *t = &triangles[i];
    double f[2][2], sums[2][3] = {{0}}; // columns of the deformation gradient
    proof_strains made = {.stiffness = {t->area * (t->lambda + t->mu), t->area * t->mu, t->area * t->mu}};
    for (int column = 0; column < 2; ++column)
        for (int x = 0; x < 2; ++x)
            f[column][x] = (position[1][x] - position[0][x]) * t->inverse[0][column] +
                           (position[2][x] - position[0][x]) * t->inverse[1][column];
    const double xx = 0.5 * (f[0][0] * f[0][0] + f[0][1] * f[0][1] - 1.0);
    const double yy = 0.5 * (f[1][0] * f[1][0] + f[1][1] * f[1][1] - 1.0);
    made.size[0] = xx + yy;
    made.size[1] = xx - yy;
    made.size[2] = f[0][0] * f[1][0] + f[0][1] * f[1][1];
    for (int corner = 1; corner < 3; ++corner)
        for (int x = 0; x < 2; ++x) {
            const double by_x = t->inverse[corner - 1][0], by_y = t->inverse[corner - 1][1];
            const double gradients[] = {by_x * f[0][x] + by_y * f[1][x], by_x * f[0][x] - by_y * f[1][x],
                                        by_x * f[1][x] + by_y * f[0][x]};
            for (int k = 0; k < PROOF_STRAINS; ++k) {
                made.gradient[k][corner][x] = gradients[k];
                sums[x][k] += gradients[k];
            }
        }
    for (int k = 0; k < PROOF_STRAINS; ++k)
        for (int x = 0; x < 2; ++x)
            made.gradient[k][0][x] = -sums[x][k];
    return made;
}

static proof_strains strains_now(const mspring_network *network, uint32_t i) {
    double position[3][2];
    for (int corner = 0; corner < 3; ++corner) {
        position[corner][0] = mspringi_x_of(&network->state, slot_of(network, i, corner));
        position[corner][1] = mspringi_y_of(&network->state, slot_of(network, i, corner));
    }
    return proof_strains_at(i, (const double(*)[2])position);
}

static double energy_of(const mspring_network *network, uint32_t i) {
    const proof_strains s = strains_now(network, i);
    double energy = 0.0;
    for (int k = 0; k < PROOF_STRAINS; ++k)
        energy += 0.5 * s.stiffness[k] * s.size[k] * s.size[k];
    return energy;
}

double proof_energy(const mspring_network *network) {
    double sum = 0.0;
    for (uint32_t i = 0; i < triangle_count; ++i)
        sum += energy_of(network, i);
    return sum;
}

static void list_strains(const mspring_network *network, uint32_t i) {
    const proof_strains now = strains_now(network, i);
    for (uint32_t k = 0; k < PROOF_STRAINS; ++k) {
        strain *of = &strains[PROOF_STRAINS * i + k];
        *of = (strain){.triangle = i, .which = k, .stiffness = now.stiffness[k]};
        for (int corner = 0; corner < 3; ++corner) {
            const double *g = now.gradient[k][corner];
            of->corners[corner] = (mspringi_corner){.particle = triangles[i].corners[corner],
                                                    .spring = MSPRING_NONE,
                                                    .reach = (float)hypot(g[0], g[1])};
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- edits */

void proof_add_triangle(mspring_network *network, const mspring_id corners[3], double lambda, double mu) {
    triangle *t = &triangles[triangle_count++];
    double x[3], y[3];
    memcpy(t->corners, corners, sizeof t->corners);
    for (int corner = 0; corner < 3; ++corner) {
        x[corner] = mspringi_x_of(&network->state, slot_of(network, triangle_count - 1, corner));
        y[corner] = mspringi_y_of(&network->state, slot_of(network, triangle_count - 1, corner));
    }
    const double ax = x[1] - x[0], ay = y[1] - y[0], bx = x[2] - x[0], by = y[2] - y[0], twice = ax * by - ay * bx;
    t->inverse[0][0] = by / twice;
    t->inverse[0][1] = -bx / twice;
    t->inverse[1][0] = -ay / twice;
    t->inverse[1][1] = ax / twice;
    t->area = 0.5 * twice;
    t->lambda = lambda;
    t->mu = mu;
    list_strains(network, triangle_count - 1);
    mspringi_notify_change(network, MSPRINGI_CHANGED_AREA, 0);
    (void)mspringi_constraints_reserve(network, MSPRINGI_ANGLE_CONSTRAINT, PROOF_STRAINS * PROOF_TRIANGLES,
                                       3 * PROOF_STRAINS * PROOF_TRIANGLES);
    (void)mspringi_field_reserve(network, &force);
}

void proof_remove_triangles(mspring_network *network) {
    mspringi_free(&network->memory, force.x);
    force = (mspringi_field){NULL, NULL};
    triangle_count = 0;
}

/* -------------------------------------------------------------------------------------- solvers without system */

static bool is_used(const mspring_network *network) {
    (void)network;
    return triangle_count > 0;
}

// Linear systems have them.
static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    (void)network;
    return attempt->solver->ops->has_implicit_areas;
}

static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    return is_quiet(network, attempt) ? attempt->substeps - substep : 1;
}

static mspringi_field push(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                           mspringi_field base) {
    (void)substep;
    if (is_quiet(network, attempt))
        return base;
    if (base.x)
        mspringi_field_copy(network, base, force);
    else
        mspringi_field_clear(network, force);
    for (uint32_t i = 0; i < triangle_count; ++i) {
        const proof_strains s = strains_now(network, i);
        for (int corner = 0; corner < 3; ++corner)
            for (int k = 0; k < PROOF_STRAINS; ++k) {
                const double pull = -s.stiffness[k] * s.size[k];
                force.x[slot_of(network, i, corner)] += (float)(pull * s.gradient[k][corner][0]);
                force.y[slot_of(network, i, corner)] += (float)(pull * s.gradient[k][corner][1]);
            }
    }
    return force;
}

const mspringi_stage proof_stage_triangles = {.is_used = is_used,
                                              .is_inner = true,
                                              .is_quiet = is_quiet,
                                              .free_substeps = free_substeps,
                                              .before_substep = push};

/* --------------------------------------------------------------------------------------------- linear systems */

static void list_triangle(mspring_network *network, uint32_t i) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    double position[3][2];
    for (int corner = 0; corner < 3; ++corner) {
        position[corner][0] = n->x[slot_of(network, i, corner)];
        position[corner][1] = n->y[slot_of(network, i, corner)];
    }
    const proof_strains s = proof_strains_at(i, (const double(*)[2])position);
    for (int k = 0; k < PROOF_STRAINS; ++k) {
        mspringi_constraints *all = &network->constraints;
        mspringi_constraint *c = mspringi_constraint_add(all, MSPRINGI_ANGLE_CONSTRAINT, i, 3);
        c->is_closed = true;
        c->stiffness = n->system.force_scale * s.stiffness[k];
        c->effort = -c->stiffness * s.size[k];
        for (int corner = 0; corner < 3; ++corner)
            mspringi_constraint_add_entry(all, slot_of(network, i, corner), s.gradient[k][corner][0],
                                          s.gradient[k][corner][1]);
    }
}

static void list_constraints(mspring_network *network) {
    for (uint32_t i = 0; i < triangle_count; ++i)
        list_triangle(network, i);
}

static void add_energy(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    for (uint32_t i = 0; i < triangle_count; ++i) {
        const uint32_t number = n->budget.of_slot[slot_of(network, i, 0)];
        if (number == MSPRINGI_NO_COMPONENT)
            continue;
        n->budget.components[number].elastic += energy_of(network, i);
        n->budget.components[number].length += triangles[i].area * (triangles[i].lambda + 2.0 * triangles[i].mu);
    }
}

const mspringi_element_ops proof_element_triangles = {
    .is_used = is_used, .list_constraints = list_constraints, .add_energy = add_energy};

/* ------------------------------------------------------------------- stability, settling, tuning: each strain */

static proof_strains strains_of(const mspringi_element_ref *e, const mspringi_positions *at) {
    const strain *of = e->of;
    double position[3][2] = {{0}};
    for (uint32_t corner = 1; corner < 3; ++corner) {
        const mspringi_vector way = mspringi_way_of(at, e, 0, corner);
        position[corner][0] = way.x;
        position[corner][1] = way.y;
    }
    return proof_strains_at(of->triangle, (const double(*)[2])position);
}

static double size_of(const mspringi_element_ref *e, const mspringi_positions *at) {
    return strains_of(e, at).size[((const strain *)e->of)->which];
}

static mspringi_vector gradient_of(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t corner) {
    const proof_strains s = strains_of(e, at);
    const double *g = s.gradient[((const strain *)e->of)->which][corner];
    return (mspringi_vector){g[0], g[1]};
}

static double force_of(const void *of, double size) {
    return -((const strain *)of)->stiffness * size;
}

static double stiffness_of(const void *of, double size) {
    (void)size;
    return ((const strain *)of)->stiffness;
}

static double energy_of_strain(const void *of, double size) {
    return 0.5 * ((const strain *)of)->stiffness * size * size;
}

// The second derivative of a strain by two corners is this times the unit matrix.
static double second_derivative(const strain *of, uint32_t i, uint32_t j) {
    const double(*by)[2] = (const double(*)[2])triangles[of->triangle].inverse;
    const double all[3][2] = {
        {-by[0][0] - by[1][0], -by[0][1] - by[1][1]}, {by[0][0], by[0][1]}, {by[1][0], by[1][1]}};
    const double xx = all[i][0] * all[j][0], yy = all[i][1] * all[j][1];
    return of->which == 0 ? xx + yy : of->which == 1 ? xx - yy : all[i][0] * all[j][1] + all[i][1] * all[j][0];
}

// Strains are quadratic: a move changes one by g . u + u . H u / 2.
static double energy_change_of(const mspringi_element_ref *e, const mspringi_positions *at,
                               const mspringi_move *move, double *sum) {
    const strain *of = e->of;
    const double size = size_of(e, at);
    double change = 0.0;
    for (uint32_t i = 1; i < 3; ++i) {
        const mspringi_vector g = gradient_of(e, at, i), u = mspringi_move_of(move, e, 0, i);
        change += g.x * u.x + g.y * u.y;
        for (uint32_t j = 1; j < 3; ++j) {
            const mspringi_vector v = mspringi_move_of(move, e, 0, j);
            change += 0.5 * second_derivative(of, i, j) * (u.x * v.x + u.y * v.y);
        }
    }
    const double energy = of->stiffness * change * (size + 0.5 * change);
    *sum += fabs(energy);
    return energy;
}

// As all g add up to 0, c g g' is that of springs along the sides, of which each is -c g_i g_j'; likewise the rest.
static void blocks_of(const mspringi_element_ref *e, const mspringi_positions *at, bool clamped,
                      mspringi_side_block *blocks) {
    const strain *of = e->of;
    const double push = clamped ? 0.0 : force_of(of, size_of(e, at)), c = of->stiffness;
    for (uint32_t side = 0; side < 3; ++side) {
        const uint32_t next = (side + 1) % 3;
        const mspringi_vector g = gradient_of(e, at, side), h = gradient_of(e, at, next);
        const double rest = push * second_derivative(of, side, next);
        blocks[side] =
            (mspringi_side_block){rest - c * g.x * h.x, -0.5 * c * (g.x * h.y + g.y * h.x), rest - c * g.y * h.y};
    }
}

static double rest_of(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t side) {
    (void)at;
    return fabs(second_derivative(e->of, side, (side + 1) % 3));
}

static mspringi_element_bound bound_of(const void *of) {
    return (mspringi_element_bound){((const strain *)of)->stiffness, 0.0};
}

static const mspringi_element_law law = {.size = size_of,
                                         .gradient = gradient_of,
                                         .force = force_of,
                                         .stiffness = stiffness_of,
                                         .energy = energy_of_strain,
                                         .energy_change = energy_change_of,
                                         .blocks = blocks_of,
                                         .rest = rest_of,
                                         .bound = bound_of};

static bool next_strain(mspringi_element_walk *walk) {
    if (walk->next >= (size_t)PROOF_STRAINS * triangle_count)
        return false;
    const strain *of = &strains[walk->next++];
    walk->element = (mspringi_element_ref){
        .law = &law, .of = of, .corners = of->corners, .count = 3, .is_ringed = true, .owns_sides = true};
    return true;
}

static void refresh(mspring_network *network) {
    (void)network; // none is ever open
}

static double longest(const mspring_network *network) {
    (void)network;
    return INFINITY;
}

const mspringi_element_list proof_list_of_strains = {next_strain, refresh, longest};
