/// Reading a network of equal bodies by public calls, and rejecting networks that a batch cannot have.
///
/// **Order of sums.** It follows from slots and from the plan's counts, which mspring_network_describe() tells.
/// Particles in lattices come first, then those in chains, then the irregular ones. A row is whole blocks of 16
/// slots. So columns of neighbours in a lattice differ as their slots do modulo 16, neighbours in a row have
/// consecutive slots, and higher rows have higher slots. A row from which no spring leads north is a top row.
/// arrange.c in tests/spec derives the order from rows. If the number of springs found in rows differs from the
/// plan's, the network is rejected.
///
/// SPDX-License-Identifier: MIT
#include "gpu_template.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/// Slots in a block of a row.
#define GPU_BLOCK 16u

static mspring_result refuse(mspringi_gpu_message *message, const char *what, uint32_t number) {
    return mspringi_gpu_fail(message, MSPRING_ERROR_ARGUMENT, what, (unsigned)number);
}

static mspring_result call_failed(const mspring_network *network, mspring_result result,
                                  mspringi_gpu_message *message) {
    return result == MSPRING_OK
               ? MSPRING_OK
               : mspringi_gpu_fail(message, result, "the network says: %s", mspring_network_error(network));
}

static mspring_result no_memory(mspringi_gpu_message *message) {
    return mspringi_gpu_fail(message, MSPRING_ERROR_MEMORY, "no memory to read the network");
}

/* -------------------------------------------------------------------------------------- state and hash */

float mspringi_gpu_low_of(float value, float low) {
    return fabsf(low) <= fabsf(value) * 0x1p-21f ? low : 0.0f;
}

static uint64_t hash_gpu_word(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * UINT64_C(0x100000001b3);
    return hash ^ hash >> 32;
}

static uint64_t hash_gpu_double(uint64_t hash, double value) {
    uint64_t word;
    memcpy(&word, &value, sizeof word);
    return hash_gpu_word(hash, word);
}

static uint64_t hash_gpu_floats(uint64_t hash, float a, float b) {
    uint32_t low, high;
    memcpy(&low, &a, sizeof low);
    memcpy(&high, &b, sizeof high);
    return hash_gpu_word(hash, (uint64_t)high << 32 | low);
}

uint64_t mspringi_gpu_hash_head(double origin_x, double origin_y, float lag) {
    const uint64_t hash = hash_gpu_double(hash_gpu_double(UINT64_C(0xcbf29ce484222325), origin_x), origin_y);
    return hash_gpu_double(hash, (double)lag);
}

uint64_t mspringi_gpu_hash_body(uint64_t hash, const float *state, uint32_t n) {
    for (uint32_t p = 0; p < n; p++) {
        const float x = state[p], y = state[n + p];
        hash = hash_gpu_floats(hash, x, y);
        hash = hash_gpu_floats(hash, state[4 * n + p], state[5 * n + p]);
        hash = hash_gpu_floats(hash, mspringi_gpu_low_of(x, state[2 * n + p]),
                               mspringi_gpu_low_of(y, state[3 * n + p]));
    }
    return hash;
}

mspring_result mspringi_gpu_read_states(const mspring_network *network, mspringi_gpu_template *to,
                                        mspringi_gpu_message *message) {
    const uint32_t n = to->particle_count, all = to->body_count * n;
    mspring_view view = mspring_view_default();
    double *places = malloc(2 * (size_t)all * sizeof *places);
    if (places == NULL)
        return no_memory(message);
    mspring_result result = mspring_network_get_view(network, &view);
    if (result == MSPRING_OK)
        result = mspring_network_get_positions(network, NULL, 0, all, places, places + 1, 2);
    for (uint32_t p = 0; result == MSPRING_OK && p < all; p++) {
        float *state = to->states + (size_t)(p / n) * 6 * n + p % n;
        const uint32_t slot = view.slot_of_particle[p];
        state[0] = view.x[slot];
        state[n] = view.y[slot];
        state[2 * n] = (float)((places[2 * (size_t)p] - view.origin_x) - (double)state[0]);
        state[3 * n] = (float)((places[2 * (size_t)p + 1] - view.origin_y) - (double)state[n]);
        state[4 * n] = view.vx[slot];
        state[5 * n] = view.vy[slot];
    }
    to->origin_x = view.origin_x;
    to->origin_y = view.origin_y;
    free(places);
    return call_failed(network, result, message);
}

// Compare the hash of the state that was read with the network's: it differs if a word could not be read.
static mspring_result check_hash(const mspring_network *network, const mspringi_gpu_template *t,
                                 mspringi_gpu_message *message) {
    uint64_t expected, hash = mspringi_gpu_hash_head(t->origin_x, t->origin_y, 0.0f);
    for (uint32_t b = 0; b < t->body_count; b++)
        hash = mspringi_gpu_hash_body(hash, t->states + (size_t)b * 6 * t->particle_count, t->particle_count);
    const mspring_result result = call_failed(network, mspring_network_get_state_hash(network, &expected), message);
    if (result != MSPRING_OK || hash == expected)
        return result;
    return mspringi_gpu_fail(
        message, MSPRING_ERROR_ARGUMENT,
        "the network has state that no call reads: create the batch before its first step, and "
        "without MSPRING_NETWORK_PRECISE");
}

/* --------------------------------------------------------------------------------------- whole network */

static mspring_result read_settings(const mspring_network *network, mspringi_gpu_template *to,
                                    mspringi_gpu_message *message) {
    mspring_settings settings = mspring_settings_default();
    mspring_contact_def contact = mspring_contact_def_default();
    const uint32_t elements = mspring_network_count(network, MSPRING_ELEMENTS);
    mspring_result result = mspring_network_get_settings(network, &settings);
    if (result == MSPRING_OK)
        result = mspring_network_get_contact(network, &contact);
    if (result != MSPRING_OK)
        return call_failed(network, result, message);
    if (settings.solver != MSPRING_SOLVER_EXPLICIT || settings.substeps > MSPRING_MAX_SUBSTEPS)
        return refuse(message, "a batch takes the explicit solver with a number of substeps", 0);
    if (elements > 0)
        return refuse(message, "a batch has no areas and angles, and the network has %u", elements);
    if (contact.capacity > 0)
        return refuse(message, "a batch has no contact, and the network has room for %u points", contact.capacity);
    to->substeps = settings.substeps;
    to->gravity_x = settings.gravity_x;
    to->gravity_y = settings.gravity_y;
    to->global_damping = settings.global_damping;
    to->max_speed = settings.max_speed;
    return MSPRING_OK;
}

static mspring_result read_floor(const mspring_network *network, mspringi_gpu_template *to,
                                 mspringi_gpu_message *message) {
    mspring_floor_def def = mspring_floor_def_default();
    const mspring_result result = call_failed(network, mspring_network_get_floor(network, &def), message);
    if (result != MSPRING_OK)
        return result;
    if (def.height_count > 0)
        return refuse(message, "a batch takes half-planes, and the floor has %u heights", def.height_count);
    to->plane_count = def.plane_count;
    for (uint32_t i = 0; i < def.plane_count; i++) {
        const double *from = def.planes + 4 * (size_t)i, length = sqrt(from[2] * from[2] + from[3] * from[3]);
        double *plane = to->planes[i];
        plane[0] = from[2] / length;
        plane[1] = from[3] / length;
        plane[2] = plane[0] * (to->origin_x - from[0]) + plane[1] * (to->origin_y - from[1]);
        plane[3] = (double)(def.plane_frictions != NULL ? def.plane_frictions[i] : def.friction);
        plane[4] = (double)(def.plane_restitutions != NULL ? def.plane_restitutions[i] : def.restitution);
    }
    return MSPRING_OK;
}

/// The counts of a plan that a batch needs.
typedef struct gpu_plan {
    uint32_t particle_count, spring_count, loose_particles, has_damping;
    uint32_t lattice_particles, lattice_springs, chain_particles, chain_springs;
} gpu_plan;

// Return the number behind a name in lines of names and numbers, or 0.
static uint32_t described(const char *text, const char *name) {
    const size_t size = strlen(name);
    for (const char *line = text; line != NULL; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, name, size) == 0 && line[size] == ' ')
            return (uint32_t)strtoul(line + size, NULL, 10);
    }
    return 0;
}

static mspring_result read_plan(const mspring_network *network, gpu_plan *plan, mspringi_gpu_message *message) {
    char text[4096];
    const mspring_result result =
        call_failed(network, mspring_network_describe(network, text, sizeof text, NULL), message);
    if (result == MSPRING_OK)
        *plan = (gpu_plan){.particle_count = described(text, "particle_count"),
                           .spring_count = described(text, "spring_count"),
                           .loose_particles = described(text, "loose_particles"),
                           .has_damping = described(text, "has_damping"),
                           .lattice_particles = described(text, "lattice_particles"),
                           .lattice_springs = described(text, "lattice_springs"),
                           .chain_particles = described(text, "chain_particles"),
                           .chain_springs = described(text, "chain_springs")};
    return result;
}

// Check that each group has as many particles as a body: each has the last one, of some mass, and there are no
// more.
static mspring_result check_groups_of(const mspring_network *network, const mspringi_gpu_template *t,
                                      mspringi_gpu_message *message) {
    const mspring_observation last = {MSPRING_MASS, t->particle_count - 1};
    for (uint32_t g = 0; g < t->body_count; g++) {
        double mass = 0.0;
        const mspring_result result =
            call_failed(network, mspring_network_observe_groups(network, NULL, g, 1, &last, 1, &mass, 1), message);
        if (result != MSPRING_OK)
            return result;
        if (!(mass > 0.0))
            return refuse(message, "the bodies of a batch are equal, but group %u has fewer particles than others",
                          g);
    }
    return MSPRING_OK;
}

static mspring_result read_sizes(const mspring_network *network, mspringi_gpu_template *to, gpu_plan *plan,
                                 mspringi_gpu_message *message) {
    const uint32_t groups = mspring_network_count(network, MSPRING_GROUPS);
    const mspring_result result = read_plan(network, plan, message);
    if (result != MSPRING_OK)
        return result;
    if (groups == 0)
        return refuse(message, "the network has no groups: each body must be one", 0);
    if (plan->particle_count % groups != 0 || plan->spring_count % groups != 0)
        return refuse(message,
                      "the bodies of a batch are equal, but %u groups don't share the particles and springs",
                      groups);
    to->body_count = groups;
    to->particle_count = plan->particle_count / groups;
    to->spring_count = plan->spring_count / groups;
    to->is_damped = plan->has_damping != 0;
    if (to->particle_count > MSPRING_GPU_MAX_PARTICLES || to->spring_count >= MSPRINGI_GPU_NONE)
        return mspringi_gpu_fail(message, MSPRING_ERROR_LIMIT,
                                 "a body has %u particles and %u springs; it may have %u and %u",
                                 (unsigned)to->particle_count, (unsigned)to->spring_count,
                                 (unsigned)MSPRING_GPU_MAX_PARTICLES, (unsigned)MSPRINGI_GPU_NONE - 1);
    if (plan->loose_particles > 0)
        return refuse(message, "each particle of a batch has a spring, but %u have none", plan->loose_particles);
    return check_groups_of(network, to, message);
}

/* ---------------------------------------------------------------------------------- particles, springs */

// True if all bodies have the values of the first. Else *at is the index of a different one.
static bool are_alike(const uint32_t *values, uint32_t bodies, uint32_t count, uint32_t *at) {
    for (uint32_t i = count; i < bodies * count; i++)
        if (values[i] != values[i % count]) {
            *at = i;
            return false;
        }
    return true;
}

// Read a property of the first body. Fails if another body has other values, or if a value is below least.
static mspring_result read_property(const mspring_network *network, const mspringi_gpu_template *t,
                                    mspring_property property, const char *name, float least, uint32_t *values,
                                    mspringi_gpu_message *message) {
    const bool is_of_particles = property == MSPRING_MASS || property == MSPRING_INVERSE_MASS_SCALE;
    const uint32_t count = is_of_particles ? t->particle_count : t->spring_count;
    const char *kind = is_of_particles ? "particle" : "spring";
    float *floats = (float *)values;
    uint32_t at = 0;
    const mspring_result result = call_failed(
        network, mspring_network_get(network, property, NULL, 0, t->body_count * count, floats, 1), message);
    if (result == MSPRING_OK && !are_alike(values, t->body_count, count, &at))
        return mspringi_gpu_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "the bodies of a batch are equal, but %s %u has another %s than the first body's",
                                 kind, (unsigned)at, name);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; i++)
        if (floats[i] < least && !(property == MSPRING_INVERSE_MASS_SCALE && floats[i] == 0.0f)) // 0: a pin
            return mspringi_gpu_fail(message, MSPRING_ERROR_ARGUMENT, "a batch has no %s, but %s %u has one", name,
                                     kind, (unsigned)i);
    return result;
}

static mspring_result read_particles(const mspring_network *network, mspringi_gpu_template *to, uint32_t *values,
                                     mspringi_gpu_message *message) {
    mspring_view view = mspring_view_default();
    mspring_result result =
        read_property(network, to, MSPRING_INVERSE_MASS_SCALE, "scale of its inverse mass", 1, values, message);
    if (result == MSPRING_OK)
        result = read_property(network, to, MSPRING_MASS, "mass", 0, values, message);
    if (result == MSPRING_OK)
        result = call_failed(network, mspring_network_get_view(network, &view), message);
    for (uint32_t p = 0; result == MSPRING_OK && p < to->particle_count; p++) {
        memcpy(&to->masses[p], &values[p], sizeof *values);
        to->particles[p].inverse_mass = view.inverse_mass[view.slot_of_particle[p]];
    }
    return result;
}

static mspring_result read_ends(const mspring_network *network, mspringi_gpu_template *to, uint32_t *a, uint32_t *b,
                                mspringi_gpu_message *message) {
    const uint32_t all = to->body_count * to->spring_count;
    const mspring_column ends[] = {{MSPRING_END_A, 1, a}, {MSPRING_END_B, 1, b}};
    const mspring_result result =
        call_failed(network, mspring_network_get_columns(network, NULL, 0, all, ends, 2), message);
    for (uint32_t i = 0; result == MSPRING_OK && i < all; i++) {
        const uint32_t from = i / to->spring_count * to->particle_count, first = i % to->spring_count;
        if (a[i] != a[first] + from || b[i] != b[first] + from)
            return refuse(message,
                          "the bodies of a batch are equal, but spring %u has other ends than the first body's", i);
        if (a[first] >= to->particle_count || b[first] >= to->particle_count)
            return refuse(
                message,
                "the particles and springs of a body must follow each other, but spring %u leads out of it", i);
    }
    for (uint32_t s = 0; result == MSPRING_OK && s < to->spring_count; s++) {
        to->springs[s].a = a[s];
        to->springs[s].b = b[s];
    }
    return result;
}

static mspring_result read_flags(const mspring_network *network, mspringi_gpu_template *to, uint32_t *values,
                                 mspringi_gpu_message *message) {
    uint32_t at = 0;
    const uint32_t all = to->body_count * to->spring_count;
    const mspring_result result = call_failed(
        network, mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, all, values, 1), message);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t i = 0; i < all; i++)
        if ((values[i] & ~(uint32_t)(MSPRING_SPRING_RELATIVE | MSPRING_SPRING_METRES)) != 0)
            return mspringi_gpu_fail(message, MSPRING_ERROR_ARGUMENT,
                                     "a batch has no springs that are %s, but spring %u is",
                                     values[i] & (MSPRING_SPRING_BROKEN | MSPRING_SPRING_REMOVED) ? "broken"
                                     : values[i] & MSPRING_SPRING_STRESSED                        ? "stressed"
                                                                                                  : "one-way",
                                     (unsigned)i);
    if (!are_alike(values, to->body_count, to->spring_count, &at))
        return refuse(message,
                      "the bodies of a batch are equal, but spring %u has other flags than the first body's", at);
    for (uint32_t s = 0; s < to->spring_count; s++) {
        to->springs[s].is_relative = (values[s] & MSPRING_SPRING_RELATIVE) != 0;
        to->has_relative |= to->springs[s].is_relative;
    }
    return MSPRING_OK;
}

static mspring_result read_springs(const mspring_network *network, mspringi_gpu_template *to, uint32_t *values,
                                   mspringi_gpu_message *message) {
    static const struct {
        mspring_property property;
        const char *name;
        float least;
        size_t member; // of mspringi_gpu_spring, if it is kept
    } all[] = {{MSPRING_BREAK_STRAIN, "break strain", MSPRING_NEVER, 0},
               {MSPRING_WARN_STRAIN, "warn strain", MSPRING_NEVER, 0},
               {MSPRING_YIELD_STRAIN, "yield strain", MSPRING_NEVER, 0},
               {MSPRING_STIFFNESS, "stiffness", 0, offsetof(mspringi_gpu_spring, stiffness)},
               {MSPRING_DAMPING, "damping", 0, offsetof(mspringi_gpu_spring, damping)},
               {MSPRING_ACTIVE_REST_LENGTH, "rest length", 0, offsetof(mspringi_gpu_spring, rest_length)}};
    mspring_result result =
        read_ends(network, to, values, values + (size_t)to->body_count * to->spring_count, message);
    if (result == MSPRING_OK)
        result = read_flags(network, to, values, message);
    for (size_t i = 0; result == MSPRING_OK && i < sizeof all / sizeof all[0]; i++) {
        result = read_property(network, to, all[i].property, all[i].name, all[i].least, values, message);
        for (uint32_t s = 0; all[i].member > 0 && s < to->spring_count; s++)
            memcpy((char *)&to->springs[s] + all[i].member, &values[s], sizeof *values);
    }
    to->shortest = INFINITY;
    for (uint32_t s = 0; s < to->spring_count; s++) {
        float *length = &to->springs[s].rest_length;
        to->shortest = *length > 0.0f ? fmin(to->shortest, (double)*length) : to->shortest;
        *length = *length > 0.0f ? *length : 0x1p-50f; // a weld
    }
    return result;
}

/* --------------------------------------------------------------------------------------- order of sums */

/// The layout of the first body.
typedef struct body_layout {
    uint32_t *slots; ///< [particle_count]
    uint8_t *kinds;  ///< [particles of the network] a body_kind
    int32_t *rows;   ///< [particle_count] scratch: number of the row in its part
    uint32_t *parts; ///< [particle_count] scratch: lowest particle that springs in rows connect with this one
} body_layout;

typedef enum body_kind { IN_LATTICE, IN_CHAIN, IRREGULAR } body_kind;

// Find the kinds of particles. Those in lattices have the first slots, then come those in chains.
static mspring_result read_kinds(const mspring_network *network, const mspringi_gpu_template *t,
                                 const gpu_plan *plan, const body_layout *layout, mspringi_gpu_message *message) {
    const uint32_t n = t->particle_count, all = t->body_count * n;
    mspring_view view = mspring_view_default();
    const mspring_result result = call_failed(network, mspring_network_get_view(network, &view), message);
    for (uint32_t slot = 0, count = 0; result == MSPRING_OK && slot < view.slot_count; slot++) {
        const uint32_t p = view.particle_of_slot[slot];
        if (p >= all)
            continue;
        layout->kinds[p] = count < plan->lattice_particles                           ? IN_LATTICE
                           : count < plan->lattice_particles + plan->chain_particles ? IN_CHAIN
                                                                                     : IRREGULAR;
        count++;
    }
    for (uint32_t p = 0; result == MSPRING_OK && p < all; p++) {
        if (layout->kinds[p] != layout->kinds[p % n])
            return refuse(message,
                          "the bodies of a batch are equal, but particle %u is laid out otherwise than in the "
                          "first body",
                          p);
        if (p < n)
            layout->slots[p] = view.slot_of_particle[p];
    }
    return result;
}

// Return the side of a spring, as the kernel numbers them, or MSPRINGI_GPU_SIDES if it is in no row.
static uint32_t side_to(const body_layout *layout, uint32_t p, uint32_t q) {
    const uint32_t from = layout->slots[p], to = layout->slots[q], column = (to - from) % GPU_BLOCK;
    const bool is_north = to > from;
    if (layout->kinds[p] != layout->kinds[q] || layout->kinds[p] == IRREGULAR)
        return MSPRINGI_GPU_SIDES;
    if (to - from == 1 || from - to == 1)
        return is_north ? 5 : 3;
    if (layout->kinds[p] == IN_CHAIN || (column > 1 && column < GPU_BLOCK - 1))
        return MSPRINGI_GPU_SIDES;
    return column == 0 ? (is_north ? 6 : 1) : column == 1 ? (is_north ? 7 : 0) : (is_north ? 4 : 2);
}

// Put each spring into a slot of its two particles: that of its side or, if it is in no row, the next one behind
// those. Without slots, only count them.
static void fill_slots(mspringi_gpu_template *t, const body_layout *layout, uint32_t *others) {
    const size_t n = t->particle_count;
    memset(others, 0, n * sizeof *others);
    for (uint32_t s = 0; s < t->spring_count; s++)
        for (int end = 0; end < 2; end++) {
            const uint32_t p = end == 0 ? t->springs[s].a : t->springs[s].b,
                           q = t->springs[s].a + t->springs[s].b - p;
            const uint32_t side = side_to(layout, p, q);
            const uint32_t slot = side < MSPRINGI_GPU_SIDES ? side : t->row_slots + others[p]++;
            if (t->slots != NULL)
                t->slots[slot * n + p] = (uint16_t)s;
            else
                t->slot_count = slot >= t->slot_count ? slot + 1 : t->slot_count;
            if (side == MSPRINGI_GPU_SIDES)
                t->particles[p].flags |= MSPRINGI_GPU_HAS_OTHERS;
        }
}

static mspring_result check_row_springs(const mspringi_gpu_template *t, const gpu_plan *plan,
                                        const body_layout *layout, mspringi_gpu_message *message) {
    uint32_t counts[3] = {0, 0, 0};
    for (uint32_t s = 0; s < t->spring_count; s++)
        counts[side_to(layout, t->springs[s].a, t->springs[s].b) == MSPRINGI_GPU_SIDES
                   ? IRREGULAR
                   : layout->kinds[t->springs[s].a]]++;
    if (counts[IN_LATTICE] * t->body_count == plan->lattice_springs &&
        counts[IN_CHAIN] * t->body_count == plan->chain_springs)
        return MSPRING_OK;
    return mspringi_gpu_fail(message, MSPRING_ERROR_ARGUMENT,
                             "%u springs of a lattice and %u of chains: the slots don't tell which ones",
                             (unsigned)(plan->lattice_springs / t->body_count),
                             (unsigned)(plan->chain_springs / t->body_count));
}

// Number the rows of each part, which springs in rows connect. The row of its first particle is 0.
static void number_rows(const mspringi_gpu_template *t, const body_layout *layout) {
    for (uint32_t p = 0; p < t->particle_count; p++) {
        layout->rows[p] = 0;
        layout->parts[p] = p;
    }
    for (bool goes_on = true; goes_on;) {
        goes_on = false;
        for (uint32_t s = 0; s < t->spring_count; s++) {
            const uint32_t a = t->springs[s].a, b = t->springs[s].b, side = side_to(layout, a, b);
            const int32_t rise = (side == 4 || side == 6 || side == 7) - (side < 3);
            if (side == MSPRINGI_GPU_SIDES || layout->parts[a] == layout->parts[b])
                continue;
            const bool is_a_first = layout->parts[a] < layout->parts[b];
            const uint32_t p = is_a_first ? a : b, q = is_a_first ? b : a;
            layout->parts[q] = layout->parts[p];
            layout->rows[q] = layout->rows[p] + (is_a_first ? rise : -rise);
            goes_on = true;
        }
    }
}

// Flag the particles in rows, and those in top rows: rows from which no spring leads north.
static void mark_rows(mspringi_gpu_template *t, const body_layout *layout) {
    const uint32_t n = t->particle_count;
    number_rows(t, layout);
    for (uint32_t p = 0; p < n; p++)
        t->particles[p].flags |= layout->kinds[p] == IRREGULAR ? 0 : MSPRINGI_GPU_IN_ROWS | MSPRINGI_GPU_ON_TOP;
    for (uint32_t p = 0; p < n; p++) {
        bool leads_north = false;
        for (uint32_t side = 4; layout->kinds[p] == IN_LATTICE && side < MSPRINGI_GPU_SIDES; side++)
            leads_north |= side != 5 && t->slots[(size_t)side * n + p] != MSPRINGI_GPU_NONE;
        for (uint32_t q = 0; leads_north && q < n; q++)
            if (layout->parts[q] == layout->parts[p] && layout->rows[q] == layout->rows[p])
                t->particles[q].flags &= ~(uint32_t)MSPRINGI_GPU_ON_TOP;
    }
}

static mspring_result order_sums(const mspring_network *network, mspringi_gpu_template *t, const gpu_plan *plan,
                                 mspringi_gpu_message *message) {
    const size_t n = t->particle_count;
    uint32_t *numbers = malloc(4 * n * sizeof *numbers);
    const body_layout layout = {.slots = numbers,
                                .kinds = malloc(t->body_count * n),
                                .rows = malloc(n * sizeof(int32_t)),
                                .parts = numbers + (numbers != NULL ? n : 0)};
    mspring_result result = MSPRING_OK;
    if (numbers == NULL || layout.kinds == NULL || layout.rows == NULL)
        result = no_memory(message);
    if (result == MSPRING_OK)
        result = read_kinds(network, t, plan, &layout, message);
    if (result == MSPRING_OK)
        result = check_row_springs(t, plan, &layout, message);
    if (result == MSPRING_OK) {
        t->slot_count = t->row_slots = plan->lattice_particles + plan->chain_particles > 0 ? MSPRINGI_GPU_SIDES : 0;
        fill_slots(t, &layout, numbers + 2 * n);
        t->slots = malloc(t->slot_count * n * sizeof *t->slots);
        if (t->slots == NULL)
            result = no_memory(message);
    }
    if (result == MSPRING_OK) {
        memset(t->slots, 0xff, t->slot_count * n * sizeof *t->slots);
        fill_slots(t, &layout, numbers + 2 * n);
        mark_rows(t, &layout);
    }
    free(numbers);
    free(layout.kinds);
    free(layout.rows);
    return result;
}

/* --------------------------------------------------------------------------------------------- reading */

static mspring_result read_all(const mspring_network *network, mspringi_gpu_template *to,
                               mspringi_gpu_message *message) {
    gpu_plan plan;
    mspring_result result = read_sizes(network, to, &plan, message);
    if (result != MSPRING_OK)
        return result;
    const size_t n = to->particle_count,
                 most = plan.spring_count > plan.particle_count ? plan.spring_count : plan.particle_count;
    uint32_t *values = malloc(2 * most * sizeof *values);
    to->masses = malloc(n * sizeof *to->masses);
    to->particles = calloc(n, sizeof *to->particles);
    to->springs = calloc(to->spring_count, sizeof *to->springs);
    to->states = malloc(to->body_count * 6 * n * sizeof *to->states);
    if (values == NULL || to->masses == NULL || to->particles == NULL || to->springs == NULL || to->states == NULL)
        result = no_memory(message);
    if (result == MSPRING_OK)
        result = read_settings(network, to, message);
    if (result == MSPRING_OK)
        result = read_particles(network, to, values, message);
    if (result == MSPRING_OK)
        result = read_springs(network, to, values, message);
    if (result == MSPRING_OK)
        result = mspringi_gpu_read_states(network, to, message);
    if (result == MSPRING_OK)
        result = read_floor(network, to, message);
    if (result == MSPRING_OK)
        result = check_hash(network, to, message);
    if (result == MSPRING_OK)
        result = order_sums(network, to, &plan, message);
    free(values);
    return result;
}

mspring_result mspringi_gpu_read_network(const mspring_network *network, mspringi_gpu_template *to,
                                         mspringi_gpu_message *message) {
    memset(to, 0, sizeof *to);
    const mspring_result result = read_all(network, to, message);
    if (result != MSPRING_OK)
        mspringi_gpu_template_free(to);
    return result;
}

void mspringi_gpu_template_free(mspringi_gpu_template *t) {
    free(t->masses);
    free(t->particles);
    free(t->springs);
    free(t->slots);
    free(t->states);
    memset(t, 0, sizeof *t);
}
