/// @file union_find.h
/// A disjoint-set forest (Galler and Fischer, 1964) in an array of parents: which elements hang together. Every
/// root is the lowest element of its set, whatever the order in which sets were joined.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_UNION_FIND_H
#define MSPRINGI_UNION_FIND_H

#include <stdint.h>

/// The root of an element; halves the way to it (a root is its own parent).
static inline uint32_t mspringi_union_find_root(uint32_t *parents, uint32_t element) {
    while (parents[element] != element) {
        parents[element] = parents[parents[element]];
        element = parents[element];
    }
    return element;
}

/// Make one set of those of a and b.
static inline void mspringi_union_find_join(uint32_t *parents, uint32_t a, uint32_t b) {
    a = mspringi_union_find_root(parents, a);
    b = mspringi_union_find_root(parents, b);
    if (a < b)
        parents[b] = a;
    else
        parents[a] = b;
}

#endif
