/// Lanczos iteration (Lanczos 1950; Parlett, The Symmetric Eigenvalue Problem, 1980, chapter 13): M^-1 S is
/// tridiagonal in the Krylov space of a vector, with the inner product of the masses, q . M r. Extreme eigenvalues
/// converge long before rounding destroys the orthogonality of the vectors. So there is no reorthogonalisation,
/// single precision is enough, and two vectors suffice. The eigenvector takes a second run over the same vectors.
#include "stability/lanczos.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "kernels/kernels.h"
#include "stability/tridiagonal.h"

/// Residual of a converged eigenvalue, relative to the eigenvalue.
#define TOLERANCE 2e-3

/// Fewest iterations before an eigenvalue below the bound decides.
#define MIN_ITERATIONS 12

/// Smallest next vector, relative to the eigenvalue: of a smaller one only rounding is left, and the space is
/// invariant.
#define CLOSED 1e-6

// Pseudo-random number from -1 to 1 for each n (the last steps of MurmurHash3, Appleby 2011).
static inline float noise(uint32_t n) {
    n = (n + 1) * 0x9e3779b9u;
    n = (n ^ n >> 16) * 0x85ebca6bu;
    n = (n ^ n >> 13) * 0xc2b2ae35u;
    return (float)(int32_t)(n ^ n >> 16) * 0x1p-31f;
}

void mspringi_lanczos_add_noise(const mspringi_lanczos *p, float amount) {
    const uint32_t slots = (uint32_t)p->slots;
    for (uint32_t slot = 0; slot < slots; ++slot) {
        const float root = amount * sqrtf(p->inverse_mass[slot]);
        p->here.x[slot] += root * noise(slot);
        p->here.y[slot] += root * noise(slot + slots);
    }
}

// a . M b, summed in an order that does not depend on the machine.
static double dot(const mspringi_lanczos *p, mspringi_displacement a, mspringi_displacement b) {
    double sums[MSPRINGI_WIDTH] = {0.0}, sum = 0.0;
    for (size_t slot = 0; slot < p->slots; slot += MSPRINGI_WIDTH) {
        const float *restrict inverse_mass = p->inverse_mass + slot;
        const float *ax = a.x + slot, *ay = a.y + slot, *bx = b.x + slot, *by = b.y + slot;
        for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
            // Pinned slots have a displacement of 0.
            const float mass = 1.0f / (inverse_mass[i] > FLT_MIN ? inverse_mass[i] : FLT_MIN);
            sums[i] += (double)(mass * (ax[i] * bx[i] + ay[i] * by[i]));
        }
    }
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        sum += sums[i];
    return sum;
}

// a += factor b
static void add(const mspringi_lanczos *p, mspringi_displacement a, float factor, mspringi_displacement b) {
    float *restrict ax = a.x, *restrict ay = a.y;
    const float *restrict bx = b.x, *restrict by = b.y;
    for (size_t slot = 0; slot < p->slots; ++slot) {
        ax[slot] += factor * bx[slot];
        ay[slot] += factor * by[slot];
    }
}

static void scale(const mspringi_lanczos *p, mspringi_displacement a, float factor) {
    for (size_t slot = 0; slot < p->slots; ++slot) {
        a.x[slot] *= factor;
        a.y[slot] *= factor;
    }
}

// Take the next vector for the present one, and of that only its part in the one to come.
static void advance(const mspringi_lanczos *p, mspringi_displacement *here, mspringi_displacement *next,
                    double off_diagonal) {
    scale(p, *next, (float)(1.0 / off_diagonal));
    scale(p, *here, (float)-off_diagonal);
    const mspringi_displacement swapped = *here;
    *here = *next;
    *next = swapped;
}

static void clear(const mspringi_lanczos *p, mspringi_displacement a) {
    memset(a.x, 0, p->slots * sizeof *a.x);
    memset(a.y, 0, p->slots * sizeof *a.y);
}

// Repeat the run from the start in `vector`, and sum up the eigenvector there.
static void sum_up(const mspringi_lanczos *p, const mspringi_tridiagonal *t, const double *weights) {
    mspringi_displacement here = p->here, next = p->next;
    clear(p, here);
    clear(p, next);
    add(p, here, 1.0f, p->vector);
    scale(p, p->vector, (float)weights[0]);
    for (int j = 0; j + 1 < t->size; ++j) {
        p->add_image(p->context, here, next);
        add(p, next, (float)-t->diagonal[j], here);
        advance(p, &here, &next, t->off_diagonal[j]);
        add(p, p->vector, (float)weights[j + 1], here);
    }
    // Not of length 1 yet if orthogonality was lost.
    scale(p, p->vector, (float)(1.0 / sqrt(dot(p, p->vector, p->vector))));
}

static bool has_ended(const mspringi_lanczos *p, int iterations, double off_diagonal, mspringi_ritz ritz) {
    const bool stays_below = iterations >= MIN_ITERATIONS && ritz.value + ritz.residual < p->bound;
    return (p->bound < INFINITY && (ritz.value > p->bound || stays_below)) ||
           (iterations >= p->least && ritz.residual <= TOLERANCE * ritz.value) || iterations == p->most ||
           !(off_diagonal > CLOSED * ritz.value);
}

mspringi_ritz mspringi_lanczos_largest(const mspringi_lanczos *p) {
    mspringi_tridiagonal t = {.size = 0};
    mspringi_displacement here = p->here, next = p->next;
    double weights[MSPRINGI_LANCZOS_MAX], off_diagonal = sqrt(dot(p, here, here));
    mspringi_ritz ritz = {0.0, 0.0};
    if (!(off_diagonal > 0.0 && off_diagonal < INFINITY))
        return ritz;
    scale(p, here, (float)(1.0 / off_diagonal));
    clear(p, next);
    if (p->vector.x) {
        clear(p, p->vector);
        add(p, p->vector, 1.0f, here);
    }
    for (double largest = 0.0;;) {
        const int j = t.size++;
        p->add_image(p->context, here, next);
        t.diagonal[j] = dot(p, here, next);
        add(p, next, (float)-t.diagonal[j], here);
        off_diagonal = t.off_diagonal[j] = sqrt(dot(p, next, next));
        largest = fmax(largest, t.diagonal[j]);
        if (t.size % p->period == 0 || t.size == p->most || !(off_diagonal > CLOSED * largest)) {
            ritz.value = mspringi_tridiagonal_top(&t, weights);
            ritz.residual = off_diagonal * fabs(weights[j]);
            if (has_ended(p, t.size, off_diagonal, ritz))
                break;
        }
        advance(p, &here, &next, off_diagonal);
    }
    if (p->vector.x)
        sum_up(p, &t, weights);
    return ritz;
}
