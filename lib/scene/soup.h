/*
 * scene/soup.h: the polygons of a file as its format gives them, one after another, and the mesh that they
 * become: of triangles, with corners that lie in exactly one place joined, and without corners of none.
 *
 * Left out are triangles without any area, which cover nothing, and all but the first of those that have the
 * same three corners.
 */
#pragma once

#include "shape/mesh.h"

enum {
    SOUP_TRIANGLES_MOST = 1 << 24, /* of a file; as many as documents of 1 GB have */
    SOUP_CORNERS_MOST = 3 << 24,
    SOUP_LABEL = 512, /* bytes of the names of an object, or of the groups that a polygon is in */
    SOUP_PARTS_MOST = 4096,
};

struct soup {
    const char *name; /* of the file */
    const char *unit; /* what is counted where it is read: "line", "triangle" */
    int64_t at;       /* and the number of the one that is read, from 1 */
    struct failure *failure;
    bool single; /* corners are of 32 bits */
    int32_t corners, triangles, corner_room, triangle_room;
    vec3 *corner;           /* [corners] in the file's unit of length */
    int32_t (*triangle)[3]; /* [triangles] */
    int32_t flat;           /* triangles of polygons that have no area, and are not among them */
    bool grouped;           /* which part of the surface each triangle is of is wanted, too: */
    int32_t *part_of;       /* [triangles] -1: of none, else row of */
    int32_t parts,
        now;     /* how many there are, and that of the polygons to come; -2: by their label */
    char **part; /* [parts] the names of its object and of its groups, each ended by a newline */
    char label[2][SOUP_LABEL]; /* those of the polygons to come: of the object, of the groups */
    int64_t work;              /* left to concave polygons [scene/ears.h], and to finding parts */
};

/* Each returns 0 or the status of a fault. The fault names the file and the place in it. */
int soup_fault(struct soup *s, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* At least one more corner; in an order of the format's own */
int soup_corner(struct soup *s, vec3 x);
/* A polygon of n corners, which are checked to be there */
int soup_polygon(struct soup *s, const int64_t *corner, int64_t n);

/* Polygons to come are of another object (0), or in other groups (1): of none, and one more that is named by these
   bytes. A name that is none is a fault. */
void soup_no_label(struct soup *s, int which);
int soup_label(struct soup *s, int which, const char *name, int n);

/* Adds the triangles to a mesh, a unit of the file `scale` m; *left_out: how many are not, see above. Refused
   are numbers too coarse for what they describe: far from the origin those of 32 bits are. */
int soup_mesh(struct mesh *to, struct soup *s, double scale, int32_t *left_out);
void soup_free(struct soup *s);
