/// @file cpu.h
/// What the CPU can do, and the floating-point environment of a step.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CPU_H
#define MSPRINGI_CPU_H

#include <stdint.h>

#include <massspring/massspring_tools.h>

/// The level to run at: the best supported one, lowered by wanted (MSPRING_SIMD_AUTO: not) and by the environment
/// variable MSPRING_SIMD.
mspring_simd mspringi_cpu_choose(mspring_simd wanted);

/// The calling thread's floating-point control word, as a step must find it again.
typedef uint64_t mspringi_fp_state;

/// Ask for memory that is read soon.
#if defined(__GNUC__)
#define MSPRINGI_PREFETCH(address) __builtin_prefetch(address)
#else
#define MSPRINGI_PREFETCH(address) ((void)(address))
#endif

/// Keeps a function a function: the compiler must not move its arithmetic to before mspringi_fp_enter() or to after
/// mspringi_fp_leave().
#if defined(_MSC_VER)
#define MSPRINGI_NOINLINE __declspec(noinline)
#else
#define MSPRINGI_NOINLINE __attribute__((noinline))
#endif

/// Makes a function part of its caller, for loops that are to be vectors with what the caller knows.
#if defined(_MSC_VER)
#define MSPRINGI_ALWAYS_INLINE static __forceinline
#else
#define MSPRINGI_ALWAYS_INLINE static inline __attribute__((always_inline))
#endif

/// Switch to rounding to nearest with denormals kept and no exception trapped: the state of the host's thread
/// must not change a step's bits. Returns what was there.
mspringi_fp_state mspringi_fp_enter(void);
void mspringi_fp_leave(mspringi_fp_state before);

#endif
