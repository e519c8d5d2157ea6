/* measure/stress.h: the stress in a region, by contacts and by the bodies' motion. */
#pragma once

#include "measure/snapshot.h"
#include "measure/tensor.h"

/* What moves in a region: bodies whose centres are in it. Velocities are those relative to the flow of the cell. */
struct moving {
    int64_t bodies;
    double mass;           /* kg */
    vec3 velocity, spin;   /* m/s, rad/s: their means, by mass and by inertia */
    struct tensor kinetic; /* J: sum m v' v'^T about the mean velocity */
    double rotation;       /* J: sum I w'^2 about the mean spin */
};
void moving_of(struct moving *m, const struct snapshot *s, const struct region *r);

/* N m, of a region with solved contacts: sum f l^T of the forces' parts in it */
struct tensor stress_contacts(const struct snapshot *s, const struct region *r);
