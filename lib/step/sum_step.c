#include "step/sum_step.h"

#include "state/face_of.h"
#include "step/contact_motion.h"

#include <math.h>
#include <stdlib.h>

static void sum_step_add(struct face_sums *to, const struct packing *p, const struct contacts *s,
                         int64_t i, const struct impulses *sum)
{
    const struct contact *c = &s->c[i];
    const double *r = s->found[i].r, *moment = s->moment ? s->moment[i] : NULL;
    const struct contact_motion m = contact_motion(p, sum, c);
    const vec3 f = contact_in_space(c, r);
    to->impulse = v3_sub(to->impulse, f);
    to->moment = v3_sub(to->moment, v3_cross(c->x, f));
    if (moment) to->moment = v3_sub(to->moment, contact_in_space(c, moment));
    to->normal += r[0], to->tangential += hypot(r[1], r[2]);
    to->work += contact_wall_work(&m, c, r, moment);
    to->friction += contact_loss(&m, c, r, moment).friction;
    if (r[0] > 0) to->rub += r[0] * hypot(v3_dot(m.u, c->t1), v3_dot(m.u, contact_t2(c)));
}

int sum_step_faces(struct packing *p, struct failure *failure)
{
    if (p->sums.faces) return 0;
    if (!(p->sums.faces = calloc(1, sizeof *p->sums.faces)))
        return failure_set(failure, EX_SOFTWARE, "no memory for the sums");
    return face_of_init(p->sums.faces, p, true, failure);
}

int sum_step(struct packing *p, const struct contacts *s, const struct impulses *sum,
             struct failure *failure)
{
    if (!p->sums.n) return 0;
    if (sum_step_faces(p, failure)) return failure->status;
    const struct wall_faces *f = p->sums.faces;
    for (int64_t i = 0; i < s->n && s->c[i].a < 0; i++) { // walls come first
        const double *r = s->found[i].r;
        if (r[0] == 0 && r[1] == 0 && r[2] == 0) continue;
        int32_t face = face_of_contact(f, p, &s->c[i], sum->ahead);
        sum_step_add(&p->sums.face[f->first[-1 - s->c[i].a] + face], p, s, i, sum);
    }
    return 0;
}
