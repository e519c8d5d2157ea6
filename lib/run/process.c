#include "run/process.h"

#include "base/output.h"
#include "file/child.h"
#include "file/writer.h"

#include <pthread.h>
#include <unistd.h>

static pthread_mutex_t hdf5 = PTHREAD_MUTEX_INITIALIZER;
static _Thread_local bool held; /* by this thread */
static H5E_auto2_t printer; /* the program's own way to print errors of libhdf5, in this thread */
static void *printer_data;

void process_lock(void)
{
    pthread_mutex_lock(&hdf5);
    held = true;
    H5Eget_auto2(H5E_DEFAULT, &printer, &printer_data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

void process_unlock(void)
{
    H5Eset_auto2(H5E_DEFAULT, printer, printer_data);
    held = false;
    pthread_mutex_unlock(&hdf5);
}

/* ---- fork() ---- */

/* A thread that holds the lock forks for the process that reads [file/child.c], which drops all that it inherits. Any other
   fork is the program's: it waits until no thread is in libhdf5 for us, so that the child finds that whole. */
static void before_fork(void)
{
    if (!held) pthread_mutex_lock(&hdf5);
}

static void after_fork(void)
{
    if (!held) pthread_mutex_unlock(&hdf5);
}

static void in_child(void)
{
    child_forget_all();
    if (held) return;
    writer_forget_all();
    pthread_mutex_unlock(&hdf5);
}

static void process_watch_forks(void)
{
    pthread_atfork(before_fork, after_fork, in_child);
}

pid_t process_begin(void)
{
    static pthread_once_t watched = PTHREAD_ONCE_INIT;
    embedded_set();
    pthread_once(&watched, process_watch_forks);
    return getpid();
}

bool process_owns(pid_t maker)
{
    return maker == getpid();
}
