#include "file/request.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

enum { ANSWER = 4096 /* an answer takes as long as so many bytes of it */ };

int sink_bytes(struct sink *sink, struct reply *reply, const void *bytes, size_t size)
{
    reply->there = true, reply->size = size;
    if (sink->begin(sink, reply)) return -1;
    for (size_t done = 0; done < size;) {
        size_t most;
        void *to = sink->room(sink, &most);
        if (most > size - done) most = size - done;
        memcpy(to, (const char *)bytes + done, most);
        done += most;
        if (sink->put(sink, most)) return -1;
    }
    return 0;
}

static int taker_begin(struct sink *sink, const struct reply *reply)
{
    struct taker *t = (struct taker *)sink;
    t->reply = *reply;
    t->reply.text[sizeof t->reply.text - 1] = 0;
    if (t->budget && (budget_draw(t->budget, ANSWER, t->failure) ||
                      budget_draw(t->budget, reply->work, t->failure) ||
                      (!t->pour && budget_draw(t->budget, reply->size, t->failure))))
        return t->failure->status;
    if (t->pour) t->size = reply->size;
    if (!t->out && !t->pour) {
        t->size = reply->size;
        if (reply->size > SIZE_MAX / 2 || !(t->out = malloc((size_t)reply->size + 8)))
            return failure_set(t->failure, EX_SOFTWARE, "no memory for %llu bytes of a document",
                               (unsigned long long)reply->size);
        memset((char *)t->out + reply->size, 0, 8);
    }
    return reply->size == t->size
               ? 0
               : failure_set(t->failure, EX_DATAERR, "an answer of another size");
}

static void *taker_room(struct sink *sink, size_t *most)
{
    struct taker *t = (struct taker *)sink;
    *most = (size_t)(t->size - t->done);
    return (char *)t->out + t->done;
}

static int taker_put(struct sink *sink, size_t size)
{
    ((struct taker *)sink)->done += size;
    return 0;
}

void taker_start(struct taker *t, struct failure *failure)
{
    t->sink = (struct sink){ taker_begin, taker_room, taker_put };
    t->failure = failure;
}

struct request request_of(int op, const char *path)
{
    struct request q;
    memset(&q, 0, sizeof q);
    q.op = op;
    snprintf(q.path, sizeof q.path, "%s", path);
    return q;
}

bool line_send(int line, const void *message, size_t size)
{
    ssize_t n;
    do n = send(line, message, size, MSG_NOSIGNAL);
    while (n < 0 && errno == EINTR);
    return n == (ssize_t)size;
}

ssize_t line_receive(int line, void *message, size_t size)
{
    ssize_t n;
    do n = recv(line, message, size, 0);
    while (n < 0 && errno == EINTR);
    return n;
}
