/*
 * state/body_columns.h: the table of the numbers that every body has. A row makes the member of struct
 * packing, an array of n, and all that is done to bodies as a whole: allocate, resize, copy, check, exchange
 * between ranks, read, write. So a new number is a row here, and the place that uses it.
 */
#pragma once

#include "base/field.h"
#include "base/vec.h"

#include <stdint.h>

typedef int32_t edge_count[3];

/*
 * X(C type, member, type and numbers in documents, name, unit, range, traits)
 *
 *   radius   of the ball around it
 *   mass     0: immovable or prescribed
 *   inertia  the mean of the principal moments
 *   id       a number that stays with the body
 *   material     row of the material tables
 *   shape    row of the packing's shapes; NULL: all are balls
 *   group    1 + row of the packing's names; 0: of no group; NULL: all are
 *   q        orientation
 *   damage   from 0 to 1, with which the grain breaks before the next step [state/breakage.h]
 *   parent   the id of the grain that it is a fragment of; -1: none
 *   generation  how many of its ancestors have broken
 *   born     s: the time at which it became a body; 0 of those that are no fragments
 *   image    edges to add to x for the way that the body has gone; NULL: the cell is not periodic
 */
#define EACH_BODY_COLUMN(X)                                                                        \
    X(double, radius, F64, 1, "radius", "m", POSITIVE, FIELD_SAME)                                 \
    X(double, mass, F64, 1, "mass", "kg", NOT_NEGATIVE, FIELD_SAME)                                \
    X(double, inertia, F64, 1, "inertia", "kg m2", NOT_NEGATIVE, FIELD_SAME)                       \
    X(int32_t, id, I32, 1, "id", "1", ANY, FIELD_SAME)                                             \
    X(int32_t, material, I32, 1, "species", "1", ANY, FIELD_SAME)                                  \
    X(int32_t, shape, I32, 1, "shape", "1", ANY, FIELD_SAME | FIELD_BY_SETTINGS)                   \
    X(int32_t, group, I32, 1, "group", "1", ANY, FIELD_SAME | FIELD_OPTIONAL)                      \
    X(int32_t, parent, I32, 1, "parent", "1", ANY, FIELD_SAME | FIELD_OPTIONAL)                    \
    X(int32_t, generation, I32, 1, "generation", "1", NOT_NEGATIVE, FIELD_SAME | FIELD_OPTIONAL)   \
    X(double, born, F64, 1, "born", "s", FINITE, FIELD_SAME | FIELD_OPTIONAL)                      \
    X(vec3, x, F64, 3, "position", "m", FINITE, FIELD_MOVES)                                       \
    X(vec3, v, F64, 3, "velocity", "m s-1", FINITE, FIELD_MOVES)                                   \
    X(vec3, w, F64, 3, "angular_velocity", "rad s-1", FINITE, FIELD_MOVES)                         \
    X(quat, q, F64, 4, "orientation", "1", FINITE, FIELD_MOVES)                                    \
    X(edge_count, image, I32, 3, "image", "1", ANY,                                                \
      FIELD_MOVES | FIELD_BY_SETTINGS | FIELD_OPTIONAL)                                            \
    X(double, damage, F64, 1, "damage", "1", FRACTION, FIELD_MOVES | FIELD_OPTIONAL)

#define BODY_POINTER(ctype, member, ...) ctype *member;

/* Row of the table: body_columns[BODY_radius] ... */
#define BODY_NUMBER(ctype, member, ...) BODY_##member,
enum { EACH_BODY_COLUMN(BODY_NUMBER) BODY_COLUMNS };
#undef BODY_NUMBER

_Static_assert(BODY_COLUMNS < 32, "sets of columns are bits");
/* [BODY_COLUMNS], and one without a name */
extern const struct field body_columns[];
