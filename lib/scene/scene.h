/*
 * scene/scene.h: a scene, what a packing is built from: a JSON object, checked, as a plain struct.
 *
 * The objects of a scene, their keys and what these mean are in tables [scene/keys.h], which nsd-scene(5) prints. Any
 * object may have a "comment". Unknown and repeated keys, wrong types and numbers out of range are errors, reported as
 * "line:column: path: trouble".
 *
 * The paper's examples. The paper gives radii, mu, dt and (example 1) the initial velocity. Our
 * choices: density 2500 kg/m^3, g 9.81 m/s^2, e_n = e_t = 0, and
 *   example 1  the ball touches the floor at the start (gap 0);
 *   example 2  a box of 1.6 mm, no lid, the balls one above the other in cells of 1.05 mm; seed 9,
 *              with which every solve converges, as the paper says (with 1 some steps jam);
 *   example 3  a box of 6.3 mm, no lid, cells of 1.05 mm, 6 x 6 a layer, full jitter.
 */
#pragma once

#include "base/failure.h"
#include "scene/scene_size.h"
#include "shape/solid.h"
#include "state/breakage.h"
#include "state/packing.h"

#include <stddef.h>

struct scene_material {
    char *name;
    double density; /* kg/m^3, in the plane kg/m^2 */
    struct breakage breaks;
};

struct scene_law {
    EVERY_PAIR_COLUMN(PAIR_NUMBER) /* mu, en, et, mu_s, v_s, inert */
    struct pair_law pair_law;
    double young;      /* Pa: gives k_n [scene/stiffness.h]; 0: does not */
    double tangential; /* N/m: k_t that the scene gives; 0: it follows k_n */
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
    int32_t types; /* materials that its types are */
    struct scene_type {
        char *name; /* as the file counts it: "1" */
        int32_t material;
    } * type;                                                /* [types] */
    bool has_v, has_w, has_material, has_density, has_fixed; /* given for all bodies of the group */
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
    int32_t material;
    int32_t group; /* 1 + row of the scene's names; 0: it has no name */
    struct scene_form form;
};

/* Are its bodies those of a list, from a file or a random start? */
static inline bool scene_is_list(const struct scene_bodies *b)
{
    return b->from != SCENE_ONE && b->from != SCENE_LATTICE;
}

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
    int32_t material;
    int32_t group; /* 1 + row of the scene's names; 0: it has no name */
    struct scene_form form;
    struct flow_count poured; /* what it has brought before the scene begins */
};

/* Which grains go, and when: bodies whose centre is there */
struct scene_removal {
    enum scene_region { REGION_OUTSIDE, REGION_INSIDE, REGION_BELOW, REGION_ALL } region;
    struct scene_box box;
    vec3 point, normal; /* m; unit vector: REGION_BELOW, on the side away from the normal */
    int32_t material;   /* only bodies of this material; -1: of all */
    int32_t ids;        /* only bodies with these numbers; 0: all */
    int32_t *id;        /* [ids], rising */
    int32_t group;      /* only bodies of this group, 1 + row of the scene's names; 0: of all */
    double from, until; /* s */
    struct flow_count removed; /* what it has taken before the scene begins */
};

/* A wall whose triangles are in a file: whoever can read it adds them, with mesh_grow(), before the
   scene is built. */
struct scene_mesh {
    int32_t wall;
    char *file;
    double scale;     /* m a unit of the file */
    vec3 at;          /* m: where its origin is */
    bool groups;      /* the groups of the file are names of parts of the surface */
    int32_t left_out; /* triangles of the file that are not in the mesh */
};

/* Faces of a mesh that become a wall of their own [scene/surface_parts.h] */
struct scene_part {
    int32_t wall;        /* that they are of */
    int64_t first, last; /* among its elements */
    int32_t material;
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
    double dt, theta; /* dt 0: "auto"; NaN: none is given */
    vec3 g;
    uint64_t seed;
    bool allow_overlap;

    int32_t materials;
    struct scene_material *material; /* [materials] 0 is "ball", 1 is "wall" */
    struct scene_law *law;           /* [materials * materials], symmetric */

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

    /* while it is parsed: */
    const char *title;
    double density;          /* kg/m^3: of materials that have none of their own */
    struct scene_law common; /* of pairs that have none of their own */
    bool boxed;              /* a wall is a box: */
    struct scene_box box;    /* the first of them */
    struct scene_files *files;

    bool rewritten; /* the JSON, which now has what was in files */
    char *text;     /* the JSON, without blanks outside strings */
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
