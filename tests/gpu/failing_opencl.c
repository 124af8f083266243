/// @file failing_opencl.c
/// An OpenCL library that hands calls on to the system's, but for those that a test has asked to fail. It counts what
/// has been made and not released.
///
///     failing_opencl_fail(n, all)    the n-th call from now on fails, with all also those after it; 0: none
///     failing_opencl_report(...)     what devices say of themselves instead
///
/// SPDX-License-Identifier: MIT
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_icd.h>
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#define PUBLIC __attribute__((visibility("default")))

/// Functions for a test.
PUBLIC void failing_opencl_fail(unsigned number, int all);
PUBLIC unsigned failing_opencl_calls(void);
PUBLIC int failing_opencl_live(void);
PUBLIC void failing_opencl_report(cl_device_info what, cl_ulong value);

static unsigned calls, fails_at;
static int fails_all, live;
static cl_device_info reported;
static cl_ulong reported_value;

void failing_opencl_fail(unsigned number, int all) {
    calls = 0;
    fails_at = number;
    fails_all = all;
}

unsigned failing_opencl_calls(void) {
    return calls;
}

int failing_opencl_live(void) {
    return live;
}

void failing_opencl_report(cl_device_info what, cl_ulong value) {
    reported = what;
    reported_value = value;
}

static void *function(const char *name) {
    static void *library;
    if (library == NULL)
        library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
    void *const found = library != NULL ? dlsym(library, name) : NULL;
    if (found == NULL)
        abort();
    return found;
}

static int must_fail(void) {
    calls++;
    return fails_at > 0 && (calls == fails_at || (fails_all && calls > fails_at));
}

// The function of the system's library.
#define REAL(name, to)                                                                                                 \
    cl_api_##name to;                                                                                                  \
    void *const found_##to = function(#name);                                                                          \
    memcpy(&to, &found_##to, sizeof to)

#define FORWARD(name, parameters, arguments, status)                                                                   \
    PUBLIC CL_API_ENTRY cl_int CL_API_CALL name parameters {                                                           \
        if (must_fail())                                                                                               \
            return status;                                                                                             \
        REAL(name, real);                                                                                              \
        return real arguments;                                                                                         \
    }

#define MAKE(type, name, parameters, arguments, status)                                                                \
    PUBLIC CL_API_ENTRY type CL_API_CALL name parameters {                                                             \
        if (must_fail()) {                                                                                             \
            *error = status;                                                                                           \
            return NULL;                                                                                               \
        }                                                                                                              \
        REAL(name, real);                                                                                              \
        type const made = real arguments;                                                                              \
        live += made != NULL;                                                                                          \
        return made;                                                                                                   \
    }

#define RELEASE(type, name)                                                                                            \
    PUBLIC CL_API_ENTRY cl_int CL_API_CALL name(type object) {                                                         \
        REAL(name, real);                                                                                              \
        live--;                                                                                                        \
        return real(object);                                                                                           \
    }

FORWARD(clGetPlatformIDs, (cl_uint room, cl_platform_id *platforms, cl_uint *count), (room, platforms, count),
        CL_OUT_OF_HOST_MEMORY)
FORWARD(clGetDeviceIDs, (cl_platform_id platform, cl_device_type type, cl_uint room, cl_device_id *devices, cl_uint *count),
        (platform, type, room, devices, count), CL_DEVICE_NOT_FOUND)
FORWARD(clBuildProgram,
        (cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
         void(CL_CALLBACK *notify)(cl_program, void *), void *user),
        (program, count, devices, options, notify, user), CL_BUILD_PROGRAM_FAILURE)
FORWARD(clGetProgramBuildInfo,
        (cl_program program, cl_device_id device, cl_program_build_info what, size_t size, void *to, size_t *needed),
        (program, device, what, size, to, needed), CL_OUT_OF_HOST_MEMORY)
FORWARD(clSetKernelArg, (cl_kernel kernel, cl_uint i, size_t size, const void *value), (kernel, i, size, value),
        CL_OUT_OF_RESOURCES)
FORWARD(clEnqueueWriteBuffer,
        (cl_command_queue queue, cl_mem buffer, cl_bool waits, size_t offset, size_t size, const void *from,
         cl_uint count, const cl_event *events, cl_event *event),
        (queue, buffer, waits, offset, size, from, count, events, event), CL_MEM_OBJECT_ALLOCATION_FAILURE)
FORWARD(clEnqueueReadBuffer,
        (cl_command_queue queue, cl_mem buffer, cl_bool waits, size_t offset, size_t size, void *to, cl_uint count,
         const cl_event *events, cl_event *event),
        (queue, buffer, waits, offset, size, to, count, events, event), CL_OUT_OF_RESOURCES)
FORWARD(clEnqueueNDRangeKernel,
        (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *first, const size_t *items,
         const size_t *group, cl_uint count, const cl_event *events, cl_event *event),
        (queue, kernel, dimensions, first, items, group, count, events, event), CL_OUT_OF_RESOURCES)
FORWARD(clFinish, (cl_command_queue queue), (queue), CL_OUT_OF_RESOURCES)

MAKE(cl_context, clCreateContext,
     (const cl_context_properties *properties, cl_uint count, const cl_device_id *devices,
      void(CL_CALLBACK *notify)(const char *, const void *, size_t, void *), void *user, cl_int *error),
     (properties, count, devices, notify, user, error), CL_DEVICE_NOT_AVAILABLE)
MAKE(cl_command_queue, clCreateCommandQueue,
     (cl_context context, cl_device_id device, cl_command_queue_properties properties, cl_int *error),
     (context, device, properties, error), CL_OUT_OF_RESOURCES)
MAKE(cl_program, clCreateProgramWithSource,
     (cl_context context, cl_uint count, const char **lines, const size_t *lengths, cl_int *error),
     (context, count, lines, lengths, error), CL_OUT_OF_HOST_MEMORY)
MAKE(cl_kernel, clCreateKernel, (cl_program program, const char *name, cl_int *error), (program, name, error),
     CL_OUT_OF_RESOURCES)
MAKE(cl_mem, clCreateBuffer, (cl_context context, cl_mem_flags flags, size_t size, void *from, cl_int *error),
     (context, flags, size, from, error), CL_MEM_OBJECT_ALLOCATION_FAILURE)

RELEASE(cl_context, clReleaseContext)
RELEASE(cl_command_queue, clReleaseCommandQueue)
RELEASE(cl_program, clReleaseProgram)
RELEASE(cl_kernel, clReleaseKernel)
RELEASE(cl_mem, clReleaseMemObject)

PUBLIC CL_API_ENTRY cl_int CL_API_CALL clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void *to,
                                                       size_t *needed) {
    if (must_fail())
        return CL_INVALID_DEVICE;
    if (reported != 0 && what == reported) {
        memcpy(to, &reported_value, size < sizeof reported_value ? size : sizeof reported_value);
        return CL_SUCCESS;
    }
    REAL(clGetDeviceInfo, real);
    return real(device, what, size, to, needed);
}
