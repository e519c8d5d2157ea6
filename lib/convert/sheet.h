/*
 * convert/sheet.h: a part of a moment as points, cells over them, and named columns of numbers: what
 * the formats of VTK and tables of text have in common.
 */
#pragma once

#include "base/failure.h"
#include "convert/format.h"

enum { SHEET_COLUMNS = 24 };

/* What a cell is, by VTK's numbers */
enum sheet_cell { SHEET_POINT = 1, SHEET_LINE = 3, SHEET_POLYGON = 7 };

struct sheet_column {
    const char *name;
    const char *suffix; /* of its components in a table of text, a character each; "" for one */
    int width;          /* numbers in a row */
    double *real;       /* [rows][width]; or NULL, and */
    int32_t *whole;     /* [rows][width] */
};

struct sheet {
    int64_t points, cells, corners, room; /* room: of points, cells and corners each */
    vec3 *x;                              /* [points] m */
    enum sheet_cell shape;                /* of all cells */
    int64_t *corner;                      /* [corners] the points of all cells, one after another */
    int64_t *end;                         /* [cells] one past a cell's last in corner[] */
    bool of_points;                       /* a row of the columns is a point; else a cell */
    int columns;
    struct sheet_column column[SHEET_COLUMNS];
};

/* s = a part of a moment, of as many cells as there are such things that are wanted. Returns 0 or EX_SOFTWARE. */
int sheet_of(struct sheet *s, enum part part, const struct export_frame *m,
             struct failure *failure);
void sheet_free(struct sheet *s);

static inline int64_t sheet_rows(const struct sheet *s)
{
    return s->of_points ? s->points : s->cells;
}

/* ---- for those who fill one: sheet.c, sheet_walls.c ---- */

int sheet_walls(struct sheet *s, const struct export_frame *m, struct failure *failure);

/* One cell more, of these corners. */
int sheet_add(struct sheet *s, int corners, const vec3 *x, struct failure *failure);
/*
 * A column for all rows that there are: memory for its numbers, all zero, or NULL (EX_SOFTWARE).
 * Columns are added when the cells are there.
 */
double *sheet_real(struct sheet *s, const char *name, const char *suffix, struct failure *failure);
int32_t *sheet_whole(struct sheet *s, const char *name, const char *suffix,
                     struct failure *failure);
