/// @file machine.h
/// What the numbers were measured with: clock, processor, caches, compiler.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_MACHINE_H
#define BENCH_MACHINE_H

#include <stddef.h>

/// Seconds on a clock that only goes forward.
double bench_seconds(void);

/// Time of this thread alone: for what is told against something else, whatever other programs do meanwhile.
double bench_thread_seconds(void);

/// Name of the processor; "unknown processor" where it does not tell. Fills text and returns it.
const char *bench_cpu_name(char *text, size_t size);

/// Name and version of the compiler that built the bench.
const char *bench_compiler(void);

/// Bytes of data cache at level 1, 2 or 3 that one core reaches; a usual size where the system does not tell.
size_t bench_cache_size(int level);

#endif
