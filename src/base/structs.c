/// Structs of hosts that are shorter or longer than today's.
#include "base/structs.h"

/* ---------------------------------------------------------------------------------------------------------- sizes */

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
                               "is %u: fill the struct with its init function, or set struct_size to its size",
                               of->name, size, (unsigned)of->first, MSPRINGI_LARGEST_STRUCT, (unsigned)of->known);
}

// Elements of an array lie as far apart as the first is large: another size is a mistake.
static mspring_result check_alike(mspringi_message *message, const mspringi_struct *of, const void *array,
                                  size_t index) {
    const size_t size = size_of(mspringi_element(array, index)), of_first = size_of(array);
    if (size == of_first)
        return MSPRING_OK;
    return !message ? MSPRING_ERROR_STRUCT
                    : mspringi_fail(message, MSPRING_ERROR_STRUCT,
                                    "%s.struct_size is %zu, but that of the first in the array is %zu", of->name,
                                    size, of_first);
}

/* --------------------------------------------------------------------------------------------------------- inputs */

mspring_result mspringi_init_struct(const mspringi_struct *of, void *out, size_t size) {
    const uint32_t struct_size = (uint32_t)size;
    if (!out)
        return MSPRING_ERROR_ARGUMENT;
    if (!is_possible(of, size))
        return MSPRING_ERROR_STRUCT;
    memcpy(out, &struct_size, sizeof struct_size);
    mspringi_put_struct(of, out, of->defaults);
    return MSPRING_OK;
}

mspring_result mspringi_check_given(mspringi_message *message, const mspringi_struct *of, const void *given) {
    return given ? MSPRING_OK : refuse_null(message, of);
}

mspring_result mspringi_take_struct(mspringi_message *message, const mspringi_struct *of, const void *given,
                                    void *taken) {
    const unsigned char *bytes = given;
    const size_t size = given ? size_of(given) : 0;
    const mspring_result result = given ? check_size(message, of, size) : MSPRING_OK;
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
    return MSPRING_OK;
}

mspring_result mspringi_take_struct_at(mspringi_message *message, const mspringi_struct *of, const void *array,
                                       size_t index, void *taken) {
    const mspring_result result = check_alike(message, of, array, index);
    return result == MSPRING_OK ? mspringi_take_struct(message, of, mspringi_element(array, index), taken) : result;
}

/* -------------------------------------------------------------------------------------------------------- outputs */

mspring_result mspringi_check_output(mspringi_message *message, const mspringi_struct *of, const void *out) {
    return out ? check_size(message, of, size_of(out)) : refuse_null(message, of);
}

mspring_result mspringi_check_outputs(mspringi_message *message, const mspringi_struct *of, const void *array,
                                      uint32_t count) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        result = check_alike(message, of, array, i);
        if (result == MSPRING_OK)
            result = check_size(message, of, size_of(array));
        if (result != MSPRING_OK && count > 1)
            result = mspringi_prefix(message, result, "index", i);
    }
    return result;
}

void mspringi_put_struct(const mspringi_struct *of, void *out, const void *made) {
    const size_t size = size_of(out), shared = shared_with(of, size), begin = sizeof of->known; // struct_size stays
    memcpy((char *)out + begin, (const char *)made + begin, shared - begin);
    memset((char *)out + shared, 0, size - shared);
}

void *mspringi_element(const void *array, size_t index) {
    return (char *)(uintptr_t)array + size_of(array) * index;
}
