#pragma once
typedef struct fenv_t {
    unsigned long control, status;
} fenv_t;
extern const fenv_t *const msvc_default_environment;
#define FE_DFL_ENV msvc_default_environment
#define FE_TONEAREST 0
int fegetround(void);
int fesetround(int direction);
int fegetenv(fenv_t *environment);
int fesetenv(const fenv_t *environment);
int feholdexcept(fenv_t *environment);
