/// Stability limit in the present shape, on request of the host.
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "stability/lanczos.h"
#include "stability/pencil.h"
#include "stability/stability.h"
#include "stability/stability_elements.h"
#include "stability/tridiagonal.h"

/// Relative change of the limit at convergence.
#define LIMIT_TOLERANCE 5e-4

/// Fewest iterations: a start near an eigenvector hides larger eigenvalues for a while.
#define MIN_ITERATIONS 16

typedef struct workspace {
    mspringi_pencil pencil;
    float *arrays; ///< [6 slots] three displacements
} workspace;

static void release(mspring_network *network, workspace *work) {
    mspringi_free(&network->memory, work->pencil.terms);
    mspringi_free(&network->memory, work->arrays);
}

static mspring_result reserve(mspring_network *network, workspace *work) {
    const size_t slots = mspringi_slot_count(network), springs = network->topology.spring_count;
    *work = (workspace){.pencil.network = network};
    work->pencil.terms = mspringi_alloc(&network->memory, springs, sizeof *work->pencil.terms);
    work->arrays = mspringi_alloc(&network->memory, 6 * slots, sizeof *work->arrays);
    if (work->pencil.terms && work->arrays)
        return MSPRING_OK;
    release(network, work);
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to find the stable dt of %u particles",
                         (unsigned)network->topology.particle_count);
}

static mspringi_displacement displacement_at(const workspace *work, size_t which) {
    const size_t slots = mspringi_slot_count(work->pencil.network);
    return (mspringi_displacement){work->arrays + 2 * which * slots, work->arrays + (2 * which + 1) * slots};
}

// Any vector gives an upper bound of the limit; the eigenvector at the limit gives the limit itself. So iterate:
// eigenvector at the last bound, then its bound. The bounds fall so fast that few iterations suffice.
static double find_limit(const mspring_network *network, workspace *work, double start) {
    const size_t slots = mspringi_slot_count(network);
    const mspringi_lanczos lanczos = {.slots = slots,
                                      .inverse_mass = network->inverse_mass,
                                      .add_image = mspringi_pencil_add_image,
                                      .context = &work->pencil,
                                      .here = displacement_at(work, 0),
                                      .next = displacement_at(work, 1),
                                      .vector = displacement_at(work, 2),
                                      .bound = INFINITY,
                                      .least = MIN_ITERATIONS,
                                      .most = MSPRINGI_LANCZOS_MAX,
                                      .period = 4};
    double limit = start;
    memset(lanczos.here.x, 0, 2 * slots * sizeof *lanczos.here.x);
    mspringi_lanczos_add_noise(&lanczos, 1.0f);
    for (int turn = 0; turn < 12; ++turn) {
        mspringi_pencil_set(&work->pencil, limit);
        const mspringi_ritz ritz = mspringi_lanczos_largest(&lanczos);
        if (!(ritz.value > 0.0))
            return INFINITY;
        mspringi_quotient quotient = mspringi_pencil_quotient(&work->pencil, lanczos.vector);
        const double margin = 1.0 + ritz.residual / ritz.value;
        quotient.stiffness *= margin;
        quotient.damping *= margin;
        quotient.relative *= margin;
        const double before = limit;
        limit = mspringi_quotient_limit(&quotient, network->settings.global_damping);
        // Without dampers and relative springs the eigenvector is the same at every h.
        if ((quotient.damping == 0.0 && quotient.relative == 0.0) || !(limit > 0.0 && limit < INFINITY) ||
            fabs(limit - before) <= LIMIT_TOLERANCE * limit)
            break;
        memcpy(lanczos.here.x, lanczos.vector.x, 2 * slots * sizeof *lanczos.here.x);
        mspringi_lanczos_add_noise(&lanczos, (float)(1.0 / sqrt(2.0 * (double)slots)));
    }
    return limit;
}

static MSPRINGI_NOINLINE mspring_result find_now(mspring_network *network, double *now) {
    mspring_id spring;
    workspace work;
    mspring_result result = reserve(network, &work);
    if (result != MSPRING_OK)
        return result;
    const double any_shape = mspringi_stable_in_any_shape(network, &spring);
    *now = any_shape < INFINITY ? find_limit(network, &work, any_shape) : INFINITY;
    if (!mspringi_elements_exist(network)) // the stiffness of areas grows with the network
        *now = fmax(*now, any_shape);
    release(network, &work);
    return MSPRING_OK;
}

mspring_result mspring_network_get_stable_dt(mspring_network *network, double *now, double *any_shape) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspringi_any_shape known = network->any_shape; // a question leaves the guard as it is
    if (now)
        result = find_now(network, now);
    mspring_id spring;
    if (result == MSPRING_OK && any_shape)
        *any_shape = mspringi_stable_in_any_shape(network, &spring);
    network->any_shape = known;
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_suggest_substeps(mspring_network *network, double dt, double safety,
                                                uint32_t *substeps) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (!(dt > 0.0 && dt < INFINITY) || !(safety > 0.0 && safety <= 1.0) || !substeps)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "dt is %g s, safety %g: dt must be finite and > 0, safety > 0 and at most 1, and "
                             "substeps not NULL",
                             dt, safety);
    double now;
    result = mspring_network_get_stable_dt(network, &now, NULL);
    if (result != MSPRING_OK)
        return result;
    const uint32_t count = mspringi_substeps_within(dt, safety * now, MSPRING_MAX_SUBSTEPS);
    if (count > MSPRING_MAX_SUBSTEPS)
        return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                             "%g s in substeps of at most %g s are more than %u substeps", dt, safety * now,
                             (unsigned)MSPRING_MAX_SUBSTEPS);
    *substeps = count;
    return MSPRING_OK;
}
