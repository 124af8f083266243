/// The memory of a factor, and the way to the kernels of its level.
#include "solvers/sparse/cholesky.h"

#include <string.h>

#include "solvers/sparse/factor_kernels.h"
#include "solvers/sparse/symbolic.h"

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
    mspring_result mspringi_cholesky_##real##_reserve(mspringi_cholesky_##real *factor,                            \
                                                      const mspringi_cholesky_symbolic *plan, mspring_simd level,  \
                                                      mspringi_memory *memory, mspringi_message *message) {        \
        const size_t size = mspringi_pad(2 * (size_t)plan->size) + MSPRINGI_PAD;                                   \
        const size_t first = plan->update_reals[0] + MSPRINGI_PAD, second = plan->update_reals[1] + MSPRINGI_PAD;  \
        const size_t panels = plan->panel_reals + MSPRINGI_PAD;                                                    \
        const size_t others = 3 * size + plan->scaled_reals + plan->vector_reals;                                  \
        real *at = mspringi_alloc_unset(memory, panels + first + second + others, sizeof(real));                   \
        if (!at)                                                                                                   \
            return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a factor of %zu numbers",           \
                                 plan->panel_reals);                                                               \
        *factor = (mspringi_cholesky_##real){                                                                      \
            .plan = plan,                                                                                          \
            .kernels = mspringi_cholesky_kernels_of(level),                                                        \
            .panels = at,                                                                                          \
            .updates = {at + panels, at + panels + first},                                                         \
            .reciprocal = at + panels + first + second,                                                            \
            .rest = MSPRINGI_PAD + others,                                                                         \
        };                                                                                                         \
        factor->vector = factor->reciprocal + size;                                                                \
        factor->scaled = factor->vector + 2 * size;                                                                \
        factor->part = factor->scaled + plan->scaled_reals;                                                        \
        memset(factor->updates[0] - MSPRINGI_PAD, 0, MSPRINGI_PAD * sizeof(real));                                 \
        memset(factor->updates[1] - MSPRINGI_PAD, 0, MSPRINGI_PAD * sizeof(real));                                 \
        return MSPRING_OK;                                                                                         \
    }                                                                                                              \
                                                                                                                   \
    void mspringi_cholesky_##real##_clear(const mspringi_cholesky_##real *factor, size_t first, size_t count) {    \
        const size_t left = factor->rest > first ? factor->rest - first : 0;                                       \
        if (left > 0)                                                                                              \
            memset(factor->reciprocal - MSPRINGI_PAD + first, 0, (count < left ? count : left) * sizeof(real));    \
    }                                                                                                              \
                                                                                                                   \
    mspring_result mspringi_cholesky_##real##_create(mspringi_cholesky_##real *factor,                             \
                                                     const mspringi_cholesky_symbolic *plan, mspring_simd level,   \
                                                     mspringi_memory *memory, mspringi_message *message) {         \
        const mspring_result result = mspringi_cholesky_##real##_reserve(factor, plan, level, memory, message);    \
        if (result == MSPRING_OK)                                                                                  \
            mspringi_cholesky_##real##_clear(factor, 0, factor->rest);                                             \
        return result;                                                                                             \
    }                                                                                                              \
                                                                                                                   \
    static const mspringi_array_entry columns_##real[] = {                                                         \
        MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_##real, plan, MSPRINGI_VIEW),                                       \
        MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_##real, panels, MSPRINGI_ARRAY),                                    \
        MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_##real, reciprocal, MSPRINGI_VIEW),                                 \
        MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_##real, updates[0], MSPRINGI_VIEW),                                 \
        MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_##real, updates[1], MSPRINGI_VIEW),                                 \
        MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_##real, scaled, MSPRINGI_VIEW),                                     \
        MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_##real, vector, MSPRINGI_VIEW),                                     \
        MSPRINGI_ARRAY_ENTRY(mspringi_cholesky_##real, part, MSPRINGI_VIEW),                                       \
    };                                                                                                             \
    const mspringi_array_table mspringi_cholesky_##real##_columns = MSPRINGI_ARRAY_TABLE(columns_##real);          \
                                                                                                                   \
    void mspringi_cholesky_##real##_destroy(mspringi_cholesky_##real *factor, mspringi_memory *memory) {           \
        mspringi_array_table_free(mspringi_cholesky_##real##_columns, factor, memory);                             \
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
