/// @file structs.h
/// Public structs of hosts that were built with the header of another version: shorter or longer than today's.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STRUCTS_H
#define MSPRINGI_STRUCTS_H

#include <stddef.h>

#include <massspring/massspring.h>
#if !defined(MSPRING_EXPERIMENTAL)
#define MSPRING_EXPERIMENTAL
#endif
#include <massspring/lab.h>

#include "base/message.h"
#include "base/parts.h"

/// No struct is larger, ever: a size that is has not been set.
#define MSPRINGI_LARGEST_STRUCT 4000u

/// A public struct that begins with struct_size.
typedef struct mspringi_struct {
    const char *name;
    uint32_t first;    ///< bytes in the version that introduced it; never changes
    uint32_t known;    ///< bytes today
    uint32_t settings; ///< offset of the mspring_settings that it ends with, and that grow with it; 0: it has none
    const void *defaults; ///< [known]; NULL: 0
} mspringi_struct;

/// Copy a struct of the host onto the defaults: what an older header lacks has its default. Refuse a size that no
/// version has, and fields of a later header that are not 0. The copy has today's size. NULL gives the defaults.
/// The message may be NULL.
mspring_result mspringi_take_struct(mspringi_message *message, const mspringi_struct *of, const void *given,
                                    void *taken);

/// Copy an element of an array, all of whose elements must be as large as the first.
mspring_result mspringi_take_struct_at(mspringi_message *message, const mspringi_struct *of, const void *array,
                                       size_t index, void *taken);

/// Refuse NULL.
mspring_result mspringi_check_given(mspringi_message *message, const mspringi_struct *of, const void *given);

/// Refuse a struct that cannot be filled. NULL is MSPRING_ERROR_ARGUMENT. The message may be NULL.
mspring_result mspringi_check_output(mspringi_message *message, const mspringi_struct *of, const void *out);

/// Fill a struct that was checked, as far as its header has it. Fields of a later header become 0; struct_size
/// stays.
void mspringi_put_struct(const mspringi_struct *of, void *out, const void *made);
/// Fill an element of an array whose first element was checked. The others get its struct_size.
void mspringi_put_struct_at(const mspringi_struct *of, void *array, size_t index, const void *made);

/// For each struct: its mspringi_struct, and the above with its type. A struct that is taken is exchanged for the
/// copy, so that all that follows reads that.
#define INPUT_STRUCT(name, KIND, on_64_bits, on_32_bits, settings)                                                 \
    extern const mspringi_struct mspringi_struct_##name;                                                           \
    static inline mspring_result mspringi_take_##name##_or_defaults(                                               \
        mspringi_message *message, const mspring_##name **given, mspring_##name *taken) {                          \
        const mspring_result result = mspringi_take_struct(message, &mspringi_struct_##name, *given, taken);       \
        if (result == MSPRING_OK)                                                                                  \
            *given = taken;                                                                                        \
        return result;                                                                                             \
    }                                                                                                              \
    static inline mspring_result mspringi_take_##name(mspringi_message *message, const mspring_##name **given,     \
                                                      mspring_##name *taken) {                                     \
        const mspring_result result = mspringi_check_given(message, &mspringi_struct_##name, *given);              \
        return result == MSPRING_OK ? mspringi_take_##name##_or_defaults(message, given, taken) : result;          \
    }                                                                                                              \
    static inline mspring_result mspringi_take_##name##_at(mspringi_message *message, const mspring_##name *array, \
                                                           size_t index, mspring_##name *taken) {                  \
        return mspringi_take_struct_at(message, &mspringi_struct_##name, array, index, taken);                     \
    }                                                                                                              \
    static inline void mspringi_put_##name(mspring_##name *out, const mspring_##name *made) {                      \
        mspringi_put_struct(&mspringi_struct_##name, out, made);                                                   \
    }                                                                                                              \
    static inline void mspringi_put_##name##_at(mspring_##name *array, size_t index, const mspring_##name *made) { \
        mspringi_put_struct_at(&mspringi_struct_##name, array, index, made);                                       \
    }
#define OUTPUT_STRUCT INPUT_STRUCT
#include "base/structs.def"
#undef OUTPUT_STRUCT
#undef INPUT_STRUCT

#endif
