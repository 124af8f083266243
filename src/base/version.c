#include <massspring/massspring.h>

#define TEXT_OF(token) #token
#define TEXT(token) TEXT_OF(token)

uint32_t mspring_version(void) {
    return MSPRING_VERSION;
}

const char *mspring_version_string(void) {
    return TEXT(MSPRING_VERSION_MAJOR) "." TEXT(MSPRING_VERSION_MINOR) "." TEXT(MSPRING_VERSION_PATCH);
}
