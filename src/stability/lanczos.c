/// Lanczos iteration (Lanczos 1950; Parlett, The Symmetric Eigenvalue Problem, 1980, chapter 13): S is tridiagonal
/// in the Krylov space of a vector. Extreme eigenvalues converge long before rounding destroys the orthogonality of
/// the vectors. So there is no reorthogonalisation, and three vectors suffice. The eigenvector takes a second run
/// over the same vectors.
#include "stability/lanczos.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "stability/tridiagonal.h"

/// Iterations between two solutions of the tridiagonal matrix.
#define CHECK_PERIOD 4

/// Fewest iterations: a start near an eigenvector hides larger eigenvalues for a while.
#define MIN_ITERATIONS 16

static double dot(const double *a, const double *b, size_t size) {
    double sum = 0.0;
    for (size_t i = 0; i < size; ++i)
        sum += a[i] * b[i];
    return sum;
}

// next = S here, minus its parts along here and before. known_diagonal, from the first run, saves a dot product.
static void advance(const mspringi_lanczos *p, const double *before, const double *here, double *next,
                    double off_diagonal, const double *known_diagonal, double *diagonal) {
    p->apply(p->context, here, next);
    *diagonal = known_diagonal ? *known_diagonal : dot(here, next, p->size);
    for (size_t i = 0; i < p->size; ++i)
        next[i] -= *diagonal * here[i] + off_diagonal * before[i];
}

static void divide(double *vector, double by, size_t size) {
    for (size_t i = 0; i < size; ++i)
        vector[i] /= by;
}

// Repeat the run and sum up the eigenvector.
static void sum_up(const mspringi_lanczos *p, const mspringi_tridiagonal *t, const double *weights) {
    double *before = p->work[0], *here = p->work[1], *next = p->work[2], diagonal;
    memcpy(here, p->vector, p->size * sizeof *here);
    for (size_t i = 0; i < p->size; ++i)
        p->vector[i] = weights[0] * here[i];
    for (int j = 0; j + 1 < t->size; ++j) {
        advance(p, before, here, next, j > 0 ? t->off_diagonal[j - 1] : 0.0, &t->diagonal[j], &diagonal);
        divide(next, t->off_diagonal[j], p->size);
        for (size_t i = 0; i < p->size; ++i)
            p->vector[i] += weights[j + 1] * next[i];
        double *const oldest = before;
        before = here;
        here = next;
        next = oldest;
    }
    // Not of length 1 yet if orthogonality was lost.
    divide(p->vector, sqrt(dot(p->vector, p->vector, p->size)), p->size);
}

mspringi_ritz mspringi_lanczos_largest(const mspringi_lanczos *p, double tolerance) {
    mspringi_tridiagonal t = {.size = 0};
    double weights[MSPRINGI_LANCZOS_MAX];
    mspringi_ritz ritz = {0.0, 0.0};
    double scale = 0.0;
    double *before = p->work[0], *here = p->work[1], *next = p->work[2];
    const double length = sqrt(dot(p->vector, p->vector, p->size));
    if (!(length > 0.0))
        return ritz;
    divide(p->vector, length, p->size);
    memset(before, 0, p->size * sizeof *before);
    memcpy(here, p->vector, p->size * sizeof *here);
    for (bool done = false; !done;) {
        const int j = t.size++;
        advance(p, before, here, next, j > 0 ? t.off_diagonal[j - 1] : 0.0, NULL, &t.diagonal[j]);
        t.off_diagonal[j] = sqrt(dot(next, next, p->size));
        // Only rounding is left: the space is invariant under S.
        scale = fmax(scale, fmax(fabs(t.diagonal[j]), t.off_diagonal[j]));
        const bool closed = t.off_diagonal[j] <= 1e-12 * scale;
        const bool full = closed || t.size == MSPRINGI_LANCZOS_MAX;
        if (full || t.size % CHECK_PERIOD == 0) {
            ritz.value = mspringi_tridiagonal_top(&t, weights);
            ritz.residual = closed ? 0.0 : t.off_diagonal[j] * fabs(weights[j]);
            done = full || (t.size >= MIN_ITERATIONS && ritz.residual <= tolerance * ritz.value);
        }
        if (!done) {
            divide(next, t.off_diagonal[j], p->size);
            double *const oldest = before;
            before = here;
            here = next;
            next = oldest;
        }
    }
    sum_up(p, &t, weights);
    return ritz;
}

double mspringi_noise(size_t n) {
    uint64_t bits = ((uint64_t)n + 1) * UINT64_C(0x9e3779b97f4a7c15); // mixer of SplitMix64 (Steele et al. 2014)
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)(bits >> 11) * 0x1p-52 - 1.0;
}
