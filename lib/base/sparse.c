/* base/sparse.c: entries, the checks of stored matrices, and lists by owner. */
#include "base/sparse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool sparse_add(struct sparse *A, int64_t row, int64_t col, double x)
{
    if (A->count == A->room) {
        int64_t room = 2 * A->room + 64;
        int32_t *r = realloc(A->row, (size_t)room * sizeof *r);
        if (r) A->row = r;
        int32_t *c = realloc(A->col, (size_t)room * sizeof *c);
        if (c) A->col = c;
        double *v = realloc(A->x, (size_t)room * sizeof *v);
        if (v) A->x = v;
        if (!r || !c || !v) return false;
        A->room = room;
    }
    A->row[A->count] = (int32_t)row, A->col[A->count] = (int32_t)col, A->x[A->count++] = x;
    return true;
}

void sparse_free(struct sparse *A)
{
    free(A->row);
    free(A->col);
    free(A->x);
    *A = (struct sparse){ 0 };
}

bool stored_init(struct stored *S, int64_t m, int64_t n, int32_t nz, int64_t count)
{
    uint64_t lines = (uint64_t)(nz == -2 ? m : n) + 1;
    *S = (struct stored){ (int32_t)m, (int32_t)n, nz, (int32_t)count, .np = lines };
    S->ni = S->nx = (uint64_t)count;
    S->p = calloc(lines, sizeof *S->p);
    S->i = malloc((size_t)(count + 1) * sizeof *S->i);
    S->x = malloc((size_t)(count + 1) * sizeof *S->x);
    return S->p && S->i && S->x;
}

void stored_free(struct stored *S)
{
    free(S->p);
    free(S->i);
    free(S->x);
    *S = (struct stored){ 0 };
}

/* p of a compressed matrix begins at 0, never decreases and has lines + 1 values. */
static int check_pointers(const struct stored *S, const char *name, int32_t lines, struct failure *failure)
{
    if (S->np != (uint64_t)lines + 1)
        return failure_set(failure, EX_DATAERR, "%s/p: %llu pointers, %lld are needed", name,
                       (unsigned long long)S->np, lines + 1LL);
    if (S->p[0] != 0) return failure_set(failure, EX_DATAERR, "%s/p: begins with %d, not 0", name, S->p[0]);
    for (int32_t k = 0; k < lines; k++)
        if (S->p[k + 1] < S->p[k])
            return failure_set(failure, EX_DATAERR, "%s/p: falls from %d to %d at entry %lld", name,
                           S->p[k], S->p[k + 1], k + 1LL);
    return 0;
}

/* i, x and, of triplets, p have at least count and at most nzmax values. */
static int check_lengths(const struct stored *S, const char *name, int64_t count, struct failure *failure)
{
    if (S->nzmax < count)
        return failure_set(failure, EX_DATAERR, "%s/nzmax: is %d and there are %lld entries", name,
                       S->nzmax, (long long)count);
    const struct {
        const char *name;
        uint64_t length;
    } of[] = { { "i", S->ni }, { "x", S->nx }, { "p", S->nz < 0 ? S->ni : S->np } };
    for (int k = 0; k < 3; k++)
        if (of[k].length < (uint64_t)count || of[k].length > (uint64_t)S->nzmax)
            return failure_set(failure, EX_DATAERR, "%s/%s: %llu values for %lld entries, nzmax %d", name,
                           of[k].name, (unsigned long long)of[k].length, (long long)count,
                           S->nzmax);
    return 0;
}

static int check_entries(const struct sparse *A, bool by_rows, const char *name, struct failure *failure)
{
    const char *row = by_rows ? "p" : "i", *col = by_rows ? "i" : "p";
    const char *letter = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
    for (int64_t k = 0; k < A->count; k++) {
        if (A->row[k] < 0 || A->row[k] >= A->m)
            return failure_set(failure, EX_DATAERR, "%s/%s: entry %lld is %d, %s has %lld rows", name, row,
                           (long long)k, A->row[k], letter, (long long)A->m);
        if (A->col[k] < 0 || A->col[k] >= A->n)
            return failure_set(failure, EX_DATAERR, "%s/%s: entry %lld is %d, %s has %lld columns", name,
                           col, (long long)k, A->col[k], letter, (long long)A->n);
        if (!isfinite(A->x[k]))
            return failure_set(failure, EX_DATAERR, "%s/x: entry %lld is %g", name, (long long)k, A->x[k]);
    }
    return 0;
}

/* The line (row or column) of every entry, from p of a compressed matrix; NULL: no memory */
static int32_t *lines_of_entries(const int32_t *p, int32_t lines)
{
    int32_t *line = calloc((size_t)p[lines] + 1, sizeof *line);
    for (int32_t l = 0; line && l < lines; l++)
        for (int32_t k = p[l]; k < p[l + 1]; k++) line[k] = l;
    return line;
}

int sparse_unpack(struct sparse *A, struct stored *S, const char *name, struct failure *failure)
{
    bool by_rows = S->nz == -2;
    int32_t lines = by_rows ? S->m : S->n;
    if (S->nz < -2) return failure_set(failure, EX_DATAERR, "%s/nz: %d is no form of storage", name, S->nz);
    if (S->nz < 0 && check_pointers(S, name, lines, failure)) return failure->status;
    int64_t count = S->nz < 0 ? S->p[lines] : S->nz;
    if (check_lengths(S, name, count, failure)) return failure->status;
    if (S->nz < 0) { // triplets, once p has the line of every entry
        int32_t *line = lines_of_entries(S->p, lines);
        if (!line) return failure_set(failure, EX_SOFTWARE, "%s: out of memory", name);
        free(S->p);
        S->p = line;
    }
    *A = (struct sparse){ S->m, S->n, count, count, by_rows ? S->p : S->i, by_rows ? S->i : S->p,
                          S->x };
    *S = (struct stored){ 0 };
    return check_entries(A, by_rows, name, failure);
}

bool lists_init(struct lists *L, int64_t n, int64_t count, const int32_t *owner)
{
    L->first = calloc((size_t)n + 2, sizeof *L->first);
    L->item = malloc((size_t)(count + 1) * sizeof *L->item);
    if (!L->first || !L->item) return lists_free(L), false;
    for (int64_t k = 0; k < count; k++)
        if (owner[k] >= 0) L->first[owner[k] + 2]++;
    for (int64_t o = 0; o < n; o++) L->first[o + 2] += L->first[o + 1];
    for (int64_t k = 0; k < count; k++)
        if (owner[k] >= 0) L->item[L->first[owner[k] + 1]++] = k;
    return true;
}

void lists_free(struct lists *L)
{
    free(L->first);
    free(L->item);
    *L = (struct lists){ 0 };
}

bool stored_columns(struct stored *S, const struct sparse *A)
{
    struct lists rows = { 0 };
    *S = (struct stored){ 0 };
    int32_t *last = malloc((size_t)(A->n + 1) * sizeof *last); // of a column: its last row so far
    bool good = A->count <= INT32_MAX && last && stored_init(S, A->m, A->n, -1, A->count) &&
                lists_init(&rows, A->m, A->count, A->row);
    // the columns' lengths, then their entries: both row by row, so that rows ascend
    for (int pass = 0; good && pass < 2; pass++) {
        for (int64_t j = 0; j < A->n; j++) last[j] = -1;
        for (int64_t i = 0; i < A->m; i++)
            for (int64_t k = rows.first[i]; k < rows.first[i + 1]; k++) {
                int64_t e = rows.item[k];
                int32_t j = A->col[e];
                bool new = last[j] != i;
                last[j] = (int32_t)i;
                if (pass == 0) {
                    S->p[j + 1] += new;
                    continue;
                }
                int32_t at = S->p[j + 1] - !new; // p[j + 1] is where the next entry goes
                S->i[at] = (int32_t)i, S->x[at] = new ? A->x[e] : S->x[at] + A->x[e];
                S->p[j + 1] += new;
            }
        // after the first pass p[j + 1] becomes the column's beginning, after the second its end
        for (int64_t j = 0, sum = 0; pass == 0 && j < A->n; j++) {
            int32_t length = S->p[j + 1];
            S->p[j + 1] = (int32_t)sum, sum += length;
        }
    }
    lists_free(&rows), free(last);
    return good;
}
