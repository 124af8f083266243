#include <massspring/massspring.h>

#include "base/parts.h"

#define QUOTED_AS_IS(token) #token
#define QUOTED(token) QUOTED_AS_IS(token)

uint32_t mspring_version(void) {
    return MSPRING_VERSION;
}

const char *mspring_version_string(void) {
    return QUOTED(MSPRING_VERSION_MAJOR) "." QUOTED(MSPRING_VERSION_MINOR) "." QUOTED(MSPRING_VERSION_PATCH);
}

uint32_t mspring_features(void) {
    uint32_t features = 0;
#if defined(MSPRINGI_THREADS)
    features |= MSPRING_FEATURE_THREADS;
#endif
#if !defined(MSPRINGI_FREESTANDING)
    features |= MSPRING_FEATURE_HOSTED;
#endif
#if defined(MSPRING_BUILD_SHARED)
    features |= MSPRING_FEATURE_SHARED;
#endif
#if !defined(MSPRINGI_WITHOUT_IMPLICIT)
    features |= MSPRING_FEATURE_IMPLICIT;
#endif
#if !defined(MSPRINGI_WITHOUT_IMPLICIT) && !defined(MSPRINGI_WITHOUT_DIRECT)
    features |= MSPRING_FEATURE_DIRECT;
#endif
    features |= MSPRING_FEATURE_FLOOR | MSPRING_FEATURE_CONTACT;
    MSPRINGI_LAWS(features |= MSPRING_FEATURE_LAWS;)
    MSPRINGI_BATCH(features |= MSPRING_FEATURE_BATCH;)
    MSPRINGI_LAB(features |= MSPRING_FEATURE_LAB;)
    return features;
}
