/* run/answer_frame.c: the answer that a whole document is [run/answer.h]. */
#include "run/answer.h"
#include "file/frame.h"

#include <stdio.h>
#include <string.h>

static int reply_frame_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for an answer");
}

static int other(struct failure *failure, const char *what)
{
    return failure_set(failure, EX_DATAERR, "the document answered has another %s than the run", what);
}

/* ---- what has to be the same ---- */

/* A number of a body that is not to be changed, and is */
static int check_column(const struct body_column *b, const struct packing *q,
                        const struct packing *p, struct failure *failure)
{
    const size_t row = column_bytes(&b->column);
    const char *x = column_array(&b->column, q), *y = column_array(&b->column, p);
    if (!x && !y) return 0;
    if (!x || !y) return other(failure, b->column.name);
    for (int64_t i = 0; i < p->n; i++)
        if (memcmp(x + (size_t)i * row, y + (size_t)i * row, row) != 0)
            return failure_set(failure, EX_DATAERR,
                           "the document answered has another %s of body %d than the run, which "
                           "cannot be changed",
                           b->column.name, p->id[i]);
    return 0;
}

static int check_boundaries(const struct packing *q, const struct packing *p, struct failure *failure)
{
    for (int32_t w = 0; w < p->walls; w++) {
        vec3 d = v3_sub(q->wall[w].x, p->wall[w].x), v = v3_sub(q->wall[w].v, p->wall[w].v);
        if (v3_norm(v) == 0 && v3_norm(d) != 0)
            return failure_set(failure, EX_DATAERR,
                           "the document answered has another place of boundary %d than the run, "
                           "which cannot be changed",
                           w);
    }
    return 0;
}

static int reply_frame_check_same(const struct frame *f, const struct packing *p, struct failure *failure)
{
    const struct packing *q = &f->packing;
    if (q->dim != p->dim) return other(failure, "dim");
    if (q->step != p->step)
        return failure_set(failure, EX_DATAERR,
                       "the document answered is of step %lld, and the run has made step %lld",
                       (long long)q->step, (long long)p->step);
    if (q->t != p->t || q->dt != p->dt) return other(failure, q->t != p->t ? "time" : "dt");
    if (q->n != p->n)
        return failure_set(failure, EX_DATAERR, "the document answered has %lld bodies, and there are %lld",
                       (long long)q->n, (long long)p->n);
    if (q->walls != p->walls) return other(failure, "number of boundaries");
    bool kinds = q->kinds == p->kinds;
    for (int32_t k = 0; kinds && k < p->kinds; k++)
        kinds = !strcmp(q->kind_name[k], p->kind_name[k]);
    if (!kinds) return other(failure, "list of materials");
    for (int k = 0; k < BODY_COLUMNS; k++)
        if (k != BODY_v && k != BODY_w && check_column(&body_columns[k], q, p, failure))
            return failure->status;
    return check_boundaries(q, p, failure);
}

/* ---- what is taken ---- */

static json_t *reply_frame_numbers(vec3 x)
{
    return json_pack("[f, f, f]", x.x, x.y, x.z);
}

static bool reply_frame_same(vec3 x, vec3 y)
{
    return x.x == y.x && x.y == y.y && x.z == y.z;
}

/* Of the bodies in which `to` differs from `from` (NULL: from 0) */
static int put_bodies(json_t *answer, const char *name, const struct packing *p, const vec3 *to,
                      const vec3 *from, struct failure *failure)
{
    json_t *all = NULL;
    char id[20];
    for (int64_t i = 0; to && i < p->n && !failure->status; i++) {
        if (from ? reply_frame_same(to[i], from[i]) : v3_norm(to[i]) == 0) continue;
        snprintf(id, sizeof id, "%d", p->id[i]);
        if (!all) all = json_object();
        if (!all || json_object_set_new(all, id, reply_frame_numbers(to[i]))) reply_frame_no_memory(failure);
    }
    if (failure->status) return json_decref(all), failure->status;
    return all && json_object_set_new(answer, name, all) ? reply_frame_no_memory(failure) : 0;
}

static int reply_frame_put_boundaries(json_t *answer, const struct packing *q, const struct packing *p,
                          struct failure *failure)
{
    json_t *all = NULL;
    char number[20];
    for (int32_t w = 0; w < p->walls && !failure->status; w++) {
        const vec3 v = q->wall[w].v;
        const double push = q->outside.lasts.push ? q->outside.lasts.push[w] : 0;
        if (reply_frame_same(v, p->wall[w].v) && push == 0) continue;
        json_t *one = json_object();
        bool good =
            one && (reply_frame_same(v, p->wall[w].v) || !json_object_set_new(one, "velocity", reply_frame_numbers(v)));
        good = good && (push == 0 || !json_object_set_new(one, "force", json_real(push)));
        snprintf(number, sizeof number, "%d", w);
        if (!all) all = json_object();
        if (!good || !all) {
            json_decref(one);
            reply_frame_no_memory(failure);
        } else if (json_object_set_new(all, number, one)) {
            reply_frame_no_memory(failure);
        }
    }
    if (failure->status) return json_decref(all), failure->status;
    return all && json_object_set_new(answer, "boundaries", all) ? reply_frame_no_memory(failure) : 0;
}

static int put_frictions(json_t *answer, const struct packing *q, const struct packing *p,
                         struct failure *failure)
{
    json_t *all = NULL;
    for (int32_t a = 0; a < p->kinds; a++)
        for (int32_t b = a; b < p->kinds; b++) {
            const double mu = q->mu[a * p->kinds + b];
            if (mu == p->mu[a * p->kinds + b]) continue;
            if (!all) all = json_array();
            if (!all || json_array_append_new(
                            all, json_pack("[s, s, f]", p->kind_name[a], p->kind_name[b], mu)))
                return json_decref(all), reply_frame_no_memory(failure);
        }
    return all && json_object_set_new(answer, "friction", all) ? reply_frame_no_memory(failure) : 0;
}

json_t *reply_of_frame(const struct frame *f, const struct packing *p, struct failure *failure)
{
    const struct packing *q = &f->packing;
    const struct lasting *s = &q->outside.lasts;
    json_t *answer = json_object();
    if (!answer) return reply_frame_no_memory(failure), NULL;
    if (!reply_frame_check_same(f, p, failure) && !put_bodies(answer, "forces", p, s->force, NULL, failure) &&
        !put_bodies(answer, "torques", p, s->torque, NULL, failure) &&
        !put_bodies(answer, "velocities", p, q->v, p->v, failure) &&
        !put_bodies(answer, "angular_velocities", p, q->w, p->w, failure) &&
        !reply_frame_put_boundaries(answer, q, p, failure) && !put_frictions(answer, q, p, failure) &&
        !reply_frame_same(q->g, p->g) && json_object_set_new(answer, "gravity", reply_frame_numbers(q->g)))
        reply_frame_no_memory(failure);
    if (!failure->status) return answer;
    json_decref(answer);
    return NULL;
}
