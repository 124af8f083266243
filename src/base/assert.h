/// @file assert.h
/// Conditions that fail only if the library itself is wrong. What a caller can get wrong is an error with a message
/// instead.
///
/// MSPRINGI_ASSERTS turns them on: in debug builds and under sanitizers (MASSSPRING_ASSERTS). Elsewhere the
/// compiler checks the condition and drops it.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ASSERT_H
#define MSPRINGI_ASSERT_H

#if defined(MSPRINGI_ASSERTS)
/// Called for a condition that does not hold; must not return. Whoever builds the library may define this as the
/// name of a function of their own. The library's writes to stderr and aborts, or loops where there is no C
/// library.
#if !defined(MSPRINGI_ASSERT_HANDLER)
#define MSPRINGI_ASSERT_HANDLER mspringi_assert_failed
#endif
void MSPRINGI_ASSERT_HANDLER(const char *condition, const char *file, int line);
#define MSPRINGI_ASSERT(condition) ((condition) ? (void)0 : MSPRINGI_ASSERT_HANDLER(#condition, __FILE__, __LINE__))
#else
#define MSPRINGI_ASSERT(condition) ((void)(0 && (condition)))
#endif

#endif
