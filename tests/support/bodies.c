#include "bodies.h"

#include <math.h>
#include <stdlib.h>

bodies *bodies_begin(double h) {
    bodies *b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->builder = support_builder();
    b->h = h;
    b->damping = 0.03;
    return b;
}

void bodies_free(bodies *b) {
    free(b);
}

static void add_spring(bodies *b, uint32_t p, uint32_t q, double f) {
    const double inverse = (b->mass[p] > 0 ? 1 / b->mass[p] : 0) + (b->mass[q] > 0 ? 1 / b->mass[q] : 0);
    const double reduced = inverse > 0 ? 1 / inverse : 1;
    bodies_spring *s = &b->springs[b->spring_count++];
    assert_true(b->spring_count <= BODIES_MOST_SPRINGS);
    s->a = p;
    s->b = q;
    s->stiffness = (double)(float)(f * reduced / (b->h * b->h));
    const mspring_id id =
        support_spring(b->builder, p, q, (float)s->stiffness, (float)(b->damping * reduced / b->h));
    assert_int_equal(id, b->spring_count - 1);
}

uint32_t bodies_add(bodies *b, const bodies_lattice *l) {
    static const int32_t steps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    const int32_t width = (int32_t)l->width, height = (int32_t)l->height;
    const uint32_t first = b->count;
    uint32_t *id = malloc(sizeof *id * l->width * l->height);
    assert_non_null(id);
    for (int32_t r = 0; r < height; r++)
        for (int32_t c = 0; c < width; c++) {
            id[r * width + c] = MSPRING_NONE;
            if (l->mask && !l->mask[r * width + c])
                continue;
            const uint32_t p = id[r * width + c] = b->count++;
            assert_true(b->count <= BODIES_MOST_PARTICLES);
            const double u = (c - (width - 1) / 2.0) * l->spacing, v = (r - (height - 1) / 2.0) * l->spacing;
            b->x[p] = l->x + cos(l->angle) * u - sin(l->angle) * v;
            b->y[p] = l->y + sin(l->angle) * u + cos(l->angle) * v;
            b->mass[p] = l->mass;
            b->body[p] = b->body_count;
            b->column[p] = c;
            b->row[p] = r;
            if (l->mass > 0)
                (void)support_particle(b->builder, b->x[p], b->y[p], (float)l->mass);
            else
                (void)support_pinned(b->builder, b->x[p], b->y[p], 1);
        }
    for (int32_t r = 0; r < height; r++)
        for (int32_t c = 0; c < width; c++)
            for (int i = 0; i < 4; i++) {
                const int32_t to_c = c + steps[i][0], to_r = r + steps[i][1];
                if (to_c < 0 || to_c >= width || to_r >= height || id[r * width + c] == MSPRING_NONE ||
                    id[to_r * width + to_c] == MSPRING_NONE)
                    continue;
                add_spring(b, id[r * width + c], id[to_r * width + to_c], l->f);
            }
    b->body_count++;
    free(id);
    return first;
}

/* -------------------------------------------------------------------------------------------------- two of them */

static uint32_t between(uint64_t *seed, uint32_t low, uint32_t high) {
    return low + (uint32_t)(support_random_between(seed, 0, 1) * (high - low + 1));
}

// A hull with holes, a block, a rope, a wedge, a block with a needle, a particle.
static uint32_t add_shape(bodies *b, uint64_t *seed, double x, double y, double mass, double f) {
    uint8_t mask[64];
    bodies_lattice l = {.x = x,
                        .y = y,
                        .angle = support_random_between(seed, 0, 6.283),
                        .spacing = 1,
                        .mass = mass,
                        .f = f,
                        .width = 1,
                        .height = 1};
    for (int i = 0; i < 64; i++)
        mask[i] = 0;
    switch (between(seed, 0, 5)) {
    case 0:
        l.width = 8, l.height = 5, l.mask = mask;
        for (int i = 0; i < 40; i++)
            mask[i] = support_random_between(seed, 0, 1) > 0.15;
        break;
    case 1:
        l.width = between(seed, 2, 8), l.height = between(seed, 2, 5);
        break;
    case 2:
        l.width = between(seed, 3, 11);
        break;
    case 3:
        l.width = 9, l.height = 5, l.mask = mask;
        for (int r = 0; r < 5; r++)
            for (int c = r; c < 9 - r; c++)
                mask[r * 9 + c] = 1;
        break;
    case 4:
        l.width = 7, l.height = 3, l.mask = mask;
        for (int i = 0; i < 21; i++)
            mask[i] = i < 7 || i % 7 < 3;
        break;
    default:
        break;
    }
    return bodies_add(b, &l);
}

bodies *bodies_two(uint64_t trial, double fastest, double h, double *speed) {
    uint64_t seed = trial;
    bodies *b = bodies_begin(h);
    const double ratio = support_random_between(&seed, -0.5, 0.5) * log(1000),
                 f = exp(support_random_between(&seed, log(0.05), log(0.5)));
    (void)add_shape(b, &seed, 0, 0, exp(ratio) * 10, f);
    const double angle = support_random_between(&seed, 0, 6.283), x = 14 * cos(angle), y = 14 * sin(angle);
    const uint32_t second = add_shape(b, &seed, x, y, exp(-ratio) * 10, f);
    *speed = fastest * pow(10, support_random_between(&seed, -2, 0));
    const double off = angle + support_random_between(&seed, -0.25, 0.25),
                 turn = support_random_between(&seed, -0.04, 0.04) * *speed,
                 turn_2 = support_random_between(&seed, -0.04, 0.04) * *speed;
    for (uint32_t p = 0; p < second; p++) {
        b->vx[p] = (float)(-turn * b->y[p]);
        b->vy[p] = (float)(turn * b->x[p]);
    }
    for (uint32_t p = second; p < b->count; p++) {
        b->vx[p] = (float)(-*speed * cos(off) - turn_2 * (b->y[p] - y));
        b->vy[p] = (float)(-*speed * sin(off) + turn_2 * (b->x[p] - x));
    }
    return b;
}

/* ----------------------------------------------------------------------------------------------------- outline */

static bool are_joined(const bodies *b, uint32_t p, uint32_t q) {
    return b->body[p] == b->body[q] && abs(b->column[p] - b->column[q]) <= 1 && abs(b->row[p] - b->row[q]) <= 1;
}

// Springs without triangles on both sides.
static void find_outline(bodies *b) {
    for (uint32_t s = 0; s < b->spring_count; s++) {
        const uint32_t p = b->springs[s].a, q = b->springs[s].b;
        bool left = false, right = false;
        for (uint32_t r = 0; r < b->count; r++) {
            if (r == p || r == q || !are_joined(b, p, r) || !are_joined(b, q, r))
                continue;
            const int side = (b->column[q] - b->column[p]) * (b->row[r] - b->row[p]) -
                             (b->row[q] - b->row[p]) * (b->column[r] - b->column[p]);
            left |= side > 0;
            right |= side < 0;
        }
        b->springs[s].is_edge = !(left && right);
        if (b->springs[s].is_edge)
            b->is_outline[p] = b->is_outline[q] = true;
    }
    bool *has_spring = calloc(b->count + 1, sizeof *has_spring);
    assert_non_null(has_spring);
    for (uint32_t s = 0; s < b->spring_count; s++)
        has_spring[b->springs[s].a] = has_spring[b->springs[s].b] = true;
    for (uint32_t p = 0; p < b->count; p++)
        b->is_outline[p] |= !has_spring[p];
    free(has_spring);
}

mspring_network *bodies_network(bodies *b, const mspring_network_def *def) {
    mspring_network *network = support_network(b->builder, def);
    b->builder = NULL;
    b->gravity_y = (double)def->settings.gravity_y;
    for (uint32_t s = 0; s < b->spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        b->springs[s].rest_length = (double)info.rest_length;
    }
    check_ok(mspring_network_set_velocities(network, NULL, 0, b->count, b->vx, b->vy, 1));
    find_outline(b);
    return network;
}

uint32_t bodies_heap(bodies *b, int blocks, double y) {
    uint32_t last = bodies_add(b, &(bodies_lattice){.width = 24, .height = 1, .spacing = 1, .f = 0.1});
    for (int i = 0; i < blocks; i++)
        last = bodies_add(b, &(bodies_lattice){.width = 4,
                                               .height = 2 + (uint32_t)(i % 2),
                                               .x = -6 + 5 * (i % 3),
                                               .y = y + 4 * (i / 3),
                                               .angle = 0.3 * i,
                                               .spacing = 1,
                                               .mass = 4,
                                               .f = 0.3});
    return last;
}

mspring_contact_def bodies_contact(double thickness, float friction, float restitution) {
    mspring_contact_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def));
    def.thickness = thickness;
    def.friction = friction;
    def.restitution = restitution;
    return def;
}

mspring_result bodies_touch(mspring_network *network, double thickness, float friction, float restitution) {
    const mspring_contact_def def = bodies_contact(thickness, friction, restitution);
    return mspring_network_set_contact(network, &def);
}

/* ----------------------------------------------------------------------------------------------- measuring */

static double add_springs(const bodies *b, double *fx, double *fy) {
    double energy = 0;
    for (uint32_t i = 0; i < b->spring_count; i++) {
        const bodies_spring *s = &b->springs[i];
        const double dx = b->x[s->b] - b->x[s->a], dy = b->y[s->b] - b->y[s->a], length = sqrt(dx * dx + dy * dy);
        const double force = s->stiffness * (length - s->rest_length);
        energy += 0.5 * force * (length - s->rest_length);
        if (length == 0)
            continue;
        fx[s->a] += force * dx / length;
        fy[s->a] += force * dy / length;
        fx[s->b] -= force * dx / length;
        fy[s->b] -= force * dy / length;
    }
    return energy;
}

bodies_measure bodies_measured(bodies *b, const mspring_network *network) {
    bodies_measure m = {0};
    double *fx = calloc(2 * (size_t)b->count, sizeof *fx), *fy = fx + b->count;
    assert_non_null(fx);
    check_ok(mspring_network_get_positions(network, NULL, 0, b->count, b->x, b->y, 1));
    check_ok(mspring_network_get_velocities(network, NULL, 0, b->count, b->vx, b->vy, 1));
    m.energy = add_springs(b, fx, fy);
    for (uint32_t p = 0; p < b->count; p++) {
        const double mass = b->mass[p], vx = (double)b->vx[p], vy = (double)b->vy[p], v = sqrt(vx * vx + vy * vy);
        if (!(mass > 0))
            continue;
        m.energy += mass * (0.5 * v * v - b->gravity_y * b->y[p]);
        m.energy += 0.5 * b->h * (vx * fx[p] + vy * (fy[p] + mass * b->gravity_y));
        m.x += mass * vx;
        m.y += mass * vy;
        m.turn += mass * (b->x[p] * vy - b->y[p] * vx);
        m.momentum_scale += mass * v;
        m.turn_scale += mass * v * sqrt(b->x[p] * b->x[p] + b->y[p] * b->y[p]);
        m.fastest = fmax(m.fastest, v);
        m.mean_speed += v * v;
    }
    m.mean_speed = sqrt(m.mean_speed / b->count);
    free(fx);
    return m;
}

static double distance(const bodies *b, uint32_t p, uint32_t s, uint32_t t) {
    const double ex = b->x[t] - b->x[s], ey = b->y[t] - b->y[s], square = ex * ex + ey * ey;
    double share = square > 0 ? ((b->x[p] - b->x[s]) * ex + (b->y[p] - b->y[s]) * ey) / square : 0;
    share = fmin(fmax(share, 0), 1);
    return hypot(b->x[p] - b->x[s] - share * ex, b->y[p] - b->y[s] - share * ey);
}

static double side(const bodies *b, uint32_t p, uint32_t q, uint32_t r) {
    return (b->x[q] - b->x[p]) * (b->y[r] - b->y[p]) - (b->y[q] - b->y[p]) * (b->x[r] - b->x[p]);
}

static bool are_crossing(const bodies *b, const bodies_spring *s, const bodies_spring *t) {
    return side(b, s->a, s->b, t->a) * side(b, s->a, s->b, t->b) < 0 &&
           side(b, t->a, t->b, s->a) * side(b, t->a, t->b, s->b) < 0;
}

double bodies_deepest(const bodies *b, double thickness, uint32_t *crossings) {
    double deepest = 0;
    *crossings = 0;
    for (uint32_t i = 0; i < b->spring_count; i++) {
        const bodies_spring *s = &b->springs[i];
        if (!s->is_edge)
            continue;
        for (uint32_t p = 0; p < b->count; p++)
            if (b->is_outline[p] && b->body[p] != b->body[s->a])
                deepest = fmax(deepest, thickness - distance(b, p, s->a, s->b));
        for (uint32_t j = i + 1; j < b->spring_count; j++)
            *crossings += b->springs[j].is_edge && b->body[s->a] != b->body[b->springs[j].a] &&
                          are_crossing(b, s, &b->springs[j]);
    }
    return deepest;
}
