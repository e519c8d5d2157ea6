/* convert/sheet_box.c: the cell as the lines along its edges; none where nothing repeats. */
#include "convert/sheet.h"

int sheet_box(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct cell *c = &m->packing->cell;
    struct box b;
    s->shape = SHEET_LINE;
    if (!cell_repeats(c)) return 0;
    export_frame_box(&b, m->packing);
    for (int k = 0; k < 3; k++)
        for (int corner = 0; corner < 4; corner++) {
            vec3 from = b.origin;
            if (corner & 1) from = v3_add(from, b.edge[(k + 1) % 3]);
            if (corner & 2) from = v3_add(from, b.edge[(k + 2) % 3]);
            const vec3 line[2] = { from, v3_add(from, b.edge[k]) };
            if (sheet_add(s, 2, line, failure)) return failure->status;
        }
    int32_t *edge = sheet_whole(s, "edge", "", failure), *repeats = sheet_whole(s, "repeats", "", failure);
    double *rate = sheet_real(s, "rate", "xyz", failure);
    if (failure->status) return failure->status;
    for (int k = 0; k < 12; k++) {
        const vec3 r = c->rate[k / 4];
        edge[k] = k / 4, repeats[k] = c->repeats[k / 4];
        rate[3 * k] = r.x, rate[3 * k + 1] = r.y, rate[3 * k + 2] = r.z;
    }
    return 0;
}
