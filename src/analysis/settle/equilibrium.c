/// Energy, forces and stiffness.
#include "analysis/settle/equilibrium.h"

#include <math.h>
#include <string.h>

#include "kernels/spring_law.h"

/* ------------------------------------------------------------------------------------------------------ memory */

static mspringi_vectors vectors_at(double *block, size_t count, size_t *used) {
    const mspringi_vectors vectors = {block + *used * count, block + (*used + 1) * count};
    *used += 2;
    return vectors;
}

bool mspringi_statics_create(mspringi_statics *statics, uint32_t particle_count, uint32_t edge_count,
                             mspringi_memory *memory) {
    const size_t particles = particle_count, springs = edge_count;
    enum { PER_PARTICLE = 18, PER_SPRING = 8 };
    *statics = (mspringi_statics){.particle_count = particle_count};
    statics->fixed = mspringi_alloc(memory, particles, sizeof *statics->fixed);
    double *block = statics->block = mspringi_alloc(memory, PER_PARTICLE * particles, sizeof *block);
    double *spring_block = statics->spring_block =
        mspringi_alloc(memory, PER_SPRING * springs, sizeof *spring_block);
    uint32_t *ends = statics->end_block = mspringi_alloc(memory, 2 * springs, sizeof *ends);
    if (!statics->fixed || !block || !spring_block || !ends)
        return false;
    size_t used = 0;
    statics->start = vectors_at(block, particles, &used);
    statics->moved = vectors_at(block, particles, &used);
    statics->outside = vectors_at(block, particles, &used);
    statics->force = vectors_at(block, particles, &used);
    statics->step = vectors_at(block, particles, &used);
    statics->curvature = vectors_at(block, particles, &used);
    statics->spare = vectors_at(block, particles, &used);
    double **const single[] = {&statics->xx, &statics->xy, &statics->yy, &statics->scale};
    for (size_t i = 0; i < sizeof single / sizeof single[0]; ++i)
        *single[i] = block + used++ * particles;
    mspringi_statics_springs *s = &statics->springs;
    double **const of_springs[] = {&s->stiffness, &s->rest_length, &s->side, &s->x, &s->y, &s->xx, &s->xy, &s->yy};
    for (size_t i = 0; i < sizeof of_springs / sizeof of_springs[0]; ++i)
        *of_springs[i] = spring_block + i * springs;
    s->a = ends;
    s->b = ends + springs;
    return true;
}

void mspringi_statics_destroy(mspringi_statics *statics, mspringi_memory *memory) {
    mspringi_cholesky_double_destroy(&statics->factor, memory);
    mspringi_cholesky_symbolic_destroy(&statics->plan, memory);
    mspringi_free(memory, statics->fixed);
    mspringi_free(memory, statics->block);
    mspringi_free(memory, statics->spring_block);
    mspringi_free(memory, statics->end_block);
    mspringi_free(memory, statics->elements.sides);
    mspringi_free(memory, statics->elements.blocks);
    mspringi_free(memory, statics->secants.block);
}

mspring_result mspringi_statics_prepare(mspringi_statics *statics, mspring_simd level, mspringi_memory *memory,
                                        mspringi_message *message) {
    const mspringi_cholesky_graph graph = {
        .node_count = statics->particle_count,
        .edge_count = statics->springs.edge_count,
        .edge_a = statics->springs.a,
        .edge_b = statics->springs.b,
        .absent = statics->fixed,
        .x = statics->start.x,
        .y = statics->start.y,
    };
    const mspring_result result = mspringi_cholesky_symbolic_create(&statics->plan, &graph, memory, message);
    return result == MSPRING_OK
               ? mspringi_cholesky_double_create(&statics->factor, &statics->plan, level, memory, message)
               : result;
}

/* ------------------------------------------------------------------------------------------------------ springs */

/// A spring in the present shape.
typedef struct spring_vector {
    double x, y, length; ///< from a to b
} spring_vector;

static spring_vector vector_of_spring(const mspringi_statics *statics, uint32_t spring) {
    const mspringi_statics_springs *s = &statics->springs;
    const uint32_t a = s->a[spring], b = s->b[spring];
    const double x = s->x[spring] + (statics->moved.x[b] - statics->moved.x[a]);
    const double y = s->y[spring] + (statics->moved.y[b] - statics->moved.y[a]);
    return (spring_vector){x, y, sqrt(x * x + y * y)};
}

// True if a one-way spring is slack: one that only pulls and is short, or one that only pushes and is long.
static bool is_slack(const mspringi_statics_springs *s, uint32_t spring, double length) {
    return s->side[spring] * (length - s->rest_length[spring]) < 0.0;
}

mspringi_residual mspringi_statics_forces(mspringi_statics *statics) {
    const mspringi_statics_springs *s = &statics->springs;
    mspringi_residual residual = {.where = MSPRING_NONE};
    mspringi_vectors force = statics->force;
    for (uint32_t p = 0; p < statics->particle_count; ++p) {
        force.x[p] = statics->outside.x[p];
        force.y[p] = statics->outside.y[p];
        if (!statics->fixed[p])
            residual.scale = fmax(residual.scale, fmax(fabs(force.x[p]), fabs(force.y[p])));
    }
    for (uint32_t i = 0; i < s->count; ++i) {
        const spring_vector now = vector_of_spring(statics, i);
        if (!(now.length > 0.0) || is_slack(s, i, now.length))
            continue;
        const double pull = MSPRINGI_LAW_FORCE(MSPRINGI_TIMES, s->stiffness[i], now.length - s->rest_length[i]),
                     each = pull / now.length;
        force.x[s->a[i]] += each * now.x;
        force.y[s->a[i]] += each * now.y;
        force.x[s->b[i]] -= each * now.x;
        force.y[s->b[i]] -= each * now.y;
        residual.scale = fmax(residual.scale, fabs(pull));
    }
    residual.scale = fmax(residual.scale, mspringi_statics_element_forces(statics));
    for (uint32_t p = 0; p < statics->particle_count; ++p) {
        if (statics->fixed[p])
            continue;
        const double largest = fmax(fabs(force.x[p]), fabs(force.y[p]));
        if (residual.where == MSPRING_NONE || !(largest <= residual.force)) {
            residual.where = p;
            residual.force = largest;
        }
    }
    return residual;
}

double mspringi_statics_slope(const mspringi_statics *statics) {
    double slope = 0.0;
    for (uint32_t p = 0; p < statics->particle_count; ++p)
        if (!statics->fixed[p])
            slope += statics->force.x[p] * statics->step.x[p] + statics->force.y[p] * statics->step.y[p];
    return slope;
}

static double half_square(double stretch) {
    return 0.5 * stretch * stretch;
}

// A difference of energies would be lost in rounding. So the change of length follows from that of the squared
// length, and the change of energy from the change of length.
double mspringi_statics_energy_change(const mspringi_statics *statics, double t, double *error) {
    const mspringi_statics_springs *s = &statics->springs;
    const mspringi_vectors step = statics->step, curvature = statics->curvature;
    double size = 0.0, change = mspringi_statics_element_change(statics, t, &size);
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t a = s->a[i], b = s->b[i];
        const spring_vector now = vector_of_spring(statics, i);
        const double dx = t * ((step.x[b] - step.x[a]) + t * (curvature.x[b] - curvature.x[a]));
        const double dy = t * ((step.y[b] - step.y[a]) + t * (curvature.y[b] - curvature.y[a]));
        const double x = now.x + dx, y = now.y + dy, length = sqrt(x * x + y * y), sum = length + now.length;
        if (!(sum > 0.0))
            continue;
        const double longer = ((now.x + x) * dx + (now.y + y) * dy) / sum;
        const bool was_slack = is_slack(s, i, now.length), gets_slack = is_slack(s, i, length);
        if (was_slack && gets_slack)
            continue;
        const double energy = s->stiffness[i] * (was_slack    ? half_square(length - s->rest_length[i])
                                                 : gets_slack ? -half_square(now.length - s->rest_length[i])
                                                              : longer * (0.5 * sum - s->rest_length[i]));
        change += energy;
        size += fabs(energy);
    }
    for (uint32_t p = 0; p < statics->particle_count; ++p) {
        if (statics->fixed[p])
            continue;
        const double work = t * (statics->outside.x[p] * (step.x[p] + t * curvature.x[p]) +
                                 statics->outside.y[p] * (step.y[p] + t * curvature.y[p]));
        change -= work;
        size += fabs(work);
    }
    *error = 1e-14 * size;
    return change;
}

/* --------------------------------------------------------------------------------------------------- stiffness */

/// Stiffness of a slack spring in the matrix, relative to its own. A slack rope of 40 links took as many iterations
/// with 1e-6 as with 1, but more than twice as many with 0.
#define SLACK_SHARE 1e-6

static void add_to_node(mspringi_statics *statics, uint32_t p, double xx, double xy, double yy, double scale) {
    statics->xx[p] += xx;
    statics->xy[p] += xy;
    statics->yy[p] += yy;
    statics->scale[p] += scale;
}

// K = k (t I + (1 - t) n n^T), t = 1 - L0 / l, n the direction. A spring of length 0 has no direction and is stiff
// in all. A slack spring keeps just enough stiffness for a positive definite matrix.
static void add_spring(mspringi_statics *statics, uint32_t spring, bool clamped) {
    const mspringi_statics_springs *s = &statics->springs;
    const spring_vector now = vector_of_spring(statics, spring);
    const bool is_slack_now = is_slack(s, spring, now.length);
    const double k = is_slack_now ? SLACK_SHARE * s->stiffness[spring] : s->stiffness[spring];
    const double nx = now.length > 0.0 ? now.x / now.length : 0.0, ny = now.length > 0.0 ? now.y / now.length : 0.0;
    const double across = now.length > 0.0 && !is_slack_now ? 1.0 - s->rest_length[spring] / now.length : 1.0;
    const double t = clamped ? fmax(0.0, across) : across;
    const double along = k * (1.0 - t), xx = k * t + along * nx * nx, xy = along * nx * ny,
                 yy = k * t + along * ny * ny;
    const double scale = 0.5 * k * (1.0 + fmax(0.0, across));
    add_to_node(statics, s->a[spring], xx, xy, yy, scale);
    add_to_node(statics, s->b[spring], xx, xy, yy, scale);
    s->xx[spring] = -xx;
    s->xy[spring] = -xy;
    s->yy[spring] = -yy;
}

bool mspringi_statics_factor(mspringi_statics *statics, bool clamped, double shift) {
    const uint32_t count = statics->particle_count;
    const mspringi_statics_springs *s = &statics->springs;
    memset(statics->xx, 0, 4 * (size_t)count * sizeof *statics->xx); // and xy, yy, scale, which follow it in memory
    for (uint32_t i = 0; i < s->count; ++i)
        add_spring(statics, i, clamped);
    for (uint32_t i = s->count; i < s->edge_count; ++i)
        s->xx[i] = s->xy[i] = s->yy[i] = 0.0;
    mspringi_statics_add_element_stiffness(statics, clamped);
    double stiffest = 0.0;
    for (uint32_t p = 0; p < count; ++p)
        stiffest = statics->fixed[p] ? stiffest : fmax(stiffest, statics->scale[p]);
    // A particle without springs has no stiffness. Any will do, as no force acts on it.
    const double least = stiffest > 0.0 ? 1e-12 * stiffest : 1.0;
    for (uint32_t p = 0; p < count; ++p) {
        const double add = shift * fmax(statics->scale[p], least) + (statics->scale[p] > 0.0 ? 0.0 : least);
        statics->xx[p] += add;
        statics->yy[p] += add;
    }
    const mspringi_cholesky_matrix_double matrix = {statics->xx, statics->xy, statics->yy, s->xx, s->xy, s->yy};
    return mspringi_cholesky_double_factor(&statics->factor, &matrix) == MSPRING_NONE;
}

/* -------------------------------------------------------------------------------------------------- Newton step */

static void solve(mspringi_statics *statics, mspringi_vectors v) {
    for (uint32_t p = 0; p < statics->particle_count; ++p)
        if (statics->fixed[p])
            v.x[p] = v.y[p] = 0.0;
    mspringi_cholesky_double_solve(&statics->factor, v.x, v.y);
}

// Half the second derivative of a spring's force along the step: d is the vector of the spring, n its direction,
// and s the change of d, with sn its part along n and sp across:
//
//     (k (l - L0) n)'' = k L0 (2 sn sp + |sp|^2 n) / l^2
static void add_curvature(mspringi_statics *statics, uint32_t spring) {
    const mspringi_statics_springs *s = &statics->springs;
    const uint32_t a = s->a[spring], b = s->b[spring];
    const spring_vector now = vector_of_spring(statics, spring);
    if (!(now.length > 0.0) || is_slack(s, spring, now.length))
        return;
    const double nx = now.x / now.length, ny = now.y / now.length;
    const double dx = statics->step.x[b] - statics->step.x[a], dy = statics->step.y[b] - statics->step.y[a];
    const double along = dx * nx + dy * ny, px = dx - along * nx, py = dy - along * ny;
    const double k = 0.5 * s->stiffness[spring] * s->rest_length[spring] / (now.length * now.length);
    const double across = px * px + py * py;
    const double fx = k * (2.0 * along * px + across * nx), fy = k * (2.0 * along * py + across * ny);
    statics->curvature.x[a] += fx;
    statics->curvature.y[a] += fy;
    statics->curvature.x[b] -= fx;
    statics->curvature.y[b] -= fy;
}

/* ---------------------------------------------------------------------------------------------------- secants */

static double *secant(const mspringi_statics *statics, uint32_t which) {
    return statics->secants.block + 2 * (size_t)which * statics->particle_count;
}

static double dot(const mspringi_statics *statics, const double *a, const double *b) {
    double sum = 0.0;
    for (size_t i = 0; i < 2 * (size_t)statics->particle_count; ++i)
        sum += a[i] * b[i];
    return sum;
}

static void add_times(const mspringi_statics *statics, double factor, const double *from, double *to) {
    for (size_t i = 0; i < 2 * (size_t)statics->particle_count; ++i)
        to[i] += factor * from[i];
}

static void clear_fixed(const mspringi_statics *statics, double *v) {
    for (uint32_t p = 0; p < statics->particle_count; ++p)
        if (statics->fixed[p])
            v[p] = v[p + statics->particle_count] = 0.0;
}

// Keep the last move as a secant, if the forces fell along it.
static void learn(mspringi_statics *statics) {
    mspringi_secants *s = &statics->secants;
    const size_t bytes = 2 * (size_t)statics->particle_count * sizeof(double);
    double *last_moved = secant(statics, 2 * MSPRINGI_SECANTS),
           *last_force = secant(statics, 2 * MSPRINGI_SECANTS + 1);
    double *move = secant(statics, 2 * s->next), *less = secant(statics, 2 * s->next + 1);
    if (s->has_last) {
        memcpy(move, statics->moved.x, bytes);
        add_times(statics, -1.0, last_moved, move);
        memcpy(less, last_force, bytes);
        add_times(statics, -1.0, statics->force.x, less);
        clear_fixed(statics, less);
        const double product = dot(statics, move, less);
        if (product > 1e-10 * sqrt(dot(statics, move, move) * dot(statics, less, less))) {
            s->inverse[s->next] = 1.0 / product;
            s->next = (s->next + 1) % MSPRINGI_SECANTS;
            s->count += s->count < MSPRINGI_SECANTS;
        }
    }
    memcpy(last_moved, statics->moved.x, bytes);
    memcpy(last_force, statics->force.x, bytes);
    s->has_last = true;
}

// Limited memory BFGS (Nocedal 1980), around the factor of the present matrix.
static void solve_by_secants(mspringi_statics *statics) {
    const mspringi_secants *s = &statics->secants;
    double shares[MSPRINGI_SECANTS], *step = statics->step.x;
    clear_fixed(statics, step);
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t k = (s->next + MSPRINGI_SECANTS - 1 - i) % MSPRINGI_SECANTS;
        shares[k] = s->inverse[k] * dot(statics, secant(statics, 2 * k), step);
        add_times(statics, -shares[k], secant(statics, 2 * k + 1), step);
    }
    solve(statics, statics->step);
    for (uint32_t i = s->count; i-- > 0;) {
        const uint32_t k = (s->next + MSPRINGI_SECANTS - 1 - i) % MSPRINGI_SECANTS;
        const double share = s->inverse[k] * dot(statics, secant(statics, 2 * k + 1), step);
        add_times(statics, shares[k] - share, secant(statics, 2 * k), step);
    }
}

void mspringi_statics_find_step(mspringi_statics *statics) {
    const size_t bytes = 2 * (size_t)statics->particle_count * sizeof *statics->step.x;
    memcpy(statics->step.x, statics->force.x, bytes);
    if (statics->secants.block) {
        learn(statics);
        solve_by_secants(statics);
    } else
        solve(statics, statics->step);
    memset(statics->curvature.x, 0, bytes);
    for (uint32_t i = 0; i < statics->springs.count; ++i)
        add_curvature(statics, i);
    solve(statics, statics->curvature);
}
