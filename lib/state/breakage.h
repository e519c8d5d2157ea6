/*
 * state/breakage.h: how the grains of a material break, and the account of those that have broken.
 *
 * A grain of diameter d, that of the ball (disc) of its volume, has the strength
 *
 *     S = strength (d / size)^-e (-ln(1 - q))^(1/m),   0 <= q < 1 a number of its id alone
 *
 * so that the strengths of grains of one size have Weibull's distribution of modulus m [Weibull 1951]; e = 3/m (in the plane
 * 2/m) is its weakest link [Jaeger 1967]. m = 0: all of a size have the same strength, and e = 0 unless it is given. What
 * a step does to it, over S, is its load:
 *
 *     force   the largest force of a neighbour over d^2 (in the plane over d times 1 m) [Jaeger 1967]
 *     stress  the mean of its stress, a third of the trace (in the plane half of it), compression positive
 *     shear   the octahedral shear stress of its stress [McDowell & de Bono 2013]
 *     energy  the energy of an impact over its mass, less `least`, which scales with size as S does
 *
 * The damage of a grain is the largest load so far or, with laws of damage, what impacts add up to; with 1 it breaks:
 *
 *     linear  damage += load [the total of energy beyond a threshold: Vogel & Peukert 2003]
 *     tavares damage += (1 - damage) D,  D = (2 gamma E / (2 gamma - 5 D + 5))^(2 gamma / 5),
 *             E = load / (1 - damage) < 1 [Tavares 2009]
 */
#pragma once

#include "base/failure.h"

#include <stdbool.h>
#include <stdint.h>

enum breakage_by { BREAKAGE_FORCE, BREAKAGE_STRESS, BREAKAGE_SHEAR, BREAKAGE_ENERGY, BREAKAGE_BYS };
enum breakage_damage { DAMAGE_NONE, DAMAGE_LINEAR, DAMAGE_TAVARES, DAMAGES };
enum breakage_into { INTO_PIECES, INTO_BALLS, INTOS };

/* Of a material */
struct breakage {
    double strength; /* Pa; by energy J/kg; 0: its grains do not break */
    double size;     /* m: the diameter at which they have it; 0: at any */
    double modulus;  /* of Weibull's distribution; 0: without scatter */
    double exponent; /* e */
    double least;    /* J/kg: of impacts that do no damage */
    double gamma;    /* of damage */
    double smallest; /* m: no grain of a smaller diameter breaks */
    double dust;     /* m: pieces of a smaller diameter are dust */
    int64_t pieces;  /* that a grain breaks into */
    int32_t by, damage, into;
};

/* Of the grains of a material, since the first frame */
struct broken {
    int64_t grains, originals; /* that have broken, and those of generation 0 */
    int64_t fragments;         /* into which */
    int64_t waiting;           /* that are due, and were too many for the step */
    double mass;               /* kg: of originals that have broken */
    double dust;               /* kg: of what was left over */
    double momentum[3];        /* N s: that dust had */
    double kinetic, potential; /* J: that dust had */
    double taken;              /* J: both, of the grains that broke before the step in hand */
};

/* What is wrong with numbers that are in their ranges, or NULL */
const char *breakage_trouble(const struct breakage *b);

/* The shape of a fragment is called so, for the grain with its id that it is made for; the id of such a name, or -1 */
#define BREAKAGE_FRAGMENT "fragment %d"
int32_t breakage_fragment(const char *name);
/* What 1 - (1 - damage)(1 - D) is after an impact of this load */
double breakage_tavares(double damage, double load, double gamma);
