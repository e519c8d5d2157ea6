/* scene/stiffness.c: the stiffness that a scene or a command line gives to contacts [scene/stiffness.h]. */
#include "scene/stiffness.h"

#include "base/text.h"
#include "contact/spring.h"
#include "scene/time_step.h"

#include <string.h>

/* N/m: of a bar with the cross-section and the length of a grain, in the plane for each metre of thickness */
static double stiffness_of_bar(int dim, double young, double radius)
{
    return dim == 2 ? young : M_PI_4 * young * 2 * radius;
}

void stiffness_expect(struct packing *p, const struct scene *s)
{
    for (int32_t i = 0; p->law && i < p->materials * p->materials; i++)
        if (stiffness_given(&s->law[i]) && !pair_law_springs(&p->law[i]))
            p->law[i].kn = p->law[i].kt = 1;
}

int stiffness_build(struct packing *p, const struct scene *s, struct failure *failure)
{
    struct time_step t = { .radius = INFINITY };
    bool any = false;
    const int32_t pairs = p->materials * p->materials;
    for (int32_t i = 0; i < pairs; i++) any = any || s->law[i].young > 0;
    if (any) time_step_of(&t, s, p); // the smallest radius, of bodies that inlets bring too
    for (int32_t i = 0; p->law && i < pairs; i++) {
        const struct scene_law *l = &s->law[i];
        if (p->dim == 3 && l->young > 0 && !isfinite(t.radius))
            return failure_set(failure, EX_DATAERR,
                               "stiffness: young: no body has a diameter: give a stiffness in N/m");
        if (l->young > 0) p->law[i].kn = stiffness_of_bar(p->dim, l->young, t.radius);
        p->law[i].kt = l->tangential > 0 ? l->tangential : SPRING_ACROSS * p->law[i].kn;
    }
    return 0;
}

static bool compliance_read(double *alpha, const char *text)
{
    char *end;
    *alpha = COMPLIANCE_AUTO;
    if (!*text) return true;
    if (*text != ':') return false;
    *alpha = number_read(text + 1, &end);
    return end != text + 1 && !*end && *alpha >= COMPLIANCE_LEAST && *alpha <= 1;
}

int stiffness_read(struct stiffness *to, const char *text, struct failure *failure)
{
    char *end;
    *to = (struct stiffness){ 0, 0 };
    if (!strcmp(text, "rigid")) return 0;
    if (!strncmp(text, "auto", 4)) {
        if (compliance_read(&to->soft, text + 4)) return 0;
        return failure_set(failure, EX_USAGE,
                           "'%.60s': the compliance of auto:ALPHA lies between 1e-9 and 1", text);
    }
    to->k = number_read(text, &end);
    if (end != text && !*end && to->k > 0 && isfinite(to->k)) return 0;
    return failure_set(failure, EX_USAGE,
                       "'%.60s' is neither a number above 0 (N/m) nor rigid nor auto", text);
}

/* What lasts of springs: their stiffness, so that contacts whose stiffness the step decides push as they did; of rigid ones
   nothing */
static void stiffness_remember(struct packing *p, const struct bonds *s, bool springs)
{
    for (int64_t i = 0; i < s->n; i++) {
        struct bond *b = &s->bond[i];
        const struct contact c = { .a = b->a, .b = b->b };
        const double k = p->law[packing_pair(p, c.a, c.b)].kn;
        if (springs && k > 0 && b->pressed) b->spring = k;
        if (springs) continue;
        b->pressed = 0, b->rest = 0, b->spring = 0;
        b->turn = v3(0, 0, 0);
    }
}

int stiffness_set(struct packing *p, struct stiffness to, struct failure *failure)
{
    const int32_t pairs = p->materials * p->materials;
    const bool springs = to.k > 0 || to.soft > 0;
    if (!p->law && !springs) return 0;
    if (!p->law && packing_alloc_laws(p, failure)) return failure->status;
    stiffness_remember(p, &p->bonds, springs);
    for (int32_t i = 0; i < pairs; i++)
        p->law[i].kn = to.k, p->law[i].kt = SPRING_ACROSS * to.k, p->law[i].soft = to.soft;
    return 0;
}

void stiffness_range(const struct packing *p, struct stiffness range[2])
{
    range[0] = range[1] = (struct stiffness){ 0, 0 };
    for (int32_t i = 0; p->law && i < p->materials * p->materials; i++) {
        const double k = p->law[i].kn, soft = p->law[i].soft;
        range[0].k = i ? fmin(range[0].k, k) : k, range[1].k = fmax(range[1].k, k);
        range[0].soft = i ? fmin(range[0].soft, soft) : soft;
        range[1].soft = fmax(range[1].soft, soft);
    }
}

bool stiffness_is(const struct packing *p, struct stiffness s)
{
    struct stiffness range[2];
    stiffness_range(p, range);
    return range[0].k == s.k && range[1].k == s.k && range[0].soft == s.soft &&
           range[1].soft == s.soft;
}

double stiffness_softness(const struct packing *p)
{
    struct stiffness range[2];
    stiffness_range(p, range);
    return range[1].k > 0 ? packing_mean_mass(p) / (2 * range[1].k * p->dt * p->dt) : 0;
}
