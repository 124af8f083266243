/// The memory of a factor, and the way to the kernels of its level.
#include "solvers/sparse/cholesky.h"

#include "solvers/sparse/kernels.h"
#include "solvers/sparse/plan.h"

static const mspringi_cholesky_kernels *const levels[] = {
#define LEVEL(name, number) &mspringi_cholesky_##name,
#include "base/levels.def"
#undef LEVEL
};

// The lowest level is that of all that is not built in.
const mspringi_cholesky_kernels *mspringi_cholesky_kernels_of(mspring_simd level) {
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; ++i)
        if (levels[i]->level == level)
            return levels[i];
    return levels[0];
}

// NOLINTBEGIN(bugprone-macro-parentheses): of a type
#define MSPRINGI_CHOLESKY_DEFINE(real)                                                                             \
    mspring_result mspringi_cholesky_##real##_create(mspringi_cholesky_##real *factor,                             \
                                                     const mspringi_cholesky_plan *plan, mspring_simd level,       \
                                                     mspringi_memory *memory, mspringi_message *message) {         \
        const size_t size = mspringi_pad(2 * (size_t)plan->size) + MSPRINGI_PAD;                                   \
        *factor = (mspringi_cholesky_##real){                                                                      \
            .plan = plan,                                                                                          \
            .kernels = mspringi_cholesky_kernels_of(level),                                                        \
            .panels = mspringi_alloc(memory, plan->panel_reals + MSPRINGI_PAD, sizeof(real)),                      \
            .reciprocal = mspringi_alloc(memory, size, sizeof(real)),                                              \
            .updates = {mspringi_alloc(memory, plan->update_reals[0] + MSPRINGI_PAD, sizeof(real)),                \
                        mspringi_alloc(memory, plan->update_reals[1] + MSPRINGI_PAD, sizeof(real))},               \
            .scaled = mspringi_alloc(memory, plan->scaled_reals, sizeof(real)),                                    \
            .vector = mspringi_alloc(memory, 2 * size, sizeof(real)),                                              \
            .part = mspringi_alloc(memory, plan->vector_reals, sizeof(real)),                                      \
        };                                                                                                         \
        if (factor->panels && factor->reciprocal && factor->updates[0] && factor->updates[1] && factor->scaled &&  \
            factor->vector && factor->part)                                                                        \
            return MSPRING_OK;                                                                                     \
        mspringi_cholesky_##real##_destroy(factor, memory);                                                        \
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a factor of %zu numbers",               \
                             plan->panel_reals);                                                                   \
    }                                                                                                              \
                                                                                                                   \
    static const mspringi_column columns_##real[] = {                                                              \
        MSPRINGI_COLUMN(mspringi_cholesky_##real, plan, MSPRINGI_VIEW),                                            \
        MSPRINGI_COLUMN(mspringi_cholesky_##real, panels, MSPRINGI_ARRAY),                                         \
        MSPRINGI_COLUMN(mspringi_cholesky_##real, reciprocal, MSPRINGI_ARRAY),                                     \
        MSPRINGI_COLUMN(mspringi_cholesky_##real, updates[0], MSPRINGI_ARRAY),                                     \
        MSPRINGI_COLUMN(mspringi_cholesky_##real, updates[1], MSPRINGI_ARRAY),                                     \
        MSPRINGI_COLUMN(mspringi_cholesky_##real, scaled, MSPRINGI_ARRAY),                                         \
        MSPRINGI_COLUMN(mspringi_cholesky_##real, vector, MSPRINGI_ARRAY),                                         \
        MSPRINGI_COLUMN(mspringi_cholesky_##real, part, MSPRINGI_ARRAY),                                           \
    };                                                                                                             \
    const mspringi_columns mspringi_cholesky_##real##_columns = MSPRINGI_COLUMNS(columns_##real);                  \
                                                                                                                   \
    void mspringi_cholesky_##real##_destroy(mspringi_cholesky_##real *factor, mspringi_memory *memory) {           \
        mspringi_columns_free(mspringi_cholesky_##real##_columns, factor, memory);                                 \
        *factor = (mspringi_cholesky_##real){0};                                                                   \
    }                                                                                                              \
                                                                                                                   \
    uint32_t mspringi_cholesky_##real##_factor(mspringi_cholesky_##real *factor,                                   \
                                               const mspringi_cholesky_matrix_##real *matrix) {                    \
        return factor->kernels->factor_##real(factor, matrix);                                                     \
    }                                                                                                              \
                                                                                                                   \
    void mspringi_cholesky_##real##_solve(mspringi_cholesky_##real *factor, real *x, real *y) {                    \
        factor->kernels->solve_##real(factor, x, y);                                                               \
    }                                                                                                              \
                                                                                                                   \
    uint32_t mspringi_cholesky_##real##_factor_solve(                                                              \
        mspringi_cholesky_##real *factor, const mspringi_cholesky_matrix_##real *matrix, real *x, real *y) {       \
        return factor->kernels->factor_solve_##real(factor, matrix, x, y);                                         \
    }
// NOLINTEND(bugprone-macro-parentheses)

MSPRINGI_CHOLESKY_DEFINE(float)
MSPRINGI_CHOLESKY_DEFINE(double)
