#include "file/background_writer.h"

#include "file/h5.h"

#include <pthread.h>
#include <stdlib.h>

struct background_writer {
    struct writer *writer;
    pthread_t thread;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t changed;
    struct frame frame;
    bool full;              /* frame is to be written, or is being */
    bool over;              /* none comes any more */
    struct failure failure; /* of the first that could not be */
};

static void *write_frames(void *arg)
{
    struct background_writer *b = arg;
    h5_start(); // of each thread libhdf5 asks anew whether it shall print its errors
    pthread_mutex_lock(&b->lock);
    for (;;) {
        while (!b->full && !b->over) pthread_cond_wait(&b->changed, &b->lock);
        if (!b->full) break;
        struct failure failure = b->failure;
        pthread_mutex_unlock(&b->lock);
        if (!failure.status) writer_frame(b->writer, &b->frame, &failure);
        packing_free(&b->frame.packing);
        contacts_free(&b->frame.contacts);
        pthread_mutex_lock(&b->lock);
        b->failure = failure, b->full = false;
        pthread_cond_broadcast(&b->changed);
    }
    pthread_mutex_unlock(&b->lock);
    return NULL;
}

int background_open(struct background_writer **out, struct writer *writer, struct failure *failure)
{
    struct background_writer *b = *out = calloc(1, sizeof *b);
    if (!b) return failure_set(failure, EX_SOFTWARE, "no memory");
    b->writer = writer;
    pthread_mutex_init(&b->lock, NULL), pthread_cond_init(&b->changed, NULL);
    if (!pthread_create(&b->thread, NULL, write_frames, b)) return 0;
    free(b);
    *out = NULL;
    return failure_set(failure, EX_SOFTWARE, "no thread to write with");
}

/* Once the frame before is written; what became of it */
static int wait_until_empty(struct background_writer *b, struct failure *failure)
{
    pthread_mutex_lock(&b->lock);
    while (b->full) pthread_cond_wait(&b->changed, &b->lock);
    if (b->failure.status) *failure = b->failure;
    pthread_mutex_unlock(&b->lock);
    return failure->status;
}

int background_frame(struct background_writer *b, const struct frame *f, struct failure *failure)
{
    struct frame copy = *f;
    copy.packing = (struct packing){ 0 }, copy.contacts = (struct contacts){ 0 };
    if (packing_copy(&copy.packing, &f->packing, failure)) {
        packing_free(&copy.packing);
        return failure->status;
    }
    if (f->detected && contacts_copy(&copy.contacts, &f->contacts)) {
        packing_free(&copy.packing);
        return failure_set(failure, EX_SOFTWARE, "no memory for the contacts");
    }
    if (wait_until_empty(b, failure)) {
        packing_free(&copy.packing), contacts_free(&copy.contacts);
        return failure->status;
    }
    pthread_mutex_lock(&b->lock);
    b->frame = copy, b->full = true;
    pthread_cond_broadcast(&b->changed);
    pthread_mutex_unlock(&b->lock);
    return 0;
}

int background_close(struct background_writer *b, struct failure *failure)
{
    if (!b) return failure->status;
    wait_until_empty(b, failure);
    pthread_mutex_lock(&b->lock);
    b->over = true;
    pthread_cond_broadcast(&b->changed);
    pthread_mutex_unlock(&b->lock);
    pthread_join(b->thread, NULL);
    free(b);
    return failure->status;
}
