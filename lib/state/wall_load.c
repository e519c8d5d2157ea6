#include "state/wall_load.h"

#include "state/fields.h"
#include "state/wall_faces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void sums_forget_faces(struct wall_sums *s)
{
    if (s->faces) wall_faces_free(s->faces);
    free(s->faces);
    s->faces = NULL;
}

void sums_free(struct wall_sums *s)
{
    sums_forget_faces(s);
    free(s->face);
    *s = (struct wall_sums){ 0 };
}

static int alloc(struct wall_sums *s, int32_t n, struct failure *failure)
{
    s->face = calloc((size_t)n + 1, sizeof *s->face);
    if (!s->face) return failure_set(failure, EX_SOFTWARE, "no memory for the sums of %d faces", n);
    s->n = n;
    return 0;
}

int sums_begin(struct wall_sums *s, int32_t walls, const struct wall *wall, double t,
               struct failure *failure)
{
    struct wall_faces f;
    sums_free(s);
    if (wall_faces_init(&f, walls, wall, NULL, failure)) return failure->status;
    const int32_t n = f.n;
    wall_faces_free(&f);
    s->since = t;
    if (!n)
        return failure_set(failure, EX_DATAERR, "there are no walls, of which sums could be kept");
    return alloc(s, n, failure);
}

int sums_copy(struct wall_sums *to, const struct wall_sums *from, struct failure *failure)
{
    *to = (struct wall_sums){ .since = from->since };
    if (!from->n) return 0;
    if (alloc(to, from->n, failure)) return failure->status;
    memcpy(to->face, from->face, (size_t)from->n * sizeof *to->face);
    return 0;
}

int sums_check(const struct wall_sums *s, int32_t walls, const struct wall *wall,
               struct failure *failure)
{
    struct wall_faces f;
    if (!s->n) return 0;
    if (wall_faces_init(&f, walls, wall, NULL, failure)) return failure->status;
    if (f.n != s->n || !isfinite(s->since))
        failure_set(failure, EX_DATAERR, "sums of %d faces, and the walls have %d", s->n, f.n);
    if (!failure->status)
        records_check(RECORDS(sum_fields, s->n, s->face), "sums of face", failure);
    wall_faces_free(&f);
    return failure->status;
}
