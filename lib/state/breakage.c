#include "state/breakage.h"

#include "shape/fracture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *breakage_trouble(const struct breakage *b)
{
    if (!(b->strength > 0)) return NULL;
    if (b->by < 0 || b->by >= BREAKAGE_BYS) return "by is no criterion of breakage";
    if (b->damage < 0 || b->damage >= DAMAGES) return "damage is no law of damage";
    if (b->into < 0 || b->into >= INTOS) return "into is nothing that grains break into";
    if (b->pieces < 2 || b->pieces > FRACTURE_MOST) return "pieces must lie in [2, 64]";
    if (!(b->smallest > 0)) return "smallest must be positive";
    if (!(b->size > 0) && b->exponent != 0)
        return "size must be positive where strength depends on it";
    if (b->damage && b->by != BREAKAGE_ENERGY) return "damage adds up impacts: by energy alone";
    if (b->damage == DAMAGE_TAVARES && !(b->gamma > 0)) return "gamma must be positive";
    return NULL;
}

int32_t breakage_fragment(const char *name)
{
    char again[32];
    int id;
    if (sscanf(name, BREAKAGE_FRAGMENT, &id) != 1 || id < 0) return -1;
    snprintf(again, sizeof again, BREAKAGE_FRAGMENT, id);
    return strcmp(again, name) ? -1 : id;
}

double breakage_tavares(double damage, double load, double gamma)
{
    const double e = load / (1 - damage);
    double D = 0;
    if (!(e < 1)) return 1;
    for (int k = 0; k < 50; k++) // a contraction: five are enough where E < 0.9
        D = pow(2 * gamma * e / (2 * gamma - 5 * D + 5), 2 * gamma / 5);
    return damage + (1 - damage) * D;
}
