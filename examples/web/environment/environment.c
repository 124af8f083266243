/// @file environment.c
/// What a compiler takes for granted, and memory.
///
/// SPDX-License-Identifier: MIT
#include "environment.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------------ bytes */

// One instruction each (bulk memory).
void *memcpy(void *restrict to, const void *restrict from, size_t size) {
    return __builtin_memcpy(to, from, size);
}

void *memmove(void *to, const void *from, size_t size) {
    return __builtin_memmove(to, from, size);
}

void *memset(void *to, int value, size_t size) {
    return __builtin_memset(to, value, size);
}

int memcmp(const void *a, const void *b, size_t size) {
    const unsigned char *left = a, *right = b;
    for (size_t i = 0; i < size; i++)
        if (left[i] != right[i])
            return left[i] < right[i] ? -1 : 1;
    return 0;
}

int strcmp(const char *a, const char *b) {
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return (unsigned char)*a - (unsigned char)*b;
}

size_t strlen(const char *text) {
    size_t length = 0;
    while (text[length])
        length++;
    return length;
}

/* ---------------------------------------------------------------------------------------------------- numbers */

// A number beside NaN wins, as in the C library.
double fmin(double a, double b) {
    return a < b || b != b ? a : b;
}

double fmax(double a, double b) {
    return a > b || b != b ? a : b;
}

float fminf(float a, float b) {
    return a < b || b != b ? a : b;
}

float fmaxf(float a, float b) {
    return a > b || b != b ? a : b;
}

static double power_of_two(int exponent) {
    const uint64_t bits = (uint64_t)(exponent + 1023) << 52;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// A result below the normal numbers would be rounded twice, which the library has no use for.
double ldexp(double value, int exponent) {
    for (; exponent > 1023; exponent -= 1023)
        value *= power_of_two(1023);
    for (; exponent < -1022; exponent += 1022)
        value *= power_of_two(-1022);
    return value * power_of_two(exponent);
}

double frexp(double value, int *exponent) {
    uint64_t bits;
    int scale = 0;
    *exponent = 0;
    if (value == 0 || !isfinite(value))
        return value;
    if (fabs(value) < power_of_two(-1022)) { // denormal
        value *= power_of_two(54);
        scale = -54;
    }
    memcpy(&bits, &value, sizeof bits);
    *exponent = (int)(bits >> 52 & 0x7ff) - 1022 + scale;
    bits = (bits & ~(UINT64_C(0x7ff) << 52)) | UINT64_C(1022) << 52;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* ----------------------------------------------------------------------------------------------------- memory */

// From the linker: where free memory begins.
extern unsigned char __heap_base;

enum { SMALLEST = 6, LARGEST = 31, PAGE = 1 << 16 }; // powers of two

typedef struct block {
    struct block *next;
} block;

static block *freed[LARGEST + 1]; // by size
static uintptr_t unused;          // where memory begins that was never given out

static unsigned size_class(size_t size) {
    unsigned power = SMALLEST;
    while (power < LARGEST && (size_t)1 << power < size)
        power++;
    return power;
}

static void *take(size_t size, size_t alignment, void *user) {
    (void)alignment; // at most 64, as all blocks have
    (void)user;
    const unsigned power = size_class(size);
    const uintptr_t taken = (uintptr_t)1 << power;
    if (taken < size)
        return NULL;
    if (freed[power]) {
        block *found = freed[power];
        freed[power] = found->next;
        return found;
    }
    if (!unused)
        unused = ((uintptr_t)&__heap_base + 63) / 64 * 64;
    const uintptr_t has = __builtin_wasm_memory_size(0) * (uintptr_t)PAGE;
    if (taken > UINTPTR_MAX - PAGE - unused)
        return NULL;
    if (unused + taken > has && __builtin_wasm_memory_grow(0, (unused + taken - has + PAGE - 1) / PAGE) == SIZE_MAX)
        return NULL;
    void *memory = (void *)unused;
    unused += taken;
    return memory;
}

static void leave(void *memory, size_t size, void *user) {
    (void)user;
    if (!memory)
        return;
    block *left = memory;
    const unsigned power = size_class(size);
    left->next = freed[power];
    freed[power] = left;
}

const mspring_allocator environment_allocator = {
    .struct_size = sizeof(mspring_allocator),
    .alloc = take,
    .free = leave,
};
