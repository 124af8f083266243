/// @file assert.h
/// Conditions that fail only if the library itself is wrong. A caller's mistake is an error with a message instead.
///
/// MSPRINGI_ASSERTS enables them: in debug builds and under sanitizers (MASSSPRING_ASSERTS). Otherwise the compiler
/// only parses the condition.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ASSERT_H
#define MSPRINGI_ASSERT_H

#if defined(MSPRINGI_ASSERTS)
/// Handler of a failed condition; must not return. A build may define this as the name of its own function. The
/// library's handler writes to stderr and aborts, or loops if there is no C library.
#if !defined(MSPRINGI_ASSERT_HANDLER)
#define MSPRINGI_ASSERT_HANDLER mspringi_assert_failed
#endif
void MSPRINGI_ASSERT_HANDLER(const char *condition, const char *file, int line);
#define MSPRINGI_ASSERT(condition) ((condition) ? (void)0 : MSPRINGI_ASSERT_HANDLER(#condition, __FILE__, __LINE__))
#else
#define MSPRINGI_ASSERT(condition) ((void)(0 && (condition)))
#endif

#endif
