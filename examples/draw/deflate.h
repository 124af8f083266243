/// @file deflate.h
/// What deflate.c and huffman.c share.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_DEFLATE_H
#define DRAW_DEFLATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Bits on their way into bytes that grow.
typedef struct bit_writer {
    uint8_t *bytes;
    size_t length, capacity;
    uint32_t bits;
    int bit_count;
    bool out_of_memory;
} bit_writer;

/// Put up to 16 bits, the lowest first.
void bit_writer_put(bit_writer *writer, uint32_t bits, int count);

/// A literal byte (length 0), or a reference to length bytes at a distance of value.
typedef struct deflate_token {
    uint16_t length, value;
} deflate_token;

enum { DEFLATE_BLOCK_TOKENS = 16384, DEFLATE_LITERALS = 286, DEFLATE_DISTANCES = 30 };

/// Tokens that are sent in one pair of codes.
typedef struct deflate_block {
    deflate_token tokens[DEFLATE_BLOCK_TOKENS];
    size_t token_count;
} deflate_block;

/// Add a token; a full block is put first.
void deflate_block_add(deflate_block *block, bit_writer *writer, deflate_token token);
/// Put a block and empty it.
void deflate_block_put(deflate_block *block, bit_writer *writer, bool last);

#endif
