#include "hdf5/crc.h"

#include <zlib.h>

#ifdef __x86_64__
#include <immintrin.h>
#include <stdbool.h>

/*
 * Gopal et al., "Fast CRC Computation for Generic Polynomials Using PCLMULQDQ Instruction", Intel 2009: the
 * bytes are a polynomial over GF(2), bits in reflected order, of which the remainder by P is wanted. 128 bits
 * a x^64 + b are moved on by d bits as a (x^(64+d) mod P) + b (x^d mod P), a product each, and added to those
 * there. The constants are these remainders, for d = 512 and 128, then 96 and 64 bits; last, P and 1 / P.
 */
static const uint64_t by_512[2] = { 0x154442bd4, 0x1c6e41596 },
                      by_128[2] = { 0x1751997d0, 0x0ccaa009e }, by_64[2] = { 0x163cd6124, 0 },
                      reduce[2] = { 0x1db710641, 0x1f7011641 };

#define CLMUL __attribute__((target("pclmul,sse4.1")))

static inline CLMUL __m128i load(const void *p)
{
    return _mm_loadu_si128((const __m128i *)p);
}

/* x moved on by what `by` is for, and added to y */
static inline CLMUL __m128i fold(__m128i x, __m128i by, __m128i y)
{
    __m128i low = _mm_clmulepi64_si128(x, by, 0x00), high = _mm_clmulepi64_si128(x, by, 0x11);
    return _mm_xor_si128(_mm_xor_si128(low, high), y);
}

/* From 64 bytes, a multiple of 16; crc without the complement that zlib's begins and ends with. */
static CLMUL uint32_t fold_all(uint32_t crc, const unsigned char *p, size_t size)
{
    __m128i x[4], by = load(by_512), half = _mm_setr_epi32(~0, 0, ~0, 0);
    for (int k = 0; k < 4; k++) x[k] = load(p + 16 * k);
    x[0] = _mm_xor_si128(x[0], _mm_cvtsi32_si128((int)crc));
    for (p += 64, size -= 64; size >= 64; p += 64, size -= 64) {
        x[0] = fold(x[0], by, load(p)); // four chains: a product takes several clocks
        x[1] = fold(x[1], by, load(p + 16));
        x[2] = fold(x[2], by, load(p + 32));
        x[3] = fold(x[3], by, load(p + 48));
    }
    by = load(by_128);
    __m128i y = fold(fold(fold(x[0], by, x[1]), by, x[2]), by, x[3]), z;
    for (; size; p += 16, size -= 16) y = fold(y, by, load(p));
    // 128 bits to 64, and these to 32 [Gopal's figures 10 and 12]
    y = _mm_xor_si128(_mm_srli_si128(y, 8), _mm_clmulepi64_si128(y, by, 0x10));
    z = _mm_srli_si128(y, 4);
    y = _mm_xor_si128(_mm_clmulepi64_si128(_mm_and_si128(y, half), load(by_64), 0x00), z);
    by = load(reduce);
    z = _mm_and_si128(_mm_clmulepi64_si128(_mm_and_si128(y, half), by, 0x10), half);
    y = _mm_xor_si128(y, _mm_clmulepi64_si128(z, by, 0x00));
    return (uint32_t)_mm_extract_epi32(y, 1);
}

uint32_t document_crc(uint32_t crc, const void *bytes, size_t size)
{
    size_t most = size & ~(size_t)15;
    bool can = __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("sse4.1");
    if (!can || size < 64) return (uint32_t)crc32_z(crc, bytes, size);
    crc = ~fold_all(~crc, bytes, most);
    return (uint32_t)crc32_z(crc, (const unsigned char *)bytes + most, size - most);
}
#else
uint32_t document_crc(uint32_t crc, const void *bytes, size_t size)
{
    return (uint32_t)crc32_z(crc, bytes, size);
}
#endif
