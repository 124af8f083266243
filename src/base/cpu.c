#include "base/cpu.h"

#include <string.h>

#if !defined(MSPRINGI_FREESTANDING)
#include <stdlib.h>
#endif

#include "base/target.h"

#if defined(MSPRINGI_X86)
#include <immintrin.h>
#if defined(_MSC_VER) && !defined(__clang__)
#include <intrin.h>
#else
#include <cpuid.h>
#endif
#elif !defined(__wasm__)
#include <fenv.h>
#endif

/* ------------------------------------------------------------------------------------------------ levels */

// Levels of this build, lowest first.
static const mspring_simd levels[] = {
#define LEVEL(name, number) MSPRING_SIMD_##number,
#include "base/levels.def"
#undef LEVEL
};
#define LEVEL_COUNT (sizeof levels / sizeof levels[0])

#if defined(MSPRINGI_X86)

typedef struct cpuid_words {
    uint32_t a, b, c, d;
} cpuid_words;

static cpuid_words cpuid(uint32_t leaf) {
    cpuid_words words = {0, 0, 0, 0};
#if defined(_MSC_VER) && !defined(__clang__)
    int out[4];
    __cpuid(out, 0);
    if ((uint32_t)out[0] >= leaf) {
        __cpuidex(out, (int)leaf, 0);
        words = (cpuid_words){(uint32_t)out[0], (uint32_t)out[1], (uint32_t)out[2], (uint32_t)out[3]};
    }
#else
    if (!__get_cpuid_count(leaf, 0, &words.a, &words.b, &words.c, &words.d))
        words = (cpuid_words){0, 0, 0, 0};
#endif
    return words;
}

// Registers saved by the operating system: bits 1 and 2 for the 256-bit ones, 5 to 7 for the 512-bit ones.
static uint64_t saved_registers(void) {
#if defined(_MSC_VER) && !defined(__clang__)
    return _xgetbv(0);
#else
    uint32_t low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return (uint64_t)high << 32 | low;
#endif
}

// Best level of the CPU, even if this build lacks it.
static mspring_simd best_of_cpu(void) {
    const uint32_t osxsave = 1u << 27, avx = 1u << 28, avx2 = 1u << 5, avx512f = 1u << 16;
    const uint64_t saves_256 = 0x06, saves_512 = 0xe6;
    const cpuid_words features = cpuid(1), extended = cpuid(7);
    if (!(features.c & osxsave) || !(features.c & avx) || (saved_registers() & saves_256) != saves_256 ||
        !(extended.b & avx2))
        return MSPRING_SIMD_SSE2;
    if (!(extended.b & avx512f) || (saved_registers() & saves_512) != saves_512)
        return MSPRING_SIMD_AVX2;
    return MSPRING_SIMD_AVX512;
}

#else

// Every 64-bit ARM CPU has NEON. Vector units of 32-bit ones flush denormals, so they cannot give the same bits.
static mspring_simd best_of_cpu(void) {
    return levels[LEVEL_COUNT - 1];
}

#endif

static mspring_simd best_of_build(void) {
    const mspring_simd best = best_of_cpu();
    size_t i = LEVEL_COUNT - 1;
    while (i > 0 && levels[i] > best)
        --i;
    return levels[i];
}

uint32_t mspring_simd_available(mspring_simd level) {
    if (level == MSPRING_SIMD_AUTO)
        return 1;
    for (size_t i = 0; i < LEVEL_COUNT; ++i)
        if (levels[i] == level)
            return level <= best_of_build();
    return 0;
}

const char *mspring_simd_name(mspring_simd level) {
    switch (level) {
    case MSPRING_SIMD_AUTO:
        return "auto";
#define MSPRINGI_EVERY_LEVEL
#define LEVEL(name, number)                                                                                        \
    case MSPRING_SIMD_##number:                                                                                    \
        return #name;
#include "base/levels.def"
#undef LEVEL
#undef MSPRINGI_EVERY_LEVEL
    default:
        return "unknown";
    }
}

// MSPRING_SIMD_SCALAR selects scalar code, or the lowest level of this build.
mspring_simd mspringi_cpu_choose(mspring_simd wanted) {
    mspring_simd level = best_of_build();
    if (wanted == MSPRING_SIMD_SCALAR)
        level = levels[0];
    else if (wanted != MSPRING_SIMD_AUTO && mspring_simd_available(wanted))
        level = wanted;
#if defined(MSPRINGI_FREESTANDING)
    const char *name = NULL;
#else
    const char *name = getenv("MSPRING_SIMD");
#endif
    if (name && strcmp(name, mspring_simd_name(MSPRING_SIMD_SCALAR)) == 0)
        level = levels[0];
    for (mspring_simd l = MSPRING_SIMD_SCALAR; name && l < level; ++l)
        if (mspring_simd_available(l) && strcmp(name, mspring_simd_name(l)) == 0)
            level = l;
    return level;
}

/* -------------------------------------------------------------------------------- floating-point environment */

#if defined(MSPRINGI_X86)

mspringi_fp_state mspringi_fp_enter(void) {
    const mspringi_fp_state before = _mm_getcsr();
    _mm_setcsr(0x1f80); // all exceptions masked, round to nearest, no flush to zero
    return before;
}

void mspringi_fp_leave(mspringi_fp_state before) {
    _mm_setcsr((unsigned)before);
}

#elif defined(__aarch64__) && defined(__GNUC__)

mspringi_fp_state mspringi_fp_enter(void) {
    mspringi_fp_state before;
    __asm__ volatile("mrs %0, fpcr" : "=r"(before));
    __asm__ volatile("msr fpcr, %0" : : "r"((mspringi_fp_state)0));
    return before;
}

void mspringi_fp_leave(mspringi_fp_state before) {
    __asm__ volatile("msr fpcr, %0" : : "r"(before));
}

#elif defined(__arm__) && defined(__ARM_FP) && defined(__GNUC__)

mspringi_fp_state mspringi_fp_enter(void) {
    uint32_t before;
    __asm__ volatile("vmrs %0, fpscr" : "=r"(before));
    __asm__ volatile("vmsr fpscr, %0" : : "r"(0u));
    return before;
}

void mspringi_fp_leave(mspringi_fp_state before) {
    __asm__ volatile("vmsr fpscr, %0" : : "r"((uint32_t)before));
}

#elif defined(__wasm__)

// WebAssembly has one mode, the right one.
mspringi_fp_state mspringi_fp_enter(void) {
    return 0;
}

void mspringi_fp_leave(mspringi_fp_state before) {
    (void)before;
}

#else

// Set as much as the C library can; it cannot change modes that flush denormals.
mspringi_fp_state mspringi_fp_enter(void) {
    const int before = fegetround();
    fesetround(FE_TONEAREST);
    return (mspringi_fp_state)before;
}

void mspringi_fp_leave(mspringi_fp_state before) {
    fesetround((int)before);
}

#endif
