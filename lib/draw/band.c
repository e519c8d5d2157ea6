/* draw/band.c: the memory of a band, and the samples near a point. */
#include "draw/band.h"

#include <stdlib.h>

int band_clamp(double x, int lo, int hi)
{
    return !(x > lo) ? lo : x >= hi ? hi : (int)x;
}

struct patch band_patch(const struct band *b, double x, double y, double r)
{
    return (struct patch){ band_clamp(ceil(x - r - 0.5), 0, b->width),
                           band_clamp(floor(x + r - 0.5) + 1, 0, b->width),
                           band_clamp(ceil(y - r - 0.5), b->y0, b->y1),
                           band_clamp(floor(y + r - 0.5) + 1, b->y0, b->y1) };
}

bool band_init(struct band *b, const struct raster *s, int rows)
{
    size_t n = (size_t)rows * (size_t)s->width;
    *b = (struct band){ .width = s->width };
    b->z = calloc(n, sizeof *b->z), b->what = calloc(n, sizeof *b->what);
    b->n = calloc(n, sizeof *b->n);
    size_t tiles = (size_t)(s->width / SHADE_TILE + 1) * (size_t)(rows / SHADE_TILE + 1);
    b->range = malloc(tiles * sizeof *b->range);
    b->dark = calloc(n, sizeof *b->dark), b->edge = calloc(n, sizeof *b->edge);
    if (s->panes) b->veil = calloc(n, sizeof *b->veil);
    b->spot = malloc((size_t)(s->spots + 1) * sizeof *b->spot);
    return b->z && b->what && b->n && b->range && b->dark && b->edge && b->spot &&
           (b->veil || !s->panes);
}

void band_free(struct band *b)
{
    free(b->z), free(b->what), free(b->n), free(b->range), free(b->dark), free(b->edge),
        free(b->spot), free(b->veil);
}
