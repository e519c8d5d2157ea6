/*
 * scene/scene.h: a scene, what a packing is built from: a JSON object, checked, as a plain struct.
 *
 * SI units. A vector is [x, y, z], or [x, y] where dim is 2. Any object may have a
 * "comment". Unknown and repeated keys, wrong types and numbers out of range are errors, reported
 * as "line:column: path: trouble".
 *
 *   title     string
 *   dim       3 | 2                    [3] balls in space, or discs in the plane z = 0
 *   dt        number > 0 | "auto"      (needed) s; auto: by scene/time_step.h
 *   theta     0..1                     [0.5] of the theta-method
 *   gravity   vector                   [9.81 down the last axis] m/s^2
 *   seed      integer 0..2^32-1        [1] of the random numbers
 *   density   number > 0               [2500] kg/m^3 (kg/m^2 of discs)
 *   mu        number >= 0              [0] friction of every pair of kinds
 *   e_n, e_t  0..1                     [0] restitution, normal and tangential, of every pair
 *   kinds     { NAME: { density } }    kinds of material; "ball" and "wall" are always there
 *   pairs     [ { pair: [NAME, NAME], mu, e_n, e_t } ]       exceptions, each pair once
 *   time      number                   [0] s: of the packing; what moves by itself is where it then is
 *   overlap   true | false             [false] bodies may overlap at the start
 *   bodies    [ GROUP ]                [none]
 *   shapes    { NAME: SHAPE }          [none] shapes of grains; "ball" is always there
 *   walls     [ WALL ]                 [those of the first document among the bodies, else none]
 *   room      ROOM                     [none] walls whose size yields to a mean pressure, or changes by rates
 *   pour      [ POUR ]                 [none] grains that come, while the scene runs
 *   remove    [ REMOVAL ]              [none] grains that go
 *   cell      CELL or null             [that of the first document, else none] the box that repeats
 *
 * GROUP, one of
 *   { x: vector, radius: number }      one body
 *   { count: integer, radius: SIZE, box: BOX, cells, spacing, jitter, thermal }   a random lattice
 *   { random: { phi: 0..1 | count: integer }, radius: SIZE, box: BOX, thermal }   without a lattice:
 *                                      as many as fill phi of the box, or count
 *   { file: string }                   a table, one body a line: x y z r, or x y r where dim is 2;
 *                                      # begins a comment, the first may name columns, see below
 *   { document: string, frame: integer, at_rest: true | false }      the bodies of a document
 *                                      [nsd-format(5)]: frame [-1], -1 is the last, 0 the first
 *   { import: string, frame, at_rest, types: { "1": NAME, ... }, repeats: [true | false, ...] }   the balls of a
 *                                      file of another program [convert/import_file.h]: types are its numbers of
 *                                      materials [the kind of that name; "ball" where there is one type], repeats
 *                                      along which edges its box is periodic [as it says, else none]
 *   a relative name starts at the scene
 * with, for each of its bodies,
 *   v vector [0] m/s; w vector, or a number where dim is 2 [0] rad/s; kind NAME ["ball"];
 *   density [its kind's] or mass, kg; fixed true | false [false]: moves with v and w whatever
 *   happens, so that its mass does not matter. For a table or a document: [what it says]
 *   shape NAME [a ball], and then orientation "random" | rotation vector, rad, or an angle where dim is
 *   2 [as described], and in place of a radius, which is that of the ball around it, size SIZE [1]: how
 *   many times as large as described. x is its centre of mass. Not for a table or a document.
 *   name NAME [none; of a document: as it has them]: that of the group; several groups may have one
 * and for a lattice
 *   box      [the cell, in rows along its edges; else that of the first wall that is a BOX]
 *                                                      may be open only above (the last axis)
 *   cells    "equal" | "own" ["equal"]  all of one size, or each as its body needs it
 *   spacing  number >= 1 [1.05]        least edge of a cell, in largest diameters (own: in its own)
 *   jitter   0..1 [1]                  share of the free room in its cell that is used; no overlap
 *   thermal  number >= 0 [0]           m/s, standard deviation added to each component of v
 *
 * A table's first line may name its columns: "# x y z r kind", in any order. x y z and r or d (the
 * diameter) are needed; mass density vx vy vz wx wy wz qw qx qy qz id kind fixed may be there.
 *
 * SIZE, the radius in m: a number, or one of
 *   { uniform: [min, max] }
 *   { gaussian: { mean, sd, min, max } }           drawn again until it lies in [min, max]
 *   { lognormal: { median, sigma, min, max } }     sigma: of the logarithm
 *   { uniform_by_mass: [min, max] }                as much mass at every radius
 *   { power: { exponent, min, max } }              density by number: r^-exponent
 *   { sieve: [[size, passing], ...] }              share of the mass that passes a sieve of this
 *                                                  aperture (m, a diameter), from 0 to 1
 *
 * SHAPE, one of (m)
 *   { box: vector }                                sides along x, y (, z)
 *   { regular: { sides, radius, height } }         a prism along z, in the plane a polygon, no height
 *   { points: [vector, ...] }                      their convex hull
 *   { vertices: [vector, ...], faces: [[0, 1, 2, ...], ...] }     a convex polyhedron, as it is: corners
 *                                                  counterclockwise seen from outside
 *   { polygon: [[x, y], ...] }                     in the plane, convex, counterclockwise
 *     these with round m [0]: all points within that of it
 *   { capsule: { length, radius } }                length between the centres of its ends, along x
 *   { balls: [[x, y, z, r], ...] }                 a clump; in the plane [x, y, r]. In space with solid
 *                                                  { volume, centre, inertia: MATRIX }: what it stands for, of density 1
 *   { mesh: { file, scale }, clump: { balls: integer, error: 0..1 } }     balls that fill a closed surface
 *
 * BOX { x: [from, to], y: [from, to], z: [from, to] }: null is open, and so is an axis left out.
 *
 * WALL, a boundary: { point: vector, normal: vector } or { box: BOX }, or in space one of
 *   { rectangle: { center, normal, sides: [a, b], along } }   { disc: { center, normal, radius, hole } }
 *   { cylinder: { point, axis, radius, length, side, along, arc } }
 *   { cone: { point, axis, radii: [r, s], length, side, along, arc } }
 *   { sphere: { center, radius, side } }                      { mesh: { file, scale, at } }
 *   in the plane one of
 *   { segment: [[x, y], [x, y]] }      { polygon: { points: [[x, y], ...], closed } }
 *   { circle: { center, radius, side } }  { arc: { center, radius, along, arc, side } }
 *   with name NAME [none], velocity vector [0], kind ["wall"], drives [ DRIVE ], until s, weld m, wear 1/Pa and all
 *   but the box load. Several walls may have one name. Mesh and polygon may have parts: "groups", of the OBJ file, or
 *   [ { name: NAME, faces: [first, last] }, ... ], triangles or segments from 0 [state/names.h].
 *   Bodies stay on the side that the normal points to; in a box they stay inside.
 *   side inside [that] | outside | both. A boundary may yield to a load, on top of its motion:
 *   { along: vector, mass: kg, force: N [0], speed: m/s [0], travel: m [0] }  free along the vector
 *   { about: point, axis, mass: kg m^2, torque: N m [0], speed, travel }   about an axis there
 *   whose force or torque is a number or { table: [[t, N], ...], mean [0] } or
 *   { amplitude, frequency, phase, mean }.
 *   A plane may have { pressure: Pa, mass, speed, travel } instead, a number or such a signal: along its normal,
 *   times the face that the planes beside it leave. A mass that is left out is that of scene/time_step.h.
 *   Its weight is a force like others: gravity does not pull at boundaries.
 *
 * DRIVE { along: vector } or { about: point, axis: vector }, with speed, or amplitude, frequency and
 *   phase, or table [[t, way], ...]; from, until s [shape/drive.h]
 *
 * ROOM { walls: NAME or [NAME, ...], pressure: Pa, strain_rate: vector, center: vector, mass: kg, growth: 1/s, travel:
 *   [m, ...] }   planes that move in proportion to their distances from the center [state/servo_box.h]
 *   pressure    a number or a signal as of a load [none: the size does not yield]
 *   strain_rate 1/s, along the axes, extension is positive [0]; with a pressure its sum is 0
 *   center      [midway between opposite walls; where the room has only one of two, on the other]
 *   mass        of each wall, as of a load [scene/time_step.h]
 *   growth      1/s, of the size at the start [0];   travel, of each wall at the start [0]
 *
 * CELL { edges: [vector, ...] or lengths: vector [the first document's], repeats, origin, gradient, affine, stress }
 *   edges    dim of them, the cell's from its origin; lengths: along x, y, z
 *   repeats  [true | false, ...] [all true]   along which edges
 *   origin   vector [0]
 *   gradient MATRIX, 1/s, or [ { t: s, L: MATRIX } ], linear between and constant outside [0]: of
 *            velocity; the edges move with it, d edge/dt = L edge. MATRIX [[L_xx, L_xy], ...]
 *   affine   true | false [true with a gradient and no document]: at the start bodies have the
 *            velocity L (x - origin) as well
 *   stress   { pressure: Pa, mass: kg, factor }, { target: MATRIX, mass: kg, factor } or { mean: Pa, mass: kg,
 *            factor }: what edges yield to, as bodies of this mass [by rule: scene/time_step.h]; compression is positive, N/m in the plane. Number [i][j]: component
 *            i of edge j yields; null: it moves by the gradient. A pressure is one on the diagonal,
 *            of edges that repeat. mass may be a MATRIX of masses, of the same shape. A mean: the size of the
 *            cell yields, while the gradient changes its shape. factor [[t, x], ...]: multiplies the stress
 *
 * POUR { rate: bodies/s | mass_rate: kg/s, opening: { box: BOX } or { disc: { center, normal,
 *   radius } }, radius: SIZE, v, w, name, kind, density or mass, from [time] s, until s, count, and shape,
 *   size, orientation as of a group of bodies }
 *   [scene/inlet.h]; in the plane the disc is a segment.
 *
 * REMOVAL { outside: BOX } or { inside: BOX } or { below: { point, normal } } [anywhere], with kind [any], id integer
 *   or [integer, ...] [any], name of a group or of a pour [any], from, until s: bodies go whose centre is there.
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

#include "base/failure.h"
#include "scene/scene_size.h"
#include "shape/solid.h"
#include "state/packing.h"

#include <stddef.h>

struct scene_kind {
    char *name;
    double density; /* kg/m^3, in the plane kg/m^2 */
};

struct scene_law {
    EVERY_PAIR_COLUMN(PAIR_NUMBER) /* mu, en, et, mu_s, v_s, inert */
    struct pair_law pair_law;
};

struct scene_box {
    double lo[3], hi[3]; /* m; infinite where it is open */
};

/* The shape of the bodies of a group */
struct scene_form {
    int32_t shape; /* row of the scene's shapes; 0: balls */
    bool tumbled;  /* orientations at random; else */
    quat turned;   /* that of all, from how the shape is described */
    double fill;   /* its volume, in volumes of the ball around it */
};

struct scene_bodies {
    enum scene_source {
        SCENE_ONE,
        SCENE_LATTICE,
        SCENE_TABLE,
        SCENE_SHELVES, /* a lattice whose cells fit their grains */
        SCENE_RANDOM,
        SCENE_DOCUMENT
    } from;
    int64_t count; /* bodies; 0 where only scene_build knows: tables, documents, "phi" */
    vec3 x;        /* m, SCENE_ONE */
    char *file;    /* of a table or a document */
    double phi;    /* SCENE_RANDOM: share of the box that is filled; 0: count bodies */
    int64_t frame; /* SCENE_DOCUMENT: from 0, or from the end: -1 is the last */
    bool at_rest;  /* SCENE_DOCUMENT: without its velocities */
    bool foreign;  /* SCENE_DOCUMENT: the file is another program's, and a mass of 0 is none */
    bool has_repeats, repeats[3];
    int32_t types; /* kinds that its types are */
    struct scene_type {
        char *name; /* as the file counts it: "1" */
        int32_t kind;
    } * type;                                            /* [types] */
    bool has_v, has_w, has_kind, has_density, has_fixed; /* given for all bodies of the group */
    /* SCENE_DOCUMENT: the frame, which whoever can read documents puts here before the scene is
       built; owned */
    struct packing *document;
    struct scene_size size;
    struct scene_box box;
    bool in_cell;                    /* box is the cell's: heights above its faces, from 0 */
    double spacing, jitter, thermal; /* of a lattice, as above */
    vec3 v, w;                       /* m/s, rad/s */
    double density, mass;            /* kg/m^3 or kg/m^2; kg a body, 0: from the density */
    bool fixed;
    int32_t kind;
    int32_t group; /* 1 + row of the scene's names; 0: it has no name */
    struct scene_form form;
};

/* Where grains come in: one after another, each at a place drawn in the opening */
struct scene_pour {
    double rate; /* bodies a second or, by mass, kg/s */
    bool by_mass;
    double from, until;   /* s */
    double count;         /* bodies at most; may be infinite */
    struct scene_box box; /* the opening, m */
    bool disc;            /* it is a disc instead, in the plane a segment: */
    vec3 center, normal;  /* m; unit vector */
    double radius;        /* m, of the disc */
    struct scene_size size;
    vec3 v, w;            /* m/s, rad/s */
    double density, mass; /* as of struct scene_bodies */
    int32_t kind;
    int32_t group; /* 1 + row of the scene's names; 0: it has no name */
    struct scene_form form;
    struct flow_count poured; /* what it has brought before the scene begins */
};

/* Which grains go, and when: bodies whose centre is there */
struct scene_removal {
    enum scene_region { REGION_OUTSIDE, REGION_INSIDE, REGION_BELOW, REGION_ALL } region;
    struct scene_box box;
    vec3 point, normal; /* m; unit vector: REGION_BELOW, on the side away from the normal */
    int32_t kind;       /* only bodies of this kind; -1: of all */
    int32_t ids;        /* only bodies with these numbers; 0: all */
    int32_t *id;        /* [ids], rising */
    int32_t group;      /* only bodies of this group, 1 + row of the scene's names; 0: of all */
    double from, until; /* s */
    struct flow_count removed; /* what it has taken before the scene begins */
};

/* A boundary whose triangles are in a file: whoever can read it adds them, with mesh_grow(), before the
   scene is built. */
struct scene_mesh {
    int32_t wall;
    char *file;
    double scale;     /* m a unit of the file */
    bool groups;      /* the groups of the file are names of parts of the surface */
    int32_t left_out; /* triangles of the file that are not in the mesh */
};

/* Faces of a mesh that become a wall of their own [scene/surface_parts.h] */
struct scene_part {
    int32_t wall;        /* that they are of */
    int64_t first, last; /* among its elements */
    int32_t kind;
    vec3 belt; /* m/s */
};

/* How well balls fill a surface: of shape NAME, for who tells it [scene/clump_fit.h] */
struct scene_fit {
    char *shape;
    int32_t balls;
    double volume, distance, moments; /* errors, relative */
};

struct scene_cell {
    bool given;   /* else that of the first document is taken, unless there shall be none */
    bool none;    /* null is given */
    bool goes_on; /* edges, and what else of these is not given, are those of the first document */
    bool repeats, origin, affine;
    bool by_rule;     /* masses of what yields are those of scene/time_step.h, not given */
    struct cell cell; /* rates are those at the start */
};

struct scene {
    int dim;
    double dt, theta; /* dt 0: "auto" */
    vec3 g;
    uint64_t seed;
    bool overlap;

    int32_t kinds;
    struct scene_kind *kind; /* [kinds] 0 is "ball", 1 is "wall" */
    struct scene_law *law;   /* [kinds * kinds], symmetric */

    int64_t groups;
    struct scene_bodies *bodies; /* [groups] */
    int64_t *
        built; /* [groups] borrowed, or NULL: where scene_build puts how many bodies each has become */

    int32_t walls;
    struct wall *wall;    /* [walls] */
    int32_t *wall_item;   /* [walls] which of "walls" each comes from: a box is several */
    struct drives drives; /* of them */
    struct drives pushes; /* of their loads */
    struct drives pulls;  /* of bodies, by their ids */
    struct mesh mesh;     /* of those that are meshes */
    struct names names;   /* of walls, parts of them and groups of bodies */
    int32_t meshes;
    struct scene_mesh *mesh_file; /* [meshes] those that are files */
    int32_t parts;
    struct scene_part *part; /* [parts] */
    bool room_yields;        /* a room of walls has a pressure, and so a mass */
    bool has_walls;          /* else those of the first document are taken */
    double t;                /* s: the packing's time */

    int32_t pours, removals;       /* inlets and outlets [scene/inlet.h] */
    struct scene_pour *pour;       /* [pours] */
    struct scene_removal *removal; /* [removals] */
    struct scene_cell cell;
    struct shapes shapes;      /* of grains */
    struct solid_frame *solid; /* [shapes.n] what they were before they had their own axes */
    int32_t fits;
    struct scene_fit *fit; /* [fits] clumps that were fitted to surfaces */

    struct scene_files *files; /* while it is parsed */
    bool rewritten;            /* the JSON, which now has what was in files */
    char *text;                /* the JSON, without blanks outside strings */
};

/* Cells of a lattice along each axis, filled along x, then y, then z; and their edges (m). */
struct scene_lattice {
    double cells[3], edge[3];
};
struct scene_lattice scene_lattice(const struct scene_bodies *b, int dim);

/* Who reads the triangles of a file, `scale` m a unit of it, and adds them to a mesh. What parses scenes
   out of documents has none: those name no files. */
struct scene_files {
    const char *dir; /* that names are relative to; NULL: the current folder */
    int64_t
        mesh_bytes; /* read so far, and comparisons that concave polygons took: one account for all */
    int64_t mesh_work;
    struct names
        *parts; /* of the mesh that is read its groups are wanted, for this wall; else NULL */
    int32_t wall;
    int (*read_mesh)(struct mesh *to, struct scene_files *files, const char *name, double scale,
                     int32_t *left_out, struct failure *failure);
};

/* files: NULL where shapes of grains must not be in files; the scene's text then has what was in them.
   Returns 0, EX_DATAERR, EX_NOINPUT or EX_SOFTWARE; *s needs to be freed only after 0. */
int scene_parse(struct scene *s, const char *text, size_t length, struct scene_files *files,
                struct failure *failure);
void scene_free(struct scene *s);
/* A file that the scene names, where names are relative to dir (NULL: to the current folder); to be freed.
   NULL: no memory. */
char *scene_path(const char *dir, const char *name);

/*
 * The paper's sedimentation of n balls (dim 3) or discs (dim 2): example 3 for n = 500, example 2
 * for n = 4; every other n is example 3 in a box whose sides are 6 (n/500)^(1/3) cells long,
 * rounded and at least 1 (in the plane 25 (n/500)^(1/2)), so that all heaps have the same
 * proportions. n = 0 is an empty box. Parsed from its JSON text like any other scene.
 */
int scene_paper(struct scene *s, int dim, int64_t n, struct failure *failure);

#endif
