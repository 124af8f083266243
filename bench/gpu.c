/// @file gpu.c
/// Steps of bodies a second: batches of robots of 6x6 particles and 110 springs, 40 substeps, on a device and by
/// one worker of the processor.
///
///     bench_gpu            256, 4,096, 65,536 and 1,048,576 bodies on the first device that suits
///     bench_gpu MOST [DEVICE]   at most so many
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring_gpu.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIDE = 6, PARTICLES = SIDE * SIDE, TEMPLATES = 64, MOST_ON_PROCESSOR = 65536 };

#define DT (1.0 / 64)
#define SECONDS 2.0

static double now(void) {
    struct timespec time;
    (void)timespec_get(&time, TIME_UTC);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void check(mspring_result result, const char *why) {
    if (result != MSPRING_OK) {
        fprintf(stderr, "%s: %s\n", mspring_result_string(result), why);
        exit(1);
    }
}

static mspring_builder *robot(void) {
    mspring_builder *builder = NULL;
    check(mspring_builder_create(NULL, &builder), "no builder");
    for (uint32_t i = 0; i < PARTICLES; i++) {
        mspring_particle_def def;
        check(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def), "definition");
        def.x = i % SIDE;
        def.y = 1 + i / SIDE;
        check(mspring_builder_add_particles(builder, &def, 1, NULL), mspring_builder_error(builder));
    }
    for (uint32_t i = 0; i < PARTICLES; i++) {
        const uint32_t right = i % SIDE + 1 < SIDE, above = i / SIDE + 1 < SIDE, left = i % SIDE > 0;
        const uint32_t to[] = {i + 1, i + SIDE, i + SIDE + 1, i + SIDE - 1};
        const uint32_t is_there[] = {right, above, above && right, above && left};
        for (int k = 0; k < 4; k++) {
            mspring_spring_def def;
            check(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def), "definition");
            def.a = i;
            def.b = to[k];
            def.stiffness = 5000;
            def.damping = 5;
            if (is_there[k])
                check(mspring_builder_add_springs(builder, &def, 1, NULL), mspring_builder_error(builder));
        }
    }
    return builder;
}

static mspring_network *make(const mspring_builder *body, uint32_t count) {
    mspring_builder *all = NULL;
    mspring_network *network = NULL;
    mspring_network_def def;
    mspring_id *firsts = malloc((count + 1) * sizeof *firsts);
    if (firsts == NULL)
        exit(1);
    for (uint32_t i = 0; i <= count; i++)
        firsts[i] = i * PARTICLES;
    check(mspring_builder_create(NULL, &all), "no builder");
    check(mspring_builder_add_copies(all, body, count, NULL, NULL, 0, NULL, NULL), mspring_builder_error(all));
    check(mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def), "definition");
    def.settings.substeps = 40;
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    check(mspring_network_create(all, &def, &network), mspring_builder_error(all));
    check(mspring_network_set_groups(network, firsts, count), mspring_network_error(network));
    mspring_builder_destroy(all);
    free(firsts);
    return network;
}

static double time_processor(const mspring_builder *body, uint32_t count) {
    mspring_network *network = make(body, count);
    uint32_t steps = 0;
    check(mspring_network_step(network, DT), mspring_network_error(network));
    const double start = now();
    for (; now() - start < SECONDS; steps++)
        check(mspring_network_step(network, DT), mspring_network_error(network));
    const double rate = (double)count * steps / (now() - start);
    mspring_network_destroy(network);
    return rate;
}

// Steps a second, or 0 where there is no memory.
static double time_device(const mspring_builder *body, uint32_t count, uint32_t device) {
    mspring_network *network = make(body, TEMPLATES);
    mspring_gpu *gpu = NULL;
    mspring_gpu_def def = mspring_gpu_def_default();
    char message[1024] = "";
    uint32_t steps = 0;
    double rate = 0;
    def.body_count = count;
    def.device = device;
    def.message = message;
    def.message_size = sizeof message;
    const mspring_result result = mspring_gpu_create(network, &def, &gpu);
    if (result == MSPRING_ERROR_MEMORY)
        fprintf(stderr, "%s\n", message);
    else
        check(result, message);
    if (gpu != NULL) {
        check(mspring_gpu_step(gpu, DT), mspring_gpu_error(gpu));
        const double start = now();
        for (; now() - start < SECONDS; steps++)
            check(mspring_gpu_step(gpu, DT), mspring_gpu_error(gpu));
        rate = (double)count * steps / (now() - start);
    }
    mspring_gpu_destroy(gpu);
    mspring_network_destroy(network);
    return rate;
}

int main(int argc, char **argv) {
    const uint32_t counts[] = {256, 4096, 65536, 1048576};
    const uint32_t most = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : UINT32_MAX;
    const uint32_t device = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : MSPRING_GPU_ANY;
    char text[4096];
    check(mspring_gpu_describe_devices(NULL, text, sizeof text), text);
    printf("%s\n%10s %20s %20s\n", text, "bodies", "device, steps/s", "one worker, steps/s");
    mspring_builder *body = robot();
    for (size_t i = 0; i < sizeof counts / sizeof counts[0] && counts[i] <= most; i++) {
        printf("%10u %20.0f", (unsigned)counts[i], time_device(body, counts[i], device));
        fflush(stdout);
        if (counts[i] <= MOST_ON_PROCESSOR)
            printf(" %20.0f", time_processor(body, counts[i]));
        printf("\n");
    }
    mspring_builder_destroy(body);
    return 0;
}
