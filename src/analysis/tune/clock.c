#if !defined(_WIN32) && !defined(_POSIX_C_SOURCE)
#define _POSIX_C_SOURCE 200809L
#endif
#include "analysis/tune/clock.h"

#include <stddef.h>

#if defined(MSPRINGI_FREESTANDING)
#elif defined(_WIN32)

#define HAVE_CLOCK
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

static double read_clock(void *user) {
    LARGE_INTEGER now, per_second;
    (void)user;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&per_second);
    return (double)now.QuadPart / (double)per_second.QuadPart;
}

#else

#include <time.h>

#if defined(CLOCK_MONOTONIC)
#define HAVE_CLOCK

static double read_clock(void *user) {
    struct timespec now = {0};
    (void)user;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
#endif

double (*mspringi_clock(void))(void *user) {
#if defined(HAVE_CLOCK)
    return read_clock;
#else
    return NULL;
#endif
}
