/* The library in a program of one's own: cc step.c $(pkg-config --cflags --libs nsd) */
#include "scene/scene_build.h"
#include "solve/step.h"

#include <stdio.h>

int main(void)
{
    struct why why = { 0 };
    struct scene scene;
    struct packing p;
    struct contacts contacts = { 0 };
    struct report report = { 0 };
    struct step_opt o = { .warm = true, .solve = { .global = &solver_nlgs, .method = &local_exact,
                          .criterion = CRITERION_NATURAL, .eps = 1e-6, .max_sweeps = 10000, .threads = 1 } };
    bool failed = scene_paper(&scene, 3, 100, &why) || scene_build(&p, &scene, NULL, &why);
    for (int k = 0; k < 200 && !failed; k++)
        failed = step_advance(&p, &contacts, NULL, &o, &report, &why);
    if (failed) return fprintf(stderr, "%s\n", why.text), 1;
    printf("%lld %.17g %lld %.17g\n", (long long)p.step, p.t, (long long)contacts.n, p.x[0].z);
    return 0;
}
