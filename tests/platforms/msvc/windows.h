#pragma once
#include <stddef.h>
// The macros that get in the way of those who do not know them.
#define near
#define far
#define small char
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define TEXT(quote) quote
#define INFINITE 0xffffffffu
typedef void *HANDLE;
typedef int BOOL;
typedef unsigned long DWORD;
typedef union LARGE_INTEGER {
    long long QuadPart;
} LARGE_INTEGER;
typedef struct SRWLOCK {
    void *pointer;
} SRWLOCK;
typedef struct CONDITION_VARIABLE {
    void *pointer;
} CONDITION_VARIABLE;
void __stdcall InitializeSRWLock(SRWLOCK *lock);
void __stdcall AcquireSRWLockExclusive(SRWLOCK *lock);
void __stdcall ReleaseSRWLockExclusive(SRWLOCK *lock);
void __stdcall InitializeConditionVariable(CONDITION_VARIABLE *condition);
void __stdcall WakeAllConditionVariable(CONDITION_VARIABLE *condition);
BOOL __stdcall SleepConditionVariableSRW(CONDITION_VARIABLE *condition, SRWLOCK *lock, DWORD milliseconds,
                                         unsigned long flags);
DWORD __stdcall WaitForSingleObject(HANDLE handle, DWORD milliseconds);
BOOL __stdcall QueryPerformanceCounter(LARGE_INTEGER *count);
BOOL __stdcall QueryPerformanceFrequency(LARGE_INTEGER *frequency);
BOOL __stdcall CloseHandle(HANDLE handle);
