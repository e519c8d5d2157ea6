#include "io/background_writer.h"

#include "hdf5/h5.h"

#include <pthread.h>
#include <stdlib.h>

struct background_writer {
    struct writer *writer;
    pthread_t thread;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t changed;
    struct frame frame;
    bool full;      /* frame is to be written, or is being */
    bool over;      /* none comes any more */
    struct why why; /* of the first that could not be */
};

static void *write_frames(void *arg)
{
    struct background_writer *b = arg;
    h5_start(); // of each thread libhdf5 asks anew whether it shall print its errors
    pthread_mutex_lock(&b->lock);
    for (;;) {
        while (!b->full && !b->over) pthread_cond_wait(&b->changed, &b->lock);
        if (!b->full) break;
        struct why why = b->why;
        pthread_mutex_unlock(&b->lock);
        if (!why.status) writer_frame(b->writer, &b->frame, &why);
        packing_free(&b->frame.packing);
        contacts_free(&b->frame.contacts);
        pthread_mutex_lock(&b->lock);
        b->why = why, b->full = false;
        pthread_cond_broadcast(&b->changed);
    }
    pthread_mutex_unlock(&b->lock);
    return NULL;
}

int background_open(struct background_writer **out, struct writer *writer, struct why *why)
{
    struct background_writer *b = *out = calloc(1, sizeof *b);
    if (!b) return why_set(why, EX_SOFTWARE, "no memory");
    b->writer = writer;
    pthread_mutex_init(&b->lock, NULL), pthread_cond_init(&b->changed, NULL);
    if (!pthread_create(&b->thread, NULL, write_frames, b)) return 0;
    free(b);
    *out = NULL;
    return why_set(why, EX_SOFTWARE, "no thread to write with");
}

/* Once the frame before is written; what became of it */
static int wait_until_empty(struct background_writer *b, struct why *why)
{
    pthread_mutex_lock(&b->lock);
    while (b->full) pthread_cond_wait(&b->changed, &b->lock);
    if (b->why.status) *why = b->why;
    pthread_mutex_unlock(&b->lock);
    return why->status;
}

int background_frame(struct background_writer *b, const struct frame *f, struct why *why)
{
    struct frame copy = *f;
    copy.packing = (struct packing){ 0 }, copy.contacts = (struct contacts){ 0 };
    if (packing_copy(&copy.packing, &f->packing, why)) {
        packing_free(&copy.packing);
        return why->status;
    }
    if (f->detected && contacts_copy(&copy.contacts, &f->contacts)) {
        packing_free(&copy.packing);
        return why_set(why, EX_SOFTWARE, "no memory for the contacts");
    }
    if (wait_until_empty(b, why)) {
        packing_free(&copy.packing), contacts_free(&copy.contacts);
        return why->status;
    }
    pthread_mutex_lock(&b->lock);
    b->frame = copy, b->full = true;
    pthread_cond_broadcast(&b->changed);
    pthread_mutex_unlock(&b->lock);
    return 0;
}

int background_close(struct background_writer *b, struct why *why)
{
    if (!b) return why->status;
    wait_until_empty(b, why);
    pthread_mutex_lock(&b->lock);
    b->over = true;
    pthread_cond_broadcast(&b->changed);
    pthread_mutex_unlock(&b->lock);
    pthread_join(b->thread, NULL);
    free(b);
    return why->status;
}
