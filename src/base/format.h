/// @file format.h
/// Formatted text, equal on every host: without stdio, in any locale.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FORMAT_H
#define MSPRINGI_FORMAT_H

#include <stdarg.h>
#include <stddef.h>

#if defined(__MINGW32__) && !defined(__clang__)
#define MSPRINGI_PRINTF(format_index, first_index) __attribute__((format(gnu_printf, format_index, first_index)))
#elif defined(__GNUC__)
#define MSPRINGI_PRINTF(format_index, first_index) __attribute__((format(printf, format_index, first_index)))
#else
#define MSPRINGI_PRINTF(format_index, first_index)
#endif

/// Write text, cut to fit size bytes, at least one. Conversions are a subset of printf's: %u %x %#x, each also with
/// z and ll; %d, %g with or without a precision above 0, %s and %%. Digits of %g are correctly rounded, as in
/// glibc; a NaN is "nan" whatever its sign.
void mspringi_format(char *text, size_t size, const char *format, va_list arguments) MSPRINGI_PRINTF(3, 0);

#endif
