/*
 * step/rebound.h: impacts that gain no energy.
 *
 * Newton's law returns the normal velocity whatever friction does, and friction that reverses the slip of a lever
 * does work: a rod may strike a floor with e_n = 1 and have 1.5 times its energy afterwards [Kane 1984]. Where the
 * contacts of a pair would gain [balance_gains()], the pair's restitution is reduced to s (e_n, e_t), 0 <= s < 1,
 *
 *     -ENOUGH scale <= work(s) <= 0,
 *
 * by regula falsi over whole solves: everything that touches is solved with it. s = 0 gives no gain, for without
 * restitution the kinetic energy of an impact cannot grow. The contacts keep their reduced e_n and e_t.
 */
#ifndef NSD_REBOUND_H
#define NSD_REBOUND_H

#include "step/balance.h"

struct rebound_search;

/* Of solved contacts. *search: NULL at first; to be freed by rebound_free(). Reduces restitutions; *again: they are to
   be solved once more, and this is to be called again. Returns 0 or EX_SOFTWARE. */
int rebound_reduce(struct rebound_search **search, const struct packing *p, struct contacts *s,
                   bool *again, struct failure *failure);
void rebound_free(struct rebound_search *search); /* may be NULL */

#endif
