#include "measure/snapshot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Is --tracer a kind of this document? Returns 0 or EX_DATAERR. */
static int check_tracer(const struct packing *p, const char *tracer, struct failure *failure)
{
    char kinds[200];
    size_t at = 0;
    if (!*tracer || !strcmp(tracer, "large")) return 0;
    for (int32_t k = 0; k < p->kinds; k++) {
        if (!strcmp(tracer, p->kind_name[k])) return 0;
        if (at < sizeof kinds)
            at += (size_t)snprintf(kinds + at, sizeof kinds - at, ", %s", p->kind_name[k]);
    }
    return failure_set(failure, EX_DATAERR, "--tracer: no kind '%s' here, but large%s%s", tracer, kinds,
                   at < sizeof kinds ? "" : "...");
}

int snapshot_init(struct snapshot *s, const struct packing *p, const struct contacts *contacts,
                  bool moved, const struct asked *asked, struct failure *failure)
{
    *s = (struct snapshot){
        .p = p, .s = contacts, .moved = moved, .asked = asked, .unconverged = NAN
    };
    region_whole(&s->whole, p);
    s->region = s->whole;
    if (asked->boxed) region_box(&s->region, p, asked->lo, asked->hi);
    if (region_check_images(&s->region, p->n, 0, "--box: it holds", failure) ||
        check_tracer(p, asked->tracer, failure))
        return failure->status;
    return selection_init(&s->only, p, "--only", *asked->only ? asked->only : NULL, failure);
}

void snapshot_free(struct snapshot *s)
{
    selection_free(&s->only);
}

bool snapshot_body(const struct snapshot *s, int64_t i)
{
    return !s->only.bodies || selection_body(&s->only, s->p, i);
}

bool snapshot_wall(const struct snapshot *s, int32_t wall)
{
    return !s->only.walls || selection_wall(&s->only, s->p, wall);
}

bool snapshot_face(const struct snapshot *s, int32_t wall, int32_t face)
{
    return !s->only.walls || selection_face(&s->only, s->p, wall, face);
}

int snapshot_axis(const struct snapshot *s)
{
    const double g[3] = { fabs(s->p->g.x), fabs(s->p->g.y), fabs(s->p->g.z) };
    int axis = s->p->dim == 2 ? 1 : 2;
    if (s->asked->axis >= 0) return s->asked->axis;
    for (int k = 0; k < 3 && k < s->p->dim; k++)
        if (g[k] > g[axis]) axis = k;
    return axis;
}

int snapshot_layers(const struct snapshot *s, struct table *t, layer_function *add,
                    const void *with, struct failure *failure)
{
    const char *reason = NULL;
    int64_t n = s->asked->layers;
    int axis = snapshot_axis(s);
    struct region *layer = calloc((size_t)n + 1, sizeof *layer);
    if (!layer) return failure_set(failure, EX_SOFTWARE, "no memory for layers");
    if (axis == 3)
        region_shells(layer, n, &s->region, s->p, s->asked->point, &reason);
    else if (axis < s->p->dim)
        region_layers(layer, n, &s->region, s->p, axis, &reason);
    else
        reason = "in the plane there are no layers along z";
    if (reason) table_null(t, "%s", reason);
    for (int64_t i = 0; !reason && i < n; i++) {
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, axis == 3 ? layer[i].inner : layer[i].lo[axis]);
        put(&at, axis == 3 ? layer[i].outer : layer[i].hi[axis]);
        add(t, s, &layer[i], at, with);
    }
    free(layer);
    return failure->status;
}
