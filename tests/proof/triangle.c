#include "triangle.h"

#include <string.h>

#include "solvers/implicit/implicit.h"
#include "store/elements.h"
#include "store/stages.h"

typedef struct triangle {
    mspring_id corners[3];
    double inverse[2][2]; ///< of the matrix of the rest shape, whose columns are two sides
    double area, lambda, mu;
} triangle;

static triangle triangles[PROOF_TRIANGLES];
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
