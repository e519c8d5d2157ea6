/*
 * base/nearest.h: for messages about a name that does not exist: the name among those that exist that is most like it.
 */
#pragma once

#include <stddef.h>

/* Begins as { 0 }; name: NULL while none is near */
struct nearest {
    const char *name;
    int distance;
};

/* Compares a name with the n bytes of the one that was asked for: no more than two letters are to be left out, put in, changed or
   swapped with the next, and one alone where the name has fewer than five. Of several, the first of the nearest stays. */
void nearest_look(struct nearest *near, const char *asked, size_t n, const char *name);
