/// @file machine.c
/// Clock, processor, caches and compiler.
///
/// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include "machine.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif

double bench_seconds(void) {
    struct timespec now;
#ifdef CLOCK_MONOTONIC
    clock_gettime(CLOCK_MONOTONIC, &now);
#else
    timespec_get(&now, TIME_UTC);
#endif
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double bench_thread_seconds(void) {
#ifdef CLOCK_THREAD_CPUTIME_ID
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
#else
    return bench_seconds();
#endif
}

const char *bench_cpu_name(char *text, size_t size) {
    const char *name = "unknown processor";
#if defined(__x86_64__) || defined(__i386__)
    unsigned registers[13] = {0}; /* three leaves of 16 characters, and the end of the string */
    bool known = true;
    for (unsigned leaf = 0; leaf < 3; leaf++) {
        unsigned *part = &registers[4 * leaf];
        known = known && __get_cpuid(0x80000002u + leaf, &part[0], &part[1], &part[2], &part[3]);
    }
    char brand[sizeof registers];
    memcpy(brand, registers, sizeof brand);
    const char *start = brand + strspn(brand, " ");
    if (known && *start != '\0') {
        name = start;
    }
#endif
    snprintf(text, size, "%s", name);
    size_t length = strlen(text);
    while (length > 0 && text[length - 1] == ' ') {
        text[--length] = '\0';
    }
    return text;
}

const char *bench_compiler(void) {
#if defined(__clang__)
    return __VERSION__; /* says "Clang" itself */
#elif defined(__GNUC__)
    return "gcc " __VERSION__;
#else
    return "unknown compiler";
#endif
}

/// One word of a file of the system, or "".
static void read_word(const char *path, char word[32]) {
    word[0] = '\0';
    FILE *file = fopen(path, "r");
    if (file != NULL) {
        if (fscanf(file, "%31s", word) != 1) {
            word[0] = '\0';
        }
        fclose(file);
    }
}

size_t bench_cache_size(int level) {
    static const size_t usual[3] = {(size_t)32 << 10, (size_t)1 << 20, (size_t)16 << 20};
    for (int index = 0; index < 8; index++) {
        static const char folder[] = "/sys/devices/system/cpu/cpu0/cache/index";
        char path[96];
        char type[32];
        char its_level[32];
        char size[32];
        snprintf(path, sizeof path, "%s%d/level", folder, index);
        read_word(path, its_level);
        snprintf(path, sizeof path, "%s%d/type", folder, index);
        read_word(path, type);
        snprintf(path, sizeof path, "%s%d/size", folder, index);
        read_word(path, size);
        unsigned long kilobytes = strtoul(size, NULL, 10); /* the file says "48K" */
        if (strtol(its_level, NULL, 10) == level && strcmp(type, "Instruction") != 0 && kilobytes > 0) {
            return (size_t)kilobytes << 10;
        }
    }
    return usual[level - 1];
}
