/// The Lanczos iteration (Lanczos 1950; Parlett, The Symmetric Eigenvalue Problem, 1980, chapter 13): in the space
/// that a vector and its images span, S is tridiagonal. Extreme eigenvalues are found first, long before rounding
/// makes the vectors lose their orthogonality, so there is no reorthogonalisation, and three vectors are enough.
/// The eigenvector takes a second run, along the same vectors.
#include "lanczos.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/// Largest dimension of the space. The lattices and graphs of the tests take 20 to 120.
#define MOST 300

/// Iterations between two looks at the tridiagonal matrix.
#define LOOK 4

typedef struct tridiagonal {
    int size;
    double diagonal[MOST];
    double beside[MOST]; ///< beside[i] couples i and i + 1
} tridiagonal;

static double dot(const double *a, const double *b, size_t size) {
    double sum = 0.0;
    for (size_t i = 0; i < size; ++i)
        sum += a[i] * b[i];
    return sum;
}

// Pivots of x - T. All are positive just if x is above all eigenvalues.
static bool is_above(const tridiagonal *t, double x, double *pivots) {
    double pivot = 1.0;
    for (int i = 0; i < t->size; ++i) {
        pivot = x - t->diagonal[i] - (i > 0 ? t->beside[i - 1] * t->beside[i - 1] / pivot : 0.0);
        if (!(pivot > 0.0))
            return false;
        pivots[i] = pivot;
    }
    return true;
}

// The largest eigenvalue, from above, and its eigenvector.
static double top_of(const tridiagonal *t, double *vector) {
    double low = t->diagonal[0], high = t->diagonal[0], pivots[MOST];
    for (int i = 0; i < t->size; ++i) {
        const double reach = (i > 0 ? t->beside[i - 1] : 0.0) + (i + 1 < t->size ? t->beside[i] : 0.0);
        low = fmax(low, t->diagonal[i]);
        high = fmax(high, t->diagonal[i] + reach);
    }
    high += 1e-15 * fabs(high); // above, not at it
    for (int halving = 0; halving < 60 && high - low > 1e-15 * fabs(high); ++halving) {
        const double middle = 0.5 * (low + high);
        if (is_above(t, middle, pivots))
            high = middle;
        else
            low = middle;
    }
    vector[0] = 1.0;
    double square = 1.0;
    const bool above = is_above(t, high, pivots);
    for (int i = 1; i < t->size; ++i) {
        vector[i] = above && t->beside[i - 1] > 0.0 ? pivots[i - 1] * vector[i - 1] / t->beside[i - 1] : 0.0;
        square += vector[i] * vector[i];
    }
    for (int i = 0; i < t->size; ++i)
        vector[i] /= sqrt(square);
    return high;
}

// next = S here, less its parts along here and before. What the run before has found is what diagonal and beside
// say.
static void advance(const mspringi_lanczos *p, const double *before, const double *here, double *next,
                    double beside, const double *known_diagonal, double *diagonal) {
    p->apply(p->context, here, next);
    *diagonal = known_diagonal ? *known_diagonal : dot(here, next, p->size);
    for (size_t i = 0; i < p->size; ++i)
        next[i] -= *diagonal * here[i] + beside * before[i];
}

static void divide(double *vector, double by, size_t size) {
    for (size_t i = 0; i < size; ++i)
        vector[i] /= by;
}

// Run along the vectors that T was made of, and sum them up.
static void sum_up(const mspringi_lanczos *p, const tridiagonal *t, const double *weights) {
    double *before = p->work[0], *here = p->work[1], *next = p->work[2], diagonal;
    memcpy(here, p->vector, p->size * sizeof *here);
    for (size_t i = 0; i < p->size; ++i)
        p->vector[i] = weights[0] * here[i];
    for (int j = 0; j + 1 < t->size; ++j) {
        advance(p, before, here, next, j > 0 ? t->beside[j - 1] : 0.0, &t->diagonal[j], &diagonal);
        divide(next, t->beside[j], p->size);
        for (size_t i = 0; i < p->size; ++i)
            p->vector[i] += weights[j + 1] * next[i];
        double *const free_again = before;
        before = here;
        here = next;
        next = free_again;
    }
}

mspringi_ritz mspringi_lanczos_largest(const mspringi_lanczos *p, double tolerance) {
    tridiagonal t = {.size = 0};
    double weights[MOST];
    mspringi_ritz ritz = {0.0, 0.0};
    double *before = p->work[0], *here = p->work[1], *next = p->work[2];
    const double length = sqrt(dot(p->vector, p->vector, p->size));
    if (!(length > 0.0))
        return ritz;
    divide(p->vector, length, p->size);
    memset(before, 0, p->size * sizeof *before);
    memcpy(here, p->vector, p->size * sizeof *here);
    for (bool done = false; !done;) {
        const int j = t.size++;
        advance(p, before, here, next, j > 0 ? t.beside[j - 1] : 0.0, NULL, &t.diagonal[j]);
        t.beside[j] = sqrt(dot(next, next, p->size));
        // Nothing left but rounding: the space is closed under S.
        const bool closed = t.beside[j] <= 1e-13 * (fabs(t.diagonal[j]) + (j > 0 ? t.beside[j - 1] : 0.0));
        const bool full = closed || t.size == MOST;
        if (full || t.size % LOOK == 0) {
            ritz.value = top_of(&t, weights);
            ritz.residual = closed ? 0.0 : t.beside[j] * fabs(weights[j]);
            done = full || ritz.residual <= tolerance * ritz.value;
        }
        if (!done) {
            divide(next, t.beside[j], p->size);
            double *const free_again = before;
            before = here;
            here = next;
            next = free_again;
        }
    }
    sum_up(p, &t, weights);
    return ritz;
}
