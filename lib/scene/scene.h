/*
 * scene/scene.h: what a packing is made from: a JSON object, checked, as a plain struct.
 *
 * SI units. A vector is [x, y, z], or [x, y] where dim is 2. Any object may have a
 * "comment". Unknown keys, keys given twice, wrong types and numbers out of range are errors,
 * told as "line:column: path: trouble".
 *
 *   title     string
 *   dim       3 | 2                    [3] balls in space, or discs in the plane z = 0
 *   dt        number > 0               (needed) s
 *   theta     0..1                     [0.5] of the theta-method
 *   gravity   vector                   [9.81 down the last axis] m/s^2
 *   seed      integer 0..2^32-1        [1] of the random numbers
 *   density   number > 0               [2500] kg/m^3 (kg/m^2 of discs)
 *   mu        number >= 0              [0] friction of every pair of kinds
 *   e_n, e_t  0..1                     [0] restitution, normal and tangential, of every pair
 *   kinds     { NAME: { density } }    kinds of material; "ball" and "wall" are always there
 *   pairs     [ { pair: [NAME, NAME], mu, e_n, e_t } ]       exceptions, each pair once
 *   overlap   true | false             [false] bodies may overlap at the start
 *   bodies    [ GROUP ]                [none]
 *   walls     [ WALL ]                 [none]
 *
 * GROUP, one of
 *   { x: vector, radius: number }      one body
 *   { count: integer, radius: SIZE, box: BOX, spacing, jitter, thermal }   a random lattice
 *   { file: string }                   a table, one body a line: x y z r, or x y r where dim is 2;
 *                                      # begins a comment; a relative name starts at the scene
 * with, for each of its bodies,
 *   v vector [0] m/s; w vector, or a number where dim is 2 [0] rad/s; kind NAME ["ball"];
 *   density [its kind's] or mass, kg; fixed true | false [false]: moves with v and w whatever
 *   happens, so that its mass does not matter
 * and for a lattice
 *   box      [the box of the walls]    open at most above (the last axis)
 *   spacing  number >= 1 [1.05]        least cell, in largest diameters
 *   jitter   0..1 [1]                  of the room that a body has in its cell: never an overlap
 *   thermal  number >= 0 [0]           m/s, standard deviation added to each component of v
 *
 * SIZE, the radius in m: a number, or one of
 *   { uniform: [min, max] }
 *   { gaussian: { mean, sd, min, max } }           drawn again until it lies in [min, max]
 *   { lognormal: { median, sigma, min, max } }     sigma: of the logarithm
 *
 * BOX { x: [from, to], y: [from, to], z: [from, to] }: null is open, and so is an axis left out.
 *
 * WALL { point: vector, normal: vector } or { box: BOX }, with velocity vector [0], kind ["wall"].
 *   Bodies stay on the side that the normal, of any length, points to; in a box they stay inside.
 *
 * The paper's examples. It gives radii, mu, dt and (example 1) the first velocity. Ours: density
 * 2500 kg/m^3, g 9.81 m/s^2, e_n = e_t = 0, and
 *   example 1  the ball touches the floor at the start (gap 0);
 *   example 2  a box of 1.6 mm, no lid, the balls one above the other in cells of 1.05 mm; seed 9,
 *              with which every solve converges, as the paper says (with 1 some steps jam);
 *   example 3  a box of 6.3 mm, no lid, cells of 1.05 mm, 6 x 6 a layer, full jitter.
 */
#ifndef NSD_SCENE_H
#define NSD_SCENE_H

#include "base/why.h"
#include "bodies/packing.h"

#include <stddef.h>

struct scene_kind {
    char *name;
    double density; /* kg/m^3, in the plane kg/m^2 */
};

struct scene_law {
    double mu, en, et;
};

struct scene_size {
    enum { SIZE_UNIFORM, SIZE_GAUSSIAN, SIZE_LOGNORMAL } law;
    double mid, spread; /* mean and sd, m; or median, m, and sigma */
    double min, max;    /* m; a single radius is min = max */
};

struct scene_box {
    double lo[3], hi[3]; /* m; infinite where it is open */
};

struct scene_bodies {
    enum scene_source { SCENE_ONE, SCENE_LATTICE, SCENE_TABLE } from;
    int64_t count; /* of a table: 0, not yet known */
    vec3 x;        /* m, SCENE_ONE */
    char *file;    /* SCENE_TABLE */
    struct scene_size size;
    struct scene_box box;
    double spacing, jitter, thermal;
    vec3 v, w;            /* m/s, rad/s */
    double density, mass; /* of each; mass 0: from the density */
    bool fixed;
    int32_t kind;
};

struct scene {
    int dim;
    double dt, theta;
    vec3 g;
    uint64_t seed;
    bool overlap;

    int32_t kinds;
    struct scene_kind *kind; /* [kinds] 0 is "ball", 1 is "wall" */
    struct scene_law *law;   /* [kinds * kinds], symmetric */

    int64_t groups;
    struct scene_bodies *bodies; /* [groups] */

    int32_t walls;
    struct wall *wall; /* [walls] */

    char *text; /* the JSON, without the blanks */
};

/* Of a lattice: cells an axis, filled along x, then y, then z; and their edges, m. */
struct scene_lattice {
    double cells[3], edge[3];
};
struct scene_lattice scene_lattice(const struct scene_bodies *, int dim);

/* Returns 0, EX_DATAERR or EX_SOFTWARE; there is something to free only after 0. */
int scene_parse(struct scene *, const char *text, size_t length, struct why *);
void scene_free(struct scene *);

/*
 * The paper's sedimentation of n balls (dim 3) or discs (dim 2): example 3 for n = 500, example 2
 * for n = 4; every other n is example 3 in a box of 6 (n/500)^(1/3) columns of cells along either
 * side, rounded and at least 1 (in the plane 25 (n/500)^(1/2)), so that all heaps have the same
 * proportions. n = 0 is an empty box. Parsed from its JSON text like any other scene.
 */
int scene_paper(struct scene *, int dim, int64_t n, struct why *);

#endif
