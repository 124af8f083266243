/// @file parts.h
/// Parts of the library that a build may leave out (MASSSPRING_PARTS): each macro is its arguments if the part is
/// there, else nothing. Tables put their rows into them; the part's sources are listed in CMakeLists.txt.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PARTS_H
#define MSPRINGI_PARTS_H

#if defined(MSPRINGI_WITHOUT_LAWS)
#define MSPRINGI_LAWS(...)
#else
#define MSPRINGI_LAWS(...) __VA_ARGS__
#endif

#if defined(MSPRINGI_WITHOUT_BATCH)
#define MSPRINGI_BATCH(...)
#else
#define MSPRINGI_BATCH(...) __VA_ARGS__
#endif

#if defined(MSPRINGI_WITHOUT_LAB)
#define MSPRINGI_LAB(...)
#else
#define MSPRINGI_LAB(...) __VA_ARGS__
#endif

#endif
