/* ranks/answers.c: what ranks answer alike [ranks/answers.h]. */
#include "ranks/answers.h"

#include "base/why.h"

static double most(struct shared *s, double x)
{
    return talk_most(s->talk, x);
}

static int64_t count(struct shared *s, int64_t n)
{
    return talk_sum(s->talk, n);
}

static double agree(struct shared *s, double x)
{
    double since = talk_busy();
    MPI_Bcast(&x, 1, MPI_DOUBLE, 0, s->talk->comm);
    talk_waited(s->talk, since);
    return x;
}

static void fail(struct shared *s)
{
    talk_fail(s->talk, EX_SOFTWARE, "no memory to solve the contacts");
}

void answers_alike(struct shared *s, struct talk *t)
{
    s->talk = t, s->most = most, s->count = count, s->agree = agree, s->fail = fail;
}
