/// Snapshot of settings, step count, motion, masses and forces.
#include <float.h>
#include <math.h>
#include <string.h>

#include "edits/edit_particles.h"
#include "layout/emit/spare.h"
#include "step/origin.h"
#include "store/changed.h"
#include "store/sections.h"
#include "store/springs.h"

/* --------------------------------------------------------------------------------------------------- settings */

typedef struct settings {
    double origin_x, origin_y;
    float recentre_distance, relative_h;
    mspring_settings values;
    uint32_t substeps, max_substeps, auto_substeps, most_work;
} settings;

static void hand_settings(mspringi_io *io, settings *s) {
    MSPRINGI_HAND(io, s->origin_x);
    MSPRINGI_HAND(io, s->origin_y);
    mspringi_hand(io, &s->recentre_distance, 2, sizeof(float)); // and the next one
    mspringi_hand(io, &s->substeps, 4, sizeof(uint32_t));       // and those that follow
#define SETTING(name, first, range, is_good, change) MSPRINGI_HAND(io, s->values.name);
#define SLEEP_SETTING(name, first, range, is_good, change)
#include "base/settings.def"
}

static void settings_save(const mspring_network *network, mspringi_writer *to) {
    mspringi_io io = mspringi_io_to(to);
    hand_settings(&io, &(settings){network->origin_x, network->origin_y, network->recentre_distance,
                                   network->relative_h, network->settings, network->substeps, network->max_substeps,
                                   network->auto_substeps, network->most_work});
}

static mspring_result settings_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_settings;
    mspringi_io io = mspringi_io_from(from, size);
    settings s = {.values = network->settings};
    mspringi_message message;
    hand_settings(&io, &s);
    if (mspringi_section_end(network, section, &io) != MSPRING_OK)
        return MSPRING_ERROR_SNAPSHOT;
    // A network may have moved: its origin is up to MSPRING_MAX_COORDINATE from its initial place.
    const double largest = 2.0 * MSPRING_MAX_COORDINATE;
    if (!(fabs(s.origin_x) <= largest && fabs(s.origin_y) <= largest && s.recentre_distance > 0.0f))
        return mspringi_section_fail(network, section, "the origin is (%g, %g) m", s.origin_x, s.origin_y);
    if (!(s.relative_h == 0.0f || (s.relative_h >= FLT_MIN && s.relative_h <= FLT_MAX)))
        return mspringi_section_fail(network, section, "relative springs are for a substep of %g s",
                                     (double)s.relative_h);
    if (mspringi_check_settings(&s.values, &message) != MSPRING_OK)
        return mspringi_section_fail(network, section, "%s", message.text);
    if (s.substeps < 1 || s.substeps > MSPRING_MAX_SUBSTEPS || s.max_substeps < 1 ||
        s.max_substeps > MSPRING_MAX_SUBSTEPS || s.auto_substeps > MSPRINGI_SUBSTEPS_EVEN ||
        s.most_work > MSPRING_MAX_SUBSTEPS)
        return mspringi_section_fail(network, section, "substeps is %u, max_substeps %u, most_work %u",
                                     (unsigned)s.substeps, (unsigned)s.max_substeps, (unsigned)s.most_work);
    return MSPRING_OK;
}

static void settings_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    settings s = {.values = network->settings};
    hand_settings(&io, &s);
    mspringi_origin_set(network, s.origin_x, s.origin_y);
    network->recentre_distance = s.recentre_distance;
    network->settings = s.values;
    network->substeps = s.substeps;
    network->max_substeps = s.max_substeps;
    network->auto_substeps = s.auto_substeps;
    network->most_work = s.most_work;
    mspringi_derive_relative(network, s.relative_h);
}

const mspringi_section mspringi_section_settings = {"sett",        "settings",     false,         NULL,
                                                    settings_save, settings_check, settings_load, NULL};

// An archive by a library with fewer settings: the network has the others from its definition.
static size_t settings_enter(const mspring_network *network, uint8_t *section, size_t size) {
    uint8_t own[sizeof(settings)];
    mspringi_writer to = mspringi_writer_begin(own, network->kernels);
    const size_t full = mspringi_section_size(network, &mspringi_section_settings);
    settings_save(network, &to);
    if (size < full)
        memcpy(section + size, own + size, full - size);
    return size < full ? full : size;
}

const mspringi_by_id mspringi_by_id_settings = {&mspringi_section_settings, NULL, NULL, settings_enter};

/* ------------------------------------------------------------------------------------------------ step count */

static void hand_steps(mspringi_io *io, mspringi_steps *steps) {
    MSPRINGI_HAND(io, steps->count);
    MSPRINGI_HAND(io, steps->fallback_count);
    MSPRINGI_HAND(io, steps->time);
    MSPRINGI_HAND(io, steps->substeps);
    MSPRINGI_HAND(io, steps->lag);
    MSPRINGI_HAND(io, steps->dt);
    MSPRINGI_HAND(io, steps->uneven_steps);
    MSPRINGI_HAND(io, steps->pace.dt);
    MSPRINGI_HAND(io, steps->pace.h);
    MSPRINGI_HAND(io, steps->pace.left);
    MSPRINGI_HAND(io, steps->pace.steps);
}

static void steps_save(const mspring_network *network, mspringi_writer *to) {
    mspringi_io io = mspringi_io_to(to);
    mspringi_steps steps = network->steps;
    hand_steps(&io, &steps);
}

static mspring_result steps_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_steps;
    mspringi_io io = mspringi_io_from(from, size);
    mspringi_steps steps;
    hand_steps(&io, &steps);
    if (mspringi_section_end(network, section, &io) != MSPRING_OK)
        return MSPRING_ERROR_SNAPSHOT;
    const bool has_stepped = steps.count > 0;
    if (!(steps.time >= 0.0 && steps.time <= DBL_MAX) || (steps.time > 0.0) != has_stepped ||
        (steps.substeps > 0) != has_stepped || steps.substeps > MSPRING_MAX_SUBSTEPS ||
        steps.fallback_count > steps.count || !(steps.lag >= 0.0f && steps.lag <= FLT_MAX) ||
        !(steps.dt >= 0.0 && steps.dt <= DBL_MAX) || (steps.dt > 0.0) != has_stepped ||
        steps.uneven_steps > MSPRINGI_UNEVEN_STEPS || !(steps.pace.dt >= 0.0 && steps.pace.dt <= DBL_MAX) ||
        !(steps.pace.h >= 0.0 && steps.pace.h <= DBL_MAX) || !(fabs(steps.pace.left) <= DBL_MAX) ||
        steps.pace.steps > MSPRINGI_UNEVEN_STEPS)
        return mspringi_section_fail(
            network, section,
            "there were %llu, %llu by the fallback, of %u substeps, the last of %g s, in "
            "%g s, the last step of %g s (%u more count as uneven); substeps go by a step of "
            "%g s, %g s are left",
            (unsigned long long)steps.count, (unsigned long long)steps.fallback_count, (unsigned)steps.substeps,
            (double)steps.lag, steps.time, steps.dt, (unsigned)steps.uneven_steps, steps.pace.dt, steps.pace.left);
    return MSPRING_OK;
}

static void steps_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    network->steps = (mspringi_steps){.result = MSPRING_OK, .outcome = mspringi_outcome_none()};
    hand_steps(&io, &network->steps);
}

const mspringi_section mspringi_section_steps = {"step",     "steps",     false,      NULL,
                                                 steps_save, steps_check, steps_load, NULL};

/* ------------------------------------------------------------------------------------------------ whole arrays */

// True if all floats are at most `largest`. Checking all slots in a row, and single particles only after a failure,
// takes a fifth of the time.
static bool are_within(const uint8_t *from, size_t count, float largest) {
    uint32_t others = 0; // as wide as a float, for vectorisation
    for (size_t i = 0; i < count; ++i)
        others |= !(fabsf(mspringi_float_at(from, i)) <= largest);
    return others == 0;
}

// True if all floats are equal. Always false on big-endian hosts, where the comparison is slow.
static bool are_same(const uint8_t *from, const float *values, size_t count) {
    return !MSPRINGI_BIG_ENDIAN_HOST && memcmp(from, values, count * sizeof *values) == 0;
}

/* ----------------------------------------------------------------------------------------------------- motion */

static size_t motion_floats(const mspring_network *network) {
    return mspringi_state_arrays(network) * mspringi_slot_count(network);
}

static size_t motion_size(const mspring_network *network) {
    return motion_floats(network) * sizeof(float);
}

// Save the state that the host may have written to as the next step would tidy it: without stale low words, and
// with 0 in empty slots.
static void put_tidied(const mspring_network *network, size_t array, mspringi_writer *to) {
    const size_t slots = mspringi_slot_count(network), first_low = 4; // x, y, vx, vy, low_x, low_y, low_vx, low_vy
    const float *values = network->state.x + array * slots;
    const float *of = network->state.x + (array < first_low ? array : array - first_low) * slots;
    const float grid = array < first_low + 2 ? network->state.grid : 0.0f;
    for (size_t first = 0; first < slots; first += MSPRINGI_WIDTH) {
        float block[MSPRINGI_WIDTH];
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const size_t slot = first + lane;
            const float value = array < first_low ? values[slot] : mspringi_low_of(of[slot], values[slot], grid);
            block[lane] = network->topology.particle_of_slot[slot] == MSPRING_NONE ? 0.0f : value;
        }
        mspringi_put(to, block, MSPRINGI_WIDTH, sizeof(float));
    }
}

static void motion_save(const mspring_network *network, mspringi_writer *to) {
    if (!network->is_open)
        mspringi_put(to, network->state.x, motion_floats(network), sizeof(float));
    for (size_t array = 0; network->is_open && array < mspringi_state_arrays(network); ++array)
        put_tidied(network, array, to);
}

static mspring_result check_motion(mspring_network *network, const uint8_t *from, mspring_id p, uint32_t slot) {
    const size_t slots = mspringi_slot_count(network);
    const float largest = (float)MSPRING_MAX_COORDINATE, fastest = (float)MSPRING_MAX_SPEED;
    const float x = mspringi_float_at(from, slot), y = mspringi_float_at(from, slots + slot);
    const float vx = mspringi_float_at(from, 2 * slots + slot), vy = mspringi_float_at(from, 3 * slots + slot);
    return fabsf(x) <= largest && fabsf(y) <= largest && fabsf(vx) <= fastest && fabsf(vy) <= fastest
               ? MSPRING_OK
               : mspringi_section_fail(network, &mspringi_section_motion,
                                       "particle %u is at (%g, %g) m from the origin, at (%g, %g) m/s", (unsigned)p,
                                       (double)x, (double)y, (double)vx, (double)vy);
}

// Check all slots that particles may occupy. Another section says which of its two a spare one is in.
static mspring_result motion_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_topology *t = &network->topology;
    const size_t third = 2 * mspringi_slot_count(network); // positions, then velocities
    mspring_result result =
        mspringi_section_check_size(network, &mspringi_section_motion, size, motion_size(network));
    if (result == MSPRING_OK && network->is_precise &&
        !are_within(from + 3 * third * sizeof(float), third, (float)MSPRING_MAX_SPEED))
        return mspringi_section_fail(network, &mspringi_section_motion,
                                     "a low word of a velocity is not within 1e15 m/s");
    if (result == MSPRING_OK && are_within(from, third, (float)MSPRING_MAX_COORDINATE) &&
        are_within(from + third * sizeof(float), third, (float)MSPRING_MAX_SPEED))
        return MSPRING_OK;
    for (mspring_id p = 0; result == MSPRING_OK && p < t->reserve.particle_end; ++p) {
        const uint32_t first = t->reserve.first_particle;
        result = check_motion(network, from, p, p < first ? t->slot_of_particle[p] : mspringi_spare_slot(t, p));
        if (result == MSPRING_OK && p >= first)
            result = check_motion(network, from, p, t->initial_slots[p - first]);
    }
    return result;
}

// A low word too large for its coordinate counts as 0 while unused, and becomes 0 here.
static void motion_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_get(from, network->state.x, size / sizeof(float), sizeof(float));
    mspringi_clear_unused_slots(network);
    mspringi_drop_stale_lows(network);
    mspringi_clear_empty_slots(network);
    mspringi_notify_change(network, MSPRINGI_CHANGED_STATE, 0);
}

const mspringi_section mspringi_section_motion = {
    "moti", "positions and velocities", false, motion_size, motion_save, motion_check, motion_load, NULL};

static uint32_t motion_runs(const mspring_network *network, mspringi_io head, mspringi_run *runs) {
    (void)head;
    runs[0] = (mspringi_run){MSPRINGI_FLOATS, mspringi_state_arrays(network)};
    return 1;
}

const mspringi_by_id mspringi_by_id_motion = {&mspringi_section_motion, motion_runs, NULL, NULL};

/* ----------------------------------------------------------------------------------------------------- masses */

// Contents of the section: kind; a mass for each particle; inverse masses by slot or, if some are scaled, a scale
// for each particle. Files of 0.2 may have masses of relative springs behind them, which are not read: springs
// follow the masses now.
enum { SCALED = 1, SPRING_MASSES = 2 };

static uint32_t masses_kind(const mspring_network *network) {
    return network->is_scaled ? (uint32_t)SCALED : 0;
}

static size_t masses_size_of(const mspring_network *network, uint32_t kind) {
    const size_t particles = network->topology.reserve.particle_end;
    return sizeof kind + sizeof(float) * (particles + (kind & SCALED ? particles : mspringi_slot_count(network)) +
                                          (kind & SPRING_MASSES ? particles : 0));
}

static size_t masses_size(const mspring_network *network) {
    return masses_size_of(network, masses_kind(network));
}

static void masses_save(const mspring_network *network, mspringi_writer *to) {
    const uint32_t kind = masses_kind(network);
    const size_t particles = network->topology.reserve.particle_end;
    mspringi_put(to, &kind, 1, sizeof kind);
    mspringi_put(to, network->mass, particles, sizeof(float));
    if (kind & SCALED)
        mspringi_put(to, network->inverse_mass_scale, particles, sizeof(float));
    else
        mspringi_put(to, network->inverse_mass, mspringi_slot_count(network), sizeof(float));
}

typedef struct masses {
    uint32_t kind;
    const uint8_t *mass, *inverse_or_scale;
} masses;

static masses read_masses(const mspring_network *network, const uint8_t *from) {
    const size_t particles = network->topology.reserve.particle_end;
    masses m;
    m.mass = mspringi_get(from, &m.kind, 1, sizeof m.kind);
    m.inverse_or_scale = m.mass + particles * sizeof(float);
    return m;
}

static bool are_masses(const uint8_t *from, size_t count) {
    uint32_t others = 0;
    for (size_t i = 0; i < count; ++i)
        others |= !mspringi_is_mass(mspringi_float_at(from, i));
    return others == 0;
}

static bool are_scales(const uint8_t *from, size_t count) {
    uint32_t others = 0;
    for (size_t i = 0; i < count; ++i)
        others |= !mspringi_is_inverse_mass_scale(mspringi_float_at(from, i));
    return others == 0;
}

// True if all values are valid. An unscaled particle has a scale of 0 or 1.
static bool are_right(const mspring_network *network, const masses *m) {
    const size_t particles = network->topology.reserve.particle_end;
    return are_masses(m->mass, particles) && (!(m->kind & SCALED) || are_scales(m->inverse_or_scale, particles));
}

// True if the network already has these masses, the common case.
static bool has_masses(const mspring_network *network, const masses *m) {
    const size_t particles = network->topology.reserve.particle_end;
    return !network->growth.particles && (m->kind & SCALED) == masses_kind(network) &&
           are_same(m->mass, network->mass, particles) &&
           (m->kind & SCALED ? are_same(m->inverse_or_scale, network->inverse_mass_scale, particles)
                             : are_same(m->inverse_or_scale, network->inverse_mass, mspringi_slot_count(network)));
}

// Scale of an inverse mass. An unscaled one is 0 or the inverse of the mass: its scale is 0 or 1.
static float scale_in(const mspring_network *network, const masses *m, mspring_id particle) {
    if (m->kind & SCALED)
        return mspringi_float_at(m->inverse_or_scale, particle);
    return mspringi_float_at(m->inverse_or_scale, network->topology.slot_of_particle[particle]) > 0.0f ? 1.0f
                                                                                                       : 0.0f;
}

static mspring_result masses_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_masses;
    uint32_t kind = 0;
    if (size >= sizeof kind)
        mspringi_get(from, &kind, 1, sizeof kind);
    if (kind > (SCALED | SPRING_MASSES))
        return mspringi_section_fail(network, section, "they are of kind %u", (unsigned)kind);
    mspring_result result = mspringi_section_check_size(network, section, size, masses_size_of(network, kind));
    if (result != MSPRING_OK)
        return result;
    const masses m = read_masses(network, from);
    const uint32_t suspects = are_right(network, &m) ? 0 : network->topology.reserve.particle_end;
    for (mspring_id p = 0; p < suspects; ++p) {
        const float mass = mspringi_float_at(m.mass, p);
        if (!mspringi_is_mass(mass))
            return mspringi_section_fail(network, section, "particle %u has a mass of %g kg", (unsigned)p,
                                         (double)mass);
        if (!mspringi_is_inverse_mass_scale(scale_in(network, &m, p)))
            return mspringi_section_fail(network, section, "particle %u has its inverse mass scaled by %g",
                                         (unsigned)p, (double)scale_in(network, &m, p));
    }
    if (kind & SCALED)
        result = mspringi_reserve_inverse_mass_scales(network);
    return result;
}

static void masses_load(mspring_network *network, const uint8_t *from, size_t size) {
    (void)size;
    const masses m = read_masses(network, from);
    const uint32_t particles = network->topology.reserve.particle_end;
    if (has_masses(network, &m))
        return;
    const bool renew = network->fractions.values && !are_same(m.mass, network->mass, particles);
    mspringi_get(m.mass, network->mass, particles, sizeof(float));
    for (mspring_id p = 0; p < particles; ++p) {
        const float scale = mspringi_particle_exists(network, p) ? scale_in(network, &m, p) : 0.0f;
        network->inverse_mass[network->topology.slot_of_particle[p]] = scale / network->mass[p];
        if (network->inverse_mass_scale)
            network->inverse_mass_scale[p] = scale;
    }
    if (renew)
        mspringi_renew_relative(network);
    network->is_scaled = m.kind & SCALED;
    mspringi_notify_change(network, MSPRINGI_CHANGED_MASSES, 0);
}

const mspringi_section mspringi_section_masses = {"mass",      "masses",     false,       masses_size,
                                                  masses_save, masses_check, masses_load, NULL};

static uint32_t masses_runs(const mspring_network *network, mspringi_io head, mspringi_run *runs) {
    uint32_t kind = 0;
    MSPRINGI_HAND(&head, kind);
    runs[0] = (mspringi_run){MSPRINGI_BYTES, sizeof kind + network->topology.reserve.particle_end * sizeof(float)};
    runs[1] = (mspringi_run){MSPRINGI_FLOATS, kind & SCALED ? 0 : 1};
    runs[2] = (mspringi_run){MSPRINGI_BYTES, MSPRINGI_THE_REST};
    return 3;
}

const mspringi_by_id mspringi_by_id_masses = {&mspringi_section_masses, masses_runs, NULL, NULL};

/* ----------------------------------------------------------------------------------------------------- forces */

static mspring_result field_check(mspring_network *network, const mspringi_section *section, mspringi_field *field,
                                  const uint8_t *from, size_t size) {
    const size_t floats = 2 * mspringi_slot_count(network);
    if (size == 0)
        return MSPRING_OK;
    mspring_result result = mspringi_section_check_size(network, section, size, floats * sizeof(float));
    for (size_t i = 0; result == MSPRING_OK && i < floats; ++i)
        if (!isfinite(mspringi_float_at(from, i)))
            result = mspringi_section_fail(network, section, "a force is %g N", (double)mspringi_float_at(from, i));
    if (result == MSPRING_OK && field == &network->forces.first)
        result = mspringi_field_reserve(network, &network->forces.begun);
    return result == MSPRING_OK ? mspringi_field_reserve(network, field) : result;
}

// Forces on empty slots, from a forged snapshot, are dropped: a particle added later would feel them.
static void field_load(const mspring_network *network, mspringi_field field, bool *any, const uint8_t *from,
                       size_t size) {
    const size_t slots = mspringi_slot_count(network);
    if (size > 0)
        mspringi_get(from, field.x, 2 * slots, sizeof(float));
    else if (*any)
        memset(field.x, 0, 2 * slots * sizeof(float));
    for (size_t slot = 0; size > 0 && slot < slots; ++slot)
        if (network->topology.particle_of_slot[slot] == MSPRING_NONE)
            field.x[slot] = field.y[slot] = 0.0f;
    *any = size > 0;
}

static uint32_t forces_runs(const mspring_network *network, mspringi_io head, mspringi_run *runs) {
    (void)network;
    runs[0] = (mspringi_run){MSPRINGI_FLOATS, head.size > 0 ? 2 : 0};
    return 1;
}

// A section of forces given for the next step, absent if there are none.
#define FORCES(name, tag, words, member)                                                                           \
    static size_t name##_size(const mspring_network *network) {                                                    \
        return network->forces.member##_any ? 2 * mspringi_slot_count(network) * sizeof(float) : 0;                \
    }                                                                                                              \
    static void name##_save(const mspring_network *network, mspringi_writer *to) {                                 \
        mspringi_put(to, network->forces.member.x, 2 * mspringi_slot_count(network), sizeof(float));               \
    }                                                                                                              \
    static mspring_result name##_check(mspring_network *network, const uint8_t *from, size_t size) {               \
        return field_check(network, &mspringi_section_##name, &network->forces.member, from, size);                \
    }                                                                                                              \
    static void name##_load(mspring_network *network, const uint8_t *from, size_t size) {                          \
        field_load(network, network->forces.member, &network->forces.member##_any, from, size);                    \
        network->forces.held_calls = MSPRINGI_MODEST_CALLS;                                                        \
    }                                                                                                              \
    const mspringi_section mspringi_section_##name = {tag,         words,        false,       name##_size,         \
                                                      name##_save, name##_check, name##_load, NULL};               \
    const mspringi_by_id mspringi_by_id_##name = {&mspringi_section_##name, forces_runs, NULL, NULL}

FORCES(forces, "forc", "forces given for the next step", held);
FORCES(first_forces, "frst", "forces given for the first substep", first);
