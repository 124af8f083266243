/// Particles and springs, a substep back: the loops in which a reverse spends its time.
///
/// Springs are taken octet by octet. Nothing is summed across lanes, so all instruction sets give the same bits.
#include "base/cpu.h"
#include "gradient/gradient.h"

/// Added to all squared lengths, m^2, so that springs of length 0 and lanes without a spring have a finite inverse.
/// It is too small to change other lengths.
#define MSPRINGI_GRADIENT_NO_LENGTH 1e-37

/// Doubles computed together: an octet if the compiler has vector types, because it does not vectorise short loops.
#if defined(__GNUC__)
typedef double octet_lanes __attribute__((vector_size(8 * sizeof(double)), aligned(8)));
#else
typedef double octet_lanes;
#endif
#define LANES_AT_ONCE (sizeof(octet_lanes) / sizeof(double))

/// The lanes at an address.
#define AT(address) (*(octet_lanes *)(void *)(address))
#define READ(address) (*(const octet_lanes *)(const void *)(address))

// Compute extents and inverse lengths. An inverse is computed in single precision and refined by one Newton step.
// It is right to 1e-14, in a third of the time of square root and division in double precision.
MSPRINGI_ALWAYS_INLINE void measure_octet(const mspringi_moment *at, uint32_t a, uint32_t b, octet_lanes *x,
                                          octet_lanes *y, octet_lanes *inverse) {
    const octet_lanes dx = READ(at->x + b) - READ(at->x + a), dy = READ(at->y + b) - READ(at->y + a);
    const octet_lanes square = dx * dx + dy * dy + MSPRINGI_GRADIENT_NO_LENGTH;
    double lanes[LANES_AT_ONCE];
    AT(lanes) = square;
    for (uint32_t i = 0; i < LANES_AT_ONCE; ++i)
        lanes[i] = (double)(1.0f / sqrtf((float)lanes[i]));
    const octet_lanes guess = READ(lanes);
    *x = dx;
    *y = dy;
    *inverse = guess * (1.5 - 0.5 * square * (guess * guess));
}

// Add the derivatives by the state and the parameters of the springs in some lanes. With d from a to b,
// q = U(a) - U(b) and f = k (1 - r / L) + c (dv . d) / L^2 they are:
//     by d    f q + (d . q) ((k r / L^3 - 2 c (dv . d) / L^4) d + c / L^2 dv)
//     by dv   (d . q) c / L^2 d
//     by k    (d . q) (1 - r / L)
//     by c    (d . q) (dv . d) / L^2
//     by r    -(d . q) k / L
// Those by d and dv are added at b and subtracted at a.
MSPRINGI_ALWAYS_INLINE void reverse_law(const mspringi_octets *o, const mspringi_adjoint *to,
                                        const mspringi_moment *at, uint32_t octet, uint32_t i, bool is_damped) {
    const uint32_t a = o->a[octet] + i, b = o->b[octet] + i;
    const size_t spring = (size_t)octet * MSPRINGI_OCTET + i;
    octet_lanes dx, dy, inverse;
    measure_octet(at, a, b, &dx, &dy, &inverse);
    const octet_lanes k = READ(o->stiffness + spring), r = READ(o->length + spring);
    const octet_lanes qx = READ(to->force.x + a) - READ(to->force.x + b);
    const octet_lanes qy = READ(to->force.y + a) - READ(to->force.y + b);
    const octet_lanes along = dx * qx + dy * qy, square = inverse * inverse;
    const octet_lanes strain = 1.0 - r * inverse, pull = along * (k * inverse);
    octet_lanes force = k * strain, turn = pull * r * square;
    AT(o->by_stiffness + spring) += along * strain;
    AT(o->by_length + spring) -= pull;
    if (is_damped) {
        const octet_lanes c = READ(o->damping + spring);
        const octet_lanes dvx = READ(at->vx + b) - READ(at->vx + a), dvy = READ(at->vy + b) - READ(at->vy + a);
        const octet_lanes rate = (dvx * dx + dvy * dy) * square, drag = along * (c * square);
        const octet_lanes vx = drag * dx, vy = drag * dy;
        force += c * rate;
        turn -= 2.0 * (drag * rate);
        const octet_lanes x = force * qx + turn * dx + drag * dvx, y = force * qy + turn * dy + drag * dvy;
        AT(o->by_damping + spring) += along * rate;
        AT(to->velocity.x + a) -= vx;
        AT(to->velocity.y + a) -= vy;
        AT(to->by_velocity.x + b) += vx;
        AT(to->by_velocity.y + b) += vy;
        AT(to->position.x + a) -= x;
        AT(to->position.y + a) -= y;
        AT(to->by_position.x + b) += x;
        AT(to->by_position.y + b) += y;
    } else {
        const octet_lanes x = force * qx + turn * dx, y = force * qy + turn * dy;
        AT(to->position.x + a) -= x;
        AT(to->position.y + a) -= y;
        AT(to->by_position.x + b) += x;
        AT(to->by_position.y + b) += y;
    }
}

MSPRINGI_ALWAYS_INLINE void law(const mspringi_octets *o, const mspringi_doubles *to, const mspringi_moment *at,
                                uint32_t octet, uint32_t i, bool is_damped) {
    const uint32_t a = o->a[octet] + i, b = o->b[octet] + i;
    const size_t spring = (size_t)octet * MSPRINGI_OCTET + i;
    octet_lanes dx, dy, inverse;
    measure_octet(at, a, b, &dx, &dy, &inverse);
    octet_lanes force = READ(o->stiffness + spring) * (1.0 - READ(o->length + spring) * inverse);
    if (is_damped) {
        const octet_lanes dvx = READ(at->vx + b) - READ(at->vx + a), dvy = READ(at->vy + b) - READ(at->vy + a);
        force += READ(o->damping + spring) * (dvx * dx + dvy * dy) * (inverse * inverse);
    }
    AT(to[0].x + a) += force * dx;
    AT(to[0].y + a) += force * dy;
    AT(to[1].x + b) -= force * dx;
    AT(to[1].y + b) -= force * dy;
}

MSPRINGI_ALWAYS_INLINE void visit_springs(const mspring_gradient *g, const mspringi_moment *at, bool is_damped,
                                          bool goes_back) {
    const mspringi_octets octets = g->octets, *o = &octets; // copies: no store can change their pointers
    const mspringi_adjoint adjoint = g->adjoint;
    const mspringi_moment moment = *at;
    const mspringi_doubles forces[2] = {g->spring_force[0], g->spring_force[1]};
    for (uint32_t octet = 0; octet < o->count; ++octet)
        for (uint32_t i = 0; i < MSPRINGI_OCTET; i += LANES_AT_ONCE) {
            if (goes_back)
                reverse_law(o, &adjoint, &moment, octet, i, is_damped);
            else
                law(o, forces, &moment, octet, i, is_damped);
        }
}

// Compute W and U from the derivatives by the state after a substep, and those by the state before it without the
// part of springs. They are 0 in slots without a particle. Pins keep their velocity.
MSPRINGI_ALWAYS_INLINE void push_back(const mspring_gradient *g, const mspringi_times *t) {
    const mspringi_adjoint *a = &g->adjoint;
    for (uint32_t i = 0; i < g->lanes; i += LANES_AT_ONCE) {
        const octet_lanes wx = READ(a->velocity.x + i) + t->h * READ(a->position.x + i);
        const octet_lanes wy = READ(a->velocity.y + i) + t->h * READ(a->position.y + i);
        const octet_lanes kick = t->kick * READ(a->inverse_mass + i), keep = 1.0 - t->loss * READ(a->is_free + i);
        AT(a->force.x + i) = kick * wx;
        AT(a->force.y + i) = kick * wy;
        AT(a->velocity.x + i) = keep * wx;
        AT(a->velocity.y + i) = keep * wy;
    }
}

MSPRINGI_ALWAYS_INLINE void gather_ends(double *sum, double *other, uint32_t count) {
    const octet_lanes zero = {0.0};
    for (uint32_t i = 0; i < count; i += LANES_AT_ONCE) {
        AT(sum + i) += READ(other + i);
        AT(other + i) = zero;
    }
}

MSPRINGI_ALWAYS_INLINE void undo_substep(const mspring_gradient *g, const mspringi_moment *at,
                                         const mspringi_times *t) {
    const mspringi_adjoint *a = &g->adjoint;
    push_back(g, t);
    if (g->octets.damping)
        visit_springs(g, at, true, true);
    else
        visit_springs(g, at, false, true);
    gather_ends(a->position.x, a->by_position.x, g->lanes);
    gather_ends(a->position.y, a->by_position.y, g->lanes);
    if (g->octets.damping) {
        gather_ends(a->velocity.x, a->by_velocity.x, g->lanes);
        gather_ends(a->velocity.y, a->by_velocity.y, g->lanes);
    }
}

#define KERNEL(level, target)                                                                                      \
    target static void undo_substep_##level(const mspring_gradient *g, const mspringi_moment *at,                  \
                                            const mspringi_times *t) {                                             \
        undo_substep(g, at, t);                                                                                    \
    }                                                                                                              \
    target static void pull_##level(const mspring_gradient *g, const mspringi_moment *at) {                        \
        if (g->octets.damping)                                                                                     \
            visit_springs(g, at, true, false);                                                                     \
        else                                                                                                       \
            visit_springs(g, at, false, false);                                                                    \
    }

KERNEL(plain, )
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__i386__)) && !defined(MSPRINGI_WITHOUT_AVX2)
KERNEL(avx2, __attribute__((target("avx2"))))
#define CALL_AVX2(name, ...)                                                                                       \
    if (g->level >= MSPRING_SIMD_AVX2)                                                                             \
        name##_avx2(__VA_ARGS__);                                                                                  \
    else
#else
#define CALL_AVX2(name, ...)
#endif
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__i386__)) && !defined(MSPRINGI_WITHOUT_AVX512)
KERNEL(avx512, __attribute__((target("avx512f"))))
#define CALL_AVX512(name, ...)                                                                                     \
    if (g->level == MSPRING_SIMD_AVX512)                                                                           \
        name##_avx512(__VA_ARGS__);                                                                                \
    else
#else
#define CALL_AVX512(name, ...)
#endif
#define CALL(name, ...) CALL_AVX512(name, __VA_ARGS__) CALL_AVX2(name, __VA_ARGS__) name##_plain(__VA_ARGS__);

void mspringi_gradient_go_back(mspring_gradient *g, const mspringi_moment *at, const mspringi_times *t) {
    CALL(undo_substep, g, at, t)
}

void mspringi_octets_forces(mspring_gradient *g, const mspringi_moment *at) {
    CALL(pull, g, at)
}
