#include "scene/scene_parts.h"

#include <stdlib.h>
#include <string.h>

/* The drives of a wall again, of the last wall */
static int copy_drives(struct scene *s, struct wall *w, struct failure *failure)
{
    const int32_t first = w->first_drive, n = w->drives;
    struct drives *d = &s->drives;
    w->first_drive = d->n;
    if (!n) return 0;
    struct drive *more = realloc(d->drive, (size_t)(d->n + n) * sizeof *more);
    if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for the drives");
    d->drive = more;
    for (int32_t k = 0; k < n; k++) {
        d->drive[d->n] = d->drive[first + k];
        d->drive[d->n++].boundary = s->walls;
    }
    return 0;
}

/* Makes room for one more wall. */
static int surface_parts_grow(struct scene *s, struct failure *failure)
{
    const size_t n = (size_t)s->walls + 1;
    struct wall *wall = realloc(s->wall, n * sizeof *wall);
    if (wall) s->wall = wall;
    int32_t *item = wall ? realloc(s->wall_item, n * sizeof *item) : NULL;
    if (item) s->wall_item = item;
    return item ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the parts of a surface");
}

/* Which part each of the wall's elements is of, -1: none */
static int name_parts(int32_t *of, const struct scene *s, int32_t w, struct failure *failure)
{
    const int32_t n = s->wall[w].elements;
    for (int32_t e = 0; e < n; e++) of[e] = -1;
    for (int32_t k = 0; k < s->parts; k++) {
        const struct scene_part *part = &s->part[k];
        if (part->wall != w) continue;
        if (part->last >= n)
            return failure_set(failure, EX_DATAERR,
                           "walls[%d].materials: no face %lld: the surface has %d, from 0 on",
                           s->wall_item[w], (long long)part->last, n);
        for (int64_t e = part->first; e <= part->last; e++) {
            if (of[e] >= 0)
                return failure_set(failure, EX_DATAERR, "walls[%d].materials: face %lld is named twice",
                               s->wall_item[w], (long long)e);
            of[e] = k;
        }
    }
    return 0;
}

/* The elements of part k become those of a new wall; *at, where they lie. */
static int surface_parts_add_part(struct scene *s, int32_t k, int32_t first, int32_t n, struct failure *failure)
{
    const struct scene_part *part = &s->part[k];
    struct wall w = s->wall[part->wall];
    if (surface_parts_grow(s, failure) || copy_drives(s, &w, failure)) return failure->status;
    w.kind = part->kind, w.belt = part->belt, w.first_element = first, w.elements = n;
    s->wall_item[s->walls] = s->wall_item[part->wall];
    s->wall[s->walls++] = w;
    return 0;
}

/* Sorts the elements of wall w by parts, those of none first, and makes walls of the parts. */
static int split(struct scene *s, int32_t w, struct failure *failure)
{
    const int32_t first = s->wall[w].first_element, n = s->wall[w].elements;
    int32_t *of = malloc(((size_t)n + 1) * sizeof *of);
    int32_t(*had)[3] = malloc(((size_t)n + 1) * sizeof *had);
    if (!of || !had) failure_set(failure, EX_SOFTWARE, "no memory for the parts of a surface");
    if (!failure->status && !name_parts(of, s, w, failure)) {
        int32_t at = 0;
        if (n) memcpy(had, s->mesh.element + first, (size_t)n * sizeof *had);
        for (int32_t k = -1; k < s->parts && !failure->status; k++) {
            const int32_t from = at;
            if (k >= 0 && s->part[k].wall != w) continue;
            for (int32_t e = 0; e < n; e++)
                if (of[e] == k) memcpy(s->mesh.element[first + at++], had[e], sizeof *had);
            if (k < 0)
                s->wall[w].elements = at;
            else if (!s->wall[w].elements) // all are of parts: the surface is the first of them
                s->wall[w].kind = s->part[k].kind, s->wall[w].belt = s->part[k].belt,
                s->wall[w].elements = at;
            else
                surface_parts_add_part(s, k, first + from, at - from, failure);
        }
    }
    free(of), free(had);
    return failure->status;
}

int scene_parts_split(struct scene *s, struct failure *failure)
{
    const int32_t walls = s->walls;
    for (int32_t k = 0; k < s->parts && !failure->status; k++)
        if (s->part[k].wall < walls && (!k || s->part[k].wall != s->part[k - 1].wall))
            split(s, s->part[k].wall, failure);
    return failure->status;
}
