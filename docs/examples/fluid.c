/* A glass ball sinks in water: drag by Schiller and Naumann, buoyancy, and the velocity that it comes to, m/s, beside the one
   at which they balance its weight. cc fluid.c $(pkg-config --cflags --libs nsd) -lm */
#include <err.h>
#include <math.h>
#include <nsd.h>
#include <stdio.h>
#include <stdlib.h>

static const char scene[] = "{ \"dt\": 2e-4, \"density\": 2500, \"bodies\": ["
                            " { \"x\": [0, 0, 0], \"radius\": 5e-4 },"
                            " { \"x\": [1, 0, 0], \"radius\": 1e-3 } ] }";
static const double density = 1000, viscosity = 1e-3, g = 9.81; /* kg/m^3, Pa s, m/s^2: of water */
static const double pi = 3.14159265358979323846;

/* N s/m: the drag on a ball of diameter d (m) over its speed v (m/s) through the water */
static double drag(double d, double v)
{
    double Re = density * v * d / viscosity;
    return 3 * pi * viscosity * d * (1 + 0.15 * pow(Re, 0.687));
}

/* m/s: at which drag carries what buoyancy leaves of the weight (N) of a ball of diameter d (m) */
static double terminal(double d, double weight)
{
    double lo = 0, hi = 10;
    while (hi - lo > 1e-12) {
        double v = 0.5 * (lo + hi);
        *(drag(d, v) * v < weight ? &lo : &hi) = v;
    }
    return lo;
}

static double *array(struct nsd_run *run, const char *name, int64_t *n)
{
    struct nsd_array a = { .size = sizeof a };
    if (nsd_read(run, name, &a)) errx(1, "%s", nsd_error(run));
    if (n) *n = a.shape[0];
    return a.data;
}

int main(void)
{
    struct nsd_run *run;
    int64_t n;
    if (nsd_from_scene(&run, scene, NULL)) errx(1, "%s", nsd_error(NULL));
    const double *v = array(run, "velocity", &n), *r = array(run, "radius", NULL);
    const double *m = array(run, "mass", NULL);
    double *force = array(run, "force", NULL); /* they stay where they are */
    for (int k = 0; k < 10000; k++) {
        for (int64_t i = 0; i < n; i++) {
            const double *u = v + 3 * i, volume = 4 * pi / 3 * r[i] * r[i] * r[i];
            double c = drag(2 * r[i], sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
            for (int j = 0; j < 3; j++) force[3 * i + j] = -c * u[j];
            force[3 * i + 2] += density * volume * g;
        }
        if (nsd_step(run, 1)) errx(1, "%s", nsd_error(run));
    }
    for (int64_t i = 0; i < n; i++) {
        double weight = (m[i] - density * 4 * pi / 3 * r[i] * r[i] * r[i]) * g;
        printf("{\"diameter\":%g,\"velocity\":%.6f,\"expected\":%.6f}\n", 2 * r[i], -v[3 * i + 2],
               terminal(2 * r[i], weight));
    }
    nsd_close(&run);
    return 0;
}
