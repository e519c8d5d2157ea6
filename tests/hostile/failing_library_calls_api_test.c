/* A run in a program (run/nsd.h) when it does not get what it asks for: a call that fails leaves the run as it was
   [tests/support/failing_library_calls.h]. */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): asprintf
#include "failing_library_calls.h"

#include "run/run.h"

static uint32_t add(uint32_t crc, const void *bytes, size_t size)
{
    return document_crc(crc, bytes, size);
}

/* The checksum of all that a call may change */
static uint32_t state(const struct nsd_run *r)
{
    const struct packing *p = &r->f.packing;
    const struct contacts *s = &r->f.contacts;
    const size_t n = (size_t)p->n, m = (size_t)s->n;
    const double numbers[] = { (double)p->n, (double)p->step,  p->t,   p->dt,
                               p->t0,        (double)p->step0, p->g.x, (double)p->walls,
                               (double)m,    r->next_id };
    uint32_t crc = add(0, numbers, sizeof numbers);
    crc = add(crc, p->x, n * sizeof *p->x), crc = add(crc, p->q, n * sizeof *p->q);
    crc = add(crc, p->v, n * sizeof *p->v), crc = add(crc, p->w, n * sizeof *p->w);
    crc = add(crc, p->id, n * sizeof *p->id), crc = add(crc, p->mass, n * sizeof *p->mass);
    for (int32_t w = 0; w < p->walls; w++) {
        const struct load *l = &p->wall[w].load;
        const double load[] = { l->speed, l->travel, p->wall[w].x.x, p->wall[w].v.z };
        crc = add(crc, load, sizeof load);
    }
    for (size_t i = 0; i < (size_t)p->memory.n; i++)
        crc = add(crc, &p->memory.recall[i].r, sizeof p->memory.recall[i].r);
    for (size_t i = 0; i < m; i++) crc = add(crc, &s->c[i].x, sizeof s->c[i].x);
    for (size_t i = 0; i < m && s->found; i++) crc = add(crc, s->found[i].r, sizeof s->found[i].r);
    for (int t = 0; t < CONTROL_TERMS && r->driver.acts.id; t++)
        for (size_t i = 0; i < (size_t)r->driver.acts.n; i++)
            if (v3_norm(r->driver.acts.force[t][i]) > 0)
                crc = add(crc, &r->driver.acts.force[t][i], sizeof(vec3));
    return crc;
}

/* After a call: a failure has left everything as it was, which the test tells by the status 1 where it is not so. */
static int after(const struct nsd_run *r, int failed, uint32_t was, const char *call,
                 struct failure *failure)
{
    bool on = armed;
    armed = false;
    if (failed && state(r) != was)
        failure_set(failure, 1, "%s failed (%s) and has changed the run", call, nsd_error(r));
    else if (failed)
        failure_set(failure, failed, "%s: %s", call, nsd_error(r));
    armed = on;
    return failure->status;
}

#define CALL(what, call)                                                                           \
    do {                                                                                           \
        uint32_t was = state(r);                                                                   \
        int failed = (call);                                                                       \
        if (after(r, failed, was, what, failure)) goto end;                                        \
    } while (0)

/* Is it cut off, or without a key? */
static bool json_lacks(const char *json, const char *key)
{
    return !strstr(json, key) || json[strlen(json) - 1] != '}';
}

static const char *document; /* of a run, for: */

/* A document that is read as objects */
static int looked_at(uint32_t *crc, struct failure *failure)
{
    struct nsd_document *d = NULL;
    struct nsd_array a = { .size = sizeof a };
    const char *json = "";
    int more = 0, failed = nsd_open(&d, document);
    if (!failed) failed = nsd_next(d, &more);
    if (!failed) failed = nsd_objects(d, &json);
    if (!failed) *crc = add(0, json, strlen(json));
    if (!failed) failed = nsd_attributes(d, "/nsd", &json);
    if (!failed) *crc = add(*crc, json, strlen(json));
    if (!failed) failed = nsd_text(d, "/nsd/history", &json);
    if (!failed) *crc = add(*crc, json, strlen(json));
    if (!failed) failed = nsd_rows(d, "/particles/all/position/value", 0, 1, &a);
    if (!failed) *crc = add(*crc, a.data, (size_t)a.shape[1] * sizeof(double));
    if (failed) failure_set(failure, failed, "looked at: %s", nsd_error(NULL));
    nsd_shut(&d);
    return failure->status;
}

/* A run that makes steps is acted on, and gets and loses bodies where the scene does not pour */
static int acted(uint32_t *crc, struct failure *failure)
{
    struct nsd_run *r = NULL;
    const char *json;
    const double x[3] = { 0, 3.5, 0 }, f[3] = { 1, 0, 0 }, radius = 0.1;
    const struct nsd_bodies bodies = {
        .size = sizeof bodies, .n = 1, .position = x, .radius = &radius, .density = 1000
    };
    struct nsd_array a = { .size = sizeof a };
    int32_t id = 0;
    bool on = armed;
    armed = false; // that it is made is what `made` is about
    must(nsd_from_scene(&r, scene_text[now], folder), run_why_of_thread());
    armed = on;
    CALL("set", nsd_set(r, "local", "sbp"));
    CALL("step", nsd_step(r, 1));
    CALL("step", nsd_step(r, 1));
    CALL("force", nsd_force(r, r->f.packing.id[0], f, NULL, NSD_LASTING));
    CALL("read", nsd_read(r, "force_once", &a));
    CALL("read", nsd_read(r, "contact_force", &a));
    CALL("step", nsd_step(r, 1));
    CALL("step", nsd_step(r, 1));
    if (now == 2) CALL("add", nsd_add(r, &bodies, &id));
    if (now == 2) CALL("step", nsd_step(r, 1));
    if (now == 2) CALL("remove", nsd_remove(r, 1, &id));
    CALL("step", nsd_step(r, 1));
    CALL("measure", nsd_measure(r, "energy,displacement", &json));
    if (json_lacks(json, "\"displacement\":"))
        return failure_set(failure, 1, "measure: half a line");
    CALL("names", nsd_names(r, &json));
    if (json_lacks(json, "\"named\":{")) return failure_set(failure, 1, "names: half of them");
    *crc = state(r);
end:
    armed = false;
    nsd_close(&r);
    armed = on;
    return failure->status;
}

static int made(uint32_t *crc, struct failure *failure)
{
    struct nsd_run *r;
    int failed = nsd_from_scene(&r, scene_text[now], folder);
    if (failed) return failure_set(failure, failed, "made: %s", nsd_error(NULL));
    *crc = state(r);
    nsd_close(&r);
    return 0;
}

static int saved(uint32_t *crc, struct failure *failure)
{
    struct nsd_run *r = NULL;
    const char *path = fresh(".h5");
    bool on = armed;
    armed = false;
    must(nsd_from_scene(&r, scene_text[now], folder), run_why_of_thread());
    must(nsd_step(r, 1), &r->failure);
    armed = on;
    CALL("append", nsd_append(r, path));
    CALL("step", nsd_step(r, 1));
    CALL("append", nsd_append(r, path));
    CALL("finish", nsd_finish(r));
    CALL("step", nsd_step(r, 1));
    CALL("append to what there is", nsd_append(r, path));
    CALL("finish", nsd_finish(r));
    armed = false;
    *crc = crc_of(path);
end:
    armed = false;
    nsd_close(&r);
    unlink(path);
    armed = on;
    return failure->status;
}

int main(void)
{
    failing_begin();
    for (now = 0; now < SCENES; now++) {
        each_fails("a run that is made", made);
        each_fails("a run that is acted on", acted);
    }
    now = 0;
    each_fails("a trajectory", saved);
    struct nsd_run *r = NULL;
    document = fresh(".h5");
    must(nsd_from_scene(&r, scene_text[0], folder), run_why_of_thread());
    must(nsd_save(r, document), &r->failure);
    nsd_close(&r);
    each_fails("a document as objects", looked_at);
    unlink(document);
    return failing_done();
}
