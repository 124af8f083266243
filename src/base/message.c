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

mspring_result mspringi_prefix(mspringi_message *message, mspring_result result, const char *what, size_t index) {
    if (result == MSPRING_OK)
        return result;
    const mspringi_message reason = *message;
    return mspringi_fail(message, result, "%s %zu: %s", what, index, reason.text);
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
    case MSPRING_ERROR_REFUSED:
        return "refused by the host";
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
