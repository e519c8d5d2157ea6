#include "export/some_bodies.h"

int some_bodies_init(struct some_bodies *s, const struct packing *p, const struct chosen *c,
                     struct why *why)
{
    int64_t n = 0;
    for (int64_t i = 0; i < p->n; i++) n += chosen_body(c, p, i);
    if (packing_init(&s->bodies, p->dim, n, why)) return why->status;
    if (packing_alloc_optional(&s->bodies, packing_optional(p), why)) {
        packing_free(&s->bodies);
        return why->status;
    }
    n = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (chosen_body(c, p, i)) packing_copy_body(&s->bodies, n++, p, i);
    s->packing = packing_with_bodies(p, &s->bodies, 0, n);
    return 0;
}

void some_bodies_free(struct some_bodies *s)
{
    packing_free(&s->bodies);
}
