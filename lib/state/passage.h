/*
 * state/passage.h: the account of inlets and outlets: how many each pour has brought and each
 * removal has taken, and the events since the last frame. What pours and removes is
 * scene/inlet.h.
 */
#ifndef NSD_PASSAGE_H
#define NSD_PASSAGE_H

#include "base/vec.h"
#include "base/failure.h"

#include <stdint.h>

/* What one pour has brought, or one removal has taken, so far */
struct flow_count {
    int64_t bodies;
    double mass; /* kg */
};

/* A body that has come or gone */
struct event {
    int64_t step; /* the step at whose beginning it happened */
    double t;     /* s: the time of that beginning */
    int32_t id;
    int8_t came;   /* 1: poured; 0: removed */
    int32_t which; /* the pour, or the removal: its place in the scene, from 0 */
    double radius; /* m */
    double mass;   /* kg */
    vec3 x, v;     /* m, m/s: then */
};

struct events {
    int64_t n, room;
    struct event *e; /* [n] in order of time */
};

/* Returns 0 or EX_SOFTWARE. */
int events_add(struct events *events, const struct event *event, struct failure *failure);
void events_free(struct events *events);

#endif
