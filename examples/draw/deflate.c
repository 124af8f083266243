/// @file deflate.c
/// Compression in the zlib format (RFC 1950 and 1951): repeated strings are replaced by references to where they
/// came before, and what is left is sent in codes made for it (huffman.c).
///
/// SPDX-License-Identifier: MIT
#include "draw/deflate.h"
#include "draw/internal.h"

#include <stdlib.h>

enum {
    WINDOW = 32768,
    LEAST_MATCH = 3,
    MOST_MATCH = 258,
    HASH_BITS = 15,
    MOST_TRIES = 128, // candidates looked at for one match: more is slower and hardly smaller
};

// The strings seen: for each hash the last place, and for each place the one before it with its hash.
typedef struct match_finder {
    const uint8_t *bytes;
    size_t length;
    int64_t *last;     // [2^HASH_BITS]
    int64_t *previous; // [WINDOW]
} match_finder;

typedef struct match {
    size_t length, distance;
} match;

static uint32_t hash_at(const match_finder *finder, size_t at) {
    const uint8_t *bytes = finder->bytes + at;
    uint32_t string = (uint32_t)bytes[0] << 16 | (uint32_t)bytes[1] << 8 | bytes[2];
    return string * 2654435761u >> (32 - HASH_BITS);
}

static void remember(match_finder *finder, size_t at) {
    if (at + LEAST_MATCH > finder->length)
        return;
    uint32_t hash = hash_at(finder, at);
    finder->previous[at % WINDOW] = finder->last[hash];
    finder->last[hash] = (int64_t)at;
}

static match find_match(const match_finder *finder, size_t at) {
    match best = {0};
    if (at + LEAST_MATCH > finder->length)
        return best;
    size_t most = finder->length - at < MOST_MATCH ? finder->length - at : MOST_MATCH;
    int64_t candidate = finder->last[hash_at(finder, at)];
    for (int tries = 0; tries < MOST_TRIES && candidate >= 0 && (int64_t)at - candidate < WINDOW; tries++) {
        size_t length = 0;
        while (length < most && finder->bytes[(size_t)candidate + length] == finder->bytes[at + length])
            length++;
        if (length >= LEAST_MATCH && length > best.length) {
            best.length = length;
            best.distance = at - (size_t)candidate;
        }
        if (best.length == most)
            break;
        candidate = finder->previous[candidate % WINDOW];
    }
    return best;
}

// Takes a match only if the next place has no longer one.
static void put_strings(bit_writer *writer, match_finder *finder) {
    deflate_block block = {.token_count = 0};
    match next = find_match(finder, 0);
    for (size_t at = 0; at < finder->length;) {
        match here = next;
        remember(finder, at);
        next = find_match(finder, at + 1);
        if (here.length < LEAST_MATCH || next.length > here.length) {
            deflate_block_add(&block, writer, (deflate_token){.value = finder->bytes[at++]});
            continue;
        }
        deflate_block_add(&block, writer,
                          (deflate_token){.length = (uint16_t)here.length, .value = (uint16_t)here.distance});
        for (size_t i = 1; i < here.length; i++)
            remember(finder, at + i);
        at += here.length;
        next = find_match(finder, at);
    }
    deflate_block_put(&block, writer, true);
}

static uint32_t adler32(const uint8_t *bytes, size_t length) {
    uint32_t a = 1;
    uint32_t b = 0;
    for (size_t i = 0; i < length; i++) {
        a = (a + bytes[i]) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

static void put_stream(bit_writer *writer, match_finder *finder) {
    bit_writer_put(writer, 0x78, 8); // deflate with a window of 32 KiB
    bit_writer_put(writer, 0x01, 8); // makes the two bytes a multiple of 31
    put_strings(writer, finder);
    bit_writer_put(writer, 0, (8 - writer->bit_count) % 8);
    uint32_t check = adler32(finder->bytes, finder->length);
    for (int shift = 24; shift >= 0; shift -= 8)
        bit_writer_put(writer, check >> shift & 255, 8);
}

uint8_t *deflate_zlib(const uint8_t *bytes, size_t length, size_t *compressed) {
    bit_writer writer = {0};
    match_finder finder = {.bytes = bytes, .length = length};
    size_t hashes = (size_t)1 << HASH_BITS;
    finder.last = malloc(hashes * sizeof *finder.last);
    finder.previous = malloc(WINDOW * sizeof *finder.previous);
    if (finder.last && finder.previous) {
        for (size_t i = 0; i < hashes; i++)
            finder.last[i] = -1;
        put_stream(&writer, &finder);
    } else {
        writer.out_of_memory = true;
    }
    free(finder.last);
    free(finder.previous);
    if (writer.out_of_memory) {
        free(writer.bytes);
        return NULL;
    }
    *compressed = writer.length;
    return writer.bytes;
}
