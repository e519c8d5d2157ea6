/*
 * state/account.h: the account of a run: what went worst in it, in which step, and for which bodies.
 *
 * What is watched is a table, account_watched[]. A new row is one number of a step's report; logs,
 * documents and what nsd-step says in the end follow.
 */
#pragma once

#include "state/names.h"
#include "state/report.h"

#include <stddef.h>

enum account_row {
    ACCOUNT_OVERLAP,
    ACCOUNT_APPROACH,
    ACCOUNT_PINCHED,
    ACCOUNT_FAST,
    ACCOUNT_UNCONVERGED,
    ACCOUNT_ROWS
};

/* What a row has come to. All are doubles, so that a document has a row's as one dataset. */
struct account_entry {
    double value;
    double step; /* whose value it is, the first of several; of a sum: the first that added to it */
    double bodies[2]; /* ids there, as many as the row has; a wall w is -1-w */
};

struct account {
    int64_t steps; /* that it is of; 0: none was made */
    struct account_entry worst[ACCOUNT_ROWS];
};

struct watched {
    const char *name; /* for users, and that of documents, which have the first one that it had */
    const char *stored, *units;
    const char *says;    /* a format for the value, %.3g; */
    const char *one;     /* what a value of 1 is instead; or NULL */
    bool adds;           /* the values of steps are added up; else the largest stands */
    int bodies;          /* that are known there */
    double warns, fails; /* above that it is said at once; above that the run fails under -e */
    /* The value of a step, and its bodies */
    double (*of)(const struct report *report, double bodies[2]);
    const char *cure; /* what to do where it warns */
};
extern const struct watched account_watched[ACCOUNT_ROWS];

/* Adds a step. Returns the rows, as bits 1 << row, that are above what they warn at for the first time. */
unsigned account_add(struct account *account, const struct report *report);
/* Is the row above what fails, and is any? */
bool account_row_fails(const struct account *account, enum account_row row);
bool account_fails(const struct account *account);
/* Does a step by itself? */
bool account_step_fails(const struct report *report);
/* Writes "overlap 0.012 of a radius (step 217, wall 0 and body 3)" into text of that room. */
void account_says(const struct account *account, enum account_row row, const struct names *names,
                  char *text, size_t room);
