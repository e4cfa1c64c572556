/* SPDX-License-Identifier: Apache-2.0
 *
 * Launches one OpenCL kernel on every device of this machine and compares what it writes with what
 * it must write, bit for bit.
 *     cc reproduce.c -lOpenCL && ./a.out [PART OF A DEVICE'S NAME]
 * Reads from this folder: kernel.cl, and launch.txt, whose lines are
 *     kernel NAME | options TEXT | numbers float|double|int | global N | local N
 * and the kernel's arguments in their order:
 *     value FILE      passed as it stands
 *     in FILE         a buffer that holds it
 *     out FILE        a buffer of 0xa5 that must hold it in the end
 *     scratch BYTES   a buffer of zeros, not compared
 * Prints a line per device. Returns 1 if one is wrong, 0 if all are right, 2 if there is none. */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { most_arguments = 32, most_devices = 32 };

static struct {
    char what[16];
    unsigned char *bytes;
    size_t size;
} arguments[most_arguments];
static cl_uint argument_count;
static char kernel_name[200], options[4000], numbers[16] = "float";
static size_t global_size = 1, local_size = 1;
static unsigned char *source;
static size_t source_size;

static void check(int ok, const char *what) {
    if (ok) return;
    fprintf(stderr, "reproduce: %s\n", what);
    exit(2);
}

static unsigned char *read_file(const char *name, size_t *size) {
    FILE *file = fopen(name, "rb");
    unsigned char *bytes;
    check(file != NULL, name);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    bytes = malloc(*size + 1);
    check(bytes != NULL && fread(bytes, 1, *size, file) == *size, name);
    fclose(file);
    return bytes;
}

static void read_launch(void) {
    char word[16];
    static char text[4000];
    FILE *file = fopen("launch.txt", "r");
    check(file != NULL, "launch.txt");
    while (fscanf(file, "%15s %3999[^\n]", word, text) == 2) {
        if (!strcmp(word, "kernel")) {
            sprintf(kernel_name, "%.199s", text);
        } else if (!strcmp(word, "options")) {
            strcpy(options, text);
        } else if (!strcmp(word, "numbers")) {
            sprintf(numbers, "%.15s", text);
        } else if (!strcmp(word, "global")) {
            global_size = strtoul(text, NULL, 10);
        } else if (!strcmp(word, "local")) {
            local_size = strtoul(text, NULL, 10);
        } else {
            check(argument_count < most_arguments, "too many arguments");
            strcpy(arguments[argument_count].what, word);
            if (!strcmp(word, "scratch")) {
                arguments[argument_count].size = strtoul(text, NULL, 10);
                arguments[argument_count].bytes = calloc(arguments[argument_count].size, 1);
            } else {
                arguments[argument_count].bytes = read_file(text, &arguments[argument_count].size);
            }
            ++argument_count;
        }
    }
    fclose(file);
}

static double number_at(const unsigned char *bytes) {
    float f;
    double d;
    memcpy(&f, bytes, sizeof f);
    if (strcmp(numbers, "double")) return f;
    memcpy(&d, bytes, sizeof d);
    return d;
}

static void print_number(const unsigned char *bytes) {
    unsigned word;
    memcpy(&word, bytes, sizeof word);
    if (!strcmp(numbers, "int")) {
        printf("%#x", word);
    } else {
        printf("%a", number_at(bytes));
    }
}

/* Whether all numbers have the same bits; all NaNs are equal. */
static int is_right(const char *device, cl_uint k, const unsigned char *got) {
    const unsigned char *expected = arguments[k].bytes;
    const size_t width = strcmp(numbers, "double") ? 4 : 8;
    size_t at, wrong = 0, first = 0;
    for (at = 0; at + width <= arguments[k].size; at += width) {
        const double x = number_at(got + at), y = number_at(expected + at);
        const int both_nan = strcmp(numbers, "int") && x != x && y != y;
        if (both_nan || !memcmp(got + at, expected + at, width)) continue;
        if (wrong++ == 0) first = at;
    }
    if (wrong == 0) return 1;
    printf("%s: WRONG, %zu of %zu numbers of argument %u differ; number %zu: got ", device, wrong,
           arguments[k].size / width, k, first / width);
    print_number(got + first);
    printf(", expected ");
    print_number(expected + first);
    printf("\n");
    return 0;
}

static int run(cl_device_id device, const char *name) {
    cl_int e, built;
    cl_context context = clCreateContext(NULL, 1, &device, NULL, NULL, &e);
    cl_command_queue queue = clCreateCommandQueue(context, device, 0, &e);
    const char *text = (const char *)source;
    cl_program program = clCreateProgramWithSource(context, 1, &text, &source_size, &e);
    cl_mem buffers[most_arguments] = {0};
    cl_kernel kernel;
    cl_uint k;
    int right = 1;
    built = clBuildProgram(program, 1, &device, options, NULL, NULL);
    if (built != CL_SUCCESS) {
        static char log[20000];
        clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, sizeof log - 1, log, NULL);
        printf("%s: WRONG, does not build (%d)\n%s\n", name, built, log);
        return 0;
    }
    kernel = clCreateKernel(program, kernel_name, &e);
    check(e == CL_SUCCESS, "clCreateKernel");
    for (k = 0; k < argument_count; ++k) {
        const size_t size = arguments[k].size;
        if (!strcmp(arguments[k].what, "value")) {
            e = clSetKernelArg(kernel, k, size, arguments[k].bytes);
        } else {
            unsigned char *start = malloc(size + 1);
            check(start != NULL, "out of memory");
            memcpy(start, arguments[k].bytes, size);
            if (!strcmp(arguments[k].what, "out")) memset(start, 0xa5, size);
            buffers[k] = clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                                        size ? size : 1, start, &e);
            check(e == CL_SUCCESS, "clCreateBuffer");
            e = clSetKernelArg(kernel, k, sizeof buffers[k], &buffers[k]);
            free(start);
        }
        check(e == CL_SUCCESS, "clSetKernelArg");
    }
    e = clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &global_size, &local_size, 0, NULL, NULL);
    if (e == CL_INVALID_WORK_GROUP_SIZE) /* this device takes fewer work items per group */
        e = clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &global_size, NULL, 0, NULL, NULL);
    check(e == CL_SUCCESS && clFinish(queue) == CL_SUCCESS, "the kernel cannot be run");
    for (k = 0; k < argument_count; ++k) {
        unsigned char *got;
        if (strcmp(arguments[k].what, "out")) continue;
        got = malloc(arguments[k].size);
        e = clEnqueueReadBuffer(queue, buffers[k], CL_TRUE, 0, arguments[k].size, got, 0, NULL,
                                NULL);
        check(e == CL_SUCCESS, "clEnqueueReadBuffer");
        right &= is_right(name, k, got);
        free(got);
    }
    if (right) printf("%s: right\n", name);
    return right;
}

int main(int argc, char **argv) {
    cl_platform_id platforms[most_devices];
    cl_uint platform_count = 0, p, d, ran = 0;
    int right = 1;
    read_launch();
    source = read_file("kernel.cl", &source_size);
    clGetPlatformIDs(most_devices, platforms, &platform_count);
    for (p = 0; p < platform_count && p < most_devices; ++p) {
        cl_device_id devices[most_devices];
        cl_uint count = 0;
        clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, most_devices, devices, &count);
        for (d = 0; d < count && d < most_devices; ++d) {
            char name[400] = "";
            clGetDeviceInfo(devices[d], CL_DEVICE_NAME, sizeof name - 1, name, NULL);
            if (argc > 1 && !strstr(name, argv[1])) continue;
            right &= run(devices[d], name);
            ++ran;
        }
    }
    check(ran > 0, "no OpenCL device");
    return right ? 0 : 1;
}
