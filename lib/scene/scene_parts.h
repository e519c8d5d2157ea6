/*
 * scene/scene_parts.h: parts of a surface that are of another material, or move along themselves otherwise. They become
 * walls of their own behind the others, which move as the surface does; the rest is the surface.
 */
#ifndef NSD_SCENE_PARTS_H
#define NSD_SCENE_PARTS_H

#include "scene/scene.h"

/* When meshes have been read. Returns 0, EX_SOFTWARE, or EX_DATAERR where faces do not exist or are named twice. */
int scene_parts_split(struct scene *s, struct failure *failure);

#endif
