/// @file huffman.c
/// Blocks of tokens in the codes that suit them (RFC 1951, section 3.2.7): frequent symbols get short codes.
///
/// SPDX-License-Identifier: MIT
#include "draw/deflate.h"

#include <stdlib.h>

enum {
    END_OF_BLOCK = 256,
    FIRST_LENGTH = 257,
    LEAST_MATCH = 3,
    MOST_MATCH = 258,
    LONGEST_CODE = 15,
    LONGEST_LENGTH_CODE = 7, // of the code in which the lengths of the other two are sent
    LENGTH_SYMBOLS = 19,
    DYNAMIC_CODES = 2,
};

typedef struct code {
    uint32_t counts[DEFLATE_LITERALS];
    uint8_t lengths[DEFLATE_LITERALS];
    uint16_t codes[DEFLATE_LITERALS]; // bits reversed: the way they are sent
    int size;
} code;

// A symbol, and bits that follow it as they are.
typedef struct coded {
    uint32_t symbol, extra;
    int extra_bits;
} coded;

void bit_writer_put(bit_writer *writer, uint32_t bits, int count) {
    writer->bits |= bits << writer->bit_count;
    writer->bit_count += count;
    for (; writer->bit_count >= 8; writer->bit_count -= 8, writer->bits >>= 8) {
        if (writer->length == writer->capacity) {
            size_t capacity = 2 * writer->capacity + 1024;
            uint8_t *bytes = realloc(writer->bytes, capacity);
            if (!bytes) {
                writer->out_of_memory = true;
                continue;
            }
            writer->bytes = bytes;
            writer->capacity = capacity;
        }
        writer->bytes[writer->length++] = (uint8_t)writer->bits;
    }
}

// Lengths and distances come in groups that grow with powers of two: the group has a symbol, the place in it is
// sent as it is. per_power groups share a power.
static coded group_of(uint32_t value, uint32_t per_power) {
    coded group = {.symbol = value};
    if (value < 2 * per_power)
        return group;
    int power = 0;
    while (value >> power >= 2 * per_power)
        power++;
    group.extra_bits = power;
    group.extra = value & ((1u << power) - 1);
    group.symbol = (uint32_t)power * per_power + (value >> power);
    return group;
}

static coded length_symbol(deflate_token token) {
    // The longest match has a symbol of its own.
    if (token.length == MOST_MATCH)
        return (coded){.symbol = DEFLATE_LITERALS - 1};
    coded group = group_of((uint32_t)token.length - LEAST_MATCH, 4);
    group.symbol += FIRST_LENGTH;
    return group;
}

static coded distance_symbol(deflate_token token) {
    return group_of((uint32_t)token.value - 1, 2);
}

// The node with the least weight of those that are not in the tree yet.
static int take_least(const uint64_t *weights, const int *parents, int count) {
    int least = -1;
    for (int i = 0; i < count; i++)
        if (weights[i] && parents[i] < 0 && (least < 0 || weights[i] < weights[least]))
            least = i;
    return least;
}

// Joins the two lightest nodes until one is left. Returns the length of the longest code.
static int build_tree(code *made, const uint32_t *counts) {
    uint64_t weights[2 * DEFLATE_LITERALS];
    int parents[2 * DEFLATE_LITERALS];
    int nodes = made->size;
    for (int i = 0; i < nodes; i++) {
        weights[i] = counts[i];
        parents[i] = -1;
    }
    for (;;) {
        int first = take_least(weights, parents, nodes);
        if (first < 0)
            break;
        parents[first] = nodes; // for now, so that it is not taken twice
        int second = take_least(weights, parents, nodes);
        if (second < 0) {
            parents[first] = -1;
            break;
        }
        parents[second] = nodes;
        weights[nodes] = weights[first] + weights[second];
        parents[nodes] = -1;
        nodes++;
    }
    int longest = 0;
    for (int i = 0; i < made->size; i++) {
        int length = 0;
        for (int node = i; parents[node] >= 0; node = parents[node])
            length++;
        // A lone symbol needs a bit, too.
        made->lengths[i] = (uint8_t)(counts[i] && length == 0 ? 1 : length);
        longest = length > longest ? length : longest;
    }
    return longest;
}

// Gives each symbol its length. Counts are evened out until no code is too long.
static void choose_lengths(code *made, int longest) {
    uint32_t counts[DEFLATE_LITERALS];
    for (int i = 0; i < made->size; i++)
        counts[i] = made->counts[i];
    while (build_tree(made, counts) > longest)
        for (int i = 0; i < made->size; i++)
            counts[i] = counts[i] ? counts[i] / 2 + 1 : 0;
}

// Numbers codes of the same length one after the other (RFC 1951, section 3.2.2).
static void number_codes(code *made) {
    uint32_t next = 0;
    for (int length = 1; length <= LONGEST_CODE; length++) {
        next <<= 1;
        for (int i = 0; i < made->size; i++) {
            if (made->lengths[i] != length)
                continue;
            uint32_t reversed = 0;
            for (int bit = 0; bit < length; bit++)
                reversed |= (next >> bit & 1) << (length - 1 - bit);
            made->codes[i] = (uint16_t)reversed;
            next++;
        }
    }
}

static void make_code(code *made, int longest) {
    choose_lengths(made, longest);
    number_codes(made);
}

static void put_symbol(bit_writer *writer, const code *used, coded symbol) {
    bit_writer_put(writer, used->codes[symbol.symbol], used->lengths[symbol.symbol]);
    bit_writer_put(writer, symbol.extra, symbol.extra_bits);
}

// How many symbols have to be sent, at least some number of them.
static int used_size(const code *made, int least) {
    int size = made->size;
    while (size > least && made->lengths[size - 1] == 0)
        size--;
    return size;
}

// The lengths of both codes in a row, runs of zeros shortened. Returns how many symbols.
static size_t shorten_lengths(const uint8_t *lengths, size_t count, coded *symbols) {
    size_t made = 0;
    for (size_t i = 0; i < count;) {
        size_t run = 1;
        while (i + run < count && lengths[i + run] == lengths[i] && run < 138)
            run++;
        if (lengths[i] == 0 && run >= 11) {
            symbols[made++] = (coded){.symbol = 18, .extra = (uint32_t)run - 11, .extra_bits = 7};
        } else if (lengths[i] == 0 && run >= 3) {
            symbols[made++] = (coded){.symbol = 17, .extra = (uint32_t)run - 3, .extra_bits = 3};
        } else {
            run = 1;
            symbols[made++] = (coded){.symbol = lengths[i]};
        }
        i += run;
    }
    return made;
}

static void put_codes(bit_writer *writer, const code *literals, const code *distances) {
    static const uint8_t order[LENGTH_SYMBOLS] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    uint8_t lengths[DEFLATE_LITERALS + DEFLATE_DISTANCES];
    coded symbols[DEFLATE_LITERALS + DEFLATE_DISTANCES];
    int literal_size = used_size(literals, FIRST_LENGTH);
    int distance_size = used_size(distances, 1);
    for (int i = 0; i < literal_size; i++)
        lengths[i] = literals->lengths[i];
    for (int i = 0; i < distance_size; i++)
        lengths[literal_size + i] = distances->lengths[i];
    size_t count = shorten_lengths(lengths, (size_t)(literal_size + distance_size), symbols);

    code code_lengths = {.size = LENGTH_SYMBOLS};
    for (size_t i = 0; i < count; i++)
        code_lengths.counts[symbols[i].symbol]++;
    make_code(&code_lengths, LONGEST_LENGTH_CODE);
    int sent = LENGTH_SYMBOLS;
    while (sent > 4 && code_lengths.lengths[order[sent - 1]] == 0)
        sent--;
    bit_writer_put(writer, (uint32_t)(literal_size - FIRST_LENGTH), 5);
    bit_writer_put(writer, (uint32_t)(distance_size - 1), 5);
    bit_writer_put(writer, (uint32_t)(sent - 4), 4);
    for (int i = 0; i < sent; i++)
        bit_writer_put(writer, code_lengths.lengths[order[i]], 3);
    for (size_t i = 0; i < count; i++)
        put_symbol(writer, &code_lengths, symbols[i]);
}

static void count_tokens(const deflate_block *block, code *literals, code *distances) {
    literals->counts[END_OF_BLOCK] = 1;
    for (size_t i = 0; i < block->token_count; i++) {
        deflate_token token = block->tokens[i];
        if (token.length == 0) {
            literals->counts[token.value]++;
        } else {
            literals->counts[length_symbol(token).symbol]++;
            distances->counts[distance_symbol(token).symbol]++;
        }
    }
}

void deflate_block_put(deflate_block *block, bit_writer *writer, bool last) {
    code literals = {.size = DEFLATE_LITERALS};
    code distances = {.size = DEFLATE_DISTANCES};
    count_tokens(block, &literals, &distances);
    make_code(&literals, LONGEST_CODE);
    make_code(&distances, LONGEST_CODE);
    bit_writer_put(writer, last, 1);
    bit_writer_put(writer, DYNAMIC_CODES, 2);
    put_codes(writer, &literals, &distances);
    for (size_t i = 0; i < block->token_count; i++) {
        deflate_token token = block->tokens[i];
        if (token.length == 0) {
            put_symbol(writer, &literals, (coded){.symbol = token.value});
        } else {
            put_symbol(writer, &literals, length_symbol(token));
            put_symbol(writer, &distances, distance_symbol(token));
        }
    }
    put_symbol(writer, &literals, (coded){.symbol = END_OF_BLOCK});
    block->token_count = 0;
}

void deflate_block_add(deflate_block *block, bit_writer *writer, deflate_token token) {
    if (block->token_count == DEFLATE_BLOCK_TOKENS)
        deflate_block_put(block, writer, false);
    block->tokens[block->token_count++] = token;
}
