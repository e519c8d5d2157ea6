/* state/bond.c: the list of what lasts of pairs [state/bond.h]. */
#include "state/bond.h"

#include "base/array.h"
#include "state/fields.h"

#include <stdlib.h>
#include <string.h>

void bonds_free(struct bonds *s)
{
    free(s->bond);
    *s = (struct bonds){ 0 };
}

struct bond *bonds_add(struct bonds *s, const struct bond *bond)
{
    if (!array_grow(&s->bond, &s->room, s->n + 1, sizeof *s->bond)) return NULL;
    s->bond[s->n] = *bond;
    return &s->bond[s->n++];
}

static int compare_bonds(const void *x, const void *y)
{
    return contact_key_order(bond_key(x), bond_key(y));
}

void bonds_sort(struct bonds *s)
{
    int64_t i = 1; // mostly they are sorted
    while (i < s->n && compare_bonds(&s->bond[i - 1], &s->bond[i]) <= 0) i++;
    if (i < s->n) qsort(s->bond, (size_t)s->n, sizeof *s->bond, compare_bonds);
}

const struct bond *bonds_find(const struct bonds *s, const struct contact *c, int64_t *from)
{
    const struct contact_key key = contact_key(c);
    int order = -1;
    while (*from < s->n && (order = contact_key_order(bond_key(&s->bond[*from]), key)) < 0) ++*from;
    return *from < s->n && order == 0 ? &s->bond[*from] : NULL;
}

bool bonds_broken(const struct bonds *s, int32_t a, int32_t b, int64_t from)
{
    for (int64_t i = from; i < s->n && s->bond[i].a <= a; i++) {
        const struct bond *x = &s->bond[i];
        if (x->a == a && x->b > b) break;
        if (x->a == a && x->b == b && bond_anchored(x) && !(x->beta > 0)) return true;
    }
    return false;
}

static const char *bond_trouble(const struct bond *x, int dim, int64_t bodies, int32_t walls)
{
    if (x->b < 0 || x->b >= bodies || x->a >= bodies || x->a < -walls || x->a == x->b)
        return "no such bodies";
    if (!(x->wet >= 0 && x->wet <= BOND_WETTED)) return "is neither wet nor dry";
    if (!(x->pressed == 0 || x->pressed == 1)) return "pushes or not: 1 or 0";
    if (!(x->rest <= 0 && isfinite(x->rest))) return "the gap of its spring must not be positive";
    if (!bond_anchored(x)) return NULL;
    if (!v3_finite(x->at_a) || !v3_finite(x->at_b)) return "its place is not finite";
    if (!(fabs(v3_dot(x->axis, x->axis) - 1) < 1e-6)) return "its axis is not a unit vector";
    if (dim == 2 && (x->at_a.z != 0 || x->at_b.z != 0 || x->axis.z != 0))
        return "its place or axis leaves the plane, and dim is 2";
    if (x->feature >= 0) return "keeps a place, and has the key of a contact that does not";
    return NULL;
}

int bonds_check(const struct bonds *s, int dim, int64_t bodies, int32_t walls,
                struct failure *failure)
{
    if (records_check(RECORDS(bond_fields, s->n, s->bond), "bond", failure)) return failure->status;
    for (int64_t i = 0; i < s->n; i++) {
        const struct bond *x = &s->bond[i];
        const char *trouble = bond_trouble(x, dim, bodies, walls);
        if (trouble)
            return failure_set(failure, EX_DATAERR, "bond %lld: %s", (long long)i, trouble);
        if (i && compare_bonds(x - 1, x) >= 0)
            return failure_set(failure, EX_DATAERR, "bond %lld: not sorted by its bodies, or twice",
                               (long long)i);
    }
    return 0;
}
