/* outside.c DOCUMENT STEPS: what it costs to read all bodies and to put a force on each at every step, beside a run without,
   in turns; ms of the processor. cc -O2 outside.c $(pkg-config --cflags --libs nsd) */
#include <err.h>
#include <nsd.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double cpu(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double *array(struct nsd_run *run, const char *name, int64_t *n)
{
    struct nsd_array a = { .size = sizeof a };
    if (nsd_read(run, name, &a)) errx(1, "%s", nsd_error(run));
    *n = a.shape[0];
    return a.data;
}

/* s: a step, with forces that hardly act */
static double step(struct nsd_run *run, int with)
{
    double begin = cpu();
    int64_t n = 0;
    if (with) {
        const double *x = array(run, "position", &n), *v = array(run, "velocity", &n);
        double *f = array(run, "force", &n);
        for (int64_t i = 0; i < 3 * n; i++) f[i] = -1e-9 * v[i] + 1e-30 * x[i];
    }
    if (nsd_step(run, 1)) errx(1, "%s", nsd_error(run));
    return cpu() - begin;
}

int main(int argc, char **argv)
{
    struct nsd_run *run[2];
    double seconds[2] = { 0, 0 };
    if (argc != 3) errx(64, "usage: outside DOCUMENT STEPS");
    int steps = atoi(argv[2]);
    for (int k = 0; k < 2; k++)
        if (nsd_from_document(&run[k], argv[1])) errx(1, "%s", nsd_error(NULL));
    for (int k = 0; k < 2 * steps; k++) {
        int which = (k ^ k >> 1) & 1; /* 0 1 1 0: neither is always the first */
        seconds[which] += step(run[which], which);
    }
    printf("without %.3f ms, with %.3f ms a step: %+.2f %%\n", 1e3 * seconds[0] / steps,
           1e3 * seconds[1] / steps, 100 * (seconds[1] / seconds[0] - 1));
    nsd_close(&run[0]), nsd_close(&run[1]);
    return 0;
}
