#include "convert/some_bodies.h"

int some_bodies_init(struct some_bodies *s, const struct packing *p, const struct selection *c,
                     struct failure *failure)
{
    int64_t n = 0;
    for (int64_t i = 0; i < p->n; i++) n += selection_body(c, p, i);
    if (packing_init(&s->bodies, p->dim, n, failure)) return failure->status;
    if (packing_alloc_optional(&s->bodies, packing_optional(p), failure)) {
        packing_free(&s->bodies);
        return failure->status;
    }
    n = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (selection_body(c, p, i)) packing_copy_body(&s->bodies, n++, p, i);
    s->packing = packing_with_bodies(p, &s->bodies, 0, n);
    return 0;
}

void some_bodies_free(struct some_bodies *s)
{
    packing_free(&s->bodies);
}
