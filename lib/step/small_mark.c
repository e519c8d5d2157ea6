/* step/small_mark.c: the bundles of hot bodies [step/small_list.h]. */
#include "step/small_list.h"

#include <stdlib.h>

void small_marks_free(struct small *s)
{
    free(s->mark), free(s->meets), free(s->first);
    s->mark = NULL, s->meets = s->first = NULL;
}

/* s->first[i + 2] counts the bundles of body i; lanes without a pair have bodies beyond the last. */
static void count_bundles(struct small *s)
{
    for (int64_t i = 0; i < s->bundles; i++)
        for (int k = 0; k < BUNDLE; k++) {
            const int64_t a = body_index(s->bundle[i].a[k]), b = body_index(s->bundle[i].b[k]);
            if (a < s->bodies) s->first[a + 2]++, s->first[b + 2]++;
        }
}

static void list_bundles(struct small *s)
{
    for (int64_t i = 0; i < s->bundles; i++)
        for (int k = 0; k < BUNDLE; k++) {
            const int64_t a = body_index(s->bundle[i].a[k]), b = body_index(s->bundle[i].b[k]);
            if (a >= s->bodies) continue;
            s->meets[s->first[a + 1]++] = i, s->meets[s->first[b + 1]++] = i;
        }
}

void small_marks_make(struct small *s)
{
    s->mark = calloc((size_t)s->bundles + 1, sizeof *s->mark);
    s->first = calloc((size_t)s->bodies + 3, sizeof *s->first);
    s->meets = malloc((size_t)(2 * BUNDLE * s->bundles + 1) * sizeof *s->meets);
    if (!s->mark || !s->first || !s->meets) {
        small_marks_free(s);
        return;
    }
    count_bundles(s);
    for (int64_t i = 0; i < s->bodies; i++) s->first[i + 2] += s->first[i + 1];
    list_bundles(s);
}

void small_marks_begin(struct small *s, int64_t first, int64_t end)
{
    for (int64_t i = first; s->mark && i < end; i++)
        if (s->hot[i] >= s->sweep - 1) small_mark_bundles(s, i);
}
