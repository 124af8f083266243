/// The explicit scheme in double precision.
#include "reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *zeros(size_t count, size_t size) {
    void *made = calloc(count > 0 ? count : 1, size);
    if (!made)
        abort();
    return made;
}

reference reference_make(const reference *sizes) {
    reference r = *sizes;
    const uint32_t p = r.particles, s = r.springs;
    const uint32_t counts[KINDS] = {s, s, s, p, p, p, p, r.steps * r.actuators, r.steps * r.forced * 2};
    for (int kind = 0; kind < KINDS; kind++)
        r.first[kind + 1] = r.first[kind] + counts[kind];
    r.inverse_mass = zeros(p, sizeof(double));
    r.a = zeros(s, sizeof(uint32_t));
    r.b = zeros(s, sizeof(uint32_t));
    r.actuator = zeros(r.actuators, sizeof(uint32_t));
    r.nominal = zeros(r.actuators, sizeof(double));
    r.forced_of = zeros(r.forced, sizeof(uint32_t));
    r.weights = zeros(8 * (size_t)p, sizeof(double));
    r.substeps = zeros(r.steps, sizeof(uint32_t));
    r.h = zeros(r.steps, sizeof(double));
    r.lag = zeros(r.steps, sizeof(double));
    r.roundings = zeros(4 * (size_t)p * r.steps * r.most_substeps, sizeof(double));
    r.values = zeros(r.first[KINDS], sizeof(double));
    return r;
}

void reference_free(reference *r) {
    free(r->inverse_mass);
    free(r->a);
    free(r->b);
    free(r->actuator);
    free(r->nominal);
    free(r->forced_of);
    free(r->weights);
    free(r->values);
    free(r->roundings);
    free(r->substeps);
    free(r->h);
    free(r->lag);
}

/// Scratch of a run.
typedef struct trip {
    double *x, *y, *vx, *vy, *fx, *fy, *length, *from;
} trip;

static void pull(const reference *r, const trip *run) {
    const double *k = r->values + r->first[BY_STIFFNESS], *c = r->values + r->first[BY_DAMPING];
    for (uint32_t i = 0; i < r->springs; i++) {
        const uint32_t a = r->a[i], b = r->b[i];
        const double dx = run->x[b] - run->x[a], dy = run->y[b] - run->y[a];
        const double rate = (run->vx[b] - run->vx[a]) * dx + (run->vy[b] - run->vy[a]) * dy;
        const double length = sqrt(dx * dx + dy * dy);
        const double f = (k[i] * (length - run->length[i]) + c[i] * rate / length) / length;
        run->fx[a] += f * dx;
        run->fy[a] += f * dy;
        run->fx[b] -= f * dx;
        run->fy[b] -= f * dy;
    }
}

// Keep a particle above the planes: it lands on one that it would pass, and one that is below is put onto it.
static void stay_above(const reference *r, double h, double *x, double *y, double *vx, double *vy) {
    for (uint32_t i = 0; i < r->planes; i++) {
        const double *n = r->planes_of[i], distance = n[0] * *x + n[1] * *y - n[2], speed = n[0] * *vx + n[1] * *vy;
        if (distance + h * speed < 0) {
            const double wanted = distance > 0 ? -distance / h : fmax(speed, 0), out = fmin(distance, 0);
            *vx += (wanted - speed) * n[0];
            *vy += (wanted - speed) * n[1];
            *x -= out * n[0];
            *y -= out * n[1];
        }
    }
}

static void move(const reference *r, const trip *run, double h, double lag) {
    const double time = (lag + h) / 2, keep = exp(-r->rate * time);
    const double gain = r->rate > 0 ? (1 - keep) / r->rate : time;
    for (uint32_t p = 0; p < r->particles; p++) {
        const double m = r->inverse_mass[p];
        if (m > 0) {
            run->vx[p] = keep * run->vx[p] + gain * (m * run->fx[p] + r->gravity_x);
            run->vy[p] = keep * run->vy[p] + gain * (m * run->fy[p] + r->gravity_y);
            stay_above(r, h, &run->x[p], &run->y[p], &run->vx[p], &run->vy[p]);
        }
        run->x[p] += h * run->vx[p];
        run->y[p] += h * run->vy[p];
    }
}

static void set_lengths(const reference *r, const trip *run, uint32_t step, uint32_t substep) {
    const uint32_t count = r->substeps[step], all = r->changes < count ? r->changes : count;
    const uint32_t by = r->changes <= 1 ? 1 : r->changes >= count ? substep + 1 : substep * r->changes / count + 1;
    for (uint32_t i = 0; i < r->actuators; i++) {
        const double to = r->nominal[i] * r->values[r->first[BY_SIGNALS] + step * r->actuators + i];
        run->length[r->actuator[i]] = run->from[i] + (to - run->from[i]) * by / all;
    }
}

static double loss_of(const reference *r, const trip *run, int at) {
    const double *const z[4] = {run->x, run->y, run->vx, run->vy};
    const double *w = r->weights + 4 * (size_t)r->particles * (size_t)at;
    double sum = 0;
    for (uint32_t p = 0; p < r->particles; p++)
        for (int i = 0; i < 4; i++)
            sum += w[4 * p + (uint32_t)i] * (z[i][p] + z[i][p] * z[i][p] / 2);
    return sum;
}

static void begin_step(const reference *r, const trip *run) {
    for (uint32_t i = 0; i < r->actuators; i++)
        run->from[i] = run->length[r->actuator[i]];
}

static void take_substep(const reference *r, const trip *run, uint32_t step, uint32_t substep) {
    const double *forces = r->values + r->first[BY_FORCES] + (size_t)step * r->forced * 2;
    memset(run->fx, 0, r->particles * sizeof(double));
    memset(run->fy, 0, r->particles * sizeof(double));
    for (uint32_t i = 0; i < r->forced; i++) {
        run->fx[r->forced_of[i]] += forces[2 * i];
        run->fy[r->forced_of[i]] += forces[2 * i + 1];
    }
    set_lengths(r, run, step, substep);
    pull(r, run);
    move(r, run, r->h[step], substep == 0 ? r->lag[step] : r->h[step]);
    const double *rounding = r->roundings + 4 * (size_t)r->particles * (step * r->most_substeps + substep);
    for (uint32_t i = 0; i < 4 * r->particles; i++)
        run->x[i] += rounding[i]; // x, y, vx and vy lie one after another
}

static trip begin(const reference *r) {
    const size_t p = r->particles;
    double *memory = zeros(6 * p + r->springs + r->actuators, sizeof(double));
    const trip run = {memory,         memory + p,     memory + 2 * p, memory + 3 * p,
                      memory + 4 * p, memory + 5 * p, memory + 6 * p, memory + 6 * p + r->springs};
    memcpy(run.x, r->values + r->first[BY_X], 4 * p * sizeof(double));
    memcpy(run.length, r->values + r->first[BY_LENGTH], r->springs * sizeof(double));
    return run;
}

void reference_follow(reference *r, const double *states) {
    const trip run = begin(r);
    const size_t size = 4 * (size_t)r->particles;
    memset(r->roundings, 0, size * r->steps * r->most_substeps * sizeof(double));
    for (uint32_t step = 0; step < r->steps; step++) {
        begin_step(r, &run);
        for (uint32_t i = 0; i < r->substeps[step]; i++) {
            const double *before = states + size * (step * (r->most_substeps + 1) + i), *after = before + size;
            memcpy(run.x, before, size * sizeof(double));
            take_substep(r, &run, step, i);
            for (size_t k = 0; k < size; k++)
                r->roundings[size * (step * r->most_substeps + i) + k] = after[k] - run.x[k];
        }
    }
    free(run.x);
}

double reference_loss(const reference *r) {
    const trip run = begin(r);
    double loss = 0;
    for (uint32_t step = 0; step < r->steps; step++) {
        if (step == r->steps / 2)
            loss += loss_of(r, &run, 0);
        begin_step(r, &run);
        for (uint32_t substep = 0; substep < r->substeps[step]; substep++)
            take_substep(r, &run, step, substep);
    }
    loss += loss_of(r, &run, 1);
    free(run.x);
    return loss;
}

static double at(reference *r, uint32_t value, double change) {
    const double was = r->values[value];
    r->values[value] = was + change;
    const double loss = reference_loss(r);
    r->values[value] = was;
    return loss;
}

double reference_difference(reference *r, uint32_t value, double step) {
    const double near = at(r, value, step) - at(r, value, -step), far = at(r, value, 2 * step) - at(r, value, -2 * step);
    return (8 * near - far) / (12 * step);
}
