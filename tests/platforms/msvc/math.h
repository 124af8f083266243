#pragma once
#define MSVC_REAL_FUNCTION(name) \
    double name(double x);       \
    float name##f(float x);
MSVC_REAL_FUNCTION(sqrt)
MSVC_REAL_FUNCTION(fabs)
MSVC_REAL_FUNCTION(floor)
MSVC_REAL_FUNCTION(ceil)
MSVC_REAL_FUNCTION(rint)
MSVC_REAL_FUNCTION(trunc)
double fmin(double a, double b);
float fminf(float a, float b);
double fmax(double a, double b);
float fmaxf(float a, float b);
double copysign(double a, double b);
float copysignf(float a, float b);
double hypot(double a, double b);
double frexp(double x, int *exponent);
float frexpf(float x, int *exponent);
double ldexp(double x, int exponent);
float ldexpf(float x, int exponent);
double scalbn(double x, int exponent);
float scalbnf(float x, int exponent);
double nextafter(double x, double to);
float nextafterf(float x, float to);
long lrint(double x);
#define INFINITY __builtin_inff()
#define NAN __builtin_nanf("")
#define HUGE_VAL __builtin_inf()
#define isfinite(x) __builtin_isfinite(x)
#define isnan(x) __builtin_isnan(x)
#define isinf(x) __builtin_isinf(x)
#define signbit(x) __builtin_signbit(x)
