/// @file driver.c
/// Runs a fuzz target without libFuzzer.
///
///   fuzz_<target> FILE...                                replay inputs; folders are not looked into
///   fuzz_<target> --runs N [--seed S] [--length L] [FILE...]
///                                                        also N inputs at random: bytes, or changed copies of
///                                                        files
///
/// The same N, seed and files give the same inputs everywhere. An input that aborts is left in the file named
/// crash.
///
/// SPDX-License-Identifier: MIT
#include "fuzz.h"

#include <signal.h>
#include <string.h>

enum { MOST_FILES = 1000, LONGEST = 1 << 16 };

typedef struct input {
    uint8_t *bytes;
    size_t size;
} input;

static uint8_t current[LONGEST];
static size_t current_size;

static uint64_t next_random(uint64_t *seed) {
    uint64_t bits = *seed += UINT64_C(0x9e3779b97f4a7c15); // SplitMix64
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94d049bb133111eb);
    return bits ^ (bits >> 31);
}

// NOLINTBEGIN(bugprone-signal-handler,cert-sig30-c): it ends the program, in whatever state
static void leave_input(int number) {
    signal(number, SIG_DFL);
    FILE *stream = fopen("crash", "wb");
    if (stream) {
        fwrite(current, 1, current_size, stream);
        fclose(stream);
        fprintf(stderr, "the input is in the file crash, %zu bytes\n", current_size);
    }
    raise(number);
}
// NOLINTEND(bugprone-signal-handler,cert-sig30-c)

static void run(void) {
    // A copy of just this size, so that sanitizers see reads behind it.
    uint8_t *copy = malloc(current_size ? current_size : 1);
    if (!copy)
        exit(2);
    memcpy(copy, current, current_size);
    LLVMFuzzerTestOneInput(copy, current_size);
    free(copy);
}

static input read_file(const char *path) {
    input in = {NULL, 0};
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return in;
    in.bytes = malloc(LONGEST);
    if (in.bytes)
        in.size = fread(in.bytes, 1, LONGEST, stream);
    fclose(stream);
    return in;
}

static void draw_bytes(uint64_t *seed, size_t length) {
    current_size = (size_t)(next_random(seed) % length);
    for (size_t i = 0; i < current_size; i++)
        current[i] = (uint8_t)next_random(seed);
}

// Copy a file and change some of it: bytes anew, stretches left out or twice.
static void draw_changed(uint64_t *seed, const input *in) {
    memcpy(current, in->bytes, in->size);
    current_size = in->size;
    for (uint64_t changes = 1 + next_random(seed) % 8; changes > 0 && current_size > 0; changes--) {
        const size_t at = (size_t)(next_random(seed) % current_size), rest = current_size - at;
        const size_t length = 1 + (size_t)(next_random(seed) % 16);
        switch (next_random(seed) % 4) {
        case 0:
            current[at] = (uint8_t)next_random(seed);
            break;
        case 1:
            current[at] ^= (uint8_t)(1u << next_random(seed) % 8);
            break;
        case 2:
            if (length < rest) {
                memmove(current + at, current + at + length, rest - length);
                current_size -= length;
            }
            break;
        default:
            if (current_size + length <= LONGEST) {
                memmove(current + at + length, current + at, rest);
                current_size += length;
            }
        }
    }
}

int main(int count, char **arguments) {
    static input files[MOST_FILES];
    size_t file_count = 0, length = 400;
    uint64_t runs = 0, seed = 1;
    for (int i = 1; i < count; i++) {
        if (strcmp(arguments[i], "--runs") == 0 && i + 1 < count) {
            runs = strtoull(arguments[++i], NULL, 10);
        } else if (strcmp(arguments[i], "--seed") == 0 && i + 1 < count) {
            seed = strtoull(arguments[++i], NULL, 10);
        } else if (strcmp(arguments[i], "--length") == 0 && i + 1 < count) {
            length = (size_t)strtoull(arguments[++i], NULL, 10);
        } else if (file_count < MOST_FILES) {
            files[file_count] = read_file(arguments[i]);
            if (!files[file_count].bytes) {
                fprintf(stderr, "cannot read %s\n", arguments[i]);
                return 2;
            }
            file_count++;
        }
    }
    if (length < 1 || length > LONGEST)
        length = LONGEST;
    signal(SIGABRT, leave_input);
    signal(SIGSEGV, leave_input);
    signal(SIGFPE, leave_input);
    for (size_t i = 0; i < file_count; i++) {
        memcpy(current, files[i].bytes, files[i].size);
        current_size = files[i].size;
        run();
    }
    for (uint64_t i = 0; i < runs; i++) {
        if (file_count > 0 && next_random(&seed) % 4 > 0)
            draw_changed(&seed, &files[next_random(&seed) % file_count]);
        else
            draw_bytes(&seed, length);
        run();
    }
    printf("%llu inputs\n", (unsigned long long)runs + file_count);
    for (size_t i = 0; i < file_count; i++)
        free(files[i].bytes);
    return 0;
}
