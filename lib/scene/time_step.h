/*
 * scene/time_step.h: how long a time step may be in a scene, by sizes, accelerations, speeds and periods.
 *
 * The contacts of a step are solved to its eps whatever dt is. What dt costs is overlap: bodies that are
 * found to touch have already come nearer by up to (approach velocity) dt, and what is left of that is a
 * part of every length in the packing. So each limit compares what comes in a step with a radius r, the
 * smallest:
 *
 *     a lasting acceleration a, of which a resting contact gets some in every step:
 *         a dt^2 <= 0.002 r        what a projection takes of an overlap in a step at least; as the slop of
 *                                  gravity [step/project.h] a thousandth of a diameter, 0.3 % of the
 *                                  solid fraction, which has lengths in the third power
 *     a lasting rate of strain L, by which neighbours approach with L 2 r:
 *         L 2 r dt <= 0.002 r
 *     a passing impact at velocity v, whose overlap is taken back in the steps that follow:
 *         v dt <= 0.05 r           two that meet are then in one another by no more than the 0.1 r at which
 *                                  a run fails [contact/depth.h]
 *     a wall that turns with w, whose normals are those of the middle of the step:
 *         w dt <= 0.02             an error of (w dt)^2 / 8 of its radius
 *     a drive of frequency f, which moves by a chord in each step:
 *         f dt <= 1/200            an error of (2 pi f dt)^2 / 8 = 0.01 % of its amplitude
 *
 * The accelerations are gravity; the one that a pressure P gives a grain, P d^2/m (in the plane P d/m), so
 * that dt is 0.032 sqrt(m/(P d)); and a load's own, F/M, of a wall or of an edge of the cell. The impacts are
 * those of what has a velocity at the start, what falls, and what a load drives: the way h that is left until
 * grains lie at a solid fraction of 0.6, in the plane 0.8, gives sqrt(v^2 + 2 a h).
 * What falls ends on the planes, rectangles, discs and meshes below it that there are at the start. Drives of a
 * wall count together where they act at the same time.
 */
#pragma once

#include "scene/scene.h"

enum time_step_row {
    LIMIT_GRAVITY,
    LIMIT_PRESSURE,
    LIMIT_LOAD,
    LIMIT_STRAIN,
    LIMIT_SPEED,
    LIMIT_FALL,
    LIMIT_STROKE,
    LIMIT_WALL,
    LIMIT_TURN,
    LIMIT_PERIOD,
    LIMITS
};

struct time_step_limit {
    const char *name;
    const char *of, *units; /* the quantity that limits */
    const char *rule;
    enum { BY_ACCELERATION, BY_SPEED, BY_RATE } way; /* dt = sqrt(c r / x), c r / x, c / x */
    double share;                                    /* c */
};
extern const struct time_step_limit time_step_limit[LIMITS];

/* Radii: what an impact may overlap in a step of the suggested dt, and TOL of a dt that is "auto" */
#define TIME_STEP_TOLERANCE 0.05

struct time_step {
    double radius;    /* m: the smallest; of a grain that is no ball, by how thin it is */
    double pressure;  /* Pa, in the plane N/m: the largest of loads and of the cell */
    double x[LIMITS]; /* the quantities; 0: no limit */
    double dt[LIMITS];
    int32_t by;  /* the row that is the least */
    double best; /* s: that, its first two digits; INFINITY: nothing moves */
    /* s: 1, 2 or 5 times a power of ten that no acceleration and no rate of strain limits, where there is one; impacts
       do not limit what is made of small steps */
    double interval;
};

/* Of the packing that the scene has become; its dt need not be known. */
void time_step_of(struct time_step *t, const struct scene *s, const struct packing *p);

/* kg: masses of what yields, so that it is neither shaken by each grain nor slower than all of them. Of a
   wall that glides, one layer of the grains that it can press on; of an edge of the cell 3/(4 pi^2) of
   all grains [Parrinello & Rahman 1981], with which it swings no faster than a wave crosses the cell. */
double time_step_wall_mass(const struct packing *p, const struct wall *w);
double time_step_edge_mass(const struct packing *p);
