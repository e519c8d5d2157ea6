/* base/array.h: arrays that grow, and are sorted. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { ARRAY_MORE = 64 }; /* rows, beside half of what there are */

/* Room for at least so many rows of `size` bytes; array: where the pointer to them is. False: no memory, and nothing has
   changed. */
static inline bool array_grow(void *array, int64_t *room, int64_t least, size_t size)
{
    const int64_t more = *room + *room / 2 + ARRAY_MORE, wanted = least > more ? least : more;
    void *rows;
    if (least <= *room) return true;
    memcpy(&rows, array, sizeof rows);
    void *grown = realloc(rows, (size_t)wanted * size);
    if (!grown) return false;
    memcpy(array, &grown, sizeof grown);
    *room = wanted;
    return true; // cppcheck-suppress memleak ; the caller's pointer has it
}

/* As qsort(), of rows that differ; fast where two runs, one after the other, are sorted */
void array_sort(void *array, int64_t n, size_t size, int (*order)(const void *, const void *));
