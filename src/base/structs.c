/// Structs of hosts that are shorter or longer than today's.
#include "base/structs.h"

/* ------------------------------------------------------------------------------------------------------ sizes */

// A struct holds numbers of 4 and 8 bytes, so every version of it is a multiple of 4.
static bool is_possible(const mspringi_struct *of, size_t size) {
    return size >= of->first && size % sizeof(uint32_t) == 0 && size <= MSPRINGI_LARGEST_STRUCT;
}

static size_t size_of(const void *given) {
    uint32_t size;
    memcpy(&size, given, sizeof size);
    return size;
}

// Bytes of a struct of this size that this library knows.
static size_t shared_with(const mspringi_struct *of, size_t size) {
    return size < of->known ? size : of->known;
}

static mspring_result refuse_null(mspringi_message *message, const mspringi_struct *of) {
    return !message ? MSPRING_ERROR_ARGUMENT
                    : mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the pointer to %s is NULL", of->name);
}

static mspring_result check_size(mspringi_message *message, const mspringi_struct *of, size_t size) {
    if (is_possible(of, size))
        return MSPRING_OK;
    return !message
               ? MSPRING_ERROR_STRUCT
               : mspringi_fail(message, MSPRING_ERROR_STRUCT,
                               "%s.struct_size is %zu, it must be a multiple of 4 from %u to %u; this library's "
                               "is %u: fill the struct with mspring_init() or its inline form first",
                               of->name, size, (unsigned)of->first, MSPRINGI_LARGEST_STRUCT, (unsigned)of->known);
}

static const void *element(const void *array, size_t index) {
    return (const char *)array + size_of(array) * index;
}

// Elements of an array lie as far apart as the first is large: another size is a mistake.
static mspring_result check_alike(mspringi_message *message, const mspringi_struct *of, const void *array,
                                  size_t index) {
    const size_t size = size_of(element(array, index)), of_first = size_of(array);
    if (size == of_first)
        return MSPRING_OK;
    return !message ? MSPRING_ERROR_STRUCT
                    : mspringi_fail(message, MSPRING_ERROR_STRUCT,
                                    "%s.struct_size is %zu, but that of the first in the array is %zu", of->name,
                                    size, of_first);
}

/* ----------------------------------------------------------------------------------------------------- inputs */

// The struct_size of the settings that a struct of this size ends with.
static void put_nested_size(const mspringi_struct *of, void *made, size_t size) {
    const uint32_t nested = (uint32_t)size - of->settings;
    if (of->settings > 0)
        memcpy((char *)made + of->settings, &nested, sizeof nested);
}

static mspring_result check_nested_size(mspringi_message *message, const mspringi_struct *of, const void *given) {
    const size_t wanted = of->settings > 0 ? size_of(given) - of->settings : 0;
    const size_t nested = of->settings > 0 ? size_of((const char *)given + of->settings) : 0;
    if (nested == wanted)
        return MSPRING_OK;
    return !message ? MSPRING_ERROR_STRUCT
                    : mspringi_fail(
                          message, MSPRING_ERROR_STRUCT,
                          "%s.settings.struct_size is %zu, but %zu bytes of the struct are left for them: assign "
                          "settings that are filled, as by mspring_network_get_settings()",
                          of->name, nested, wanted);
}

mspring_result mspringi_check_given(mspringi_message *message, const mspringi_struct *of, const void *given) {
    return given ? MSPRING_OK : refuse_null(message, of);
}

mspring_result mspringi_take_struct(mspringi_message *message, const mspringi_struct *of, const void *given,
                                    void *taken) {
    const unsigned char *bytes = given;
    const size_t size = given ? size_of(given) : 0;
    mspring_result result = given ? check_size(message, of, size) : MSPRING_OK;
    if (result == MSPRING_OK && given)
        result = check_nested_size(message, of, given);
    if (result != MSPRING_OK)
        return result;
    for (size_t i = of->known; i < size; ++i)
        if (bytes[i] != 0)
            return !message ? MSPRING_ERROR_STRUCT
                            : mspringi_fail(message, MSPRING_ERROR_STRUCT,
                                            "%s has %zu bytes, of which this library knows %u, and byte %zu is not "
                                            "0: it asks for what a later library has",
                                            of->name, size, (unsigned)of->known, i);
    if (size < of->known && of->defaults)
        memcpy(taken, of->defaults, of->known);
    else if (size < of->known)
        memset(taken, 0, of->known);
    if (given)
        memcpy(taken, given, shared_with(of, size));
    memcpy(taken, &of->known, sizeof of->known);
    put_nested_size(of, taken, of->known);
    return MSPRING_OK;
}

mspring_result mspringi_take_struct_at(mspringi_message *message, const mspringi_struct *of, const void *array,
                                       size_t index, void *taken) {
    const mspring_result result = check_alike(message, of, array, index);
    return result == MSPRING_OK ? mspringi_take_struct(message, of, element(array, index), taken) : result;
}

/* ---------------------------------------------------------------------------------------------------- outputs */

mspring_result mspringi_check_output(mspringi_message *message, const mspringi_struct *of, const void *out) {
    return out ? check_size(message, of, size_of(out)) : refuse_null(message, of);
}

// Fill a struct of `size` bytes behind struct_size.
static void put(const mspringi_struct *of, void *out, size_t size, const void *made) {
    const size_t shared = shared_with(of, size), begin = sizeof of->known;
    memcpy((char *)out + begin, (const char *)made + begin, shared - begin);
    memset((char *)out + shared, 0, size - shared);
    put_nested_size(of, out, size);
}

void mspringi_put_struct(const mspringi_struct *of, void *out, const void *made) {
    put(of, out, size_of(out), made);
}

void mspringi_put_struct_at(const mspringi_struct *of, void *array, size_t index, const void *made) {
    const uint32_t size = (uint32_t)size_of(array);
    char *out = (char *)array + (size_t)size * index;
    memcpy(out, &size, sizeof size);
    put(of, out, size, made);
}

/* -------------------------------------------------------------------------------------------------- defaults */

static const mspringi_struct *struct_of(mspring_struct kind) {
    switch (kind) {
#define INPUT_STRUCT(name, KIND, on_64_bits, on_32_bits, settings)                                                 \
    case MSPRING_STRUCT_##KIND:                                                                                    \
        return &mspringi_struct_##name;
#define OUTPUT_STRUCT INPUT_STRUCT
#include "base/structs.def"
#undef OUTPUT_STRUCT
#undef INPUT_STRUCT
    default:
        return NULL;
    }
}

mspring_result mspring_init(mspring_struct kind, void *made, size_t size) {
    const mspringi_struct *of = struct_of(kind);
    const uint32_t struct_size = (uint32_t)size;
    if (!made || !of)
        return MSPRING_ERROR_ARGUMENT;
    if (!is_possible(of, size))
        return MSPRING_ERROR_STRUCT;
    memset(made, 0, size);
    memcpy(made, &struct_size, sizeof struct_size);
    if (of->defaults)
        mspringi_put_struct(of, made, of->defaults);
    return MSPRING_OK;
}
