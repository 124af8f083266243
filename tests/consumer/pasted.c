// The library as a part of one source of a program: nothing of it is visible outside.
// SPDX-License-Identifier: MIT
#define MSPRING_API static
#include "massspring.c"

#include "main.c"
