/* measure/fraction.c: how much of the volume is solid. */
#include "measure/ball_part.h"
#include "measure/inside.h"
#include "measure/measures.h"

static const struct quantity quantities[] = {
    { "fraction", "1", 1, "solid volume over volume of the region" },
    { "void_ratio", "1", 1, "void volume over solid volume" },
    { "solid", "m3", 1, "volume of the bodies inside the region (2D: m2)" },
    { "volume", "m3", 1, "volume of the region (2D: m2)" },
    { "from", "m", 3, "lowest corner of the region or of its bounding box" },
    { "to", "m", 3, "opposite corner" },
    { 0 },
};

static int fraction_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    struct region region = s->region;
    const struct region *r = &region;
    double solid = 0, *at = table_row(t, failure);
    if (!at || (!s->asked->boxed && region_inside(&region, p, failure) && failure->status))
        return failure->status;
    for (int64_t i = 0; i < p->n; i++)
        if (snapshot_body(s, i)) solid += grain_fill(p, i) * region_ball(r, p->x[i], p->radius[i]);
    if (!(r->volume > 0)) table_null(t, "the region has no volume");
    if (!(solid > 0)) table_null(t, "the box is empty: no void ratio");
    put(&at, r->volume > 0 ? solid / r->volume : NAN);
    put(&at, solid > 0 ? (r->volume - solid) / solid : NAN);
    put(&at, solid), put(&at, r->volume);
    double flat = p->dim == 2 ? 0 : 1;
    put_vec(&at, v3(r->lo[0], r->lo[1], flat > 0 ? r->lo[2] : 0));
    put_vec(&at, v3(r->hi[0], r->hi[1], flat > 0 ? r->hi[2] : 0));
    return 0;
}

const struct measure measure_fraction = {
    .name = "fraction",
    .help = "volume fraction, void ratio, volumes",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .usual = true,
    .rows = fraction_rows,
};
