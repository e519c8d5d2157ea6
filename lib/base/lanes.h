/*
 * base/lanes.h: arithmetic on LANES numbers at once. Code written with vd (numbers) and vm (masks)
 * is one text for one lane and for many. Each lane gets the same bits as it would alone, because
 * only IEEE operations are used, lane by lane.
 *
 * LANES is 1, plain double, unless the Makefile compiles a file for a width: 2 any machine, 4 AVX2,
 * 8 AVX-512. Branches become masks: both sides are computed, pick() takes one.
 */
#ifndef NSD_LANES_H
#define NSD_LANES_H

#ifndef LANES
#define LANES 1
#endif

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#if LANES > 1 && defined __x86_64__
#include <immintrin.h>
#endif

#ifdef NSD_COVERAGE // a branch counts once, not once for each place that it is inlined into
#define ALWAYS_INLINE static inline
#else
#define ALWAYS_INLINE __attribute__((always_inline)) static inline
#endif

#ifndef GLOBAL
#define GLOBAL /* of a pointer: into the memory that all of a device's kernels see */
#endif

#if LANES == 1
typedef double vd, vd_anywhere;
typedef int64_t vm; /* 0 or -1 */
#else
typedef double vd __attribute__((vector_size(8 * LANES)));
typedef double vd_anywhere __attribute__((vector_size(8 * LANES), may_alias, aligned(8)));
#if LANES == 8
typedef __mmask8 vm;
#else
typedef int64_t vm __attribute__((vector_size(8 * LANES)));
#endif
#endif

#define NONE ((vm){ 0 }) /* no lane */

/* On a device they are macros, for pointers into each of its memories [solve/opencl/begin.cl]. */
#ifndef vload
ALWAYS_INLINE vd vload(const double *x)
{
    return *(const vd_anywhere *)x;
}
ALWAYS_INLINE void vstore(double *x, vd a)
{
    *(vd_anywhere *)x = a;
}
#endif
ALWAYS_INLINE vd splat(double a)
{
#if LANES == 1
    return a;
#else
    return a - (vd){ 0 };
#endif
}

/* a < b, a <= b: false where either is not a number */
ALWAYS_INLINE vm lt(vd a, vd b)
{
#if LANES == 8
    return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
#elif LANES == 1
    return -(vm)(a < b);
#else
    return a < b;
#endif
}
ALWAYS_INLINE vm le(vd a, vd b)
{
#if LANES == 8
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
#elif LANES == 1
    return -(vm)(a <= b);
#else
    return a <= b;
#endif
}

ALWAYS_INLINE bool any(vm m)
{
#if LANES == 8 || LANES == 1
    return m != 0;
#elif defined __AVX__ && LANES == 4
    return _mm256_movemask_pd((__m256d)m);
#elif defined __SSE2__ && LANES == 2
    return _mm_movemask_pd((__m128d)m);
#else
    int64_t some = 0;
    for (int i = 0; i < LANES; i++) some |= m[i];
    return some;
#endif
}

ALWAYS_INLINE bool all(vm m)
{
#if LANES == 8
    return m == 0xff;
#elif defined __AVX__ && LANES == 4
    return _mm256_movemask_pd((__m256d)m) == 15;
#else
    return !any(~m);
#endif
}

/* m ? a : b */
ALWAYS_INLINE vd pick(vm m, vd a, vd b)
{
#if LANES == 8
    return _mm512_mask_blend_pd(m, b, a);
#elif LANES == 1
    return m ? a : b;
#elif defined __AVX__ && LANES == 4
    return _mm256_blendv_pd(b, a, (__m256d)m);
#else
    return (vd)((m & (vm)a) | (~m & (vm)b));
#endif
}

ALWAYS_INLINE vd root(vd a)
{
#if LANES == 8
    return _mm512_sqrt_pd(a);
#elif LANES == 1
    return sqrt(a);
#elif defined __AVX__ && LANES == 4
    return _mm256_sqrt_pd(a);
#elif defined __SSE2__ && LANES == 2
    return _mm_sqrt_pd(a);
#else
    for (int i = 0; i < LANES; i++) a[i] = sqrt(a[i]);
    return a;
#endif
}

/* The larger; b where either is not a number */
ALWAYS_INLINE vd larger(vd a, vd b)
{
#if LANES == 8
    return _mm512_max_pd(a, b);
#elif defined __AVX__ && LANES == 4
    return _mm256_max_pd(a, b);
#else
    return pick(lt(b, a), a, b);
#endif
}

ALWAYS_INLINE vd absolute(vd a)
{
#if LANES == 8
    return _mm512_abs_pd(a);
#elif LANES == 1
    return fabs(a);
#else
    return (vd)((vm)a & INT64_MAX);
#endif
}

/* |a| with the sign of s */
ALWAYS_INLINE vd with_sign(vd a, vd s)
{
#if LANES == 1
    return copysign(a, s);
#elif LANES == 8
    const __m512d bit = _mm512_set1_pd(-0.0);
    return _mm512_or_pd(_mm512_and_pd(s, bit), _mm512_andnot_pd(bit, a));
#else
    return (vd)(((vm)a & INT64_MAX) | ((vm)s & INT64_MIN));
#endif
}

ALWAYS_INLINE vm is_finite(vd a)
{
    return lt(absolute(a), splat(INFINITY));
}

/*
 * Computes *a here, in its place among others that are pinned. Compilers move what they compute to where
 * it is used, and of two transpositions that they mix more is live than there are registers.
 */
ALWAYS_INLINE void pin(vd *a)
{
#if LANES > 1 && LANES < 8 && defined __x86_64__
    __asm__ volatile("" : "+x"(*a));
#else
    (void)a;
#endif
}

/*
 * transpose() exchanges x[i][j] and x[j][i] in stages of EXCHANGE, which makes two vectors of two:
 * low and high list their lanes, counted through both. Machines have instructions for these lists.
 */
#define EXCHANGE(x, i, j, low, high)                                                               \
    do {                                                                                           \
        vd a = (x)[i], b = (x)[j];                                                                 \
        (x)[i] = __builtin_shufflevector(a, b, low);                                               \
        (x)[j] = __builtin_shufflevector(a, b, high);                                              \
    } while (0)
#define LIST(...) __VA_ARGS__

ALWAYS_INLINE void transpose(vd x[LANES])
{
    (void)x;
#if LANES == 2
    EXCHANGE(x, 0, 1, LIST(0, 2), LIST(1, 3));
#elif LANES == 4
    for (int i = 0; i < 4; i += 2) EXCHANGE(x, i, i + 1, LIST(0, 4, 2, 6), LIST(1, 5, 3, 7));
    for (int i = 0; i < 2; i++) EXCHANGE(x, i, i + 2, LIST(0, 1, 4, 5), LIST(2, 3, 6, 7));
#elif LANES == 8
    for (int i = 0; i < 8; i += 2)
        EXCHANGE(x, i, i + 1, LIST(0, 8, 2, 10, 4, 12, 6, 14), LIST(1, 9, 3, 11, 5, 13, 7, 15));
    for (int i = 0; i < 8; i += 4)
        for (int j = i; j < i + 2; j++)
            EXCHANGE(x, j, j + 2, LIST(0, 1, 2, 3, 8, 9, 10, 11), LIST(4, 5, 6, 7, 12, 13, 14, 15));
    for (int i = 0; i < 4; i++)
        EXCHANGE(x, i, i + 4, LIST(0, 1, 4, 5, 8, 9, 12, 13), LIST(2, 3, 6, 7, 10, 11, 14, 15));
    for (int i = 2; i < 4; i++) {
        vd a = x[i];
        x[i] = x[i + 2], x[i + 2] = a;
    }
#endif
}

#endif
