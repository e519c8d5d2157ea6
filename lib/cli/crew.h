/*
 * cli/crew.h: the processes of a run that mpirun has started together. One leads: it reads, writes and speaks;
 * the others make the steps with it. There are two texts of this: cli/crew.c for a process alone, and
 * ranks/company.c, with MPI, in nsd-step-mpi.
 */
#ifndef NSD_CREW_H
#define NSD_CREW_H

#include "io/elsewhere.h"
#include "solve/step.h"

/*
 * To be called first: does this process lead? Alone: yes; but where mpirun has started several it becomes
 * nsd-step-mpi, and ends the tool where there is none.
 */
bool crew_join(void);
/* Has mpirun, or its like, started this process? Its standard output is no terminal then, whatever it seems. */
bool crew_started(void);
/* How many there are */
int crew_size(void);
/* Those who do not lead: makes the steps until crew_leave(), and returns the exit status. */
int crew_follow(void);
/* The leader: who takes the bodies of what it reads, where no process shall have all of them; contacts: of steps
   that are kept they are wanted. NULL: nobody */
struct elsewhere *crew_elsewhere(bool contacts);
/* The leader: step_advance() of a frame by all. other_bodies: its packing has others than after the step
   before. */
int crew_step(struct frame *f, struct step_memory *m, bool other_bodies, const struct step_opt *o,
              struct why *why);
/* The leader, in the end: the others are done. A word of what they have told each other, or NULL */
const char *crew_leave(void);

#endif
