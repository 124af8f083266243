/// @file gpu_opencl.h
/// OpenCL, loaded at run time, and a device that gives the bits of the processor.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GPU_OPENCL_H
#define MSPRINGI_GPU_OPENCL_H

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_icd.h>
#define MSPRING_EXPERIMENTAL // mspring_network_describe()
#include <massspring/massspring_gpu.h>

/// OpenCL functions in use.
#define MSPRINGI_GPU_FUNCTIONS(X)                                                                                  \
    X(clGetPlatformIDs)                                                                                            \
    X(clGetDeviceIDs)                                                                                              \
    X(clGetDeviceInfo)                                                                                             \
    X(clCreateContext)                                                                                             \
    X(clReleaseContext)                                                                                            \
    X(clCreateCommandQueue)                                                                                        \
    X(clReleaseCommandQueue)                                                                                       \
    X(clCreateProgramWithSource)                                                                                   \
    X(clBuildProgram)                                                                                              \
    X(clGetProgramBuildInfo)                                                                                       \
    X(clReleaseProgram)                                                                                            \
    X(clCreateKernel)                                                                                              \
    X(clReleaseKernel)                                                                                             \
    X(clSetKernelArg)                                                                                              \
    X(clCreateBuffer)                                                                                              \
    X(clReleaseMemObject)                                                                                          \
    X(clEnqueueWriteBuffer)                                                                                        \
    X(clEnqueueReadBuffer)                                                                                         \
    X(clEnqueueNDRangeKernel)                                                                                      \
    X(clFinish)

/// Error message of a batch.
typedef struct mspringi_gpu_message {
    char text[1024];
} mspringi_gpu_message;

typedef struct mspringi_gpu_device {
#define MSPRINGI_GPU_MEMBER(name) cl_api_##name name;
    MSPRINGI_GPU_FUNCTIONS(MSPRINGI_GPU_MEMBER)
#undef MSPRINGI_GPU_MEMBER
    cl_device_id device;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    char name[128];
    size_t group_size; ///< most work-items of a group
    uint64_t local_memory;
} mspringi_gpu_device;

/// Set a message, and return the result.
mspring_result mspringi_gpu_fail(mspringi_gpu_message *message, mspring_result result, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/// Return MSPRING_OK if an OpenCL call succeeded. Else set a message with the call, its purpose and the device.
mspring_result mspringi_gpu_check(const mspringi_gpu_device *gpu, mspringi_gpu_message *message, cl_int status,
                                  const char *call, const char *purpose);

/// Load OpenCL, choose a device, and make a context and a queue. On error both are released.
mspring_result mspringi_gpu_open(mspringi_gpu_device *gpu, const char *library, uint32_t number,
                                 mspringi_gpu_message *message);

/// Build the program with these options.
mspring_result mspringi_gpu_build(mspringi_gpu_device *gpu, const char *options, mspringi_gpu_message *message);

/// Release program, queue and context, if they exist.
void mspringi_gpu_close(mspringi_gpu_device *gpu);

#endif
