/// Default settings to try.
#include "analysis/tune/tuning.h"

#include "store/network.h"

/// Safety factor on the stable substep of the present shape for the fewest substeps: motion stiffens a network.
#define SAFETY 0.9
#define MAX_SUBSTEPS 1000

/// Number of particles up to which a factorisation in each step may pay off.
#define MAX_DIRECT_PARTICLES 20000

typedef struct settings {
    mspring_settings list[MSPRINGI_TUNE_DEFAULT_SETTINGS];
    uint32_t count;
} settings;

static void add(settings *s, mspring_solver solver, mspring_integrator integrator, uint32_t substeps,
                float residual) {
    mspring_settings def;
    if (!mspringi_solver_ops_of(solver))
        return; // not in this build
    (void)mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def);
    def.solver = solver;
    def.integrator = integrator;
    def.substeps = substeps;
    def.residual = residual;
    s->list[s->count++] = def;
}

// Add explicit settings, in increasing order of substeps.
static void add_explicit(settings *s, uint32_t substeps) {
    if (substeps <= MAX_SUBSTEPS && (s->count == 0 || s->list[s->count - 1].substeps < substeps))
        add(s, MSPRING_SOLVER_EXPLICIT, MSPRING_INTEGRATOR_ALPHA, substeps, 0.0f);
}

static void list_settings(settings *s, const mspring_network *network, uint32_t least) {
    static const uint32_t usual[] = {10, 20, 30, 40, 60, 80};
    static const float residuals[] = {0.1f, 0.03f, 0.01f};
    for (size_t i = 0; network->fractions.values && i < sizeof usual / sizeof usual[0]; ++i)
        if (usual[i] >= least)
            add_explicit(s, usual[i]);
    if (s->count == 0) {
        add_explicit(s, least);
        add_explicit(s, least + (least + 1) / 2);
        add_explicit(s, 2 * least);
        add_explicit(s, 4 * least);
    }
    for (uint32_t substeps = 1; substeps <= 2; ++substeps) {
        for (size_t i = 0; i < sizeof residuals / sizeof residuals[0]; ++i) {
            add(s, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, substeps, residuals[i]);
            add(s, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA, substeps, residuals[i]);
        }
    }
    for (uint32_t substeps = 1; network->topology.particle_count <= MAX_DIRECT_PARTICLES && substeps <= 2;
         ++substeps) {
        add(s, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_BDF2, substeps, 0.0f);
        add(s, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA, substeps, 0.0f);
    }
}

mspring_result mspring_tune_settings(mspring_network *network, double dt, mspring_settings *list, uint32_t capacity,
                                     uint32_t *count) {
    settings s = {.count = 0};
    uint32_t least = MSPRING_MAX_SUBSTEPS;
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (!count || (capacity > 0 && !list))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "settings or count is NULL");
    result = mspring_network_suggest_substeps(network, dt, SAFETY, &least);
    if (result != MSPRING_OK && result != MSPRING_ERROR_UNSTABLE)
        return result;
    list_settings(&s, network, least);
    *count = s.count;
    if (capacity == 0)
        return MSPRING_OK;
    if (capacity < s.count)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "there is room for %u settings, but there are %u", (unsigned)capacity,
                             (unsigned)s.count);
    result = mspringi_check_output(&network->message, &mspringi_struct_settings, list);
    for (uint32_t i = 0; result == MSPRING_OK && i < s.count; ++i)
        mspringi_put_settings_at(list, i, &s.list[i]);
    return result;
}
