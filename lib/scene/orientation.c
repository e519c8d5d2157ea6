#include "scene/orientation.h"

/* A quaternion on the unit sphere by rejection: without sines, whose last bits differ between machines */
static quat draw(int dim, gsl_rng *rng)
{
    double x[4], sum;
    do {
        sum = 0;
        for (int k = 0; k < 4; k++) {
            x[k] = dim == 2 && (k == 1 || k == 2) ? 0 : 2 * gsl_rng_uniform(rng) - 1;
            sum += x[k] * x[k];
        }
    } while (sum > 1 || sum < 1e-4);
    return quat_unit((quat){ x[0], x[1], x[2], x[3] });
}

quat orientation_draw(const struct scene *s, const struct scene_form *form, gsl_rng *rng)
{
    quat q = form->tumbled ? draw(s->dim, rng) : form->turned;
    return quat_unit(quat_mul(q, s->solid[form->shape].turn));
}
