// A step of a batch of equal bodies: one work-group for each body, with its state in local memory.
//
// Derived from tests/spec, with the same names: spec.c has the order of sums (add_rows, add_others), the kick, the
// move and the dither, spec_springs.c the actuators, spec_floor.c the floor. If the two differ, tests/spec is
// right. In networks with groups (massspring_batch.h) the lag is h, so all substeps have the same kick.
//
// Defined by the host: PARTICLES, ROW_SLOTS and SLOTS of springs around each, ACTUATORS, PLANES, LOCAL (work-items
// of a group), IS_DAMPED.
//
// SPDX-License-Identifier: MIT
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

#define ON_TOP 1u
#define IN_ROWS 2u
#define HAS_OTHERS 4u
#define PER_ITEM ((PARTICLES + LOCAL - 1) / LOCAL)
#define STATE ((size_t)(6 * PARTICLES + ACTUATORS))

typedef struct step_def {
    float h, kick, damping, gravity_x, gravity_y, max_speed;
    uint substeps, dithered, changes, stops;
} step_def;

static float flushed(float speed) {
    return fabs(speed) < 1e-30f ? 0.0f : speed;
}

static float low_of(float value, float low) {
    return fabs(low) <= fabs(value) * 0x1p-21f || low == 0.0f ? low : 0.0f;
}

// Force of a spring. x, y: position, z, w: velocity of its ends.
static float2 pull(float4 here, float4 there, float stiffness, float damping, float rest_length) {
    const float2 d = there.xy - here.xy, dv = there.zw - here.zw;
    const float square = d.x * d.x + d.y * d.y, length = sqrt(square);
    float force = (length - rest_length) * (length * stiffness);
    const float rate = dv.x * d.x + dv.y * d.y;
    force = force + rate * damping;
    force = force * (square > 1e-37f ? 1.0f / square : 0.0f);
    return (float2)(force * d.x, force * d.y);
}

// Force of a link of a particle. Its x has the other particle in 16 bits, and above them the actuator, or 0xffff.
// Then come stiffness, damping and rest length. A slot without a spring has a link without stiffness to the
// particle itself, so its force is 0 without a branch.
static float2 pull_by(uint4 link, float4 here, local const float4 *motions, local const float *lengths) {
    float rest_length = as_float(link.w);
#if ACTUATORS > 0
    const uint actuator = link.x >> 16;
    rest_length = actuator < ACTUATORS ? lengths[actuator] : rest_length;
#endif
    return pull(here, motions[link.x & 0xffffu], as_float(link.y), as_float(link.z), rest_length);
}

#define PULL(slot) pull_by(links[(slot) * PARTICLES + p], here, motions, lengths)

// The first slots are south-east, south, south-west, west, north-west, east, north, north-east.
static float2 add_rows(global const uint4 *links, uint is_top, uint p, float4 here, local const float4 *motions,
                       local const float *lengths) {
    const float2 below = (PULL(0) + PULL(1)) + PULL(2), west = PULL(3), east = PULL(5);
    const float2 inside = ((below + (west + PULL(4))) + (east + PULL(6))) + PULL(7);
    return is_top ? (below + east) + west : inside;
}

static float2 add_others(global const uint4 *links, uint p, float4 here, local const float4 *motions,
                         local const float *lengths) {
    float2 force = (float2)(0.0f, 0.0f);
    for (uint slot = ROW_SLOTS; slot < SLOTS; slot++)
        force = force + PULL(slot);
    return force;
}

static float dither(const step_def *all, uint number) {
    const uint fraction = (2 * (number / 4) + 1) * 0x4f1bbcddu;
    const float d = (float)(fraction >> 8) * 0x1p-43f;
    return number >= all->dithered ? 0.0f : number % 4 == 0 || number % 4 == 3 ? d : -d;
}

#if PLANES > 0
// Half-planes, in double precision: spec_floor.c without heights. The host gives n, the offset of the border,
// friction and restitution of each plane.
#define NO_RESTITUTION 0.1
#define GROWTH (1.0 + 1e-9)
#define ROUNDS_OF_PLANES 4

typedef struct plane {
    double nx, ny, offset, friction, restitution;
} plane;

typedef struct bouncer {
    double x, y, vx, vy, half_x, half_y, max_restitution, slack, spare;
} bouncer;

static plane plane_at(global const double *planes, int i) {
    const plane p = {planes[5 * i], planes[5 * i + 1], planes[5 * i + 2], planes[5 * i + 3], planes[5 * i + 4]};
    return p;
}

static double square_of(const bouncer *b) {
    const double wx = b->vx - b->half_x, wy = b->vy - b->half_y;
    return (wx * wx + wy * wy) + b->spare;
}

static double slack_of(double keep, double scale) {
    const double u = 1.0 - keep;
    if (scale <= 1.0 || !(u < 0.05))
        return 0.0;
    double series = 1.0 / 6;
    for (int divisor = 5; divisor >= 1; divisor--)
        series = 1.0 / divisor + u * series;
    const double share = 2.0 * series / scale - 1.0;
    return share < 1.0 - 1e-5 ? 1.0 - share * share : 0.0;
}

static double distance_from(const plane *s, double x, double y) {
    return s->nx * x + s->ny * y + s->offset;
}

static double distance_from_all(global const double *planes, double x, double y) {
    double least = INFINITY;
    for (int i = 0; i < PLANES; i++) {
        const plane s = plane_at(planes, i);
        least = fmin(least, distance_from(&s, x, y));
    }
    return least;
}

static double slop_at(double x, double y) {
    return 0x1p-21 * (fabs(x) + fabs(y)) + 1e-12;
}

static bool bounce(const plane *s, double h, double allowed, bouncer *b) {
    const double nx = s->nx, ny = s->ny;
    const double distance = nx * b->x + ny * b->y + s->offset, normal_speed = nx * b->vx + ny * b->vy;
    if (!(distance + h * normal_speed < -allowed))
        return false;
    const double depth = distance < 0.0 ? distance : 0.0;
    const double half_across = nx * b->half_x + ny * b->half_y, inward = half_across - normal_speed;
    const double e = s->restitution < b->max_restitution ? s->restitution : b->max_restitution;
    const double bounce_speed = e * inward + half_across, landing_speed = (depth - distance) / h;
    const bool bounces = inward > 0.0 && bounce_speed > landing_speed && e > NO_RESTITUTION;
    const double wanted = bounces ? bounce_speed : landing_speed;
    const double normal_change = (wanted > normal_speed ? wanted : normal_speed) - normal_speed;
    const double speed = nx * b->vy - ny * b->vx, half_along = nx * b->half_y - ny * b->half_x;
    const double in_step = speed - half_along, square = in_step * in_step + b->slack * (half_along * half_along);
    const double most_friction = s->friction * normal_change, most = b->slack > 0.0 ? sqrt(square) : fabs(in_step);
    const double friction = speed > most_friction ? most_friction : speed < -most_friction ? -most_friction : speed;
    const double braked = in_step - friction;
    const double end = fabs(braked) > most * GROWTH ? (braked > 0.0 ? most : -most) : braked, brake = in_step - end;
    b->vx = b->vx + (normal_change * nx + brake * ny);
    b->vy = b->vy + (normal_change * ny - brake * nx);
    b->x = b->x - depth * nx;
    b->y = b->y - depth * ny;
    b->spare = 0.0;
    return true;
}

static bool put_outside(global const double *planes, double *x, double *y) {
    const double slop = slop_at(*x, *y);
    bool was_inside = false;
    for (int round = 0; round <= ROUNDS_OF_PLANES && distance_from_all(planes, *x, *y) < -slop; round++) {
        was_inside = true;
        for (int i = 0; i < PLANES; i++) {
            const plane s = plane_at(planes, i);
            const double distance = distance_from(&s, *x, *y);
            *x -= distance < 0.0 ? distance * s.nx : 0.0;
            *y -= distance < 0.0 ? distance * s.ny : 0.0;
        }
    }
    return was_inside;
}

static bool ends_outside(global const double *planes, double h, const bouncer *b) {
    const double x = b->x + h * b->vx, y = b->y + h * b->vy;
    return distance_from_all(planes, x, y) >= -slop_at(x, y);
}

static bool bounce_with_care(global const double *planes, double h, float2 had, bouncer *b) {
    const double slop = slop_at(b->x, b->y), most = square_of(b);
    const bool ends_inside = distance_from_all(planes, b->x + h * b->vx, b->y + h * b->vy) < 0.0;
    const bool was_inside = ends_inside && put_outside(planes, &b->x, &b->y);
    bool acts = was_inside, goes_on = true;
    for (int round = 0; round < ROUNDS_OF_PLANES && goes_on; round++) {
        goes_on = false;
        for (int i = 0; i < PLANES; i++) {
            const plane s = plane_at(planes, i);
            goes_on |= bounce(&s, h, round == 0 ? 0.0 : slop, b);
        }
        acts |= goes_on;
    }
    const double square = square_of(b);
    if (acts && !was_inside && square > most * GROWTH) {
        const double keep = sqrt(most / square);
        b->vx = b->half_x + keep * (b->vx - b->half_x);
        b->vy = b->half_y + keep * (b->vy - b->half_y);
    }
    if (!acts || ends_outside(planes, h, b))
        return acts;
    b->vx = -(double)had.x;
    b->vy = -(double)had.y;
    if (!ends_outside(planes, h, b))
        b->vx = b->vy = 0.0;
    return true;
}

static void put_coordinate(double x, float *first, float *low) {
    *first = (float)x;
    *low = low_of(*first, (float)(x - (double)*first));
}

// As spec_touch_floor(), and as bounce() in spec.c applies its result.
static void touch_floor(global const double *planes, double shortest, double h, double kick, double loss,
                        float2 had, float2 *place, float2 *low, float2 *velocity) {
    const double keep = 1.0 - loss, scale = h / kick, per_length = 4.0 * h / shortest;
    const double vx = (double)velocity->x, vy = (double)velocity->y;
    bouncer start = {(double)place->x - h * vx, (double)place->y - h * vy, vx, vy,
                     0.5 * (scale * (vx - keep * (double)had.x)), 0.5 * (scale * (vy - keep * (double)had.y)),
                     0.0, 0.0, 0.0};
    const double most = 1.0 - per_length * per_length * square_of(&start);
    start.max_restitution = most > 0.0 ? most : 0.0;
    start.slack = slack_of(keep, scale);
    start.spare = start.slack * (start.half_x * start.half_x + start.half_y * start.half_y);
    const double slop = slop_at(start.x, start.y);
    bouncer b = start;
    bool acts = false, needs_care = false;
    for (int i = 0; i < PLANES; i++) {
        const plane s = plane_at(planes, i);
        needs_care |= distance_from(&s, b.x, b.y) < -slop;
        acts |= bounce(&s, h, 0.0, &b);
    }
    needs_care |= acts && (start.slack > 0.0 || square_of(&b) >= square_of(&start) * GROWTH);
    for (int i = 0; PLANES > 1 && i < PLANES; i++) {
        const plane s = plane_at(planes, i);
        needs_care |= distance_from(&s, b.x + h * b.vx, b.y + h * b.vy) < -0.25 * slop;
    }
    if (needs_care) {
        b = start;
        acts = bounce_with_care(planes, h, had, &b);
    }
    if (acts) {
        float first_x, first_y, low_x, low_y;
        put_coordinate(b.x + h * b.vx, &first_x, &low_x);
        put_coordinate(b.y + h * b.vy, &first_y, &low_y);
        *place = (float2)(first_x, first_y);
        *low = (float2)(low_x, low_y);
        *velocity = (float2)((float)b.vx, (float)b.vy);
    }
}
#endif

// Set the rest lengths of actuators in a substep. They change to their targets in even parts.
static void set_lengths(const step_def *all, uint number, global const float *from, global const float *targets,
                        local float *lengths) {
#if ACTUATORS > 0
    const uint parts = all->changes < all->substeps ? all->changes : all->substeps;
    uint by = 1;
    if (parts > 1)
        by = all->changes >= all->substeps ? number + 1 : (uint)((ulong)number * all->changes / all->substeps) + 1;
    for (uint a = get_local_id(0); a < ACTUATORS; a += LOCAL)
        lengths[a] = by == parts ? targets[a] : from[a] + (targets[a] - from[a]) * ((float)by / (float)parts);
#endif
}

// Kick and move a particle, then let the floor act. Return the motion after the substep; *low has its low words.
static float4 move_particle(const step_def *all, uint number, uint p, uint2 particle, global const uint4 *links,
                            global const double *planes, double shortest, local const float4 *motions,
                            local const float *lengths, float2 *low) {
    const float loss = all->damping + dither(all, number), inverse_mass = as_float(particle.x);
    const bool flushes = IS_DAMPED && number % 2 == 0;
    const float4 had = motions[p];
    float2 velocity = had.zw;
#if SLOTS > ROW_SLOTS
    const float2 others = add_others(links, p, had, motions, lengths);
#endif
#if ROW_SLOTS == 0
    const float2 force = others;
#elif SLOTS == ROW_SLOTS
    const float2 force = add_rows(links, particle.y & ON_TOP, p, had, motions, lengths);
#else
    const float2 rows = add_rows(links, particle.y & ON_TOP, p, had, motions, lengths);
    const float2 force = particle.y & IN_ROWS ? rows : others;
#endif
    if (inverse_mass > 0.0f) {
        const float per_force = inverse_mass * all->kick;
        velocity.x = velocity.x + (force.x * per_force + (all->gravity_x - loss * velocity.x));
        velocity.y = velocity.y + (force.y * per_force + (all->gravity_y - loss * velocity.y));
        velocity.x = flushes ? flushed(velocity.x) : velocity.x;
        velocity.y = flushes ? flushed(velocity.y) : velocity.y;
    }
    const float2 whole = velocity * all->h + *low;
    float2 place = had.xy + whole;
    *low = whole - (place - had.xy);
#if ROW_SLOTS > 0 && SLOTS > ROW_SLOTS
    if (inverse_mass > 0.0f && (particle.y & (IN_ROWS | HAS_OTHERS)) == (IN_ROWS | HAS_OTHERS)) { // push_on()
        const float per_force = inverse_mass * all->kick;
        const float2 push = others * per_force, rest = push * all->h + *low, at = place;
        velocity = velocity + push;
        place = at + rest;
        *low = rest - (place - at);
    }
#endif
#if PLANES > 0
    if (inverse_mass > 0.0f)
        touch_floor(planes, shortest, (double)all->h, (double)all->kick, (double)loss, had.zw, &place, low, &velocity);
#endif
    return (float4)(place, velocity);
}

// End a step: tiny speeds become 0, but -0 stays. True if the particle is out of bounds.
static bool end_motion(const step_def *all, local float4 *motion) {
    float4 m = *motion;
    if (all->stops) {
        m.z = m.z != 0.0f ? flushed(m.z) : m.z;
        m.w = m.w != 0.0f ? flushed(m.w) : m.w;
    }
    *motion = m;
    return !(fmax(fabs(m.x), fabs(m.y)) <= 1e12f && fmax(fabs(m.z), fabs(m.w)) <= all->max_speed) ||
           !isfinite(m.x + m.y + m.z + m.w);
}

// Position of a body out of bounds: it moves from where it was as pins at rest do, which may round a tie in a low
// word.
static float2 rest_at(float place, float low) {
    const float whole = 0.0f + low, at = place + whole;
    return (float2)(at, whole - (at - place));
}

static void write_motion(global const float *from, global float *to, uint p, float4 motion, float2 low, bool is_bad) {
    const float2 x = is_bad ? rest_at(from[p], from[2 * PARTICLES + p]) : (float2)(motion.x, low.x);
    const float2 y = is_bad ? rest_at(from[PARTICLES + p], from[3 * PARTICLES + p]) : (float2)(motion.y, low.y);
    to[p] = x.x;
    to[PARTICLES + p] = y.x;
    to[2 * PARTICLES + p] = x.y;
    to[3 * PARTICLES + p] = y.y;
    to[4 * PARTICLES + p] = is_bad ? 0.0f : motion.z;
    to[5 * PARTICLES + p] = is_bad ? 0.0f : motion.w;
}

kernel __attribute__((reqd_work_group_size(LOCAL, 1, 1)))
void take_step(global const float *before, global float *after, global const uchar *was_held, global uchar *is_held,
               global const float *all_targets, global const uint4 *links, global const uint2 *particles,
               global const double *planes, step_def all, double shortest) {
    const size_t body = get_group_id(0);
    const uint item = get_local_id(0), held = was_held[body];
    global const float *from = before + body * STATE, *targets = all_targets + body * ACTUATORS;
    global float *to = after + body * STATE;
    local float4 motions[PARTICLES];
    local float lengths[ACTUATORS + 1];
    local uint is_bad;
    float2 low[PER_ITEM];
    float4 moved[PER_ITEM];
    if (item == 0)
        is_bad = held;
    for (uint i = 0, p = item; p < PARTICLES; i++, p += LOCAL) {
        motions[p] = (float4)(from[p], from[PARTICLES + p], from[4 * PARTICLES + p], from[5 * PARTICLES + p]);
        low[i] = (float2)(from[2 * PARTICLES + p], from[3 * PARTICLES + p]);
    }
    for (uint number = 0; number < all.substeps; number++) {
        set_lengths(&all, number, from + 6 * PARTICLES, targets, lengths);
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint i = 0, p = item; p < PARTICLES && !held; i++, p += LOCAL)
            moved[i] = move_particle(&all, number, p, particles[p], links, planes, shortest, motions, lengths, &low[i]);
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint i = 0, p = item; p < PARTICLES && !held; i++, p += LOCAL)
            motions[p] = moved[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint p = item; p < PARTICLES; p += LOCAL)
        if (end_motion(&all, &motions[p]))
            atomic_or(&is_bad, 1u);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = 0, p = item; p < PARTICLES; i++, p += LOCAL)
        write_motion(from, to, p, motions[p], low[i], is_bad);
    for (uint a = item; a < ACTUATORS; a += LOCAL)
        to[6 * PARTICLES + a] = targets[a];
    if (item == 0)
        is_held[body] = is_bad != 0;
}

// Put the bodies in a mask back to their start, and copy the others. Body b began as number b % start_count.
kernel __attribute__((reqd_work_group_size(LOCAL, 1, 1)))
void put_back(global const float *before, global float *after, global const uchar *was_held, global uchar *is_held,
              global const float *start, global const uchar *mask, uint start_count) {
    const size_t body = get_group_id(0);
    global const float *from = mask[body] ? start + body % start_count * STATE : before + body * STATE;
    for (size_t i = get_local_id(0); i < STATE; i += LOCAL)
        after[body * STATE + i] = from[i];
    if (get_local_id(0) == 0)
        is_held[body] = mask[body] ? 0 : was_held[body];
}

// Properties that a column may have: mspring_property in core.h.
#define MASS 0x000u
#define X 0x002u
#define Y 0x003u
#define VX 0x004u
#define VY 0x005u
#define RELATIVE_X 0x00bu
#define RELATIVE_Y 0x00cu
#define RELATIVE_VX 0x00du
#define RELATIVE_VY 0x00eu
#define GROUP_X 0x300u
#define GROUP_FLAGS 0x380u

// A particle's number in an observation. frame: centre of mass and its velocity.
static double observed(uint property, double mass, double2 place, double2 velocity, double2 origin, double4 frame) {
    switch (property) {
    case MASS:
        return mass;
    case X:
        return origin.x + place.x;
    case Y:
        return origin.y + place.y;
    case VX:
        return velocity.x;
    case VY:
        return velocity.y;
    case RELATIVE_X:
        return origin.x - frame.x + place.x;
    case RELATIVE_Y:
        return origin.y - frame.y + place.y;
    case RELATIVE_VX:
        return velocity.x - frame.z;
    default:
        return velocity.y - frame.w;
    }
}

// Observe bodies as mspring_network_observe_groups(). Each body is one work-item, so sums are in the order of
// particles. columns: property and index.
kernel void observe(global const float *state, global const uchar *is_held, global const float *masses,
                    global const uint2 *columns, global double *rows, uint first, uint count, uint column_count,
                    double origin_x, double origin_y) {
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    global const float *from = state + (first + i) * STATE;
    global double *row = rows + i * (size_t)column_count;
    double mass = 0.0, sx = 0.0, sy = 0.0, px = 0.0, py = 0.0;
    double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300;
    for (uint p = 0; p < PARTICLES; p++) {
        const double m = (double)masses[p];
        const double x = (double)from[p] + (double)low_of(from[p], from[2 * PARTICLES + p]);
        const double y = (double)from[PARTICLES + p] + (double)low_of(from[PARTICLES + p], from[3 * PARTICLES + p]);
        mass += m;
        sx += m * x;
        sy += m * y;
        px += m * (double)from[4 * PARTICLES + p];
        py += m * (double)from[5 * PARTICLES + p];
        low_x = x < low_x ? x : low_x;
        low_y = y < low_y ? y : low_y;
        high_x = x > high_x ? x : high_x;
        high_y = y > high_y ? y : high_y;
    }
    const double part = 1.0 / mass;
    const double of_body[8] = {origin_x + sx * part, origin_y + sy * part, px * part,         py * part,
                               origin_x + low_x,     origin_y + low_y,     origin_x + high_x, origin_y + high_y};
    const double4 frame = (double4)(of_body[0], of_body[1], of_body[2], of_body[3]);
    for (uint c = 0; c < column_count; c++) {
        const uint property = columns[c].x, p = columns[c].y;
        if (property == GROUP_FLAGS)
            row[c] = is_held[first + i] ? 1.0 : 0.0;
        else if (property >= GROUP_X)
            row[c] = of_body[property - GROUP_X];
        else if (p >= PARTICLES)
            row[c] = 0.0;
        else
            row[c] = observed(
                property, (double)masses[p],
                (double2)((double)from[p] + (double)low_of(from[p], from[2 * PARTICLES + p]),
                          (double)from[PARTICLES + p] + (double)low_of(from[PARTICLES + p], from[3 * PARTICLES + p])),
                (double2)((double)from[4 * PARTICLES + p], (double)from[5 * PARTICLES + p]),
                (double2)(origin_x, origin_y), frame);
    }
}
