// Reference soft-sphere DEM (linear spring-dashpot, Cundall-Strack), 2D discs or 3D balls; planes, periodic cell with edges
// that yield to a stress (as Parrinello-Rahman with contacts) or follow a gradient. key=value arguments.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#define NC 64
typedef struct {
    double x[3], v[3], w[3], r, m, I;
    int fixed, alive;
} B;
typedef struct {
    int j;
    int s[3];
    double t[3];
    double dm;
    int touch;
} C; // neighbour of i, j>i or wall -1-k
static int N, dim = 3;
static B *b;
static C *nb;
static int *nn;
static double kn = 1e4, kt = 0, e = 0.1, mu = 0.5, muw = -1, dt = 0, ew = -1, g[3], T = 1,
              every = 1;
static int nw;
static double wp[32][3], wn[32][3], wuntil[32];
static double H[3][3], Hd[3][3], L[3][3], Hi[3][3], tgt[3][3], Mc = 10;
static int per[3], anyper, ctl[3][3];
static double skin;
static double out0[2] = { -1e9, 1e9 };
static int outside = 0;
static double coh = 0;
static double gamt = 0, bgd = 0;
static double crad = 0, com = 0;
static char *frames, *rows_file;
static double range; // of the attraction, beyond touch
static int hyst = 0;
static int measure = 0;
static double tm0 = 0;
static char *dump;
static FILE *contacts;
static void inv3(double A[3][3], double R[3][3], double *det)
{
    double d = A[0][0] * (A[1][1] * A[2][2] - A[1][2] * A[2][1]) -
               A[0][1] * (A[1][0] * A[2][2] - A[1][2] * A[2][0]) +
               A[0][2] * (A[1][0] * A[2][1] - A[1][1] * A[2][0]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (j + 1) % 3, c = (j + 2) % 3, p = (i + 1) % 3, q = (i + 2) % 3;
            R[i][j] = (A[a][p] * A[c][q] - A[a][q] * A[c][p]) / d;
        }
    *det = d;
}
// H: H[i][k]: component i of edge k
static C *find(C *l, int n, int j, int *s)
{
    for (int k = 0; k < n; k++)
        if (l[k].j == j && l[k].s[0] == s[0] && l[k].s[1] == s[1] && l[k].s[2] == s[2])
            return l + k;
    return 0;
}
static void addn(int i, int j, int *s, C *old, int no)
{
    if (nn[i] >= NC) {
        fprintf(stderr, "too many neighbours\n");
        exit(1);
    }
    C *c = nb + (size_t)i * NC + nn[i]++;
    memset(c, 0, sizeof *c);
    c->j = j;
    memcpy(c->s, s, sizeof c->s);
    C *f = find(old, no, j, s);
    if (f) {
        memcpy(c->t, f->t, sizeof c->t);
        c->touch = f->touch;
        c->dm = f->dm;
    }
}
static C *oldnb;
static int *oldnn;
static int (*img)[3];
// pairs of a large cell with right angles that is periodic in all directions, by cells of the width of the largest ball
static int cells_fit(int *n)
{
    double rm = 0;
    if (dim != 3 || !per[0] || !per[1] || !per[2]) return 0;
    for (int i = 0; i < N; i++)
        if (b[i].r > rm) rm = b[i].r;
    for (int k = 0; k < 3; k++) {
        for (int q = 0; q < 3; q++)
            if (q != k && H[q][k] != 0) return 0;
        n[k] = (int)(H[k][k] / (2 * rm + skin));
        if (n[k] < 3) return 0;
        if (n[k] > 200) n[k] = 200;
    }
    return 1;
}
static void pairs_by_cells(const int *n)
{
    size_t all = (size_t)n[0] * n[1] * n[2];
    int *head = malloc(all * sizeof(int)), *next = malloc(N * sizeof(int));
    int(*at)[3] = malloc(N * sizeof *at);
    for (size_t k = 0; k < all; k++) head[k] = -1;
    for (int i = N - 1; i >= 0; i--) {
        for (int k = 0; k < 3; k++) {
            at[i][k] = (int)(b[i].x[k] / H[k][k] * n[k]);
            if (at[i][k] >= n[k]) at[i][k] = n[k] - 1;
        }
        size_t c = ((size_t)at[i][2] * n[1] + at[i][1]) * n[0] + at[i][0];
        next[i] = head[c];
        head[c] = i;
    }
    for (int i = 0; i < N; i++)
        for (int m = 0; m < 27; m++) {
            int c[3], shift[3], step[3] = { m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1 };
            for (int k = 0; k < 3; k++) {
                c[k] = at[i][k] + step[k];
                shift[k] = c[k] < 0 ? -1 : c[k] >= n[k] ? 1 : 0;
                c[k] -= shift[k] * n[k];
            }
            for (int j = head[((size_t)c[2] * n[1] + c[1]) * n[0] + c[0]]; j >= 0; j = next[j]) {
                double R = b[i].r + b[j].r + skin, d2 = 0;
                if (j <= i) continue;
                for (int d = 0; d < 3; d++) {
                    double y = b[j].x[d] - b[i].x[d] + H[d][d] * shift[d];
                    d2 += y * y;
                }
                if (d2 < R * R) addn(i, j, shift, oldnb + (size_t)i * NC, oldnn[i]);
            }
        }
    free(head);
    free(next);
    free(at);
}
static void rebuild(void)
{
    memcpy(oldnb, nb, sizeof(C) * (size_t)N * NC);
    memcpy(oldnn, nn, sizeof(int) * N);
    double det;
    if (anyper) {
        inv3(H, Hi, &det);
        for (int i = 0; i < N; i++) {
            img[i][0] = img[i][1] = img[i][2] = 0;
            for (int k = 0; k < 3; k++)
                if (per[k]) {
                    double s = 0;
                    for (int d = 0; d < 3; d++) s += Hi[k][d] * b[i].x[d];
                    int f = (int)floor(s);
                    img[i][k] = f;
                    if (f)
                        for (int d = 0; d < 3; d++) {
                            b[i].x[d] -= f * H[d][k];
                            b[i].v[d] -= f * Hd[d][k];
                        }
                }
        }
        // old pair (i,j,s): x_j+H s - x_i ; after x_j'=x_j-H f_j -> s' = s+f_j-f_i
        for (int i = 0; i < N; i++)
            for (int k = 0; k < oldnn[i]; k++) {
                C *c = oldnb + (size_t)i * NC + k;
                if (c->j >= 0)
                    for (int d = 0; d < 3; d++) c->s[d] += img[c->j][d] - img[i][d];
            }
    }
    for (int i = 0; i < N; i++) nn[i] = 0;
    int z[3] = { 0, 0, 0 };
    int cells[3];
    if (anyper && cells_fit(cells))
        pairs_by_cells(cells);
    else if (anyper) {
        int lo[3], hi[3];
        for (int k = 0; k < 3; k++) {
            lo[k] = per[k] ? -1 : 0;
            hi[k] = per[k] ? 1 : 0;
        }
        if (fabs(H[0][1]) > 1e-9 * H[0][0]) {
            lo[0] = -2;
            hi[0] = 2;
        }
        for (int i = 0; i < N; i++)
            for (int j = i; j < N; j++)
                for (int p = lo[0]; p <= hi[0]; p++)
                    for (int q = lo[1]; q <= hi[1]; q++)
                        for (int r = lo[2]; r <= hi[2]; r++) {
                            if (i == j) continue;
                            if (b[i].fixed && b[j].fixed) continue;
                            int s[3] = { p, q, r };
                            double R = b[i].r + b[j].r + skin, d2 = 0;
                            for (int d = 0; d < 3; d++) {
                                double y =
                                    b[j].x[d] - b[i].x[d] + H[d][0] * p + H[d][1] * q + H[d][2] * r;
                                d2 += y * y;
                            }
                            if (d2 < R * R) addn(i, j, s, oldnb + (size_t)i * NC, oldnn[i]);
                        }
    } else { // grid
        double rm = 0, lo[3] = { 1e300, 1e300, 1e300 }, hi[3] = { -1e300, -1e300, -1e300 };
        for (int i = 0; i < N; i++)
            if (b[i].alive) {
                if (b[i].r > rm) rm = b[i].r;
                for (int d = 0; d < 3; d++) {
                    if (b[i].x[d] < lo[d]) lo[d] = b[i].x[d];
                    if (b[i].x[d] > hi[d]) hi[d] = b[i].x[d];
                }
            }
        static double grm = 0;
        double cs = 2 * rm + skin;
        (void)grm;
        int n[3];
        for (int d = 0; d < 3; d++) {
            n[d] = (int)((hi[d] - lo[d]) / cs) + 1;
            if (n[d] > 2000) n[d] = 2000;
        }
        if (dim == 2) n[2] = 1;
        size_t tot = (size_t)n[0] * n[1] * n[2];
        int *head = malloc(tot * sizeof(int)), *next = malloc(N * sizeof(int));
        for (size_t k = 0; k < tot; k++) head[k] = -1;
#define CI(d, x)                                                                                   \
    ({                                                                                             \
        int q_ = (int)(((x)-lo[d]) / cs);                                                          \
        q_ < 0 ? 0 : q_ >= n[d] ? n[d] - 1 : q_;                                                   \
    })
        for (int i = N - 1; i >= 0; i--)
            if (b[i].alive) {
                size_t c =
                    ((size_t)CI(2, b[i].x[2]) * n[1] + CI(1, b[i].x[1])) * n[0] + CI(0, b[i].x[0]);
                next[i] = head[c];
                head[c] = i;
            }
        for (int i = 0; i < N; i++)
            if (b[i].alive) {
                int c0 = CI(0, b[i].x[0]), c1 = CI(1, b[i].x[1]), c2 = CI(2, b[i].x[2]);
                for (int r = c2 - 1; r <= c2 + 1; r++)
                    for (int q = c1 - 1; q <= c1 + 1; q++)
                        for (int p = c0 - 1; p <= c0 + 1; p++) {
                            if (p < 0 || q < 0 || r < 0 || p >= n[0] || q >= n[1] || r >= n[2])
                                continue;
                            for (int j = head[((size_t)r * n[1] + q) * n[0] + p]; j >= 0;
                                 j = next[j])
                                if (j > i && !(b[i].fixed && b[j].fixed)) {
                                    double R = b[i].r + b[j].r + skin, d2 = 0;
                                    for (int d = 0; d < 3; d++) {
                                        double y = b[j].x[d] - b[i].x[d];
                                        d2 += y * y;
                                    }
                                    if (d2 < R * R) addn(i, j, z, oldnb + (size_t)i * NC, oldnn[i]);
                                }
                        }
            }
        free(head);
        free(next);
    }
    if (crad > 0)
        for (int i = 0; i < N; i++) {
            double R = sqrt(b[i].x[0] * b[i].x[0] + b[i].x[1] * b[i].x[1]);
            if (R + b[i].r + skin > crad) addn(i, -32, z, oldnb + (size_t)i * NC, oldnn[i]);
        }
    for (int i = 0; i < N; i++)
        if (b[i].alive && !b[i].fixed)
            for (int k = 0; k < nw; k++) {
                double gp = 0;
                for (int d = 0; d < 3; d++) gp += wn[k][d] * (b[i].x[d] - wp[k][d]);
                if (gp < b[i].r + skin) {
                    addn(i, -1 - k, z, oldnb + (size_t)i * NC, oldnn[i]);
                }
            }
}
static double (*F)[3], (*Q)[3];
static double sig[3][3];
static int ncont, nslide;
static double *zc;
static double maxov;
static double t;
static double gn_(double m, double k, double e)
{
    if (e <= 0) e = 0.01;
    double l = log(e);
    return 2 * sqrt(m * k) * (-l) / sqrt(M_PI * M_PI + l * l);
}
static void forces(void)
{
    memset(sig, 0, sizeof sig);
    ncont = nslide = 0;
    maxov = 0;
    for (int i = 0; i < N; i++) {
        for (int d = 0; d < 3; d++) F[i][d] = b[i].m * g[d], Q[i][d] = 0;
        zc[i] = 0;
    }
    for (int i = 0; i < N; i++)
        for (int k = 0; k < nn[i]; k++) {
            C *c = nb + (size_t)i * NC + k;
            double n[3], dist, ov, v[3], la, lb = 0, me;
            int j = c->j;
            if (j >= 0) {
                double d2 = 0, x[3];
                for (int d = 0; d < 3; d++) {
                    x[d] = b[j].x[d] - b[i].x[d] + H[d][0] * c->s[0] + H[d][1] * c->s[1] +
                           H[d][2] * c->s[2];
                    d2 += x[d] * x[d];
                }
                double R = b[i].r + b[j].r;
                if (d2 >= R * R) {
                    c->touch = 0;
                    c->dm = 0;
                    c->t[0] = c->t[1] = c->t[2] = 0;
                    if (coh > 0 && d2 < (R + range) * (R + range))
                        for (int d = 0; d < 3; d++) {
                            double pull = coh * x[d] / sqrt(d2);
                            F[i][d] += pull;
                            F[j][d] -= pull;
                        }
                    continue;
                }
                dist = sqrt(d2);
                ov = R - dist;
                for (int d = 0; d < 3; d++) n[d] = x[d] / dist;
                la = b[i].r - ov / 2;
                lb = b[j].r - ov / 2;
                for (int d = 0; d < 3; d++)
                    v[d] = b[j].v[d] - b[i].v[d] + Hd[d][0] * c->s[0] + Hd[d][1] * c->s[1] +
                           Hd[d][2] * c->s[2];
                me = b[i].fixed   ? b[j].m
                     : b[j].fixed ? b[i].m
                                  : b[i].m * b[j].m / (b[i].m + b[j].m);
                double ws[3];
                for (int d = 0; d < 3; d++)
                    ws[d] = la * b[i].w[d] + lb * b[j].w[d]; // v_rel -= ws x n
                v[0] -= ws[1] * n[2] - ws[2] * n[1];
                v[1] -= ws[2] * n[0] - ws[0] * n[2];
                v[2] -= ws[0] * n[1] - ws[1] * n[0];
            } else if (j == -32) {
                double R = sqrt(b[i].x[0] * b[i].x[0] + b[i].x[1] * b[i].x[1]);
                ov = R + b[i].r - crad;
                if (ov <= 0) {
                    c->touch = 0;
                    c->dm = 0;
                    c->t[0] = c->t[1] = c->t[2] = 0;
                    continue;
                }
                n[0] = b[i].x[0] / R;
                n[1] = b[i].x[1] / R;
                n[2] = 0;
                la = b[i].r - ov;
                dist = la;
                double vw[3] = { -com * crad * n[1], com * crad * n[0], 0 };
                for (int d = 0; d < 3; d++) v[d] = vw[d] - b[i].v[d];
                double *w = b[i].w;
                v[0] -= la * (w[1] * n[2] - w[2] * n[1]);
                v[1] -= la * (w[2] * n[0] - w[0] * n[2]);
                v[2] -= la * (w[0] * n[1] - w[1] * n[0]);
                me = b[i].m;
            } else {
                int wk = -1 - j;
                if (t > wuntil[wk]) continue;
                double gp = 0;
                for (int d = 0; d < 3; d++) gp += wn[wk][d] * (b[i].x[d] - wp[wk][d]);
                ov = b[i].r - gp;
                if (ov <= 0) {
                    c->touch = 0;
                    c->dm = 0;
                    c->t[0] = c->t[1] = c->t[2] = 0;
                    continue;
                }
                for (int d = 0; d < 3; d++) n[d] = -wn[wk][d];
                la = b[i].r - ov;
                dist = la;
                for (int d = 0; d < 3; d++) v[d] = -b[i].v[d];
                double *w = b[i].w;
                v[0] -= la * (w[1] * n[2] - w[2] * n[1]);
                v[1] -= la * (w[2] * n[0] - w[0] * n[2]);
                v[2] -= la * (w[0] * n[1] - w[1] * n[0]);
                me = b[i].m;
            }
            double vn = v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
            double M = (j < 0 && muw >= 0) ? muw : mu, ee = (j < 0 && ew >= 0) ? ew : e;
            double kk = kn;
            double fn;
            if (hyst) {
                if (ov > c->dm) c->dm = ov;
                double k2 = kn / (ee * ee);
                double a = kn * ov, bb = k2 * (ov - (1 - ee * ee) * c->dm);
                fn = a < bb ? a : bb;
                if (bgd > 0) fn -= bgd * gn_(me, kk, 0.5) * vn;
                if (fn < 0) fn = 0;
            } else
                fn = kk * ov - gn_(me, kk, ee) * vn;
            if (fn < 0) fn = 0;
            if (ov > maxov) maxov = ov;
            double ft[3] = { 0, 0, 0 };
            if (M > 0) {
                double tn = c->t[0] * n[0] + c->t[1] * n[1] + c->t[2] * n[2], tt = 0;
                for (int d = 0; d < 3; d++) {
                    c->t[d] -= tn * n[d];
                }
                for (int d = 0; d < 3; d++) c->t[d] += dt * (v[d] - vn * n[d]);
                for (int d = 0; d < 3; d++) {
                    ft[d] = -kt * c->t[d] - gamt * gn_(me, kk, ee) * (v[d] - vn * n[d]);
                    tt += ft[d] * ft[d];
                }
                tt = sqrt(tt);
                if (tt > M * fn) {
                    double q = tt > 0 ? M * fn / tt : 0;
                    for (int d = 0; d < 3; d++) {
                        ft[d] *= q;
                        c->t[d] = -ft[d] / kt;
                    }
                    nslide++;
                }
            }
            c->touch = 1;
            ncont++;
            zc[i]++;
            if (j >= 0) zc[j]++;
            double f[3];
            for (int d = 0; d < 3; d++) {
                f[d] = fn * n[d] + ft[d] - coh * n[d] * (j >= 0);
            } // force on j
            if (contacts)
                fprintf(contacts, "%d %d %.17g %.17g %.17g %.17g\n", i, j, fn, ft[0], ft[1], ft[2]);
            double tq[3] = { n[1] * f[2] - n[2] * f[1], n[2] * f[0] - n[0] * f[2],
                             n[0] * f[1] - n[1] * f[0] };
            for (int d = 0; d < 3; d++) {
                F[i][d] -= f[d];
                Q[i][d] -= la * tq[d];
                if (j >= 0) {
                    F[j][d] += f[d];
                    Q[j][d] -= lb * tq[d];
                }
                if (j >= 0)
                    for (int q = 0; q < 3; q++) sig[d][q] += f[d] * n[q] * dist;
            }
        }
    // torque signs: on i at +la n, force -f: la n x (-f) = -la tq ; on j at -lb n force f: -lb n x f = -lb tq
}
static double V;
int main(int ac, char **av)
{
    char *in = av[1], *cfile = 0;
    for (int i = 0; i < 3; i++) wuntil[i] = 1e300;
    for (int i = 0; i < 32; i++) wuntil[i] = 1e300;
    for (int i = 2; i < ac; i++) {
        char *s = av[i];
#define A(k, v) else if (!strncmp(s, k "=", strlen(k) + 1)) v = atof(s + strlen(k) + 1)
        if (0)
            ;
        A("dim", dim);
        A("kn", kn);
        A("kt", kt);
        A("e", e);
        A("ew", ew);
        A("mu", mu);
        A("muw", muw);
        A("dt", dt);
        A("T", T);
        A("every", every);
        A("gx", g[0]);
        A("gy", g[1]);
        A("gz", g[2]);
        A("M", Mc);
        A("gamt", gamt);
        A("measure", measure);
        A("from", tm0);
        A("coh", coh);
        A("range", range);
        A("hyst", hyst);
        A("crad", crad);
        A("comega", com);
        A("bgd", bgd);
        else if (!strncmp(s, "wall=", 5))
        {
            sscanf(s + 5, "%lf,%lf,%lf,%lf,%lf,%lf,%lf", wp[nw], wp[nw] + 1, wp[nw] + 2, wn[nw],
                   wn[nw] + 1, wn[nw] + 2, wuntil + nw);
            nw++;
        }
        else if (!strncmp(s, "outside=", 8))
        {
            outside = 1;
            sscanf(s + 8, "%lf,%lf", out0, out0 + 1);
        }
        else if (!strncmp(s, "per=", 4))
        {
            for (int k = 0; k < 3 && s[4 + k]; k++) per[k] = s[4 + k] == '1';
            anyper = 1;
        }
        else if (!strncmp(s, "H=", 2))
        {
            sscanf(s + 2, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &H[0][0], &H[1][0], &H[2][0],
                   &H[0][1], &H[1][1], &H[2][1], &H[0][2], &H[1][2], &H[2][2]);
        }
        else if (!strncmp(s, "Hd=", 3))
        {
            sscanf(s + 3, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &Hd[0][0], &Hd[1][0], &Hd[2][0],
                   &Hd[0][1], &Hd[1][1], &Hd[2][1], &Hd[0][2], &Hd[1][2], &Hd[2][2]);
        }
        else if (!strncmp(s, "L", 1) && s[3] == '=')
        {
            L[s[1] - '0'][s[2] - '0'] = atof(s + 4);
        }
        else if (!strncmp(s, "P", 1) && s[3] == '=')
        {
            tgt[s[1] - '0'][s[2] - '0'] = atof(s + 4);
            ctl[s[1] - '0'][s[2] - '0'] = 1;
        }
        else if (!strncmp(s, "dump=", 5)) dump = s + 5;
        else if (!strncmp(s, "contacts=", 9)) cfile = s + 9;
        else if (!strncmp(s, "frames=", 7)) frames = s + 7;
        else if (!strncmp(s, "rows=", 5)) rows_file = s + 5, measure = 1;
        else
        {
            fprintf(stderr, "what is %s\n", s);
            return 1;
        }
    }
    FILE *f = fopen(in, "r");
    int cap = 1 << 17;
    b = calloc(cap, sizeof(B));
    char line[4096];
    while (fgets(line, sizeof line, f)) {
        B q;
        memset(&q, 0, sizeof q);
        int fx;
        if (sscanf(line, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %d", q.x, q.x + 1, q.x + 2,
                   &q.r, &q.m, q.v, q.v + 1, q.v + 2, q.w, q.w + 1, q.w + 2, &fx) < 12)
            continue;
        q.fixed = fx || q.m == 0;
        q.alive = 1;
        q.I = (dim == 2 ? 0.5 : 0.4) * q.m * q.r * q.r;
        b[N++] = q;
    }
    fclose(f);
    nb = calloc((size_t)N * NC, sizeof(C));
    oldnb = calloc((size_t)N * NC, sizeof(C));
    nn = calloc(N, sizeof(int));
    oldnn = calloc(N, sizeof(int));
    img = calloc(N, sizeof *img);
    F = calloc(N, sizeof *F);
    Q = calloc(N, sizeof *Q);
    zc = calloc(N, sizeof(double));
    double rmin = 1e300, mmin = 1e300, rm = 0;
    for (int i = 0; i < N; i++) {
        if (b[i].r < rmin) rmin = b[i].r;
        if (!b[i].fixed && b[i].m < mmin) mmin = b[i].m;
        rm += b[i].r / N;
    }
    if (!kt) kt = 0.8 * kn;
    if (!dt) dt = M_PI * sqrt(mmin / 2 / kn) / 25;
    skin = 0.3 * rm;
    double next = every;
    if (dim == 2 && anyper) {
        H[2][2] = 1;
    }
    if (anyper)
        for (int k = 0; k < 3; k++)
            if (!per[k] && H[k][k] == 0) H[k][k] = 1;
    double sm[3][3] = { { 0 } }, phis = 0, nav = 0, deepest = 0;
    double Vs = 0;
    for (int i = 0; i < N; i++)
        if (!b[i].fixed) Vs += dim == 2 ? M_PI * b[i].r * b[i].r : 4. / 3 * M_PI * pow(b[i].r, 3);
    long steps = 0;
    if (anyper)
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                if (!ctl[i][k]) {
                    Hd[i][k] = 0;
                    for (int q = 0; q < 3; q++) Hd[i][k] += L[i][q] * H[q][k];
                }
    rebuild();
    while (t < T - 1e-12) {
        forces();
        double det = 1;
        if (anyper) {
            inv3(H, Hi, &det);
            V = det;
            double tot[3][3];
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++) tot[i][k] = sig[i][k] / V;
            double nHd[3][3];
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++) {
                    if (ctl[i][k]) {
                        double fo = 0;
                        for (int q = 0; q < 3; q++)
                            fo += (tot[i][q] - (q == k || 1 ? tgt[i][q] * ctl[i][q] : 0)) * V *
                                  Hi[k][q];
                        fo = 0;
                        for (int q = 0; q < 3; q++) fo += tot[i][q] * V * Hi[k][q];
                        fo -= tgt[i][k] * V * Hi[k][k];
                        nHd[i][k] = Hd[i][k] + dt * fo / Mc;
                    } else {
                        double x = 0;
                        for (int q = 0; q < 3; q++) x += L[i][q] * H[q][k];
                        nHd[i][k] = x;
                    }
                }
            // bodies follow the change of the rates
            for (int i = 0; i < N; i++)
                if (!b[i].fixed) {
                    double s[3];
                    for (int k = 0; k < 3; k++) {
                        s[k] = 0;
                        for (int d = 0; d < 3; d++) s[k] += Hi[k][d] * b[i].x[d];
                    }
                    for (int d = 0; d < 3; d++)
                        for (int k = 0; k < 3; k++) b[i].v[d] += s[k] * (nHd[d][k] - Hd[d][k]);
                }
            memcpy(Hd, nHd, sizeof Hd);
        }
        double vm = 0;
        for (int i = 0; i < N; i++)
            if (b[i].alive && !b[i].fixed) {
                for (int d = 0; d < 3; d++) {
                    b[i].v[d] += dt * F[i][d] / b[i].m;
                    b[i].w[d] += dt * Q[i][d] / b[i].I;
                }
                if (dim == 2) {
                    b[i].v[2] = 0;
                    b[i].w[0] = b[i].w[1] = 0;
                }
            }
        for (int i = 0; i < N; i++)
            if (b[i].alive) {
                for (int d = 0; d < 3; d++) b[i].x[d] += dt * b[i].v[d];
                double v2 = 0;
                double vv[3];
                for (int d = 0; d < 3; d++) vv[d] = b[i].v[d];
                if (anyper && per[0]) { // peculiar
                    double s[3];
                    for (int k = 0; k < 3; k++) {
                        s[k] = 0;
                        for (int d = 0; d < 3; d++) s[k] += Hi[k][d] * b[i].x[d];
                    }
                    for (int d = 0; d < 3; d++)
                        for (int k = 0; k < 3; k++) vv[d] -= s[k] * Hd[d][k];
                    double rate = 0;
                    for (int d = 0; d < 3; d++)
                        for (int k = 0; k < 3; k++) rate += fabs(Hd[d][k]) / H[k][k];
                    v2 = 0;
                    for (int d = 0; d < 3; d++) v2 += vv[d] * vv[d];
                    double z = sqrt(v2) + rate * rm;
                    if (z > vm) vm = z;
                } else {
                    for (int d = 0; d < 3; d++) v2 += vv[d] * vv[d];
                    if (v2 > vm * vm) vm = sqrt(v2);
                }
            }
        if (anyper)
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++) H[i][k] += dt * Hd[i][k];
        static double moved = 0;
        moved += vm * dt;
        if (anyper && H[0][0] > 0 && fabs(H[0][1]) > 0.75 * H[0][0]) {
            int n = (int)round(H[0][1] / H[0][0]); // lattice change
            for (int i = 0; i < 3; i++) {
                H[i][1] -= n * H[i][0];
                Hd[i][1] -= n * Hd[i][0];
            }
            for (int i = 0; i < N; i++)
                for (int k = 0; k < nn[i]; k++) {
                    C *c = nb + (size_t)i * NC + k;
                    c->s[0] += n * c->s[1];
                }
            moved = 1e300;
        }
        if (2 * moved > skin * 0.9) {
            if (outside)
                for (int i = 0; i < N; i++)
                    if (b[i].alive && (b[i].x[0] < out0[0] || b[i].x[0] > out0[1])) {
                        b[i].alive = 0;
                        b[i].x[1] = -1e3 - i;
                        b[i].m = 1e-300;
                    }
            rebuild();
            moved = 0;
        }
        t += dt;
        steps++;
        if (maxov > deepest) deepest = maxov;
        if (measure && t >= tm0) {
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++) sm[i][k] += sig[i][k] / V;
            phis += anyper ? Vs / V : 0;
            nav++;
        }
        if (t >= next - 1e-9) {
            next += every;
            if (frames) {
                static FILE *fo;
                if (!fo && !(fo = fopen(frames, "w"))) {
                    perror(frames);
                    return 1;
                }
                fprintf(fo, "frame %.17g", t);
                for (int k = 0; k < 9; k++) fprintf(fo, " %.17g", H[k % 3][k / 3]);
                for (int k = 0; k < 9; k++) fprintf(fo, " %.17g", Hd[k % 3][k / 3]);
                fprintf(fo, "\n");
                for (int i = 0; i < N; i++)
                    if (b[i].alive)
                        fprintf(fo, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", i,
                                b[i].x[0], b[i].x[1], b[i].x[2], b[i].v[0], b[i].v[1], b[i].v[2],
                                b[i].w[0], b[i].w[1], b[i].w[2]);
                fflush(fo);
            }
            double K = 0, com = 0, M = 0;
            for (int i = 0; i < N; i++)
                if (b[i].alive && !b[i].fixed) {
                    for (int d = 0; d < 3; d++) K += b[i].m * b[i].v[d] * b[i].v[d] / 2;
                    com += b[i].m * b[i].x[dim - 1];
                    M += b[i].m;
                }
            if (rows_file) {
                static FILE *ro;
                int n0 = 0, n1 = 0, n = 0;
                if (!ro && !(ro = fopen(rows_file, "w"))) {
                    perror(rows_file);
                    return 1;
                }
                for (int i = 0; i < N; i++)
                    if (b[i].alive && !b[i].fixed) n++, n0 += zc[i] == 0, n1 += zc[i] == 1;
                fprintf(ro, "{\"time\":%.10g,\"stress\":{\"tensor\":[", t);
                for (int i = 0; i < dim; i++)
                    for (int k = 0; k < dim; k++)
                        fprintf(ro, "%s%.10g%s", k ? "," : "[", sm[i][k] / nav,
                                k < dim - 1    ? ""
                                : i == dim - 1 ? "]"
                                               : "],");
                double p = 0;
                for (int i = 0; i < dim; i++) p += sm[i][i] / nav / dim;
                fprintf(ro,
                        "],\"p\":%.10g},\"fraction\":{\"fraction\":%.10g},\"coordination\":{"
                        "\"z_mechanical\":%.10g},\"overlap\":%.4g}\n",
                        p, phis / nav, n - n0 - n1 > 0 ? (2. * ncont - n1) / (n - n0 - n1) : 0,
                        deepest / rmin);
                fflush(ro);
                memset(sm, 0, sizeof sm);
                phis = nav = 0;
            }
            printf("%g K %.4g com %.6g nc %d ov/r %.3g\n", t, K, com / M, ncont, deepest / rmin);
            deepest = 0;
            fflush(stdout);
        }
    }
    if (cfile) {
        if (!(contacts = fopen(cfile, "w"))) {
            perror(cfile);
            return 1;
        }
        forces();
        fclose(contacts);
        contacts = 0;
    } // i, j or -1 - wall, F_n, F_t on j
    if (dump) {
        FILE *o = fopen(dump, "w");
        for (int i = 0; i < N; i++)
            if (b[i].alive)
                fprintf(o, "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %d\n",
                        b[i].x[0], b[i].x[1], b[i].x[2], b[i].r, b[i].m, b[i].v[0], b[i].v[1],
                        b[i].v[2], b[i].w[0], b[i].w[1], b[i].w[2], b[i].fixed);
        fclose(o);
        if (anyper) {
            printf("H=");
            for (int k = 0; k < 3; k++)
                for (int d = 0; d < 3; d++)
                    printf("%.17g%s", H[d][k], k == 2 && d == 2 ? "\n" : ",");
        }
    }
    fprintf(stderr, "steps %ld dt %g\n", steps, dt);
}
