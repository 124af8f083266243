/// Reading of archives into builders. What belongs to the layout or to single features waits for the network
/// (archive_resume.c).
#include <float.h>
#include <math.h>
#include <string.h>

#include "archive/archive_format.h"
#include "base/cpu.h"
#include "base/definitions.h"
#include "store/metres.h"
#include "store/properties.h"

static mspring_result fail(mspring_builder *builder, const char *what) {
    return mspringi_fail(&builder->message, MSPRING_ERROR_SNAPSHOT, "the archive %s", what);
}

#define SAID "the archive's %s: "

static mspring_result fail_in(mspring_builder *builder, const char *chunk, const char *what) {
    return mspringi_fail(&builder->message, MSPRING_ERROR_SNAPSHOT, SAID "%s", chunk, what);
}

/* --------------------------------------------------------------------------------------------------- the chunks */

// A chunk that this library knows.
typedef struct known {
    const char *tag, *name;
} known;

// Name of a chunk's contents, and its number; NULL if this library does not know it.
static const char *name_of(const char *tag, uint32_t *number) {
    static const known own[] = {
        {mspringi_head_tag, "definition"}, {mspringi_plan_tag, "plan"}, {mspringi_end_tag, "end"}};
    *number = 0;
    for (size_t i = 0; i < sizeof own / sizeof own[0]; ++i, ++*number)
        if (memcmp(own[i].tag, tag, 4) == 0)
            return own[i].name;
    for (const mspringi_chunk *const *chunk = mspringi_chunks; *chunk; ++chunk, ++*number)
        if (memcmp((*chunk)->tag, tag, 4) == 0)
            return (*chunk)->name;
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i, ++*number)
        if (memcmp(mspringi_sections[i]->tag, tag, 4) == 0)
            return mspringi_sections[i]->name;
    return NULL;
}

static mspring_result check_format(mspring_builder *builder, const uint8_t *bytes, size_t size) {
    uint32_t words[2];
    if (size < MSPRINGI_ARCHIVE_HEAD_BYTES || memcmp(bytes, "msprarc\n", 8) != 0)
        return fail(builder, "does not begin as one: it is something else, or damaged");
    mspringi_get(bytes + 8, words, 2, sizeof words[0]);
    if (words[0] != MSPRINGI_ARCHIVE_VERSION || words[1] != 0)
        return mspringi_fail(&builder->message, MSPRING_ERROR_SNAPSHOT,
                             "the archive has format %u.%u, this library reads format %u", (unsigned)words[0],
                             (unsigned)words[1], MSPRINGI_ARCHIVE_VERSION);
    return MSPRING_OK;
}

// Check a chunk for itself; *is_skipped: this library does not know it.
static mspring_result check_chunk(mspring_builder *builder, const mspringi_read_chunk *chunk, uint64_t *seen,
                                  bool *is_skipped) {
    char tag[5] = {0};
    uint64_t hash;
    uint32_t number;
    for (int i = 0; i < 4; ++i)
        tag[i] = chunk->tag[i] >= ' ' && chunk->tag[i] <= '~' ? chunk->tag[i] : '?';
    const char *name = name_of(chunk->tag, &number), *called = name ? name : tag;
    mspringi_get(chunk->bytes - 8, &hash, 1, sizeof hash);
    if (hash != mspringi_chunk_hash(chunk->bytes - MSPRINGI_CHUNK_HEAD_BYTES, chunk->bytes, chunk->size))
        return fail_in(builder, called, "they are damaged: their checksum does not fit");
    *is_skipped = !name || chunk->version != MSPRINGI_CHUNK_VERSION;
    if (*is_skipped)
        return chunk->flags & MSPRINGI_CHUNK_IS_NEEDED ? fail_in(builder, called, "only later versions know them")
                                                       : MSPRING_OK;
    if (*seen >> number & 1)
        return fail_in(builder, called, "they come twice");
    *seen |= UINT64_C(1) << number;
    return MSPRING_OK;
}

static mspring_result check_chunks(mspring_builder *builder, const uint8_t *bytes, size_t size, uint32_t *skipped) {
    mspring_result result = check_format(builder, bytes, size);
    mspringi_read_chunk chunk = {0};
    size_t at = MSPRINGI_ARCHIVE_HEAD_BYTES;
    uint64_t seen = 0;
    bool is_skipped = false, is_end = false;
    _Static_assert(MSPRINGI_SECTIONS < 48, "each chunk has a bit in `seen`");
    *skipped = 0;
    while (result == MSPRING_OK && !is_end) {
        if (!mspringi_archive_next(bytes, size, &at, &chunk))
            return fail(builder, "is cut off, or damaged: its last chunk does not fit in");
        result = check_chunk(builder, &chunk, &seen, &is_skipped);
        is_end = memcmp(chunk.tag, mspringi_end_tag, 4) == 0;
        *skipped += result == MSPRING_OK && is_skipped;
    }
    return result == MSPRING_OK && at != size ? fail(builder, "has something behind its end") : result;
}

/* --------------------------------------------------------------------------------------------------------- head */

static bool is_length(double value) {
    return (value >= 0.0 && value <= (double)MSPRINGI_MAX_OWN_LENGTH) || value == (double)INFINITY;
}

static mspring_result check_head(mspring_builder *builder, const mspringi_archive_head *head, bool is_short) {
    const mspringi_solver_basis *basis = &head->basis;
    mspringi_message message;
    if (mspringi_check_settings(&head->def.settings, &message) != MSPRING_OK)
        return fail_in(builder, "definition", message.text);
    const bool has_counts = head->first_particle >= 1 && head->first_particle <= head->particle_end &&
                            head->particle_end <= MSPRING_MAX_PARTICLES && head->first_spring <= head->spring_end &&
                            head->spring_end <= MSPRING_MAX_SPRINGS;
    const uint32_t flags = MSPRING_NETWORK_RESERVE_DAMPING | MSPRING_NETWORK_RESERVE_RELATIVE |
                           MSPRING_NETWORK_PRECISE | MSPRING_NETWORK_POSES;
    if (is_short || !has_counts || head->def.flags & ~flags || head->may_have_bundles > 1 || head->is_compact > 1 ||
        head->is_compact_with_bundles > 1 || head->has_welds > 1 || !is_length(head->shortest) ||
        !is_length((double)head->shortest_set) || !(head->grid >= 0.0f && head->grid <= MSPRINGI_MAX_LENGTH) ||
        (basis->scale != 0.0 && !(basis->scale >= DBL_MIN && basis->scale <= DBL_MAX &&
                                  basis->turn_inertia >= 0.0f && basis->turn_inertia <= FLT_MAX)))
        return mspringi_fail(&builder->message, MSPRING_ERROR_SNAPSHOT,
                             SAID "%u of %u particles, %u of %u springs, with values that none has", "definition",
                             (unsigned)head->first_particle, (unsigned)head->particle_end,
                             (unsigned)head->first_spring, (unsigned)head->spring_end);
    return MSPRING_OK;
}

// The bytes of all chunks that a builder's particles and springs are made of.
typedef struct parts {
    const uint8_t *plan, *settings, *motion, *masses, *values;
    size_t arrays; ///< of the motion
    uint32_t kind; ///< of the masses
} parts;

// Find a chunk, and refuse one that is too short.
static mspring_result find(mspring_builder *builder, const uint8_t *bytes, const char *tag, size_t least,
                           const uint8_t **from) {
    const mspringi_read_chunk chunk = mspringi_archive_find(bytes, tag);
    uint32_t number;
    *from = chunk.bytes;
    if (least == 0 || (chunk.bytes && chunk.size >= least))
        return MSPRING_OK;
    return mspringi_fail(&builder->message, MSPRING_ERROR_SNAPSHOT,
                         SAID "they take %zu bytes instead of at least %zu", name_of(tag, &number), chunk.size,
                         least);
}

static mspring_result find_parts(mspring_builder *builder, const uint8_t *bytes, const mspringi_archive_head *head,
                                 parts *out) {
    const size_t particles = head->particle_end, springs = head->spring_end;
    out->arrays = head->def.flags & MSPRING_NETWORK_PRECISE ? 8 : 6;
    mspring_result result =
        find(builder, bytes, mspringi_section_motion.tag, particles * out->arrays * 4, &out->motion);
    if (result == MSPRING_OK)
        result = find(builder, bytes, mspringi_section_values.tag, springs * 12, &out->values);
    if (result == MSPRING_OK)
        result = find(builder, bytes, mspringi_section_masses.tag, 4 + particles * 8, &out->masses);
    if (result == MSPRING_OK)
        result = find(builder, bytes, mspringi_section_settings.tag, 16, &out->settings);
    if (result == MSPRING_OK)
        result = find(builder, bytes, mspringi_plan_tag,
                      head->first_particle * MSPRINGI_PLAN_PARTICLE_BYTES +
                          head->first_spring * MSPRINGI_PLAN_SPRING_BYTES,
                      &out->plan);
    return result;
}

/* ---------------------------------------------------------------------------------------- particles and springs */

static double coordinate_of(const uint8_t *origin, const uint8_t *motion, size_t high, size_t low) {
    double value;
    mspringi_get(origin, &value, 1, sizeof value);
    return value + ((double)mspringi_float_at(motion, high) + (double)mspringi_float_at(motion, low));
}

static mspring_result append_particle(mspring_builder *builder, const mspringi_archive_head *head, const parts *in,
                                      mspring_id p) {
    const size_t end = head->particle_end;
    const mspringi_particle particle = {
        .x = coordinate_of(in->settings, in->motion, p, 4 * end + p),
        .y = coordinate_of(in->settings + 8, in->motion, end + p, 5 * end + p),
        .vx = mspringi_float_at(in->motion, 2 * end + p),
        .vy = mspringi_float_at(in->motion, 3 * end + p),
        .mass = mspringi_float_at(in->masses + 4, p),
        // an inverse mass, or a scale of it
        .flags = mspringi_float_at(in->masses + 4, end + p) > 0.0f ? 0 : MSPRING_PARTICLE_PINNED,
    };
    // A network may have moved: its origin is up to MSPRING_MAX_COORDINATE from its initial place.
    const double largest = 4.0 * MSPRING_MAX_COORDINATE;
    if (!(fabs(particle.x) <= largest && fabs(particle.y) <= largest) || !mspringi_is_speed(particle.vx) ||
        !mspringi_is_speed(particle.vy))
        return mspringi_fail(&builder->message, MSPRING_ERROR_SNAPSHOT,
                             SAID "particle %u is at (%g, %g) m, at (%g, %g) m/s", mspringi_section_motion.name,
                             (unsigned)p, particle.x, particle.y, (double)particle.vx, (double)particle.vy);
    mspringi_message message;
    if (mspringi_check_mass(&message, "particle", p, particle.mass) != MSPRING_OK)
        return fail_in(builder, mspringi_section_masses.name, message.text);
    builder->particles[builder->particle_count++] = particle;
    return MSPRING_OK;
}

static mspring_result append_spring(mspring_builder *builder, const mspringi_archive_head *head, const parts *in,
                                    mspring_id s) {
    const uint8_t *from =
        in->plan + head->first_particle * MSPRINGI_PLAN_PARTICLE_BYTES + (size_t)s * MSPRINGI_PLAN_SPRING_BYTES;
    mspring_id ends[2];
    from = mspringi_get(from, ends, 2, sizeof ends[0]);
    const mspringi_spring spring = {.a = ends[0],
                                    .b = ends[1],
                                    .stiffness = mspringi_float_at(in->values, 3 * (size_t)s),
                                    .damping = mspringi_float_at(in->values, 3 * (size_t)s + 1),
                                    .rest_length = mspringi_float_at(in->values, 3 * (size_t)s + 2),
                                    .flags = *from};
    if (ends[0] >= head->first_particle || ends[1] >= head->first_particle || ends[0] == ends[1] ||
        spring.flags & ~(uint32_t)(MSPRINGI_KEPT_SPRING_FLAGS & ~MSPRING_SPRING_METRES))
        return mspringi_fail(&builder->message, MSPRING_ERROR_SNAPSHOT,
                             SAID "spring %u joins particles %s and %s, with flags %#x", "plan", (unsigned)s,
                             MSPRINGI_ID(ends[0]), MSPRINGI_ID(ends[1]), (unsigned)spring.flags);
    mspringi_message message;
    mspring_result result =
        mspringi_check_coefficients(&message, "spring", s, spring.stiffness, spring.damping, spring.flags);
    if (result == MSPRING_OK && !mspringi_is_spring_value(MSPRINGI_REST_LENGTH, spring.rest_length))
        result = mspringi_fail(&message, MSPRING_ERROR_SNAPSHOT, "spring %u has rest length %g m", (unsigned)s,
                               (double)spring.rest_length);
    if (result != MSPRING_OK)
        return fail_in(builder, mspringi_section_values.name, message.text);
    builder->springs[builder->spring_count++] = spring;
    return MSPRING_OK;
}

static mspring_result append_all(mspring_builder *builder, const mspringi_archive_head *head, const parts *in) {
    mspring_result result = mspringi_builder_reserve_particles(builder, head->first_particle);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_springs(builder, head->first_spring);
    for (mspring_id p = 0; result == MSPRING_OK && p < head->first_particle; ++p)
        result = append_particle(builder, head, in, p);
    for (mspring_id s = 0; result == MSPRING_OK && s < head->first_spring; ++s)
        result = append_spring(builder, head, in, s);
    return result;
}

/* ------------------------------------------------------------------------------------------------------- limits */

// Thresholds of a section; NULL if the archive has none of this network's size.
static const uint8_t *thresholds(const uint8_t *bytes, const char *tag, size_t size) {
    const mspringi_read_chunk chunk = mspringi_archive_find(bytes, tag);
    return chunk.size == size ? chunk.bytes : NULL;
}

static mspring_result set_limits(mspring_builder *builder, const uint8_t *bytes,
                                 const mspringi_archive_head *head) {
    const size_t size = (size_t)head->spring_end * sizeof(float);
    const uint8_t *breaks = thresholds(bytes, mspringi_section_break_strains.tag, size),
                  *stresses = thresholds(bytes, mspringi_section_stress_strains.tag, size),
                  *relaxes = thresholds(bytes, mspringi_section_relax_strains.tag, size),
                  *yields = thresholds(bytes, "yiel", 4 * size),
                  *metres = thresholds(bytes, mspringi_section_metres.tag, MSPRINGI_METRES * size);
    const uint32_t springs = (uint32_t)builder->spring_count;
    mspring_result result = MSPRING_OK;
    builder->spring_count = 0;
    for (mspring_id s = 0;
         result == MSPRING_OK && s < springs && (breaks || stresses || relaxes || yields || metres); ++s) {
        mspringi_limits limits = mspringi_builder_limits_of(builder, builder->limit_count);
        limits.break_strain = breaks ? mspringi_float_at(breaks, s) : limits.break_strain;
        limits.warn_strain = stresses ? mspringi_float_at(stresses, s) : limits.warn_strain;
        limits.relax_strain = relaxes ? mspringi_float_at(relaxes, s) : limits.relax_strain;
        if (yields) {
            float *const of_yield[] = {&limits.yield_strain, &limits.hardening, &limits.plastic_limit};
            for (size_t i = 0; i < 3; ++i)
                *of_yield[i] = mspringi_float_at(yields, 4 * (size_t)s + i);
        }
        if (metres && mspringi_float_at(metres, MSPRINGI_METRES * (size_t)s) != 0.0f) {
            float *const of_metres[] = {&limits.break_strain, &limits.warn_strain, &limits.relax_strain,
                                        &limits.yield_strain};
            for (size_t i = 0; i < MSPRINGI_METRES; ++i)
                *of_metres[i] = mspringi_read_value(mspringi_float_at(metres, MSPRINGI_METRES * (size_t)s + i));
            builder->springs[s].flags |= MSPRING_SPRING_METRES;
        }
        mspringi_message message;
        if (mspringi_check_limits(&message, "spring", s, limits) != MSPRING_OK)
            return fail_in(builder, "strain limits", message.text);
        builder->spring_count = s;
        result = mspringi_builder_reserve_limits(builder, springs - s, limits);
        builder->spring_count = (size_t)s + 1;
        if (result == MSPRING_OK)
            mspringi_builder_put_limits(builder, s, limits);
    }
    builder->spring_count = springs;
    return result;
}

/* ----------------------------------------------------------------------------------------------------- the call */

static mspring_result keep(mspring_builder *builder, const uint8_t *bytes, size_t size,
                           const mspringi_archive_head *head) {
    if (size > SIZE_MAX - sizeof *builder->archive)
        return fail(builder, "is too large");
    builder->archive = mspringi_alloc_unset(&builder->memory, sizeof *builder->archive + size, 1);
    if (!builder->archive)
        return mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for an archive of %zu bytes",
                             size);
    builder->archive_calls = &mspringi_archive_resuming;
    builder->archive->head = *head;
    builder->archive->size = size;
    memcpy(builder->archive->bytes, bytes, size);
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE mspring_result read_all(mspring_builder *builder, const uint8_t *bytes, size_t size,
                                                 uint32_t *skipped) {
    mspringi_archive_head head = {0};
    parts in;
    (void)mspring_init(MSPRING_STRUCT_NETWORK_DEF, &head.def, sizeof head.def);
    mspring_result result = check_chunks(builder, bytes, size, skipped);
    if (result != MSPRING_OK)
        return result;
    const mspringi_read_chunk chunk = mspringi_archive_find(bytes, mspringi_head_tag);
    mspringi_io io = mspringi_io_from(chunk.bytes, chunk.size);
    mspringi_archive_hand_head(&io, &head);
    result = check_head(builder, &head, io.is_short);
    if (result == MSPRING_OK)
        result = find_parts(builder, bytes, &head, &in);
    if (result == MSPRING_OK)
        result = append_all(builder, &head, &in);
    if (result == MSPRING_OK)
        result = set_limits(builder, bytes, &head);
    if (result == MSPRING_OK)
        result = keep(builder, bytes, size, &head);
    if (result != MSPRING_OK)
        builder->particle_count = builder->spring_count = builder->limit_count = 0;
    return result;
}

static mspring_result read_archive(mspring_builder *builder, const void *archive, size_t size, uint32_t *skipped) {
    if (!archive)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT, "the archive is NULL");
    if (builder->particle_count > 0 || builder->archive)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT,
                             "the builder has %zu particles, an archive needs an empty one",
                             builder->particle_count);
    return read_all(builder, archive, size, skipped);
}

mspring_result mspring_builder_read(mspring_builder *builder, const void *archive, size_t size, uint32_t *skipped) {
    uint32_t count = 0;
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = read_archive(builder, archive, size, &count);
    mspringi_fp_leave(before);
    if (result == MSPRING_OK && skipped)
        *skipped = count;
    return mspringi_builder_end(builder, result);
}

mspring_result mspring_builder_get_network_def(mspring_builder *builder, mspring_network_def *def) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspring_result result = mspringi_check_output(&builder->message, &mspringi_struct_network_def, def);
    if (result != MSPRING_OK)
        return result;
    mspringi_put_struct(&mspringi_struct_network_def, def,
                        builder->archive ? &builder->archive->head.def : mspringi_struct_network_def.defaults);
    return MSPRING_OK;
}
