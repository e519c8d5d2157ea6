/*
 * run/process.h: the process in which runs are made, its one use of libhdf5 at a time, and its children by fork().
 *
 * A child of fork() has copies of the runs of its parent, and shares the files that they write. It may make runs of its own, but the
 * copies are refused (NSD_USAGE), and its descriptors of those files lead elsewhere: whatever libhdf5 does with them as
 * the child ends does not reach the file.
 */
#pragma once

#include <stdbool.h>
#include <sys/types.h>

/* This process has runs from now on; its number, of which they are. */
pid_t process_begin(void);
/* Was what has this number made by this process? */
bool process_owns(pid_t maker);

/* libhdf5 is used by one thread at a time, and prints nothing meanwhile. */
void process_lock(void);
void process_unlock(void);
