/* scene/scene_build.h: a packing from a scene. The same scene gives the same bytes. */
#ifndef NSD_SCENE_BUILD_H
#define NSD_SCENE_BUILD_H

#include "bodies/packing.h"
#include "scene/scene.h"

/*
 * Bodies in the order of the scene's groups; p->scene is the scene's text. Tables with a relative
 * name are sought in dir (NULL: here). Returns 0, EX_DATAERR, EX_NOINPUT (a table cannot be read)
 * or EX_SOFTWARE; there is something to free only after 0.
 */
int scene_build(struct packing *, const struct scene *, const char *dir, struct why *);

#endif
