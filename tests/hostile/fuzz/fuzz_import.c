/*
 * Packings of other programs as text: bytes as the readers of LAMMPS' data files and dumps and of Yade's tables get
 * them; the first byte of the input says the dimension, the frame and what repeats.
 */
#include "convert/import_file.h"
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct packing p = { 0 };
    struct failure failure = { 0 };
    if (size < 1) return -1;
    const struct import_wish wish = { .dim = data[0] & 1 ? 2 : 3,
                                      .frame = (data[0] >> 1 & 3) - 1,
                                      .has_repeats = data[0] & 8,
                                      .repeats = { true, data[0] & 16, data[0] & 32 } };
    char *text = malloc(size); // one byte less, and a zero: none is behind it
    if (!text) abort();
    memcpy(text, data + 1, size - 1), text[size - 1] = 0;
    int e = import_bytes(&p, "f", text, (int64_t)size - 1, &wish, &failure);
    free(text);
    if (e && (!failure.status || !failure.text[0] || strchr(failure.text, '\n'))) abort();
    if (!e && packing_check(&p, &failure)) abort();
    if (!e) packing_free(&p);
    return 0;
}
