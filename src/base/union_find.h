/// @file union_find.h
/// Disjoint-set forest (Galler and Fischer 1964) in an array of parents. Every root is the lowest element of its
/// set, in any order of joins.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_UNION_FIND_H
#define MSPRINGI_UNION_FIND_H

#include <stdint.h>

/// Find the root of an element, its own parent. Halves the path to it.
static inline uint32_t mspringi_union_find_root(uint32_t *parents, uint32_t element) {
    while (parents[element] != element) {
        parents[element] = parents[parents[element]];
        element = parents[element];
    }
    return element;
}

/// Join the sets of a and b.
static inline void mspringi_union_find_join(uint32_t *parents, uint32_t a, uint32_t b) {
    a = mspringi_union_find_root(parents, a);
    b = mspringi_union_find_root(parents, b);
    if (a < b)
        parents[b] = a;
    else
        parents[a] = b;
}

#endif
