#pragma once
// Of what there is, what the library uses beside the intrinsics that all compilers have.
void __cpuid(int registers[4], int leaf);
void __cpuidex(int registers[4], int leaf, int subleaf);
unsigned long long _xgetbv(unsigned which);
