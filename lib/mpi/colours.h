/*
 * mpi/colours.h: the contacts of all ranks, solved in the order in which one process solves them: the same
 * bits on any number of ranks.
 *
 * The order is one of all contacts, and knows of no ranks. Each rank solves, group after group, the contacts
 * in which it owns a body; those at a border are solved by both owners, alike. A body of a border may also have
 * contacts of which the rank with its copy knows nothing: after their group its owner tells that rank its
 * velocity. Groups are walked through in three parts, in each of which bundles start again:
 *
 *     3 g      own contacts after which something is to be told
 *     3 g + 1  copies: contacts that another rank counts. Then messages are sent,
 *     3 g + 2  and fly while the others are solved
 */
#pragma once

#include "mpi/contact_list.h"
#include "mpi/halo.h"
#include "solve/exchange.h"
#include "solve/problem.h"

struct colours {
    struct exchange exchange; /* first: what solvers are given leads back here */
    struct subdomain *part;
    struct halo wires;
    struct tally_order tally;
    bool tallied;  /* tally is made */
    int64_t *slot; /* [contacts here] in the order of all; -1: another counts it */
    struct schedule plan;
};

/* groups, bundles, halves, contacts: of the order of all; verdict[s->n]: of the contacts here. */
void colours_begin(struct colours *c, struct subdomain *y, const struct contacts *s,
                   const struct verdict *verdict, int64_t groups, int64_t bundles);
void colours_free(struct colours *c);
