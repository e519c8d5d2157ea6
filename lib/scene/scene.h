/*
 * scene/scene.h: a scene, what a packing is built from: a JSON object, checked, as a plain struct.
 *
 * SI units. A vector is [x, y, z], or [x, y] where dim is 2. Any object may have a
 * "comment". Unknown and repeated keys, wrong types and numbers out of range are errors, reported
 * as "line:column: path: trouble".
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
 *   cell      CELL                     [none] the box that repeats
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
 *   box      [the cell, in rows along its edges; else that of the first wall that is a BOX]
 *                                                      may be open only above (the last axis)
 *   spacing  number >= 1 [1.05]        least edge of a cell, in largest diameters
 *   jitter   0..1 [1]                  share of the free room in its cell that is used; no overlap
 *   thermal  number >= 0 [0]           m/s, standard deviation added to each component of v
 *
 * SIZE, the radius in m: a number, or one of
 *   { uniform: [min, max] }
 *   { gaussian: { mean, sd, min, max } }           drawn again until it lies in [min, max]
 *   { lognormal: { median, sigma, min, max } }     sigma: of the logarithm
 *
 * BOX { x: [from, to], y: [from, to], z: [from, to] }: null is open, and so is an axis left out.
 *
 * WALL { point: vector, normal: vector } or { box: BOX }, with velocity vector [0], kind ["wall"], load.
 *   Bodies stay on the side that the normal, of any length, points to; in a box they stay inside.
 *   A wall by point and normal may yield to a load, on top of its velocity:
 *   { along: vector, mass: kg, force: N [0], speed: m/s [0] }              free along the vector
 *   { about: vector, mass: kg m^2, torque: N m [0], speed: rad/s [0] }     about its normal there
 *   Its weight is a force like others: gravity does not pull at walls.
 *
 * CELL { edges: [vector, ...] or lengths: vector, repeats, origin, gradient, affine, stress }
 *   edges    dim of them, the cell's from its origin; lengths: along x, y, z
 *   repeats  [true | false, ...] [all true]   along which edges
 *   origin   vector [0]
 *   gradient MATRIX, 1/s, or [ { t: s, L: MATRIX } ], linear between and constant outside [0]: of
 *            velocity; the edges move with it, d edge/dt = L edge. MATRIX [[L_xx, L_xy], ...]
 *   affine   true | false [false]: at the start bodies have the velocity L (x - origin) as well
 *   stress   { pressure: Pa, mass: kg } or { target: MATRIX, mass: kg }: what edges yield to, as
 *            bodies of this mass; compression is positive, N/m in the plane. Number [i][j]: component
 *            i of edge j yields; null: it moves by the gradient. A pressure is one on the diagonal,
 *            of edges that repeat. mass may be a MATRIX of masses, of the same shape
 *
 * The paper's examples. The paper gives radii, mu, dt and (example 1) the initial velocity. Our
 * choices: density 2500 kg/m^3, g 9.81 m/s^2, e_n = e_t = 0, and
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
    double mid, spread; /* gaussian: mean and sd, m; lognormal: median, m, and sigma */
    double min, max;    /* m; a single radius is min = max */
};

struct scene_box {
    double lo[3], hi[3]; /* m; infinite where it is open */
};

struct scene_bodies {
    enum scene_source { SCENE_ONE, SCENE_LATTICE, SCENE_TABLE } from;
    int64_t count; /* bodies; 0 for a table, which is read only by scene_build */
    vec3 x;        /* m, SCENE_ONE */
    char *file;    /* SCENE_TABLE */
    struct scene_size size;
    struct scene_box box;
    bool in_cell;                    /* box is the cell's: heights above its faces, from 0 */
    double spacing, jitter, thermal; /* of a lattice, as above */
    vec3 v, w;                       /* m/s, rad/s */
    double density, mass;            /* kg/m^3 or kg/m^2; kg a body, 0: from the density */
    bool fixed;
    int32_t kind;
};

struct scene_cell {
    bool given, affine;
    struct cell cell; /* rates are those at the start */
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
    struct scene_cell cell;

    char *text; /* the JSON, without blanks outside strings */
};

/* Cells of a lattice along each axis, filled along x, then y, then z; and their edges (m). */
struct scene_lattice {
    double cells[3], edge[3];
};
struct scene_lattice scene_lattice(const struct scene_bodies *b, int dim);

/* Returns 0, EX_DATAERR or EX_SOFTWARE; *s needs to be freed only after 0. */
int scene_parse(struct scene *s, const char *text, size_t length, struct why *why);
void scene_free(struct scene *s);

/*
 * The paper's sedimentation of n balls (dim 3) or discs (dim 2): example 3 for n = 500, example 2
 * for n = 4; every other n is example 3 in a box whose sides are 6 (n/500)^(1/3) cells long,
 * rounded and at least 1 (in the plane 25 (n/500)^(1/2)), so that all heaps have the same
 * proportions. n = 0 is an empty box. Parsed from its JSON text like any other scene.
 */
int scene_paper(struct scene *s, int dim, int64_t n, struct why *why);

#endif
