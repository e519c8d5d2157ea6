/*
 * convert/imported.h: what a file of another program says of its balls, in plain numbers: a head and a row for
 * each. It is read by a process of its own [base/bounded.h], and checked again before it is a packing.
 */
#ifndef NSD_IMPORTED_H
#define NSD_IMPORTED_H

#include "base/vec.h"
#include "base/failure.h"

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

/* What a file says besides its balls, in the packing that comes of it */
struct import_said {
    bool dt, gravity, laws; /* laws: mu, and perhaps restitution, of each pair of kinds */
    bool masses;            /* of all: where one is 0 the body is fixed; else it is not said */
};

/* While it is read */
struct imported {
    struct imported_head head;
    const struct import_units *units; /* that the file names; NULL: SI [convert/import_format.h] */
    int64_t room;
    struct imported_ball *ball; /* [head.n] */
};

enum { IMPORTED_MOST = 1 << 27 }; /* balls */

struct imported_ball imported_ball(void);
/* One more ball. Returns 0 or EX_SOFTWARE. */
int imported_add(struct imported *to, const struct imported_ball *ball, struct failure *failure);
void imported_free(struct imported *it);

#endif
