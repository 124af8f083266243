/// @file massspring_laws.h
/// Material laws beyond the linear spring: springs that yield, so that what bends stays bent.
///
///     plasticity  network_get_plasticity
///
/// These calls are not frozen yet: a later minor version may change them. massspring.h explains the notation.
///
/// **Springs that yield.** Give a spring, or a material, a yield_strain. A spring that is strained by more gets another
/// rest length, and keeps it. With r its rest length, r0 that before it ever yielded, L its length:
///
///     plastic strain  p = r / r0 - 1
///     it yields while |(L - r) / r0 - hardening * p| > yield_strain, and |p| is below plastic_limit
///
/// The properties, for mspring_network_set() and _get():
///
///     MSPRING_YIELD_STRAIN    > 0; default MSPRING_NEVER
///     MSPRING_HARDENING       0 to 10; default MSPRING_HARDENING_DEFAULT. Stiffness past the yield strain is
///                             hardening / (1 + hardening) of that before it. It is kinematic (Prager): what was
///                             stretched yields sooner when it is pressed.
///     MSPRING_PLASTIC_LIMIT   0 to 0.9; default MSPRING_PLASTIC_LIMIT_DEFAULT. Beyond it a spring is elastic again.
///     MSPRING_PLASTIC_STRAIN  p, -0.9 to 0.9. Set 0 to straighten a spring, or another value to dent it. Writing it
///                             ends a ramp. Frames (MSPRING_SNAPSHOT_FRAME) hold it: it is no edit to them.
///
/// To set any of them allocates, the first time. A spring that was broken and is restored keeps its plastic strain. If
/// you write MSPRING_REST_LENGTH, the plastic strain stays: r0 changes by the same factor. A spring breaks by its total
/// strain, (L - r0) / r0, but is stressed and relaxes by the strain in force. A weld never yields, nor does a spring on
/// a ramp.
///
/// Springs yield in each substep of any solver. Where the explicit solver is used, a blow leaves the same dent whatever
/// the number of substeps. Implicit and direct substeps damp a blow before it can dent: they follow slow loads, and
/// blows that last 16 substeps or more. mspring_network_settle() gives MSPRING_ERROR_EQUILIBRIUM where
/// a spring would yield on the way to rest. mspring_network_tune() compares as if they did not, unless a scene has
/// MSPRING_TUNE_SCENE_BREAKING. The guide examples/guides/materials.md has examples.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_LAWS_H
#define MASSSPRING_MASSSPRING_LAWS_H

#include "massspring.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Hardening and plastic limit of springs for which none was given.
#define MSPRING_HARDENING_DEFAULT 0.1f
#define MSPRING_PLASTIC_LIMIT_DEFAULT 0.5f

/// Report of what has yielded so far. Set struct_size first.
typedef struct mspring_plasticity {
    uint32_t struct_size;
    uint32_t bent_springs; ///< springs whose plastic strain is not 0 now
    uint64_t yield_count;  ///< springs that yielded in a step, summed over all steps
    double dissipated;     ///< energy that yielding has turned into heat, J; it never falls
} mspring_plasticity;

/// Read the report of what has yielded. Takes a pass over all springs.
/// Snapshots and clones have it.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_plasticity(
    const mspring_network *network, mspring_plasticity *report);

#ifdef __cplusplus
}
#endif

#endif
