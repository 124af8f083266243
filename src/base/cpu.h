/// @file cpu.h
/// Instruction sets of the CPU, and the floating-point environment of a step.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CPU_H
#define MSPRINGI_CPU_H

#include <stdint.h>

#include <massspring/massspring.h>

/// Choose the level: the best supported one, unless `wanted` (other than MSPRING_SIMD_AUTO) or the environment
/// variable MSPRING_SIMD lowers it.
mspring_simd mspringi_cpu_choose(mspring_simd wanted);

/// Floating-point control word of a thread.
typedef uint64_t mspringi_fp_state;

/// Prefetch memory that is read soon.
#if defined(__GNUC__)
#define MSPRINGI_PREFETCH(address) __builtin_prefetch(address)
#else
#define MSPRINGI_PREFETCH(address) ((void)(address))
#endif

/// Prevent inlining: the compiler must not move arithmetic before mspringi_fp_enter() or behind
/// mspringi_fp_leave().
#if defined(_MSC_VER)
#define MSPRINGI_NOINLINE __declspec(noinline)
#else
#define MSPRINGI_NOINLINE __attribute__((noinline))
#endif

/// Force inlining: loops become vector code with what the caller knows.
#if defined(_MSC_VER)
#define MSPRINGI_ALWAYS_INLINE static __forceinline
#else
#define MSPRINGI_ALWAYS_INLINE static inline __attribute__((always_inline))
#endif

/// Switch to round-to-nearest with denormals kept and no exception trapped, so that the state of the host's thread
/// cannot change bits. Return the previous state.
mspringi_fp_state mspringi_fp_enter(void);
void mspringi_fp_leave(mspringi_fp_state before);

#endif
