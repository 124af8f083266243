/// @file target.h
/// What the compiler makes code for: which kernels there can be. By the compiler's own macros, so that one build
/// can be for several CPUs (macOS), and so that the sources need no build system.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TARGET_H
#define MSPRINGI_TARGET_H

#include <float.h>

// The same bits on every machine take arithmetic in the types as written. Of 16 and 32 bits: types narrower than these
// alone are computed in them (ISO/IEC TS 18661-3), as _Float16 of CPUs with AVX512-FP16.
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16 && FLT_EVAL_METHOD != 32
#error "this target computes in wider types than the source has: on i386 use -msse2 -mfpmath=sse"
#endif

#if defined(__x86_64__) || (defined(_M_X64) && !defined(_M_ARM64EC)) || defined(__i386__) || defined(_M_IX86)
#define MSPRINGI_X86 1
#elif defined(__aarch64__) || defined(_M_ARM64)
#define MSPRINGI_AARCH64 1
#elif defined(__wasm_simd128__)
#define MSPRINGI_WASM 1
#endif

// Without better kernels there are the scalar ones.
#if defined(MSPRINGI_WITHOUT_SCALAR) && !defined(MSPRINGI_X86) && !defined(MSPRINGI_AARCH64) &&                    \
    !defined(MSPRINGI_WASM)
#undef MSPRINGI_WITHOUT_SCALAR
#endif

// Snapshots are little-endian everywhere.
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define MSPRINGI_BIG_ENDIAN_HOST 1
#else
#define MSPRINGI_BIG_ENDIAN_HOST 0
#endif

// For small functions of inner loops: a compiler that has seen many uses may call them otherwise.
#if defined(_MSC_VER) && !defined(__clang__)
#define MSPRINGI_INLINE static __forceinline
#else
#define MSPRINGI_INLINE static inline __attribute__((always_inline))
#endif

#endif
