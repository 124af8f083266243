#include "base/message.h"

#include <stdatomic.h>

#include "base/assert.h"

#if defined(MSPRINGI_ASSERTS) && !defined(MSPRINGI_FREESTANDING)
#include <stdio.h>
#include <stdlib.h>
#endif

mspring_result mspringi_fail(mspringi_message *message, mspring_result result, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    mspringi_format(message->text, sizeof message->text, format, arguments);
    va_end(arguments);
    return result;
}

const char *mspringi_id_text(char text[MSPRINGI_ID_SIZE], mspring_id id) {
    mspringi_message made;
    if (id == MSPRING_NONE)
        return "MSPRING_NONE (not set)";
    (void)mspringi_fail(&made, MSPRING_OK, "%u", (unsigned)id);
    memcpy(text, made.text, MSPRINGI_ID_SIZE - 1);
    return text;
}

void mspringi_shared_clear(mspringi_shared_message *shared) {
    atomic_store_explicit(&shared->state, MSPRINGI_MESSAGE_NONE, memory_order_relaxed);
}

const char *mspringi_shared_text(const mspringi_shared_message *shared) {
    return atomic_load_explicit(&shared->state, memory_order_acquire) == MSPRINGI_MESSAGE_WRITTEN
               ? shared->message.text
               : "";
}

mspring_result mspringi_shared_fail(mspringi_shared_message *shared, mspring_result result, const char *format,
                                    ...) {
    mspringi_message message;
    va_list arguments;
    va_start(arguments, format);
    mspringi_format(message.text, sizeof message.text, format, arguments);
    va_end(arguments);
    return mspringi_shared_set(shared, result, &message);
}

mspring_result mspringi_shared_set(mspringi_shared_message *shared, mspring_result result,
                                   const mspringi_message *message) {
    uint32_t none = MSPRINGI_MESSAGE_NONE;
    if (atomic_compare_exchange_strong_explicit(&shared->state, &none, MSPRINGI_MESSAGE_CLAIMED,
                                                memory_order_relaxed, memory_order_relaxed)) {
        shared->message = *message;
        atomic_store_explicit(&shared->state, MSPRINGI_MESSAGE_WRITTEN, memory_order_release);
    }
    return result;
}

/// Larger than any struct: a larger size is uninitialised memory.
#define MAX_STRUCT_SIZE 4000

static bool is_possible(size_t size, size_t known) {
    return size >= known && size % sizeof(uint32_t) == 0 && size <= MAX_STRUCT_SIZE;
}

static mspring_result reject_size(mspringi_message *message, const char *name, size_t size, size_t known) {
    if (!message)
        return MSPRING_ERROR_STRUCT;
    return mspringi_fail(
        message, MSPRING_ERROR_STRUCT,
        "%s.struct_size is %zu, this library knows %zu: fill the struct with its init function, or "
        "set struct_size to its size",
        name, size, known);
}

mspring_result mspringi_check_struct(mspringi_message *message, const char *name, const void *given, size_t known) {
    const size_t size = mspringi_struct_size(given);
    const unsigned char *bytes = given;
    if (!is_possible(size, known))
        return reject_size(message, name, size, known);
    for (size_t i = known; i < size; ++i)
        if (bytes[i] != 0)
            return !message ? MSPRING_ERROR_STRUCT
                            : mspringi_fail(message, MSPRING_ERROR_STRUCT,
                                            "%s has %zu bytes, of which this library knows %zu, and byte %zu is "
                                            "not 0: it uses a feature of a later version",
                                            name, size, known, i);
    return MSPRING_OK;
}

mspring_result mspringi_check_output(mspringi_message *message, const char *name, const void *out, size_t known) {
    if (!out)
        return !message ? MSPRING_ERROR_ARGUMENT
                        : mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s is NULL", name);
    const size_t size = mspringi_struct_size(out);
    return is_possible(size, known) ? MSPRING_OK : reject_size(message, name, size, known);
}

mspring_result mspringi_check_same_size(mspringi_message *message, const void *element, size_t struct_size) {
    const size_t size = mspringi_struct_size(element);
    if (size == struct_size)
        return MSPRING_OK;
    return !message
               ? MSPRING_ERROR_STRUCT
               : mspringi_fail(message, MSPRING_ERROR_STRUCT,
                               "struct_size is %zu, but that of the first in the array is %zu", size, struct_size);
}

mspring_result mspringi_check_outputs(const void *array, uint32_t count, const char *name, size_t known,
                                      mspringi_message *message) {
    mspring_result result = MSPRING_OK;
    const size_t struct_size = count > 0 ? mspringi_struct_size(array) : 0;
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        const void *element = mspringi_element(array, struct_size, i);
        result = mspringi_check_output(message, name, element, known);
        if (result == MSPRING_OK)
            result = mspringi_check_same_size(message, element, struct_size);
        if (result != MSPRING_OK && count > 1) {
            const mspringi_message reason = *message;
            return mspringi_fail(message, result, "index %u: %s", (unsigned)i, reason.text);
        }
    }
    return result;
}

void mspringi_put_struct(void *out, const void *made, size_t known) {
    const size_t size = mspringi_struct_size(out);
    const uint32_t struct_size = (uint32_t)size;
    memcpy(out, made, known);
    memset((char *)out + known, 0, size - known);
    memcpy(out, &struct_size, sizeof struct_size);
}

mspring_result mspringi_init_struct(void *out, size_t size, const void *defaults, size_t known) {
    const uint32_t struct_size = (uint32_t)size;
    if (!out)
        return MSPRING_ERROR_ARGUMENT;
    if (!is_possible(size, known))
        return MSPRING_ERROR_STRUCT;
    memcpy(out, &struct_size, sizeof struct_size);
    mspringi_put_struct(out, defaults, known);
    return MSPRING_OK;
}

mspring_result mspringi_check_reserved(mspringi_message *message, const char *name, uint32_t reserved) {
    if (reserved == 0)
        return MSPRING_OK;
    return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s.reserved is %u, it must be 0", name,
                         (unsigned)reserved);
}

const char *mspring_result_string(mspring_result result) {
    switch (result) {
    case MSPRING_OK:
        return "success";
    case MSPRING_ERROR_ARGUMENT:
        return "invalid argument";
    case MSPRING_ERROR_ID:
        return "unknown id";
    case MSPRING_ERROR_MEMORY:
        return "out of memory";
    case MSPRING_ERROR_LIMIT:
        return "limit exceeded";
    case MSPRING_ERROR_STRUCT:
        return "unknown struct size";
    case MSPRING_ERROR_DUPLICATE:
        return "two springs join the same particles";
    case MSPRING_ERROR_UNSTABLE:
        return "the step was rejected";
    case MSPRING_ERROR_BUSY:
        return "not allowed now";
    case MSPRING_ERROR_OUTDATED:
        return "the network has changed since the job began";
    case MSPRING_ERROR_THREAD:
        return "no thread available";
    case MSPRING_ERROR_EQUILIBRIUM:
        return "no equilibrium found";
    case MSPRING_ERROR_SNAPSHOT:
        return "no snapshot of this network";
    default:
        return "unknown result code";
    }
}

#if defined(MSPRINGI_ASSERTS)
void mspringi_assert_failed(const char *condition, const char *file, int line) {
#if defined(MSPRINGI_FREESTANDING)
    (void)condition, (void)file, (void)line;
    for (;;) {
    }
#else
    (void)fprintf(stderr, "%s:%d: massspring is wrong: %s\n", file, line, condition);
    abort();
#endif
}
#endif
