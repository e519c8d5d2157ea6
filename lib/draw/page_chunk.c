#include "draw/page_chunk.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

void chunk_put(struct chunk *b, const void *from, size_t size)
{
    memcpy(b->at + b->n, from, size), b->n += size;
}

void chunk_put_float(struct chunk *b, double x)
{
    float single = (float)x;
    chunk_put(b, &single, sizeof single);
}

void chunk_put_u16(struct chunk *b, int x)
{
    uint16_t number = (uint16_t)x;
    chunk_put(b, &number, sizeof number);
}

int chunk_quantise(double x, double most, int steps)
{
    double k = most > 0 ? x / most * steps : 0;
    return isfinite(k) ? (int)lround(fmin(fmax(k, -steps), steps)) : 0;
}

static void write_base64(FILE *out, const unsigned char *x, size_t n)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < n; i += 3) {
        unsigned b = (unsigned)x[i] << 16 | (i + 1 < n ? (unsigned)x[i + 1] << 8 : 0) |
                     (i + 2 < n ? x[i + 2] : 0);
        char four[4] = { digit[b >> 18], digit[b >> 12 & 63], i + 1 < n ? digit[b >> 6 & 63] : '=',
                         i + 2 < n ? digit[b & 63] : '=' };
        fwrite(four, 1, 4, out);
    }
}

int chunk_write(FILE *out, char letter, int64_t number, const struct chunk *b)
{
    uLongf size = compressBound(b->n);
    unsigned char *packed = malloc(size);
    bool good = packed && compress2(packed, &size, b->at, b->n, 6) == Z_OK;
    if (good) {
        fprintf(out, "<script type=\"text/plain\" id=\"%c%lld\">", letter, (long long)number);
        write_base64(out, packed, size);
        fputs("</script>\n", out);
    }
    free(packed);
    return good ? 0 : -1;
}
