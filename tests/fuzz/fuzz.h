/// @file fuzz.h
/// A fuzz target: any bytes are fine, and what goes wrong aborts.
///
/// SPDX-License-Identifier: MIT
#ifndef FUZZ_H
#define FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/// The entry point that libFuzzer and the driver call.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/// Stop here, with the condition that does not hold.
#define FUZZ_CHECK(condition)                                                                                      \
    do {                                                                                                           \
        if (!(condition)) {                                                                                        \
            fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #condition);                          \
            abort();                                                                                               \
        }                                                                                                          \
    } while (0)

/// Bytes to take decisions from; zeros after the last.
typedef struct fuzz_bytes {
    const uint8_t *data;
    size_t size, at;
} fuzz_bytes;

static inline uint8_t fuzz_byte(fuzz_bytes *bytes) {
    return bytes->at < bytes->size ? bytes->data[bytes->at++] : 0;
}

#endif
