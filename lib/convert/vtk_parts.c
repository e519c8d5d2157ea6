#include "convert/vtk_parts.h"

#include "convert/sheet.h"

#include <stdlib.h>
#include <string.h>

enum { DETAIL = 1 /* of what is round: 80 triangles a ball */ };

static const enum part part_of[] = { PART_SURFACES, PART_BOUNDARY };
static const char *const path_of[] = { "/VTKHDF/surfaces", "/VTKHDF/boundary" };

/* Columns that say which grain or wall a cell is of; what else a sheet has is in the grains. */
static bool vtk_is_wanted(const struct sheet_column *c)
{
    static const char *const wanted[] = { "id", "kind", "shape", "boundary" };
    bool any = false;
    for (size_t k = 0; c->whole && k < sizeof wanted / sizeof *wanted; k++)
        any |= !strcmp(c->name, wanted[k]);
    return any;
}

static int vtk_make(struct vtkhdf_cells *cells, const struct packing *p, int k, void **made,
                struct failure *failure)
{
    const struct export_frame m = { .packing = p, .detail = DETAIL };
    struct sheet *s = *made = calloc(1, sizeof *s);
    if (!s) return failure_set(failure, EX_SOFTWARE, "no memory for an export");
    if (sheet_of(s, part_of[k], &m, failure)) return failure->status;
    *cells = (struct vtkhdf_cells){ .points = s->points,
                                    .cells = s->cells,
                                    .corners = s->corners,
                                    .x = s->x,
                                    .corner = s->corner,
                                    .end = s->end,
                                    .lines = s->shape == SHEET_LINE };
    for (int i = 0; i < s->columns && cells->columns < VTKHDF_COLUMNS; i++) {
        if (!vtk_is_wanted(&s->column[i])) continue;
        cells->column[cells->columns].name = s->column[i].name;
        cells->column[cells->columns++].value = s->column[i].whole;
    }
    return 0;
}

static void vtk_done(void *made)
{
    if (made) sheet_free(made);
    free(made);
}

const struct vtkhdf_parts vtk_parts = { 2, path_of, vtk_make, vtk_done };
