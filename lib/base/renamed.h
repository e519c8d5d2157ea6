/*
 * base/renamed.h: old names that users wrote, and what they are called now: options of tools and of nsd_set(), and
 * keys of scenes. One table for all, so that an old name is refused with the new one.
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct renamed {
    const char *
        in; /* with blanks between: tools; "nsd_set"; "nsd_read": its arrays; "answer": keys of what a program in the loop answers; "column": of tables of grains; "scene"; "document": the options of a solve, which keep their old names there; "surface", "part": values of this option; "measure" and "quantity": of nsd-stat, printed under the name that was asked for */
    const char *was, *is; /* without dashes */
    bool accepted; /* the old name still works: it stands in scenes and scripts that others keep */
};

/* The row of the n bytes of a name in a tool, "nsd_set", "scene" or "document"; NULL: it was never renamed */
const struct renamed *renamed_find(const char *in, const char *was, size_t n);
/* The same of an option that there is no more: what to do instead; NULL: there was none */
const char *gone_find(const char *in, const char *was, size_t n);
/* Row k of the table; NULL past the last */
const struct renamed *renamed_at(int k);
/* Are these n bytes among words with blanks between? */
bool words_have(const char *words, const char *word, size_t n);
