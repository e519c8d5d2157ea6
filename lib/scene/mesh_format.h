/*
 * scene/mesh_format.h: the formats of files of surfaces, a table. A new one is a file as mesh_obj.c is, its
 * extern here and its row in mesh_file.c.
 */
#ifndef NSD_MESH_FORMAT_H
#define NSD_MESH_FORMAT_H

#include "scene/soup.h"

struct mesh_format {
    const char *name; /* in capitals */
    const char *ending;
    /* Do n bytes begin as a file of this format? Behind them there is a 0. */
    bool (*looks)(const char *bytes, int64_t n);
    /* Puts what they have into the soup. Returns 0 or the status of a fault. */
    int (*read)(struct soup *s, const char *bytes, int64_t n);
};

extern const struct mesh_format mesh_stl, mesh_obj, mesh_ply;

#endif
