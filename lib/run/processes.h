/*
 * run/processes.h: the processes of a run that mpirun has started together. One leads: it reads, writes and speaks;
 * the others make the steps with it. There are two texts of this: run/processes.c for a process alone, and
 * run/mpi_processes.c, with MPI, in nsd-step-mpi.
 */
#pragma once

#include "file/distributed.h"
#include "step/step.h"

/*
 * To be called first: does this process lead? Alone: yes; but where mpirun has started several it becomes
 * nsd-step-mpi, and ends the tool where there is none.
 */
bool processes_join(void);
/* Has mpirun, or its like, started this process? Its standard output is no terminal then, whatever it seems. */
bool processes_started(void);
/* How many there are */
int processes_size(void);
/* Those who do not lead: makes the steps until processes_leave(), and returns the exit status. */
int processes_follow(void);
/* The leader: who takes the bodies of what it reads, where no process shall have all of them; NULL: nobody. contacts: of
   steps that are kept they are wanted */
struct distributed *processes_take_bodies(bool contacts);
/* What has happened to the leader's packing since the step before */
struct changes {
    bool bodies; /* it has others */
    bool acts;   /* a program acts on it [state/external_force.h], or has */
};
/* The leader: step_advance() of a frame by all */
int processes_step(struct frame *f, struct step_memory *m, struct changes changes,
                   const struct step_opt *o, struct failure *failure);
/* The leader, in the end: the others are done. A word of what they have told each other, or NULL */
const char *processes_leave(void);
