/// @file hostile.h
/// All public functions, each as a call with arguments that can be spoilt one by one.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_HOSTILE_H
#define TEST_HOSTILE_H

#include <massspring/massspring.h>
#include <massspring/massspring_gradient.h>

enum { OUTS = 6, OUT_BYTES = 512, STRUCT_BYTES = 512, SNAPSHOT_BYTES = 8192 };

/// Arguments of a call: valid at first, then one is spoilt.
typedef struct arguments {
    mspring_network *network;
    mspring_builder *builder;
    mspring_id id, first;
    uint32_t count;
    size_t size;
    int32_t kind;
    float x, y;
    double dt, safety, ramp;
    const float *f, *g;
    const double *d, *e;
    const mspring_id *ids;
    const void *snapshot;
    void *given; ///< a struct
    void *out[OUTS];

    float f_values[2], g_values[2];
    double d_values[2], e_values[2];
    mspring_id id_values[2];
    _Alignas(16) unsigned char given_bytes[STRUCT_BYTES];
    _Alignas(16) unsigned char out_bytes[OUTS][OUT_BYTES];
    _Alignas(16) unsigned char snapshot_bytes[SNAPSHOT_BYTES];
    size_t snapshot_size;
} arguments;

/// A function, the kinds of its arguments, what makes the struct that it is given, and the call.
///
/// Kinds: capitals have to be refused when they are spoilt, small letters may be accepted.
///   N  network, of a call that is refused inside a hook      n  network of another call; both leave messages
///   v  network or builder that may be NULL        B  builder
///   I  id        R  first and count       r  the same, where the count may be MSPRING_ALL
///   A  ids       a  ids, where NULL means a range      C  count of structs (size)
///   X  x, Y  y   T  dt   L  safety   J  ramp            K  enumerator
///   F f  G g     arrays of floats, where only small letters allow infinity    D E  arrays of doubles
///   S  struct, NULL refused    s  struct, NULL accepted; impossible sizes are refused for both
///   W  any other word of the struct may be anything (for those without pointers)
///   P  first out-parameter, a struct with its size     0-5  out-parameter needed    o  all of them may be NULL
///   Z  size    V  bytes of a snapshot
typedef struct function {
    const char *name, *kinds;
    void (*prepare)(arguments *a);
    mspring_result (*call)(arguments *a);
} function;

extern const function hostile_functions[];
extern const size_t hostile_function_count;

#endif
