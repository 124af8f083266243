/// @file structs.h
/// Each public function that takes or fills a struct, for tests of other sizes than today's.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_STRUCTS_H
#define TEST_STRUCTS_H

#include "support.h"

/// All functions that take or fill one struct, with the network and builder of a test.
typedef struct subject {
    mspring_builder *builder;
    mspring_network *network;
} subject;

subject make_subject(void);
void free_subject(subject *s);

extern const struct input {
    const char *name; ///< without mspring_
    size_t size;      ///< as this program's header has it
    size_t grown;     ///< bytes of it that the version that introduced it did not have
    size_t settings;  ///< where the settings are that it ends with; 0: it has none
    mspring_struct kind;
    mspring_result (*give)(subject *s, void *given); ///< sets what init leaves unset, and makes the call
    size_t reserved;                                 ///< where a reserved field is; 0: there is none
} inputs[];
extern const size_t input_count;

extern const struct output {
    const char *name;
    size_t size;
    size_t grown;    ///< bytes of it that the version that introduced it did not have
    size_t settings; ///< where the settings are that it ends with; 0: it has none
    mspring_result (*fill)(subject *s, void *out);
    bool repeats; ///< the next call gives the same
} outputs[];
extern const size_t output_count;

#endif
