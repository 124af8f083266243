/// @file string.h
/// What the library and the page use of string.h, for a module without a C library.
///
/// SPDX-License-Identifier: MIT
#ifndef ENVIRONMENT_STRING_H
#define ENVIRONMENT_STRING_H

#include <stddef.h>

void *memcpy(void *restrict to, const void *restrict from, size_t size);
void *memmove(void *to, const void *from, size_t size);
void *memset(void *to, int value, size_t size);
int memcmp(const void *a, const void *b, size_t size);
int strcmp(const char *a, const char *b);
size_t strlen(const char *text);

#endif
