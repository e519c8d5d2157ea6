/*
 * convert/imported.h: what a file of another program says of its balls, in plain numbers: a head and a row for
 * each. It is read by a process of its own [base/bounded.h], and checked again before it is a packing.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"
#include "scene/mesh_file.h"

#include <stdbool.h>
#include <stdint.h>

struct imported_head {
    int64_t n, step; /* balls; the file's own count of steps */
    bool boxed;      /* it has a box, */
    bool says;       /* and says along which edges that is periodic: */
    bool repeats[3];
    vec3 origin, edge[3]; /* m */
};

struct imported_ball {
    vec3 x, v, w; /* m, m/s, rad/s */
    quat q;
    double radius;        /* m */
    double mass, density; /* kg, kg/m^3; 0: not said */
    int32_t type, id;     /* as the file counts them; id -1: not said */
};

/* While it is read */
struct imported {
    struct imported_head head;
    const struct import_units *units; /* that the file names; NULL: SI [convert/imported.h] */
    int64_t room;
    struct imported_ball *ball; /* [head.n] */
};

enum { IMPORTED_MOST = 1 << 27 }; /* balls */

/* One more ball. Returns 0 or EX_SOFTWARE. */
int imported_add(struct imported *to, const struct imported_ball *ball, struct failure *failure);
void imported_free(struct imported *it);

/*
 * The formats of packings of other programs, a table. A new one is a file as import_yade.c is,
 * its extern here and its row in import_file.c.
 */

struct import_format {
    const char *name;
    /* Do n bytes begin as a file of this format? Behind them there is a 0. */
    bool (*looks)(const char *bytes, int64_t n);
    /* Reads frame k, from 0, or from the end: -1 is the last. Returns 0 or the status of a fault, which
       names the line. */
    int (*read)(struct imported *to, struct words *w, int64_t k);
};

extern const struct import_format import_lammps_dump, import_lammps_data, import_yade_text;

/* ---- what they share: import_columns.c ---- */

/* What a column of text can be; the rest is read over */
enum import_column {
    IMPORT_X,
    IMPORT_Y,
    IMPORT_Z,
    IMPORT_XS, /* in edges of the box */
    IMPORT_YS,
    IMPORT_ZS,
    IMPORT_VX,
    IMPORT_VY,
    IMPORT_VZ,
    IMPORT_WX,
    IMPORT_WY,
    IMPORT_WZ,
    IMPORT_QW,
    IMPORT_QX,
    IMPORT_QY,
    IMPORT_QZ,
    IMPORT_RADIUS,
    IMPORT_DIAMETER,
    IMPORT_MASS,
    IMPORT_DENSITY,
    IMPORT_TYPE,
    IMPORT_ID,
    IMPORT_SHAPEX, /* of a superquadric or an ellipsoid: */
    IMPORT_SHAPEY, /* half axes, or axes */
    IMPORT_SHAPEZ,
    IMPORT_BLOCKINESS1, /* and exponents, of an ellipsoid 2 */
    IMPORT_BLOCKINESS2,
    IMPORT_MULTISPHERE, /* the clump that it is a part of; < 0: of none */
    IMPORT_COLUMNS,
    IMPORT_OTHER = IMPORT_COLUMNS
};

enum { IMPORT_COLUMNS_MOST = 256 }; /* of a line */

struct import_columns {
    int n;
    enum import_column of[IMPORT_COLUMNS_MOST];
    bool has[IMPORT_COLUMNS + 1];
};

/* By the names that LAMMPS, LIGGGHTS and Yade's users give them; a column may come twice, if each line has the same number
   in both. A fault: too many. */
int import_name_column(struct import_columns *c, struct words *w, struct word name);
int import_add_column(struct import_columns *c, struct words *w, enum import_column column);
/* Are there a place and a size? cure: what the other program has to write */
int import_check_columns(const struct import_columns *c, struct words *w, const char *cure);
/* A line of these columns as a ball; places in edges need the head's box. A fault, too: the grain is no ball. */
int import_line(const struct import_columns *c, struct words *w, const struct imported_head *head,
                struct imported_ball *ball);

/* ---- units: import_units.c ---- */

struct import_units;
/* The unit system of this name (LAMMPS, command units). A fault: it is none, or one of atoms. */
int import_find_units(const struct import_units **units, struct words *w, struct word name);
bool import_are_units(struct word name);
/* What was read, from the units that the file names to SI */
void import_to_si(struct imported *to);
