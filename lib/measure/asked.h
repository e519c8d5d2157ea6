/*
 * measure/asked.h: options in addition to the names of measures, from texts: options of nsd-stat, settings of a program.
 */
#ifndef NSD_ASKED_H
#define NSD_ASKED_H

#include "measure/snapshot.h"

/* What nobody has asked for otherwise: 20 layers, which have a few grains where the height has a hundred; 50 bins,
   with enough contacts in each where there are a thousand */
#define ASKED_DEFAULT                                                                              \
    {                                                                                              \
        .axis = -1, .layers = 20, .bins = 50, .radius = INFINITY                                   \
    }
/* box X0,X1,Y0,Y1[,Z0,Z1]; layers AXIS:N; point X,Y,Z; plane NX,NY,NZ; radius M; bins N; distance M; only NAME,...; wear K;
   tracer KIND, or large; sample M.
   Returns 0, or EX_USAGE with "--name: trouble", where nothing has changed. */
int asked_set(struct asked *asked, const char *name, const char *text, struct failure *failure);
/* Is there one of that name? */
bool asked_has(const char *name);

#endif
