#include "tasks/progress.h"

#include "base/target.h"

#if defined(MSPRINGI_THREADS)

#if defined(MSPRINGI_X86)
#include <immintrin.h>
#endif

/// Bounds on polls before sleeping: 200 and 3 us on a Zen 4. The upper one exceeds the serial parts of an implicit
/// step, since waking up costs as much again. (544 x 68 with two workers: 1.4 times as fast as one worker with half
/// of it, 0.95 with an eighth. A ship of 158,000 springs: one substep in seven sleeps instead of each.)
#define MAX_SPINS 8000
#define MIN_SPINS 100

/// After this many sleeps, a wait again polls up to the upper bound. The other thread may have its own core by now.
/// Or its serial part may take less than that, but more than the present polls.
#define SLEEPS_BEFORE_TRIAL 16

// Tell the processor that this loop waits.
static inline void pause_thread(void) {
#if defined(MSPRINGI_X86)
    _mm_pause();
#elif defined(__aarch64__) && defined(__GNUC__)
    __asm__ volatile("isb" : : : "memory"); // yield returns immediately
#endif
}

static void set_spins(mspringi_progress *progress, uint32_t spins) {
    atomic_store_explicit(&progress->spins, spins, memory_order_relaxed);
}

static inline bool is_reached(uint32_t value, uint32_t target) {
    return value - target < UINT32_C(1) << 31;
}

bool mspringi_progress_init(mspringi_progress *progress) {
    atomic_init(&progress->value, 0);
    atomic_init(&progress->sleepers, 0);
    atomic_init(&progress->spins, MAX_SPINS);
    progress->sleeps = 0;
    if (!mspringi_mutex_init(&progress->mutex))
        return false;
    if (mspringi_condition_init(&progress->condition))
        return true;
    mspringi_mutex_destroy(&progress->mutex);
    return false;
}

void mspringi_progress_destroy(mspringi_progress *progress) {
    mspringi_condition_destroy(&progress->condition);
    mspringi_mutex_destroy(&progress->mutex);
}

void mspringi_progress_reset(mspringi_progress *progress, uint32_t value) {
    atomic_store_explicit(&progress->value, value, memory_order_relaxed);
}

uint32_t mspringi_progress_sleeps(const mspringi_progress *progress) {
    return progress->sleeps;
}

// Both threads write one of value and sleepers, then read the other. With sequential consistency, at least one of
// them sees the other's write (Dekker).
void mspringi_progress_advance(mspringi_progress *progress, uint32_t value) {
    atomic_store(&progress->value, value);
    if (atomic_load(&progress->sleepers) == 0)
        return;
    // A thread that sleeps held the mutex from its last check until it slept.
    mspringi_mutex_lock(&progress->mutex);
    mspringi_mutex_unlock(&progress->mutex);
    mspringi_condition_wake_all(&progress->condition);
}

// Sleep after `spins` polls in vain; return the counter.
static uint32_t sleep_until(mspringi_progress *progress, uint32_t target, uint32_t spins) {
    uint32_t value;
    mspringi_mutex_lock(&progress->mutex);
    spins = ++progress->sleeps % SLEEPS_BEFORE_TRIAL == 0 ? MAX_SPINS : spins / 2;
    set_spins(progress, spins > MIN_SPINS ? spins : MIN_SPINS);
    atomic_fetch_add(&progress->sleepers, 1);
    while (!is_reached(value = atomic_load(&progress->value), target))
        mspringi_condition_wait(&progress->condition, &progress->mutex);
    atomic_fetch_sub(&progress->sleepers, 1);
    mspringi_mutex_unlock(&progress->mutex);
    return value;
}

uint32_t mspringi_progress_wait(mspringi_progress *progress, uint32_t target) {
    const uint32_t spins = atomic_load_explicit(&progress->spins, memory_order_relaxed);
    for (uint32_t poll = 0; poll < spins; ++poll) {
        const uint32_t value = atomic_load_explicit(&progress->value, memory_order_acquire);
        if (is_reached(value, target)) {
            // The other thread advanced while this one ran, so each has a core.
            if (poll > 0 && spins < MAX_SPINS)
                set_spins(progress, 2 * spins < MAX_SPINS ? 2 * spins : MAX_SPINS);
            return value;
        }
        pause_thread();
    }
    return sleep_until(progress, target, spins);
}

#else

// A single thread runs everything in order, so each value is reached before anybody waits for it.

bool mspringi_progress_init(mspringi_progress *progress) {
    progress->value = 0;
    return true;
}

void mspringi_progress_destroy(mspringi_progress *progress) {
    (void)progress;
}

void mspringi_progress_reset(mspringi_progress *progress, uint32_t value) {
    progress->value = value;
}

uint32_t mspringi_progress_sleeps(const mspringi_progress *progress) {
    (void)progress;
    return 0;
}

void mspringi_progress_advance(mspringi_progress *progress, uint32_t value) {
    progress->value = value;
}

uint32_t mspringi_progress_wait(mspringi_progress *progress, uint32_t target) {
    (void)target;
    return progress->value;
}

#endif
