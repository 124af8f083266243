/// Materials: their checks, and presets that resemble real ones.
///
/// A square lattice of springs of stiffness k, diagonals included, has Young's modulus times thickness 3 k / 2
/// along its rows. With k = s m / (2 h^2) and m / spacing^2 = density times thickness, the squared speed of sound
/// is (3 s / 4) (spacing / h)^2. A relative lattice of equal masses is stable in any shape if 2 s + 4 d is at most
/// 1. Its relative damping d is 2 zeta sqrt(s) for the damping ratio zeta.
#include "builder/builder.h"

mspring_result mspringi_take_good_material(mspringi_message *message, const char *what, size_t index,
                                           const mspring_material *materials, mspring_material *material) {
    mspring_result result = mspringi_take_material_at(message, materials, index, material);
    result = mspringi_prefix(message, result, what, index);
    if (result == MSPRING_OK)
        result = mspringi_check_mass(message, what, index, material->mass);
    if (result == MSPRING_OK)
        result = mspringi_check_coefficients(message, what, index, material->stiffness, material->damping,
                                             material->spring_flags);
    if (result == MSPRING_OK)
        result = mspringi_check_limits(message, what, index, MSPRINGI_LIMITS_OF(material));
    if (result == MSPRING_OK && material->particle_flags & ~(uint32_t)MSPRING_PARTICLE_PINNED)
        result = mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: unknown particle flags 0x%x", what, index,
                               (unsigned)material->particle_flags);
    return result;
}

mspring_result mspringi_take_own_material(mspringi_message *message, const char *shape,
                                          const mspring_material *from, mspring_material *material) {
    static const char name[] = "material 0"; // a shape has one, so its number would mislead
    if (!from)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s: its material is NULL", shape);
    const mspring_result result = mspringi_take_good_material(message, "material", 0, from, material);
    if (result == MSPRING_OK)
        return result;
    const mspringi_message reason = *message;
    return mspringi_fail(message, result, "material of the %s%s", shape, reason.text + sizeof name - 1);
}

typedef struct preset {
    double density;       // kg/m^3
    double sound;         // m/s
    double largest_share; // relative stiffness
    double damping_ratio;
} preset;

// Densities and speeds of structural steel, pine along the grain, soft rubber and gelatine. If substeps are too
// long for all materials, the largest shares keep their order.
static const preset presets[] = {
    [MSPRING_PRESET_STEEL] = {7850.0, 5000.0, 0.4, 0.01},
    [MSPRING_PRESET_WOOD] = {600.0, 4000.0, 0.2, 0.03},
    [MSPRING_PRESET_RUBBER] = {1100.0, 40.0, 0.05, 0.1},
    [MSPRING_PRESET_JELLY] = {1000.0, 4.0, 0.01, 0.1},
};

mspring_result mspring_material_preset(mspring_material *material, mspring_preset preset_number, double spacing,
                                       double substep) {
    const int32_t count = (int32_t)(sizeof presets / sizeof *presets);
    if (!material || preset_number < 0 || preset_number >= count || !(spacing >= 1e-9 && spacing <= 1e9) ||
        !(substep >= 1e-12 && substep <= 1e6))
        return MSPRING_ERROR_ARGUMENT;
    mspring_material filled;
    (void)mspring_init(MSPRING_STRUCT_MATERIAL, &filled, sizeof filled);
    const preset *of = &presets[preset_number];
    const double cells = of->sound * substep / spacing;
    const double share = 4.0 / 3.0 * cells * cells;
    filled.mass = (float)(of->density * spacing * spacing);
    filled.stiffness = (float)(share < of->largest_share ? share : of->largest_share);
    filled.damping = (float)of->damping_ratio;
    filled.spring_flags = MSPRING_SPRING_RELATIVE | MSPRING_SPRING_DAMPING_RATIO;
    const mspring_result result = mspringi_check_output(NULL, &mspringi_struct_material, material);
    if (result == MSPRING_OK)
        mspringi_put_material(material, &filled);
    return result;
}
