#include "base/nearest.h"

#include <string.h>

enum {
    NAME_MOST = 40, /* letters of a name */
    MISTAKES = 2,   /* letters */
};

/* Letters that are to be left out, put in, changed or swapped with the next to make a name of another */
static int distance(const char *a, int n, const char *b, int m)
{
    int d[NAME_MOST + 1][NAME_MOST + 1];
    for (int i = 0; i <= n; i++)
        for (int j = 0; j <= m; j++) {
            d[i][j] = i + j;
            if (!i || !j) continue;
            const int change = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            d[i][j] = 1 + (d[i - 1][j] < d[i][j - 1] ? d[i - 1][j] : d[i][j - 1]);
            if (change < d[i][j]) d[i][j] = change;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                d[i - 2][j - 2] + 1 < d[i][j])
                d[i][j] = d[i - 2][j - 2] + 1;
        }
    return d[n][m];
}

void nearest_look(struct nearest *near, const char *asked, size_t n, const char *name)
{
    const size_t m = strlen(name);
    if (n > NAME_MOST || m > NAME_MOST) return;
    const int d = distance(asked, (int)n, name, (int)m);
    if (d > MISTAKES || 3 * d > (int)m + 1 || (near->name && d >= near->distance)) return;
    *near = (struct nearest){ name, d };
}
