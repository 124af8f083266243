/// @file test_archive_forged.c
/// Archives that were cut off, tampered with or forged: each is refused with a message that names the chunk, or gives
/// a network that goes on; nothing leaks, whatever allocation fails. And files of earlier versions, which are read.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "archives.h"

static archived copy(const archived *from) {
    archived made = {malloc(from->size + 64), from->size, 0};
    assert_non_null(made.bytes);
    memcpy(made.bytes, from->bytes, from->size);
    return made;
}

static void put_word(uint8_t *at, uint32_t word) {
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(word >> 8 * i);
}

static void put_float(uint8_t *at, float value) {
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put_word(at, word);
}

/* ---------------------------------------------------------------------------------------------------- damage */

static void each_length_but_the_whole_is_refused(void **state) {
    (void)state;
    mspring_network *network = archives_make(0);
    const archived whole = archives_write(network);
    for (size_t size = 0; size < whole.size; size += size < 600 ? 1 : 37) {
        uint8_t *bytes = malloc(size + 1); // so that a sanitizer sees reads behind it
        memcpy(bytes, whole.bytes, size);
        check_contains(archives_refused(&(archived){bytes, size, 0}), "the archive ");
        free(bytes);
    }
    archived longer = copy(&whole);
    longer.size += 8;
    memset(longer.bytes + whole.size, 0, 8);
    check_contains(archives_refused(&longer), "has something behind its end");
    free(longer.bytes);
    free(whole.bytes);
    mspring_network_destroy(network);
}

static void each_changed_byte_is_refused(void **state) {
    (void)state;
    mspring_network *network = archives_make(11);
    const archived whole = archives_write(network);
    archived damaged = copy(&whole);
    for (size_t at = 0; at < whole.size; at += at < 2000 ? 3 : 61) {
        damaged.bytes[at] ^= (uint8_t)(1u << at % 8);
        check_contains(archives_refused(&damaged), "the archive");
        damaged.bytes[at] = whole.bytes[at];
    }
    free(damaged.bytes);
    free(whole.bytes);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------------- forgery */

typedef struct forgery {
    int kind; // of the network
    const char *tag;
    size_t at;
    bool is_float;
    double value;
    const char *message;
} forgery;

static const forgery forgeries[] = {
    {0, "netw", 0, false, 0xffffffff, "definition"},
    {0, "netw", 8, false, 0x00ffffff, "positions and velocities: they take"},
    {0, "netw", 12, false, 0x00ffffff, "stiffness, damping and rest lengths: they take"},
    {0, "netw", 4, false, 0, "added and removed particles and springs"},
    {0, "netw", 36, true, NAN, "definition"},
    {0, "plan", 0, false, 0x7fffffff, NULL}, // where it lay does not matter
    {0, "moti", 8, true, NAN, "positions and velocities: particle 2"},
    {0, "moti", 8, true, 1e30, "positions and velocities: particle 2"},
    {0, "mass", 8, true, -1, "masses: particle 1"},
    {0, "valu", 12, true, NAN, "stiffness, damping and rest lengths: spring 1"},
    {0, "valu", 8, true, 0, "stiffness, damping and rest lengths: spring 0"},
    {0, "brks", 0, true, -1, "strain limits: spring 0"},
    {0, "sett", 0, false, 0, NULL},
    {0, "sett", 44, true, NAN, "settings"},
    {0, "step", 0, false, 0xffffffff, NULL},
    {0, "grow", 0, false, 7, "added and removed particles and springs"},
    {0, "ramp", 0, false, 0x7fffffff, "springs on the way to their rest lengths"},
    {0, "slee", 8, false, 0xffffffff, "sleep"},
    {2, "impl", 20, false, 0xffffffff, "implicit solver"},
    {2, "impl", 24, false, 9, "implicit solver"},
    {4, "area", 4, false, 0xffffffff, "areas"},
    {4, "yiel", 0, true, NAN, "strain limits"},
    {9, "floo", 0, false, 0xffffffff, "floor"},
    {9, "floo", 4, false, 0x3ffffff, "floor: they are too short"},
    {9, "floo", 8, true, 0, NULL},
    {9, "cont", 4, true, 0, NULL},
    {9, "cont", 24, false, 0xffffffff, "contact"},
    {9, "cont", 28, false, 0xffffffff, NULL}, // room for pairs is made where a step lacks it
    {9, "cont", 32, false, 0xffffffff, "contact"},
    {9, "cont", 32, false, 0x3ffffff, NULL},
    {9, "cont", 36, false, 7, NULL},
    {9, "cont", 40, false, 0xffffffff, NULL}, // cut to what may be of use
    {9, "cont", 44, false, 0xffffffff, "contact"},
    {9, "grip", 12, false, 0x7fffffff, "grips"},
    {11, "grou", 0, false, 0xffffffff, "groups: they are too short"},
    {11, "grou", 8, false, 1, "groups"},
    {11, "grou", 24, true, NAN, "groups"},
    {11, "grou", 0, false, 0, "groups"},
    {11, "grou", 4, false, 0, NULL},          // no mark: what it held is left over
    {11, "grou", 4, false, 3, "groups"},      // lists of springs that are not there
    {11, "grou", 24, true, 1e30, "groups"},
    {11, "acts", 0, false, 0xffffffff, "signals of actuators: they are too short"},
    {11, "acts", 4, false, 1000, "signals of actuators"},
    {11, "acts", 8, false, 0xffff, "signals of actuators"},
    {11, "actu", 0, false, 9, "actuators"},
};

static void forged_values_are_refused(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(forgeries); i++) {
        const forgery *f = &forgeries[i];
        mspring_network *network = archives_make(f->kind);
        archived forged = archives_write(network);
        size_t size = 0;
        uint8_t *chunk = archives_chunk(&forged, f->tag, &size);
        if (chunk == NULL || f->at + 4 > size)
            fail_msg("network %d has no %s of %zu bytes", f->kind, f->tag, f->at + 4);
        if (f->is_float)
            put_float(chunk + f->at, (float)f->value);
        else
            put_word(chunk + f->at, (uint32_t)f->value);
        archives_renew(&forged);
        if (f->message != NULL) {
            check_contains(archives_refused(&forged), f->message);
        } else {
            mspring_builder *builder = support_builder(); // fine, or refused: no more than that
            mspring_network *made = NULL;
            if (mspring_builder_read(builder, forged.bytes, forged.size, NULL) == MSPRING_OK &&
                mspring_network_create(builder, NULL, &made) == MSPRING_OK)
                assert_true(mspring_network_step(made, 1.0 / 64) <= MSPRING_OK);
            mspring_network_destroy(made);
            mspring_builder_destroy(builder);
        }
        free(forged.bytes);
        mspring_network_destroy(network);
    }
}

/// Friction and restitution of particles come behind the head, layers and masks.
static void forged_surfaces_are_refused(void **state) {
    (void)state;
    enum { COUNT = 3 };
    const float frictions[COUNT] = {0.5f, 0.25f, 2}, restitution = 0.5f, bad[2][2] = {{2e6f, NAN}, {1.5f, NAN}};
    mspring_builder *builder = support_builder();
    mspring_contact_def contact = {.struct_size = sizeof contact};
    for (uint32_t i = 0; i < COUNT; i++)
        support_particle(builder, i, 0, 1);
    mspring_network *network = support_network(builder, NULL);
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.1;
    check_ok(mspring_network_set_contact(network, &contact));
    check_ok(mspring_network_set(network, MSPRING_FRICTION, NULL, 0, COUNT, frictions, 1));
    check_ok(mspring_network_set(network, MSPRING_RESTITUTION, NULL, 0, COUNT, &restitution, 0));
    mspring_network *other = archives_check_same(network, 1);
    float back[COUNT];
    check_ok(mspring_network_get(other, MSPRING_FRICTION, NULL, 0, COUNT, back, 1));
    assert_memory_equal(back, frictions, sizeof back);
    const archived archive = archives_write(network);
    size_t size;
    uint8_t *const chunk = archives_chunk(&archive, "cont", &size);
    for (uint32_t i = 0; i < 2 * COUNT; i++)
        for (int value = 0; value < 2; value++) {
            uint8_t *const at = chunk + size - (2 * COUNT - i) * sizeof(float), was[sizeof(float)];
            memcpy(was, at, sizeof was);
            memcpy(at, &bad[i % 2][value], sizeof was);
            archived forged = archive;
            archives_renew(&forged);
            check_contains(archives_refused(&forged), i / 2 == 1 ? "particle 1 has the friction" : "the friction");
            memcpy(at, was, sizeof was);
        }
    free(archive.bytes);
    mspring_network_destroy(other);
    mspring_network_destroy(network);
}

/// Memory that a floor's values were read into goes: a network that was read takes as much for more of them as the
/// one that was written.
static void floors_leave_no_memory(void **state) {
    (void)state;
    enum { MANY = 500 };
    static float heights[MANY] = {3}, depths[MANY] = {0.5f};
    static double planes[3 * 4] = {0, -5, 0, 1, 0, -5, 0, 1, 0, -5, 0, 1};
    mspring_network *network = archives_make(9);
    uint64_t used[3][2];
    for (int i = 0; i < 3; i++) {
        mspring_floor_def floor = {.struct_size = sizeof floor};
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
        floor.heights = heights, floor.height_count = i == 1 ? MANY : 2, floor.heights_y = -9;
        floor.silt_depths = floor.height_frictions = floor.height_restitutions = depths, floor.silt_rate = 1;
        floor.planes = planes, floor.plane_count = i == 2 ? 3 : 1;
        check_ok(mspring_network_set_floor(network, &floor));
        mspring_network *read = archives_check_same(network, 1);
        used[i][0] = support_memory_used(network);
        used[i][1] = support_memory_used(read);
        mspring_network_destroy(read);
    }
    for (int i = 1; i < 3; i++)
        assert_int_equal(used[i][1] - used[0][1], used[i][0] - used[0][0]);
    mspring_floor_def level = {.struct_size = sizeof level}; // one height is written as one, and read as one
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &level, sizeof level));
    level.heights = heights, level.height_count = 1;
    check_ok(mspring_network_set_floor(network, &level));
    mspring_network *read = archives_check_same(network, 1);
    check_ok(mspring_network_get_floor(read, &level));
    assert_true(level.height_count == 1 && level.heights[0] == heights[0]);
    mspring_network_destroy(read);
    mspring_network_destroy(network);
}

// Without what flowed, a network has the strains that its lengths are of, and goes on.
static void yield_strains_need_no_flow(void **state) {
    (void)state;
    mspring_network *network = archives_make(4);
    archived forged = archives_write(network);
    size_t size = 0;
    uint8_t *chunk = archives_chunk(&forged, "bent", &size);
    assert_true(chunk != NULL && size > 32);
    memcpy(chunk - 24, "lost", 4);
    archives_renew(&forged);
    mspring_builder *builder = support_builder();
    mspring_network *other = NULL;
    check_ok(mspring_builder_read(builder, forged.bytes, forged.size, NULL));
    check_ok(mspring_network_create(builder, NULL, &other));
    mspring_builder_destroy(builder);
    const uint32_t count = mspring_network_count(other, MSPRING_SPRINGS);
    float strains[64];
    assert_true(count <= COUNT_OF(strains));
    check_ok(mspring_network_get(other, MSPRING_PLASTIC_STRAIN, NULL, 0, count, strains, 1));
    for (uint32_t s = 0; s < count; s++)
        assert_true(fabsf(strains[s]) <= 0.9f);
    mspring_network *again = archives_check_same(other, 1);
    archives_check_goes_on(other, again, 3);
    mspring_network_destroy(again);
    mspring_network_destroy(other);
    free(forged.bytes);
    mspring_network_destroy(network);
}

// Words of all chunks, one after another, become what hosts find hardest; a network that comes of it goes on.
static void forged_words_do_no_harm(void **state) {
    (void)state;
    static const uint32_t words[] = {0, 1, 0x7f800000, 0x7fc00000, 0xff7fffff, 0xffffffff, 0x80000000, 0x00ffffff};
    uint64_t seed = 12;
    for (int kind = 0; kind < ARCHIVES_KINDS; kind++) {
        mspring_network *network = archives_make(kind);
        const archived whole = archives_write(network);
        for (int trial = 0; trial < SAMPLE(400); trial++) {
            archived forged = copy(&whole);
            for (int change = 0; change < 1 + trial % 3; change++) {
                const size_t at = 16 + (size_t)(support_random(&seed) % ((whole.size - 20) / 4)) * 4;
                put_word(forged.bytes + at, words[support_random(&seed) % COUNT_OF(words)]);
            }
            archives_renew(&forged);
            watched_allocator watched = {0};
            const mspring_allocator allocator = watched_interface(&watched);
            mspring_builder *builder = NULL;
            mspring_network *made = NULL;
            mspring_network_def def = {.struct_size = sizeof def};
            check_ok(mspring_builder_create(&allocator, &builder));
            if (mspring_builder_read(builder, forged.bytes, forged.size, NULL) == MSPRING_OK) {
                check_ok(mspring_builder_get_network_def(builder, &def));
                def.allocator = &allocator;
                const mspring_result result = mspring_network_create(builder, &def, &made);
                if (result != MSPRING_OK) {
                    check_contains(support_builder_error(builder), "the archive");
                    assert_int_equal(result, MSPRING_ERROR_SNAPSHOT);
                }
                if (watched.live_bytes > 64u << 20)
                    fail_msg("kind %d, trial %d: %zu bytes", kind, trial, watched.live_bytes);
            }
            for (int i = 0; made != NULL && i < 2; i++)
                (void)(mspring_network_step(made, 1.0 / 64) == MSPRING_OK);
            mspring_network_destroy(made);
            mspring_builder_destroy(builder);
            check_watched_clean(&watched);
            free(forged.bytes);
        }
        free(whole.bytes);
        mspring_network_destroy(network);
    }
}

/* ---------------------------------------------------------------------------------------------------- chunks */

// Insert a chunk before the one with this tag.
static archived insert(const archived *into, const char *before, const char *tag, uint8_t version, uint8_t flags) {
    size_t size = 0;
    uint8_t *at = archives_chunk(into, before, &size);
    assert_non_null(at);
    const size_t offset = (size_t)(at - into->bytes) - 24;
    archived made = {calloc(into->size + 32, 1), into->size + 32, 0};
    memcpy(made.bytes, into->bytes, offset);
    memcpy(made.bytes + offset, tag, 4);
    made.bytes[offset + 4] = version;
    made.bytes[offset + 6] = flags;
    made.bytes[offset + 8] = 8;
    memcpy(made.bytes + offset + 32, into->bytes + offset, into->size - offset);
    archives_renew(&made);
    return made;
}

// Ids of elements are never given again, so an archive may say that there were billions. Calls about all of them take
// as long as those that there are.
static void billions_of_elements_take_no_time(void **state) {
    (void)state;
    mspring_network *network = archives_make(11);
    archived forged = archives_write(network);
    const mspring_observation columns[2] = {{MSPRING_ELEMENT_FLAGS, 0}, {MSPRING_ELEMENT_FLAGS, 1}};
    const mspring_id twice[2] = {0, 0};
    const float stiffness = 0; // as a gas has
    uint32_t flags;
    double row[2];
    size_t size;
    memset(archives_chunk(&forged, "area", &size), 0xfe, 4); // the next id
    archives_renew(&forged);
    mspring_network *other = archives_read(&forged, 1);
    assert_int_equal(mspring_network_count(other, MSPRING_ELEMENTS), 0xfefefefeu);
    check_ok(mspring_network_set(other, MSPRING_ELEMENT_STIFFNESS, NULL, 0, MSPRING_ALL, &stiffness, 0));
    check_ok(mspring_network_observe_groups(other, NULL, 0, 1, columns, 2, row, 2));
    assert_true(row[0] > 0 && row[1] > 0);
    check_ok(mspring_network_remove_elements(other, NULL, 1, MSPRING_ALL));
    check_ok(mspring_network_get_integers(other, MSPRING_ELEMENT_FLAGS, NULL, 1, 1, &flags, 1));
    assert_int_equal(flags, MSPRING_ELEMENT_REMOVED);
    check_ok(mspring_network_observe_groups(other, NULL, 0, 1, columns, 2, row, 2));
    assert_true(row[0] > 0 && row[1] == 0);
    check_ok(mspring_network_remove_elements(other, twice, 0, 2));
    check_error(mspring_network_remove_elements(other, twice, 0, 1), MSPRING_ERROR_ID);
    support_steps(other, 1, 1.0 / 64);
    free(forged.bytes);
    mspring_network_destroy(other);
    mspring_network_destroy(network);
}

static void later_chunks_are_skipped_and_counted(void **state) {
    (void)state;
    mspring_network *network = archives_make(1), *made = NULL;
    const archived whole = archives_write(network);
    const archived one = insert(&whole, "step", "warp", 1, 0), two = insert(&one, "end.", "grip", 7, 0);
    mspring_builder *builder = support_builder();
    uint32_t skipped = 9;
    check_ok(mspring_builder_read(builder, two.bytes, two.size, &skipped));
    assert_int_equal(skipped, 2);
    check_ok(mspring_network_create(builder, NULL, &made));
    assert_int_equal(support_hash(made), support_hash(network));
    const archived needed = insert(&whole, "moti", "warp", 1, 1), twice = insert(&whole, "end.", "step", 1, 0);
    check_contains(archives_refused(&needed), "the archive's warp: only later versions know them");
    check_contains(archives_refused(&twice), "the archive's steps: they come twice");
    mspring_network_destroy(made);
    mspring_builder_destroy(builder);
    free(needed.bytes);
    free(twice.bytes);
    free(two.bytes);
    free(one.bytes);
    free(whole.bytes);
    mspring_network_destroy(network);
}

static void a_missing_chunk_is_refused(void **state) {
    (void)state;
    static const char *const needed[] = {"netw", "plan", "moti", "mass", "valu", "sett", "step", "guar", "slee"};
    mspring_network *network = archives_make(1);
    for (size_t i = 0; i < COUNT_OF(needed); i++) {
        archived whole = archives_write(network);
        size_t size = 0;
        uint8_t *at = archives_chunk(&whole, needed[i], &size) - 24;
        memmove(at, at + 24 + size, (size_t)(whole.bytes + whole.size - at) - 24 - size);
        whole.size -= 24 + size;
        check_contains(archives_refused(&whole), "the archive's");
        free(whole.bytes);
    }
    mspring_network_destroy(network);
}

/* ---------------------------------------------------------------------------------------------------- memory */

static void no_allocation_that_fails_leaks(void **state) {
    (void)state;
    for (int kind = 0; kind < ARCHIVES_KINDS; kind += ROUNDS_ARE_FEW ? 4 : 1) {
        mspring_network *network = archives_make(kind);
        const archived whole = archives_write(network);
        mspring_result result = MSPRING_ERROR_MEMORY;
        for (size_t nth = 1; result != MSPRING_OK; nth += support_is_quick() ? 5 : 1) {
            watched_allocator watched = {.fail_at = nth};
            const mspring_allocator allocator = watched_interface(&watched);
            mspring_builder *builder = NULL;
            mspring_network *made = NULL;
            mspring_network_def def = {.struct_size = sizeof def};
            result = mspring_builder_create(&allocator, &builder);
            if (result == MSPRING_OK)
                result = mspring_builder_read(builder, whole.bytes, whole.size, NULL);
            if (result == MSPRING_OK) {
                check_ok(mspring_builder_get_network_def(builder, &def));
                def.allocator = &allocator;
                result = mspring_network_create(builder, &def, &made);
            } else if (builder != NULL) {
                assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);
            }
            if (result != MSPRING_OK)
                assert_int_equal(result, MSPRING_ERROR_MEMORY);
            mspring_network_destroy(made);
            mspring_builder_destroy(builder);
            check_watched_clean(&watched);
        }
        free(whole.bytes);
        mspring_network_destroy(network);
    }
}

static mspring_result MSPRING_CALL drop(const void *bytes, size_t size, void *user) {
    (void)bytes;
    *(size_t *)user += size;
    return MSPRING_OK;
}

static void writing_without_memory_leaks_nothing(void **state) {
    (void)state;
    mspring_network *network = archives_make(9);
    const archived whole = archives_write(network);
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_builder *builder = support_builder();
    mspring_network *made = NULL;
    mspring_network_def def = {.struct_size = sizeof def};
    check_ok(mspring_builder_read(builder, whole.bytes, whole.size, NULL));
    check_ok(mspring_builder_get_network_def(builder, &def));
    def.allocator = &allocator;
    check_ok(mspring_network_create(builder, &def, &made));
    const size_t live = watched.live, calls = watched.calls;
    size_t written = 0;
    for (size_t nth = 1; written < whole.size; nth++) {
        watched.calls = calls;
        watched.fail_at = calls + nth;
        written = 0;
        const mspring_result result = mspring_network_write(made, drop, &written);
        assert_int_equal(result, written == whole.size ? MSPRING_OK : MSPRING_ERROR_MEMORY);
        assert_int_equal(watched.live, live);
    }
    watched.fail_at = 0;
    mspring_network_destroy(made);
    mspring_builder_destroy(builder);
    check_watched_clean(&watched);
    free(whole.bytes);
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------------- files */

// Files of earlier versions are read: the state has the hash that was written down with them, and goes on. Renew none of
// them: with a new version, add files (test_archive_forged --write).
static const struct {
    const char *name;
    int kind;
    uint64_t hash; // of the state
} files[] = {
    {"0.2-implicit", 2, 0xf24a6ef69465fba3},
    {"0.2-compact", 6, 0xb5eba137b2ca158b},
    {"0.2-precise", 9, 0xeb1d19edea215a88},
    {"0.2-groups", 11, 0x01a5cd691bd37edc},
};

static FILE *open_file(const char *name, const char *mode) {
    char path[500];
    snprintf(path, sizeof path, "%s/%s.archive", ARCHIVE_FILES, name);
    FILE *file = fopen(path, mode);
    if (file == NULL)
        fail_msg("%s cannot be opened", path);
    return file;
}

static void files_of_earlier_versions_are_read(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(files); i++) {
        static uint8_t bytes[1 << 17];
        FILE *file = open_file(files[i].name, "rb");
        const archived archive = {bytes, fread(bytes, 1, sizeof bytes, file), 0};
        fclose(file);
        assert_true(archive.size < sizeof bytes);
        mspring_network *network = archives_read(&archive, 1);
        if (support_hash(network) != files[i].hash)
            fail_msg("%s: 0x%016llx", files[i].name, (unsigned long long)support_hash(network));
        support_steps(network, 16, 1.0 / 64);
        mspring_network_destroy(network);
    }
}

static int write_files(void) {
    for (size_t i = 0; i < COUNT_OF(files); i++) {
        mspring_network *network = archives_make(files[i].kind);
        const archived archive = archives_write(network);
        FILE *file = open_file(files[i].name, "wb");
        const bool ok = fwrite(archive.bytes, 1, archive.size, file) == archive.size;
        if (fclose(file) != 0 || !ok)
            return 1;
        printf("%s: 0x%016llx, %zu bytes\n", files[i].name, (unsigned long long)support_hash(network), archive.size);
        free(archive.bytes);
        mspring_network_destroy(network);
    }
    return 0;
}

int main(int argc, char **argv) {
    if (argc > 1 && strcmp(argv[1], "--write") == 0)
        return write_files();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_length_but_the_whole_is_refused),
        cmocka_unit_test(each_changed_byte_is_refused),
        cmocka_unit_test(forged_values_are_refused),
        cmocka_unit_test(forged_surfaces_are_refused),
        cmocka_unit_test(floors_leave_no_memory),
        cmocka_unit_test(yield_strains_need_no_flow),
        cmocka_unit_test(forged_words_do_no_harm),
        cmocka_unit_test(billions_of_elements_take_no_time),
        cmocka_unit_test(later_chunks_are_skipped_and_counted),
        cmocka_unit_test(a_missing_chunk_is_refused),
        cmocka_unit_test(no_allocation_that_fails_leaks),
        cmocka_unit_test(writing_without_memory_leaks_nothing),
        cmocka_unit_test(files_of_earlier_versions_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
