/// @file export.h
/// How functions and enums of the library are declared.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_EXPORT_H
#define MASSSPRING_EXPORT_H

/// Marks the functions of the library. If you use the library as a Windows DLL, define MSPRING_SHARED. If you compile
/// the library with your program, you may define MSPRING_API itself before the headers, for instance as `static`.
#if defined(MSPRING_API)
#elif defined(_WIN32) && defined(MSPRING_BUILD_SHARED)
#define MSPRING_API __declspec(dllexport)
#elif defined(_WIN32) && defined(MSPRING_SHARED)
#define MSPRING_API __declspec(dllimport)
#elif defined(__GNUC__)
#define MSPRING_API __attribute__((visibility("default")))
#else
#define MSPRING_API
#endif

/// Calling convention of all functions and callbacks. Only 32-bit Windows has a choice.
#if defined(MSPRING_CALL)
#elif defined(_WIN32) && !defined(_WIN64)
#define MSPRING_CALL __cdecl
#else
#define MSPRING_CALL
#endif

/// Marks results that must not be ignored. You may define it yourself before the headers, for instance as nothing.
#if defined(MSPRING_NODISCARD)
#elif defined(__cplusplus) && __cplusplus >= 201703L
#define MSPRING_NODISCARD [[nodiscard]]
#elif defined(__GNUC__)
#define MSPRING_NODISCARD __attribute__((warn_unused_result))
#else
#define MSPRING_NODISCARD
#endif

/// Makes an enum a signed integer of 32 bits with every compiler. Its enumerator is no value: give a switch a default.
#define MSPRING_ENUM_INT (-0x7fffffff - 1)

#endif
