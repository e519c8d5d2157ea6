/* draw/page_chunk.h: numbers as the page has them: small, packed by zlib, in base64. */
#ifndef NSD_PAGE_CHUNK_H
#define NSD_PAGE_CHUNK_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Numbers one after another, in memory that is large enough for all of them */
struct chunk {
    unsigned char *at;
    size_t n; /* bytes so far */
};

void chunk_put(struct chunk *b, const void *from, size_t size);
void chunk_put_float(struct chunk *b, double x);
void chunk_put_u16(struct chunk *b, int x);

/* x in [-most, most] as a whole number of [-steps, steps]; 0 where it is no number */
int chunk_quantise(double x, double most, int steps);

/* As the script element with the id letter, number; -1: no memory */
int chunk_write(FILE *out, char letter, int64_t number, const struct chunk *b);

#endif
