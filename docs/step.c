/* The library in a program of one's own: cc step.c $(pkg-config --cflags --libs nsd) */
#include <err.h>
#include <nsd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The settings of the run */
static const char *const settings[][2] = {
    { "local", "exact" },       { "criterion", "natural" }, { "tolerance", "1e-6" },
    { "max-sweeps", "10000" },  { "order", "natural" },     { "warm", "true" },
    { "overlap-rule", "keep" },
};

/* The number of that name */
static double number(struct nsd_run *run, const char *name)
{
    double x;
    if (nsd_number(run, name, &x)) errx(1, "%s", nsd_error(run));
    return x;
}

int main(int argc, char **argv)
{
    struct nsd_run *run;
    struct nsd_array position = { .size = sizeof position };
    if (argc != 2) errx(64, "usage: step SCENE.json");
    if (nsd_from_scene_file(&run, argv[1])) errx(1, "%s", nsd_error(NULL));
    for (size_t k = 0; k < sizeof settings / sizeof settings[0]; k++)
        if (nsd_set(run, settings[k][0], settings[k][1])) errx(1, "%s", nsd_error(run));
    if (nsd_step(run, 200)) errx(1, "%s", nsd_error(run));
    if (nsd_read(run, "position", &position)) errx(1, "%s", nsd_error(run));
    const double *x = position.data;
    printf("%.0f %.17g %.0f %.17g\n", number(run, "step"), number(run, "time"),
           number(run, "contacts"), x[2]);
    nsd_close(&run);
    return 0;
}
