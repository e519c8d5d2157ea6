/* base/array.c: two sorted runs become one. */
#include "base/array.h"

/* Where the run that begins at `from` ends */
static int64_t array_run(const char *row, int64_t from, int64_t n, size_t size,
                         int (*order)(const void *, const void *))
{
    int64_t i = from + 1;
    while (i < n && order(row + (size_t)(i - 1) * size, row + (size_t)i * size) <= 0) i++;
    return i < n ? i : n;
}

void array_sort(void *array, int64_t n, size_t size, int (*order)(const void *, const void *))
{
    char *const row = array, *second;
    int64_t i = array_run(row, 0, n, size, order), j = n - i, k = n;
    if (i >= n) return;
    second = array_run(row, i, n, size, order) == n ? malloc((size_t)j * size) : NULL;
    if (!second) {
        qsort(row, (size_t)n, size, order);
        return;
    }
    memcpy(second, row + (size_t)i * size, (size_t)j * size);
    while (j > 0) {
        const char *a = row + (size_t)(i - 1) * size, *b = second + (size_t)(j - 1) * size;
        const bool first = i > 0 && order(a, b) > 0;
        memcpy(row + (size_t)--k * size, first ? a : b, size);
        i -= first, j -= !first;
    }
    free(second);
}
