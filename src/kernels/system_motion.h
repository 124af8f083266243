/// @file system_motion.h
/// Implicit substep before and after its linear system; formulas in solvers/implicit/integrator.c. Plain C by slot,
/// or vectors for the parts of a tile, as in system_iterate.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_MOTION_H
#define MSPRINGI_SYSTEM_MOTION_H

#include "kernels/system_iterate.h"

static void scale_masses(const float *restrict inverse_mass, float scale, float *restrict mass, size_t first,
                         size_t end) {
    for (size_t i = first; i < end; ++i) {
        const float inverse = inverse_mass[i], scaled_mass = scale / inverse;
        mass[i] = inverse > 0.0f ? scaled_mass : 0.0f;
    }
}

/* --------------------------------------------------------------------------------------- rigid motion of tiles */

/// Sums by lane over a tile, about a moving point in it: mass, first moments of position and velocity, angular
/// momentum and moment of inertia.
typedef struct tile_moments {
    part_vec sums[7][PART_VECTORS];
} tile_moments;

MSPRINGI_INLINE void add_moments(tile_moments *to, const mspringi_prediction *f, const mspringi_tile_part *part,
                                 const mspringi_tile_motion *t) {
    for (size_t v = 0; v < PART_VECTORS; ++v) {
        const size_t at = part->first_slot + v * PART_LANES;
        const part_vec m =
            part_mul(part_load(mspringi_part_weights[part->lanes] + v * PART_LANES), part_load(f->mass + at));
        const part_vec x = part_sub(part_load(f->x + at), part_set(t->origin_x));
        const part_vec y = part_sub(part_load(f->y + at), part_set(t->origin_y));
        const part_vec vx = part_sub(part_load(f->vx + at), part_set(t->origin_vx));
        const part_vec vy = part_sub(part_load(f->vy + at), part_set(t->origin_vy));
        const part_vec values[] = {m,
                                   part_mul(m, x),
                                   part_mul(m, y),
                                   part_mul(m, vx),
                                   part_mul(m, vy),
                                   part_mul(m, part_sub(part_mul(x, vy), part_mul(y, vx))),
                                   part_mul(m, part_add(part_mul(x, x), part_mul(y, y)))};
        for (size_t i = 0; i < 7; ++i)
            to->sums[i][v] = part_add(to->sums[i][v], values[i]);
    }
}

static void find_tile_motion(const mspringi_prediction *f, const mspringi_tile_part *parts, size_t count,
                             mspringi_tile_motion *to) {
    tile_moments moments;
    for (size_t i = 0; i < 7; ++i)
        for (size_t v = 0; v < PART_VECTORS; ++v)
            moments.sums[i][v] = part_set(0.0f);
    size_t origin = parts[0].first_slot;
    while (!(parts[0].lanes >> (origin - parts[0].first_slot) & 1))
        ++origin;
    to->origin_x = f->x[origin];
    to->origin_y = f->y[origin];
    to->origin_vx = f->vx[origin];
    to->origin_vy = f->vy[origin];
    for (size_t p = 0; p < count; ++p)
        add_moments(&moments, f, &parts[p], to);
    double sums[7];
    for (size_t i = 0; i < 7; ++i)
        sums[i] = sum_part(moments.sums[i]);
    const double h = (double)f->h;
    const double x = sums[1] / sums[0], y = sums[2] / sums[0], vx = sums[3] / sums[0], vy = sums[4] / sums[0];
    const double moment = sums[5] - sums[0] * (x * vy - y * vx), inertia = sums[6] - sums[0] * (x * x + y * y);
    // Tangent of half the rotation. The angle equals omega h up to third order, and is finite for any omega h.
    const double half = inertia > 1e-6 * sums[6] ? 0.5 * h * moment / inertia : 0.0;
    const double inward = -2.0 * half * half / (1.0 + half * half); // cos - 1; times half: sin - omega h
    to->x = (float)x;
    to->y = (float)y;
    to->hvx = (float)(h * vx);
    to->hvy = (float)(h * vy);
    to->inward = (float)inward;
    to->sideways = (float)(half * inward);
}

// Write to a tile's slots of a part, and 0 to the others, unless another part at these slots came first.
MSPRINGI_INLINE void put_part(float *to, part_vec weight, part_vec value, bool is_first) {
    const part_vec own = part_mul(weight, value);
    part_store(to, is_first ? own : part_add(part_load(to), own));
}

static void rotate_tiles(const mspringi_prediction *f, const mspringi_tile_part *parts, size_t count,
                         const mspringi_tile_motion *tiles) {
    const part_vec h = part_set(f->h);
    for (size_t p = 0; p < count; ++p) {
        const mspringi_tile_motion *t = &tiles[parts[p].tile];
        const bool is_first = is_first_at_slots(parts, p);
        const part_vec inward = part_set(t->inward), sideways = part_set(t->sideways);
        for (size_t v = 0; v < PART_VECTORS; ++v) {
            const size_t at = parts[p].first_slot + v * PART_LANES;
            const part_vec weight = part_load(mspringi_part_weights[parts[p].lanes] + v * PART_LANES);
            const part_vec x = part_sub(part_sub(part_load(f->x + at), part_set(t->origin_x)), part_set(t->x));
            const part_vec y = part_sub(part_sub(part_load(f->y + at), part_set(t->origin_y)), part_set(t->y));
            const part_vec vx = part_sub(part_load(f->vx + at), part_set(t->origin_vx));
            const part_vec vy = part_sub(part_load(f->vy + at), part_set(t->origin_vy));
            const part_vec turned_x = part_sub(part_mul(inward, x), part_mul(sideways, y));
            const part_vec turned_y = part_add(part_mul(inward, y), part_mul(sideways, x));
            const part_vec moved_x = part_sub(part_mul(h, vx), part_set(t->hvx));
            const part_vec moved_y = part_sub(part_mul(h, vy), part_set(t->hvy));
            put_part(f->turned_x + at, weight, turned_x, is_first);
            put_part(f->turned_y + at, weight, turned_y, is_first);
            put_part(f->arm_x + at, weight, part_add(part_add(x, turned_x), moved_x), is_first);
            put_part(f->arm_y + at, weight, part_add(part_add(y, turned_y), moved_y), is_first);
        }
    }
}

/* ----------------------------------------------------------------------------------------------------- by slot */

// Parameters, since compilers know that restrict parameters do not alias.
static void predict_coordinate(size_t first, size_t end, const float *restrict position, const float *restrict low,
                               const float *restrict velocity, const float *restrict history,
                               const float *restrict turned, const float *restrict inverse_mass, float h,
                               float first_share, float rate, double *restrict predicted, float *restrict start) {
    for (size_t i = first; i < end; ++i) {
        const float moved = (velocity[i] + first_share * history[i]) + rate * turned[i];
        const double straight = ((double)position[i] + (double)low[i]) + (double)h * (double)velocity[i];
        predicted[i] = straight + (double)turned[i];
        start[i] = inverse_mass[i] > 0.0f ? moved : velocity[i];
    }
}

static void predict(const mspringi_prediction *f, size_t first, size_t end) {
    predict_coordinate(first, end, f->x, f->low_x, f->vx, f->first_x, f->turned_x, f->inverse_mass, f->h,
                       f->first_share, f->rate, f->to_x, f->start_vx);
    predict_coordinate(first, end, f->y, f->low_y, f->vy, f->first_y, f->turned_y, f->inverse_mass, f->h,
                       f->first_share, f->rate, f->to_y, f->start_vy);
}

MSPRINGI_INLINE void add_outside_terms(const mspringi_outside *outside, float *restrict residual, size_t first,
                                       size_t end, bool forced, bool second) {
    const mspringi_outside o = *outside;
    const float *restrict const mass = o.mass, *restrict const velocity = o.velocity;
    const float *restrict const turned = o.turned, *restrict const force = o.force;
    const float *restrict const first_history = o.first, *restrict const second_history = o.second;
    for (size_t i = first; i < end; ++i) {
        float shift = o.shift + velocity[i] * o.velocity_fraction - turned[i] * o.turned_fraction;
        if (second)
            shift = shift + (first_history[i] * o.first_share + second_history[i] * o.second_share);
        float sum = residual[i] + mass[i] * shift;
        if (forced)
            sum = sum + force[i] * o.force_fraction;
        residual[i] = mass[i] > 0.0f ? sum : 0.0f;
    }
}

static void add_outside(const mspringi_outside *o, float *residual, size_t first, size_t end) {
    if (o->force && o->second)
        add_outside_terms(o, residual, first, end, true, true);
    else if (o->force)
        add_outside_terms(o, residual, first, end, true, false);
    else if (o->second)
        add_outside_terms(o, residual, first, end, false, true);
    else
        add_outside_terms(o, residual, first, end, false, false);
}

// Correct one coordinate. A pinned particle has d = 0. The way beyond h v and the change of velocity are sums of
// small terms: as differences of positions and of velocities they would be lost in short substeps.
MSPRINGI_INLINE void correct(size_t count, const double *restrict predicted, const float *restrict inverse_mass,
                             const float *restrict solution, const float *restrict direction, const float *from,
                             const float *low, const float *low_velocity, const float *history, float alpha,
                             float h, float first_share, float rate, float grid, float *restrict position,
                             float *restrict velocity, float *restrict to_low, float *restrict to_low_velocity,
                             float *restrict to_first, float *restrict to_second, mspringi_history_kind memory) {
    const float per_h = 1.0f / h;
    for (size_t i = 0; i < count; ++i) {
        const float d = solution[i] + alpha * direction[i], v = velocity[i];
        const double straight = ((double)from[i] + (double)low[i]) + (double)h * (double)v;
        const double end = predicted[i] + (double)d;
        const float rounded = ((float)end + grid) - grid, beyond = (float)((predicted[i] - straight) + (double)d);
        const float given = first_share * history[i] + rate * beyond;
        const float change = inverse_mass[i] > 0.0f ? given : 0.0f, by = change + low_velocity[i], sum = v + by;
        const float after = inverse_mass[i] > 0.0f ? sum : v;
        position[i] = rounded;
        velocity[i] = after;
        to_low[i] = (float)(end - (double)rounded);
        to_low_velocity[i] = by - (after - v);
        switch (memory) {
        case MSPRINGI_HISTORY_VELOCITY_CHANGE:
            to_first[i] = change * per_h;
            break;
        case MSPRINGI_HISTORY_ACCELERATION:
            to_first[i] = beyond * per_h * per_h + 0.5f * history[i];
            break;
        case MSPRINGI_HISTORY_BDF2:
            to_first[i] = beyond - h * change; // (h v + d) - h v(t+h)
            to_second[i] = change;
            break;
        default:
            break;
        }
    }
}

// By blocks, through copies on the stack, so that the history may be updated in place. Positions are copied, too,
// since V8 11.3 (node 20) reads one for a conversion to double after it has been written.
#define MSPRINGI_CORRECT(name, memory)                                                                             \
    static void correct_##name(const mspringi_correction *l, size_t first, size_t end) {                           \
        float low_velocity[MSPRINGI_WIDTH] = {0.0f};                                                               \
        for (size_t i = first; i < end; i += MSPRINGI_WIDTH) {                                                     \
            float from[MSPRINGI_WIDTH], low[MSPRINGI_WIDTH], history[MSPRINGI_WIDTH], unused[MSPRINGI_WIDTH];      \
            float rest[MSPRINGI_WIDTH];                                                                            \
            if (l->low_velocity)                                                                                   \
                memcpy(low_velocity, l->low_velocity + i, sizeof low_velocity);                                    \
            for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {                                                 \
                from[lane] = l->position[i + lane];                                                                \
                low[lane] = l->low[i + lane];                                                                      \
                history[lane] = l->first[i + lane];                                                                \
            }                                                                                                      \
            correct(MSPRINGI_WIDTH, l->predicted + i, l->inverse_mass + i, l->solution + i, l->direction + i,      \
                    from, low, low_velocity, history, l->alpha, l->h, l->first_share, l->rate, l->grid,            \
                    l->position + i, l->velocity + i, l->to_low + i, rest, l->to_first + i,                        \
                    memory == MSPRINGI_HISTORY_BDF2 ? l->to_second + i : unused, memory);                          \
            if (l->low_velocity)                                                                                   \
                memcpy(l->low_velocity + i, rest, sizeof rest);                                                    \
        }                                                                                                          \
    }

MSPRINGI_CORRECT(none, MSPRINGI_HISTORY_NONE)
MSPRINGI_CORRECT(velocity_change, MSPRINGI_HISTORY_VELOCITY_CHANGE)
MSPRINGI_CORRECT(acceleration, MSPRINGI_HISTORY_ACCELERATION)
MSPRINGI_CORRECT(bdf2, MSPRINGI_HISTORY_BDF2)

#undef MSPRINGI_CORRECT
#undef PART_VECTORS

#endif
