/// @file fuzz_archive.c
/// Archives that were tampered with, and bytes that never were one: they are refused with a message, or give a
/// network that steps, writes an archive, and has the same bytes when that is read. Most get checksums that fit, or
/// nothing would be seen of what is behind them.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "archives.h"
#include "fuzz.h"

enum { MOST_CHANGES = 8 };

// One archive of each kind, made once.
static const archived *subject(int kind) {
    static archived made[ARCHIVES_KINDS];
    if (made[kind].bytes == NULL) {
        mspring_network *network = archives_make(kind);
        made[kind] = archives_write(network);
        mspring_network_destroy(network);
    }
    return &made[kind];
}

// Read definitions back from a builder. Each would be accepted again.
static void read_back(mspring_builder *builder) {
    const mspring_id particles = mspring_builder_count(builder, MSPRING_PARTICLES),
                     springs = mspring_builder_count(builder, MSPRING_SPRINGS);
    mspring_particle_def particle = {.struct_size = sizeof particle};
    mspring_spring_def spring = {.struct_size = sizeof spring};
    mspring_network_def network = {.struct_size = sizeof network};
    FUZZ_CHECK(mspring_builder_get_network_def(builder, &network) == MSPRING_OK);
    if (particles > 0)
        FUZZ_CHECK(mspring_builder_get_particles(builder, NULL, particles - 1, 1, &particle) == MSPRING_OK);
    if (springs > 0)
        FUZZ_CHECK(mspring_builder_get_springs(builder, NULL, springs - 1, 1, &spring) == MSPRING_OK &&
                   spring.a < particles && spring.b < particles);
}

static mspring_network *read(const archived *from) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    FUZZ_CHECK(mspring_builder_create(NULL, &builder) == MSPRING_OK);
    mspring_result result = mspring_builder_read(builder, from->bytes, from->size, NULL);
    if (result == MSPRING_OK) {
        read_back(builder);
        result = mspring_network_create(builder, NULL, &network);
    }
    FUZZ_CHECK(result == MSPRING_OK ||
               (strstr(support_builder_error(builder), "archive") != NULL && network == NULL));
    FUZZ_CHECK(result == MSPRING_OK || result == MSPRING_ERROR_SNAPSHOT);
    mspring_builder_destroy(builder);
    return network;
}

// Write a network that was read, and read it again. Both archives have the same bytes.
static void check(mspring_network *network) {
    const mspring_id springs = mspring_network_count(network, MSPRING_SPRINGS);
    const archived first = archives_write(network);
    mspring_network *again = read(&first);
    FUZZ_CHECK(again != NULL && mspring_network_count(again, MSPRING_SPRINGS) == springs);
    const archived second = archives_write(again);
    FUZZ_CHECK(first.size == second.size && memcmp(first.bytes, second.bytes, first.size) == 0);
    free(first.bytes);
    free(second.bytes);
    for (int i = 0; i < 2; i++) {
        const mspring_result result = mspring_network_step(network, 1.0 / 64);
        FUZZ_CHECK(result == mspring_network_step(again, 1.0 / 64));
        if (result != MSPRING_OK)
            break;
    }
    mspring_network_destroy(again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_bytes bytes = {data, size, 0};
    const archived *from = subject(fuzz_byte(&bytes) % ARCHIVES_KINDS);
    const uint8_t how = fuzz_byte(&bytes);
    archived forged = {malloc(from->size + size + 1), from->size, 0};
    FUZZ_CHECK(forged.bytes != NULL);
    memcpy(forged.bytes, from->bytes, from->size);
    if (how == 0) { // not one at all
        forged.size = size;
        if (size > 0)
            memcpy(forged.bytes, data, size);
    }
    for (int i = 0; how != 0 && i < MOST_CHANGES && bytes.at < bytes.size; i++) {
        const uint32_t high = fuzz_byte(&bytes), low = fuzz_byte(&bytes), kind = fuzz_byte(&bytes);
        const size_t at = (high << 16 | low << 8 | fuzz_byte(&bytes)) % forged.size;
        for (size_t k = at; k < at + 4 && k < forged.size; k++)
            forged.bytes[k] = kind % 4 == 0 ? 0xff : kind % 4 == 1 ? 0 : fuzz_byte(&bytes);
    }
    if (how % 16 == 1)
        forged.size = forged.size * fuzz_byte(&bytes) / 256;
    if (how % 32 != 2 && how != 0)
        archives_renew(&forged);
    mspring_network *network = read(&forged);
    if (network != NULL)
        check(network);
    mspring_network_destroy(network);
    free(forged.bytes);
    return 0;
}
