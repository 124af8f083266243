#include "stability/tridiagonal.h"

#include <math.h>
#include <stdbool.h>

// Pivots of x - T. All are positive if and only if x is above all eigenvalues.
static bool is_above(const mspringi_tridiagonal *t, double x, double *pivots) {
    double pivot = 1.0;
    for (int i = 0; i < t->size; ++i) {
        pivot = x - t->diagonal[i] - (i > 0 ? t->off_diagonal[i - 1] * t->off_diagonal[i - 1] / pivot : 0.0);
        if (!(pivot > 0.0))
            return false;
        pivots[i] = pivot;
    }
    return true;
}

double mspringi_tridiagonal_top(const mspringi_tridiagonal *t, double *vector) {
    double low = t->diagonal[0], high = t->diagonal[0], pivots[MSPRINGI_LANCZOS_MAX];
    for (int i = 0; i < t->size; ++i) {
        const double reach = (i > 0 ? t->off_diagonal[i - 1] : 0.0) + (i + 1 < t->size ? t->off_diagonal[i] : 0.0);
        low = fmax(low, t->diagonal[i]);
        high = fmax(high, t->diagonal[i] + reach);
    }
    high += 1e-15 * fabs(high); // strictly above
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
        vector[i] =
            above && t->off_diagonal[i - 1] > 0.0 ? pivots[i - 1] * vector[i - 1] / t->off_diagonal[i - 1] : 0.0;
        square += vector[i] * vector[i];
    }
    for (int i = 0; i < t->size; ++i)
        vector[i] /= sqrt(square);
    return high;
}
