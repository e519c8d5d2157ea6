/*
 * solve/opencl/begin.cl: what lets OpenCL C 1.2 read base/lanes.h, law/local*.h and solve/bundle.h, which come
 * next in the text that the driver compiles, then opencl/kernels.cl [solve/opencl_api.h].
 *
 * A work-item is one slot: LANES is 1. Contraction is off, and + - * / and sqrt of doubles are rounded correctly
 * [OpenCL C 1.2, table 7.2], so each slot gets the bits that it gets on the CPU.
 */
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

#define ON_DEVICE
#define LANES  1
#define GLOBAL __global
#ifndef NULL
#define NULL 0
#endif

typedef int int32_t;
typedef long int64_t;
#define INT32_MAX 2147483647

/* Pointers into private and into global memory have types of their own. */
#undef vload
#undef vstore
#define vload(x)     (*(x))
#define vstore(x, a) (*(x) = (a))

/* Names that OpenCL C has for something else */
#undef any
#undef all
#define local local_problem
#define any   any_lane
#define all   all_lanes

/* What exact_search() of solve/local_exact.c is asked, and what it has answered: it runs on the CPU. */
struct search {
    int asked, answered, found, singular;
    double r[3]; /* out, of the answer */
};
