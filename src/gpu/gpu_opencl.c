/// Loading OpenCL, choosing a device, building the program.
///
/// SPDX-License-Identifier: MIT
#include "gpu_opencl.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include "gpu_source.h"

mspring_result mspringi_gpu_fail(mspringi_gpu_message *message, mspring_result result, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(message->text, sizeof message->text, format, arguments);
    va_end(arguments);
    return result;
}

static const char *gpu_status_name(cl_int status) {
    switch (status) {
    case CL_DEVICE_NOT_AVAILABLE:
        return "device not available";
    case CL_MEM_OBJECT_ALLOCATION_FAILURE:
        return "no device memory";
    case CL_OUT_OF_RESOURCES:
        return "out of resources, or the device is lost";
    case CL_OUT_OF_HOST_MEMORY:
        return "no memory";
    case CL_INVALID_BUFFER_SIZE:
        return "more than the device allocates at once";
    case CL_BUILD_PROGRAM_FAILURE:
        return "the program doesn't compile";
    case CL_INVALID_WORK_GROUP_SIZE:
        return "group size";
    default:
        return "see cl.h";
    }
}

mspring_result mspringi_gpu_check(const mspringi_gpu_device *gpu, mspringi_gpu_message *message, cl_int status,
                                  const char *call, const char *purpose) {
    const bool is_memory = status == CL_MEM_OBJECT_ALLOCATION_FAILURE || status == CL_OUT_OF_HOST_MEMORY ||
                           status == CL_INVALID_BUFFER_SIZE;
    if (status == CL_SUCCESS)
        return MSPRING_OK;
    return mspringi_gpu_fail(message, is_memory ? MSPRING_ERROR_MEMORY : MSPRING_ERROR_DEVICE,
                             "%s: %s failed with %d (%s), %s", gpu->name[0] != '\0' ? gpu->name : "OpenCL", call,
                             (int)status, gpu_status_name(status), purpose);
}

/* --------------------------------------------------------------------------------------------- loading */

// Load OpenCL. It is never unloaded, because drivers leave threads behind.
static void *load_library(const char *path) {
#if defined(_WIN32)
    return (void *)LoadLibraryA(path != NULL ? path : "OpenCL.dll");
#elif defined(__APPLE__)
    return dlopen(path != NULL ? path : "/System/Library/Frameworks/OpenCL.framework/OpenCL",
                  RTLD_NOW | RTLD_LOCAL);
#else
    return dlopen(path != NULL ? path : "libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
#endif
}

static bool find_function(void *library, const char *name, void *function) {
#if defined(_WIN32)
    const FARPROC found = GetProcAddress((HMODULE)library, name);
#else
    void *const found = dlsym(library, name);
#endif
    memcpy(function, &found, sizeof found);
    return found != NULL;
}

static mspring_result load_functions(mspringi_gpu_device *gpu, const char *path, mspringi_gpu_message *message) {
    void *const library = load_library(path);
    if (library == NULL)
        return mspringi_gpu_fail(message, MSPRING_ERROR_DEVICE, "there is no OpenCL library%s%s: install a driver",
                                 path != NULL ? " at " : "", path != NULL ? path : "");
#define FIND(name)                                                                                                 \
    if (!find_function(library, #name, &gpu->name))                                                                \
        return mspringi_gpu_fail(message, MSPRING_ERROR_DEVICE, "the OpenCL library has no %s", #name);
    MSPRINGI_GPU_FUNCTIONS(FIND)
#undef FIND
    return MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------- devices */

// Return why a device is unsuitable, or NULL. Also reads its name, group size and local memory.
static const char *why_unfit(mspringi_gpu_device *gpu, cl_device_id device) {
    cl_bool is_available = CL_FALSE, has_compiler = CL_FALSE;
    cl_device_fp_config single = 0, wide = 0;
    cl_ulong local_memory = 0;
    const cl_device_fp_config basic = CL_FP_DENORM | CL_FP_INF_NAN | CL_FP_ROUND_TO_NEAREST;
    memset(gpu->name, 0, sizeof gpu->name);
    if (gpu->clGetDeviceInfo(device, CL_DEVICE_NAME, sizeof gpu->name - 1, gpu->name, NULL) != CL_SUCCESS)
        (void)snprintf(gpu->name, sizeof gpu->name, "a device without a name");
#define READ(what, to) (gpu->clGetDeviceInfo(device, what, sizeof to, &to, NULL) == CL_SUCCESS)
    if (!READ(CL_DEVICE_AVAILABLE, is_available) || !READ(CL_DEVICE_COMPILER_AVAILABLE, has_compiler) ||
        !READ(CL_DEVICE_SINGLE_FP_CONFIG, single) || !READ(CL_DEVICE_MAX_WORK_GROUP_SIZE, gpu->group_size) ||
        !READ(CL_DEVICE_LOCAL_MEM_SIZE, local_memory))
        return "it doesn't tell what it can";
    if (!READ(CL_DEVICE_DOUBLE_FP_CONFIG, wide))
        wide = 0;
#undef READ
    gpu->local_memory = local_memory;
    return !is_available                                     ? "it isn't available"
           : !has_compiler                                   ? "it has no compiler"
           : !(single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) ? "its division and root are not correctly rounded"
           : (single & basic) != basic                       ? "it flushes subnormal numbers, or has no infinity"
           : (wide & basic) != basic                         ? "it has no double precision"
                                                             : NULL;
}

/// Most platforms, and most devices of each.
#define MOST_PLATFORMS 16
#define MOST_DEVICES 64

typedef struct device_list {
    cl_device_id devices[MOST_PLATFORMS * MOST_DEVICES];
    uint32_t count;
} device_list;

static void list_devices(const mspringi_gpu_device *gpu, device_list *list) {
    cl_platform_id platforms[MOST_PLATFORMS];
    cl_uint platform_count = 0, count;
    list->count = 0;
    if (gpu->clGetPlatformIDs(MOST_PLATFORMS, platforms, &platform_count) != CL_SUCCESS)
        return;
    for (cl_uint i = 0; i < platform_count && i < MOST_PLATFORMS; i++) {
        count = 0;
        if (gpu->clGetDeviceIDs(platforms[i], CL_DEVICE_TYPE_ALL, MOST_DEVICES, list->devices + list->count,
                                &count) == CL_SUCCESS)
            list->count += count < MOST_DEVICES ? count : MOST_DEVICES;
    }
}

static bool is_card(const mspringi_gpu_device *gpu, cl_device_id device) {
    cl_device_type type = 0;
    return gpu->clGetDeviceInfo(device, CL_DEVICE_TYPE, sizeof type, &type, NULL) == CL_SUCCESS &&
           (type & CL_DEVICE_TYPE_GPU) != 0;
}

static mspring_result choose_device(mspringi_gpu_device *gpu, const device_list *list, uint32_t number,
                                    mspringi_gpu_message *message) {
    const char *why = NULL;
    if (list->count == 0)
        return mspringi_gpu_fail(message, MSPRING_ERROR_DEVICE, "OpenCL has no device");
    for (int pass = 0; number == MSPRING_GPU_ANY && pass < 2; pass++)
        for (uint32_t i = 0; i < list->count; i++)
            if (is_card(gpu, list->devices[i]) == (pass == 0)) {
                gpu->device = list->devices[i];
                why = why_unfit(gpu, gpu->device);
                if (why == NULL)
                    return MSPRING_OK;
            }
    if (number != MSPRING_GPU_ANY && number >= list->count)
        return mspringi_gpu_fail(message, MSPRING_ERROR_DEVICE, "there is no device %u: numbers are below %u",
                                 (unsigned)number, (unsigned)list->count);
    if (number != MSPRING_GPU_ANY) {
        gpu->device = list->devices[number];
        why = why_unfit(gpu, gpu->device);
    }
    return why == NULL ? MSPRING_OK
                       : mspringi_gpu_fail(message, MSPRING_ERROR_DEVICE, "%s does not suit: %s", gpu->name, why);
}

static mspring_result open_context(mspringi_gpu_device *gpu, mspringi_gpu_message *message) {
    cl_int status;
    gpu->context = gpu->clCreateContext(NULL, 1, &gpu->device, NULL, NULL, &status);
    if (gpu->context == NULL)
        return mspringi_gpu_check(gpu, message, status, "clCreateContext", "opening the device");
    gpu->queue = gpu->clCreateCommandQueue(gpu->context, gpu->device, 0, &status);
    return gpu->queue != NULL
               ? MSPRING_OK
               : mspringi_gpu_check(gpu, message, status, "clCreateCommandQueue", "opening the device");
}

mspring_result mspringi_gpu_open(mspringi_gpu_device *gpu, const char *library, uint32_t number,
                                 mspringi_gpu_message *message) {
    memset(gpu, 0, sizeof *gpu);
    device_list *list = malloc(sizeof *list);
    mspring_result result = list != NULL
                                ? load_functions(gpu, library, message)
                                : mspringi_gpu_fail(message, MSPRING_ERROR_MEMORY, "no memory for devices");
    if (result == MSPRING_OK) {
        list_devices(gpu, list);
        result = choose_device(gpu, list, number, message);
    }
    free(list);
    if (result == MSPRING_OK)
        result = open_context(gpu, message);
    if (result != MSPRING_OK)
        mspringi_gpu_close(gpu);
    return result;
}

void mspringi_gpu_close(mspringi_gpu_device *gpu) {
    if (gpu->program != NULL)
        (void)gpu->clReleaseProgram(gpu->program);
    if (gpu->queue != NULL)
        (void)gpu->clReleaseCommandQueue(gpu->queue);
    if (gpu->context != NULL)
        (void)gpu->clReleaseContext(gpu->context);
    gpu->program = NULL;
    gpu->queue = NULL;
    gpu->context = NULL;
}

mspring_result mspringi_gpu_build(mspringi_gpu_device *gpu, const char *options, mspringi_gpu_message *message) {
    const cl_uint lines = sizeof mspringi_gpu_source / sizeof mspringi_gpu_source[0];
    char log[512] = "";
    cl_int status;
    gpu->program =
        gpu->clCreateProgramWithSource(gpu->context, lines, (const char **)mspringi_gpu_source, NULL, &status);
    if (gpu->program == NULL)
        return mspringi_gpu_check(gpu, message, status, "clCreateProgramWithSource", "reading the program");
    status = gpu->clBuildProgram(gpu->program, 1, &gpu->device, options, NULL, NULL);
    if (status == CL_SUCCESS)
        return MSPRING_OK;
    (void)gpu->clGetProgramBuildInfo(gpu->program, gpu->device, CL_PROGRAM_BUILD_LOG, sizeof log - 1, log, NULL);
    return mspringi_gpu_check(gpu, message, status, "clBuildProgram", log);
}

mspring_result mspring_gpu_describe_devices(const char *library, char *text, size_t size) {
    mspringi_gpu_message message = {""};
    mspringi_gpu_device gpu;
    size_t used = 0;
    if (text == NULL || size == 0)
        return MSPRING_ERROR_ARGUMENT;
    memset(&gpu, 0, sizeof gpu);
    text[0] = '\0';
    device_list *list = malloc(sizeof *list);
    const mspring_result result = list != NULL ? load_functions(&gpu, library, &message) : MSPRING_ERROR_MEMORY;
    if (result == MSPRING_OK)
        list_devices(&gpu, list);
    else
        (void)snprintf(text, size, "%s", list != NULL ? message.text : "no memory");
    for (uint32_t i = 0; result == MSPRING_OK && i < list->count && used < size; i++) {
        const char *why = why_unfit(&gpu, list->devices[i]);
        const int length = snprintf(text + used, size - used, "%u: %s%s%s\n", (unsigned)i, gpu.name,
                                    why != NULL ? ", does not suit: " : "", why != NULL ? why : "");
        used += length > 0 ? (size_t)length : 0;
    }
    free(list);
    return result;
}
