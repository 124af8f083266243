#include "base/message.h"

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

mspring_result mspringi_check_struct(mspringi_message *message, const char *name, size_t given, size_t first,
                                     size_t current) {
    if (given >= first && given <= current)
        return MSPRING_OK;
    return mspringi_fail(message, MSPRING_ERROR_STRUCT,
                         "%s.struct_size is %zu, this library knows %zu to %zu: fill the struct with its init "
                         "function",
                         name, given, first, current);
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
        return "no such particle, spring or hook";
    case MSPRING_ERROR_MEMORY:
        return "out of memory";
    case MSPRING_ERROR_LIMIT:
        return "too many particles, springs or cells";
    case MSPRING_ERROR_STRUCT:
        return "unknown struct size";
    case MSPRING_ERROR_DUPLICATE:
        return "two springs join the same particles";
    case MSPRING_ERROR_UNSTABLE:
        return "the step is unstable";
    case MSPRING_ERROR_BUSY:
        return "not allowed inside a hook";
    case MSPRING_ERROR_OUTDATED:
        return "the network is another by now";
    case MSPRING_ERROR_THREAD:
        return "no thread to be had";
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
