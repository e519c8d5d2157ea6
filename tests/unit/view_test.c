/* Pictures: what is in front, where, how large, which way round. */
#include "draw/view.h"
#include "tap.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

static const char red[] = "a red ball", blue[] = "a blue one"; // of materials 2 and 0

static struct view view(int size, double azimuth, double elevation)
{
    struct view v = { .azimuth = azimuth, .elevation = elevation, .samples = 1, .threads = 1 };
    v.width = v.height = size;
    v.background = rgb_of(0xffffff);
    paint_init(&v.paint, COLOUR_MATERIAL, true);
    v.boxed = true;
    v.region = (struct extent){ { -2, -2, -2 }, { 2, 2, 2 } };
    return v;
}

/* Its picture; ends the test where there is none. */
static struct picture draw(struct view v, const struct packing *p)
{
    struct picture pic;
    struct failure failure = { 0 };
    if (!view_extend(&v, p, &failure)) view_fit(&v, p);
    if (failure.status || view_draw(&v, p, &pic, &failure)) {
        ok(false, "a picture is drawn: %s", failure.text);
        exit(1);
    }
    return pic;
}

static struct packing balls(int dim, int n, const double (*x)[4]) /* x y z radius */
{
    struct packing p;
    struct failure failure = { 0 };
    if (packing_init(&p, dim, n, &failure) || packing_alloc_materials(&p, 3, &failure)) exit(1);
    p.dt = 1;
    for (int i = 0; i < n; i++) p.x[i] = v3(x[i][0], x[i][1], x[i][2]), p.radius[i] = x[i][3];
    return p;
}

static void walls(struct packing *p, int n, const vec3 (*w)[2]) /* point, normal */
{
    struct failure failure = { 0 };
    if (packing_alloc_walls(p, n, &failure)) exit(1);
    for (int i = 0; i < n; i++) p->wall[i] = wall_plane(w[i][0], w[i][1], 0);
}

static const vec3 box[6][2] = {
    { { -1, 0, 0 }, { 1, 0, 0 } }, { { 1, 0, 0 }, { -1, 0, 0 } }, { { 0, -1, 0 }, { 0, 1, 0 } },
    { { 0, 1, 0 }, { 0, -1, 0 } }, { { 0, 0, -1 }, { 0, 0, 1 } }, { { 0, 0, 1 }, { 0, 0, -1 } },
};

static const unsigned char *pixel(const struct picture *p, int x, int y)
{
    return p->rgb + 3 * (y * p->width + x);
}

static bool white(const struct picture *p, int x, int y)
{
    const unsigned char *c = pixel(p, x, y);
    return c[0] == 255 && c[1] == 255 && c[2] == 255;
}

static const char *ball_at(const struct picture *p, int x, int y)
{
    const unsigned char *c = pixel(p, x, y);
    if (white(p, x, y)) return "the background";
    return c[0] > c[1] + 30 && c[0] > c[2] + 30 ? red : c[2] > c[0] + 30 ? blue : "something else";
}

static bool same(const struct picture *a, const struct picture *b)
{
    return a->width == b->width && a->height == b->height &&
           !memcmp(a->rgb, b->rgb, (size_t)(3 * a->width * a->height));
}

/* How many pixels differ by more than this. */
static int differ(const struct picture *a, const struct picture *b, int much)
{
    int n = 0;
    for (int i = 0; i < a->width * a->height; i++) {
        bool d = false;
        for (int k = 3 * i; k < 3 * i + 3; k++) d |= abs(a->rgb[k] - b->rgb[k]) > much;
        n += d;
    }
    return n;
}

static int drawn(const struct picture *p)
{
    int n = 0;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) n += !white(p, x, y);
    return n;
}

/* ---- where and how large ---- */

static void test_size(void)
{
    const double where[6][2] = { { 0, 0 },    { 30, 15 }, { 117, -40 },
                                 { -70, 89 }, { 0, 90 },  { 45, 0 } };
    struct packing p = balls(3, 1, (const double[][4]){ { 0, 0, 0, 1 } });
    for (int i = 0; i < 6; i++) {
        struct view v = view(400, where[i][0], where[i][1]), seen = v;
        struct failure failure = { 0 };
        view_extend(&seen, &p, &failure), view_fit(&seen, &p);
        struct picture pic = draw(v, &p);
        double area = M_PI * seen.camera.scale * seen.camera.scale;
        ok(fabs(drawn(&pic) / area - 1) < 0.01,
           "from %g,%g a ball is pi r^2 large: %d pixels of %.0f", where[i][0], where[i][1],
           drawn(&pic), area);
        ok(!white(&pic, 200, 200) && white(&pic, 0, 0) && white(&pic, 399, 399),
           "it is in the middle, the background in the corners");
        picture_free(&pic);
    }
    packing_free(&p);
    p = balls(3, 1, (const double[][4]){ { 1.5, 0, 1, 0.25 } });
    struct picture pic = draw(view(400, 0, 0), &p);
    bool good = true; // 100 pixels a metre; x = 1.5, z = 1 is 350 to the right, 100 down
    for (int y = 0; y < 400; y++)
        for (int x = 0; x < 400; x++) {
            double d = hypot(x + 0.5 - 350, y + 0.5 - 100);
            good &= d < 24.99 ? !white(&pic, x, y) : d < 25.01 || white(&pic, x, y);
        }
    ok(good, "a ball is the disc of its place and radius, to the sample");
    picture_free(&pic), packing_free(&p);
    p = balls(3, 3, (const double[][4]){ { -1, 0, 0, 0.7 }, { 1, 0, 0, 0.7 }, { 0, 1, 1.1, 0.6 } });
    pic = draw(view(400, 0, 20), &p), good = true;
    for (int y = 0; y < 400; y++)
        for (int x = 0; x < 400; x++) good &= white(&pic, x, y) == white(&pic, 399 - x, y);
    ok(good, "a symmetric scene has a symmetric outline");
    picture_free(&pic), packing_free(&p);
}

static void test_fit(void)
{
    const double x[][4] = { { 3, 8, -4, 0.5 }, { 9, 1, 1, 2 }, { -7, 2, 3, 0.1 } };
    struct packing p = balls(3, 3, x);
    for (int i = 0; i < 5; i++) {
        struct view v = view(0, 40 * i, 20 * i - 30);
        v.width = v.height = 0, v.boxed = false;
        struct picture pic = draw(v, &p);
        int left = pic.width, right = 0, top = pic.height, bottom = 0;
        for (int b = 0; b < pic.height; b++)
            for (int a = 0; a < pic.width; a++)
                if (!white(&pic, a, b)) {
                    left = a < left ? a : left, right = a > right ? a : right;
                    top = b < top ? b : top, bottom = b > bottom ? b : bottom;
                }
        int mx = left + right + 1 - pic.width, my = top + bottom + 1 - pic.height;
        ok(abs(mx) <= 2 && abs(my) <= 2 && left > 0 && top > 0 &&
               (left < 0.05 * pic.width || top < 0.05 * pic.height),
           "unless told, all is seen, in the middle and as large as it goes (%d x %d)", pic.width,
           pic.height);
        ok((pic.width == 900 || pic.height == 900) && pic.width % 2 == 0 && pic.height % 2 == 0,
           "the longer side has 900 pixels, and both are even");
        picture_free(&pic);
    }
    packing_free(&p);
}

/* ---- what is in front ---- */

static void test_order(void)
{
    const double x[][4] = { { 0, -1, 0, 0.5 }, { 0, 1, 0, 0.8 } };
    struct packing p = balls(3, 2, x);
    p.material[0] = 2;
    for (int turn = 0; turn < 2; turn++) {
        struct picture front = draw(view(200, 0, 0), &p), back = draw(view(200, 180, 0), &p);
        ok(ball_at(&front, 100, 100) == red && ball_at(&front, 100, 65) == blue,
           "the nearer ball hides the farther one, which looks out behind it");
        ok(ball_at(&back, 100, 100) == blue && ball_at(&back, 100, 65) == blue,
           "from behind it is the other way round");
        picture_free(&front), picture_free(&back);
        // the same with their places in the arrays exchanged
        vec3 y = p.x[0];
        double r = p.radius[0];
        p.x[0] = p.x[1], p.x[1] = y, p.radius[0] = p.radius[1], p.radius[1] = r;
        p.material[0] = 0, p.material[1] = 2;
    }
    packing_free(&p);
    p = balls(3, 2, (const double[][4]){ { -0.3, 0, 0, 1 }, { 0.3, 0, 0, 1 } });
    p.material[0] = 2;
    struct picture pic = draw(view(200, 0, 0), &p);
    int wrong = 0;
    for (int i = 60; i < 140; i++)
        wrong += i != 99 && i != 100 && ball_at(&pic, i, 100) != (i < 100 ? red : blue);
    ok(!wrong, "two balls in each other meet in the plane between them (%d off)", wrong);
    picture_free(&pic), packing_free(&p);
}

static void test_walls(void)
{
    const double x[][4] = { { 0, 0, -0.2, 0.8 } };
    struct packing bare = balls(3, 1, x), p = balls(3, 1, x);
    walls(&p, 6, box);
    for (int i = 0; i < 24; i++) {
        struct view v = view(200, 30 * (i % 12), i < 12 ? 15 : -35);
        struct picture a = draw(v, &bare), b = draw(v, &p);
        int hidden = 0, more = 0;
        for (int k = 0; k < 200 * 200; k++) {
            int sky = white(&a, k % 200, k / 200);
            more += sky && !white(&b, k % 200, k / 200);
            // an edge takes a third of the light, and something near some more
            hidden += !sky && b.rgb[3 * k + 2] < 0.5 * a.rgb[3 * k + 2];
        }
        ok(!hidden && more > 100, "from %d,%d walls hide no ball and are seen", 30 * (i % 12),
           i < 12 ? 15 : -35);
        picture_free(&a), picture_free(&b);
    }
    const double sizes[] = { 1, 0.0065, 1e-3 / 3, 7e9 };
    for (int i = 0; i < 4; i++) {
        struct view v = view(200, 30, -35);
        double a = sizes[i];
        for (int k = 0; k < 6; k++) p.wall[k].x = v3_scale(a, box[k][0]);
        v.region = (struct extent){ { -a, -a, -a }, { a, a, a } }, p.x[0].z = 1e20;
        struct picture pic = draw(v, &p);
        ok(drawn(&pic) > 1000,
           "walls of %g m in the sides of --box have their twelve edges (%d pixels)", a,
           drawn(&pic));
        picture_free(&pic);
    }
    packing_free(&bare), packing_free(&p);
    p = balls(3, 1, (const double[][4]){ { 0, 0, 0.4, 0.4 } });
    walls(&p, 1, (const vec3[][2]){ { { 0, 0, 0 }, { 0, 0, 1 } } });
    struct picture above = draw(view(400, 0, 30), &p), below = draw(view(400, 0, -30), &p);
    ok(!white(&above, 100, 200) && white(&below, 100, 200),
       "a floor is seen from above and not from below");
    // beside the ball and far from it, in the same square of the pattern (0.5 m here)
    int near = 0, far = 0;
    for (int k = 0; k < 4; k++)
        near += *pixel(&above, 245 + k, 200), far += *pixel(&above, 345 + k, 200);
    ok(near < far - 40, "it is darker beside the ball (%d) than far away (%d)", near / 4, far / 4);
    picture_free(&above), picture_free(&below), packing_free(&p);
}

/* ---- glass ---- */

static const double clear = 0.1, glass[3] = { 0.62, 0.74, 0.86 }; // of a pane seen face to face

/* Linear light of an sRGB byte, and back [IEC 61966-2-1] */
static double light_of(unsigned char c)
{
    double s = c / 255.0;
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

static double byte_of(double light)
{
    return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055);
}

/* Whether a pixel is what is seen behind n panes, to a step of a byte */
static bool behind(const struct picture *panes, const struct picture *bare, int x, int y, int n)
{
    double passes = pow(1 - clear, n);
    const unsigned char *is = pixel(panes, x, y), *was = pixel(bare, x, y);
    for (int k = 0; k < 3; k++)
        if (fabs(byte_of(passes * light_of(was[k]) + (1 - passes) * glass[k]) - is[k]) > 1.5)
            return false;
    return true;
}

/* A ball between a wall in front of it and one behind, without their edges: those lie outside */
static void test_glass(void)
{
    struct packing p = balls(3, 1, (const double[][4]){ { 0, 0, 0, 0.5 } });
    struct view v = view(64, 0, 0);
    paint_init(&v.paint, COLOUR_MATERIAL, false);
    struct picture bare = draw(v, &p);
    static const vec3 front[2] = { { 0, -1, 0 }, { 0, 1, 0 } },
                      back[2] = { { 0, 1, 0 }, { 0, -1, 0 } };
    const vec3 both[2][2] = { { front[0], front[1] }, { back[0], back[1] } };
    const vec3 turned[2][2] = { { back[0], back[1] }, { front[0], front[1] } };
    v.glass = true;
    walls(&p, 2, both);
    struct picture two = draw(v, &p);
    ok(behind(&two, &bare, 32, 32, 1), "a ball is seen through the wall in front of it");
    ok(behind(&two, &bare, 8, 8, 2), "beside it one looks through both walls");
    walls(&p, 2, turned);
    struct picture other = draw(v, &p);
    ok(same(&two, &other), "their order does not matter");
    v.samples = 2, v.threads = 3;
    struct picture fine = draw(v, &p);
    v.threads = 1;
    struct picture single = draw(v, &p);
    ok(same(&fine, &single), "nor do threads");
    v.samples = 1, v.cuts = true, v.cut = v3(0, -1, 0), v.cut_at = 0.7; // the wall in front is away
    struct picture cut = draw(v, &p);
    ok(behind(&cut, &bare, 32, 32, 0) && behind(&cut, &bare, 8, 8, 1),
       "what is cut away takes no light");
    v.cuts = false, v.angle = 40;
    struct picture wide = draw(v, &p);
    v.glass = false;
    struct picture wide_bare = draw(v, &p);
    ok(behind(&wide, &wide_bare, 32, 32, 1), "with perspective too");
    picture_free(&bare), picture_free(&two), picture_free(&other), picture_free(&fine);
    picture_free(&single), picture_free(&cut), picture_free(&wide), picture_free(&wide_bare);
    packing_free(&p);
}

/* ---- marks and colours ---- */

static void test_marks(void)
{
    for (int dim = 2; dim < 4; dim++) {
        const char *what = dim == 2 ? "disc" : "ball";
        struct packing p = balls(dim, 1, (const double[][4]){ { 0, 0, 0, 1.5 } });
        struct view v = view(200, 0, 15), plain = v;
        v.paint.plain = false;
        struct picture a = draw(v, &p), c = draw(plain, &p);
        p.q[0] = (quat){ -1, 0, 0, 0 };
        struct picture b = draw(v, &p);
        ok(same(&a, &b), "q and -q turn a %s the same way", what);
        picture_free(&b);
        p.q[0] = quat_rotation(v3(0, 0, M_PI / 2));
        struct picture turned = draw(v, &p), shaded = draw(plain, &p);
        int moved = differ(&a, &turned, 20);
        ok(moved > 0.3 * drawn(&a), "a quarter of a turn moves the mark of a %s (%d pixels)", what,
           moved);
        ok(same(&c, &shaded), "a plain %s looks the same from all sides", what);
        picture_free(&a), picture_free(&c), picture_free(&turned), picture_free(&shaded);
        packing_free(&p);
    }
    struct packing p = balls(2, 1, (const double[][4]){ { 0, 0, 0, 1.5 } });
    struct view v = view(200, 0, 0);
    v.paint.plain = false;
    struct picture first = draw(v, &p);
    for (int k = 1; k < 4; k++) {
        p.q[0] = quat_rotation(v3(0, 0, k * M_PI / 2));
        struct picture now = draw(v, &p), back = now;
        back.rgb = malloc(3 * 200 * 200);
        for (int y = 0; y < 200; y++)
            for (int x = 0; x < 200; x++) { // counterclockwise: up goes to the left
                int fx = k == 1 ? y : k == 2 ? 199 - x : 199 - y;
                int fy = k == 1 ? 199 - x : k == 2 ? 199 - y : x;
                memcpy(back.rgb + 3 * (y * 200 + x), pixel(&now, fx, fy), 3);
            }
        int wrong = differ(&first, &back, 2);
        ok(wrong < 0.02 * drawn(&first),
           "a disc turned by %d degrees is its picture turned (%d off)", 90 * k, wrong);
        picture_free(&now), picture_free(&back);
    }
    picture_free(&first), packing_free(&p);
}

static void test_colours(void)
{
    struct packing p =
        balls(2, 3, (const double[][4]){ { -1, 0, 0, 0.5 }, { 0, 0, 0, 0.4 }, { 1, 0, 0, 0.3 } });
    p.v[0] = v3(0, -3, 0), p.v[1] = v3(DBL_MAX, DBL_MAX, 0), p.id[2] = INT32_MIN;
    const enum colour by[] = { COLOUR_RADIUS, COLOUR_SPEED, COLOUR_MATERIAL, COLOUR_ID };
    struct rgb c[4][3];
    for (int k = 0; k < 4; k++) {
        struct paint paint;
        paint_init(&paint, by[k], true);
        paint_range(&paint, &p);
        for (int i = 0; i < 3; i++) c[k][i] = paint_body(&paint, &p, i);
    }
    ok(c[0][0].r > 0.8 && c[0][0].b < 0.1 && c[0][2].g < 0.01,
       "the largest is yellow, the smallest violet");
    ok(!memcmp(&c[1][0], &c[1][2], sizeof c[1][0]) && c[1][1].r > 0.8,
       "the fastest is yellow, what is slow beside it violet");
    ok(!memcmp(&c[2][0], &c[2][2], sizeof c[2][0]), "one kind, one colour");
    ok(memcmp(&c[3][0], &c[3][1], sizeof c[3][0]), "another id, another colour");
    struct paint paint;
    paint_init(&paint, COLOUR_RADIUS, true);
    double last = -1;
    bool rises = true;
    for (int i = 0; i < 256; i++) {
        struct rgb q = paint.palette[i];
        double light = 0.2126 * q.r + 0.7152 * q.g + 0.0722 * q.b;
        rises &= light > last, last = light;
    }
    paint.lo = paint.hi = 0.4;
    for (int i = 0; i < 3; i++) c[0][i] = paint_body(&paint, &p, i);
    ok(!memcmp(&c[0][0], &paint.palette[255], sizeof c[0][0]) &&
           !memcmp(&c[0][2], &paint.palette[0], sizeof c[0][0]) && c[0][1].r < 0.1,
       "where all were alike, the middle is theirs and the ends are for others");
    ok(rises, "the palette becomes lighter from end to end");
    packing_free(&p);
}

/* ---- the same again, and extremes ---- */

static void test_threads(void)
{
    struct packing p = balls(3, 1, (const double[][4]){ { 0, 0, 0, 1 } });
    packing_free(&p);
    struct failure failure = { 0 };
    if (packing_init(&p, 3, 2000, &failure)) exit(1);
    srand(5);
    for (int i = 0; i < 2000; i++) {
        double s = 1.0 / RAND_MAX;
        p.x[i] = v3(2 * s * rand() - 1, 2 * s * rand() - 1, 2 * s * rand() - 1);
        p.radius[i] = 0.02 + 0.2 * s * rand() * s * rand();
        p.q[i] = quat_unit((quat){ s * rand(), s * rand(), s * rand(), 1 });
    }
    walls(&p, 6, box);
    struct view v = view(301, 30, 15);
    v.paint.plain = v.boxed = false, v.samples = 3;
    struct picture one = draw(v, &p);
    for (int n = 1; n < 8; n += 2) {
        v.threads = n;
        struct picture many = draw(v, &p);
        ok(same(&one, &many), "%d threads draw the same", n);
        picture_free(&many);
    }
    picture_free(&one), packing_free(&p);
}

static void extreme(const char *what, const struct packing *p, bool boxed)
{
    for (int i = 0; i < 3; i++) {
        struct view v = view(64, 30, 45 * i - 45);
        v.boxed = boxed, v.samples = 2;
        if (p->dim == 2) v.region.lo.z = v.region.hi.z = 0;
        struct picture pic = draw(v, p);
        if (i == 2) ok(drawn(&pic) > 0, "%s: drawn, %d pixels", what, drawn(&pic));
        picture_free(&pic);
    }
}

static void test_extremes(void)
{
    const double big = 1e300, small = 1e-300;
    struct packing p = balls(3, 2, (const double[][4]){ { 0, 0, 0, 1 }, { 0, big, -big, 1 } });
    extreme("a ball that flew away to 1e300 m", &p, false);
    p.x[1] = v3(1e149, 0, 0);
    extreme("to 1e149 m", &p, false);
    p.x[1] = v3(DBL_MAX, -DBL_MAX, DBL_MAX);
    extreme("as far as numbers go", &p, false);
    p.x[1] = v3(0, 0, 0), p.radius[1] = small;
    extreme("radii of 1 and 1e-300 m", &p, false);
    p.radius[0] = 1e-12, p.x[0] = v3(1.5, 1.5, 1.5);
    extreme("radii below a pixel", &p, true);
    p.radius[0] = 1e140, p.radius[1] = DBL_MAX;
    extreme("radii of 1e140 m and more", &p, false);
    p.radius[0] = 1e50;
    extreme("seen from the inside", &p, true);
    p.radius[0] = p.radius[1] = small, p.x[0] = p.x[1] = v3(small, small, small);
    extreme("all of it 1e-300 m small", &p, false);
    packing_free(&p);
    p = balls(3, 1, (const double[][4]){ { 0, 0, 1, 1 } });
    walls(&p, 6,
          (const vec3[][2]){ { { 0, 0, 0 }, { 0, 0, 1 } },
                             { { 0, 0, 0 }, { 0, 0, 1 } },
                             { { 0, 0, big }, { 0, 0, -1 } },
                             { { -1e150, 0, 0 }, { 1, 0, 0 } },
                             { { 5, 0, 0 }, { 1, 0, 0 } },
                             { { -5, 0, 0 }, { -1, 0, 0 } } });
    extreme("walls twice, far away, and with nothing between them", &p, false);
    if (packing_alloc_walls(&p, 500, &(struct failure){ 0 })) exit(1);
    for (int i = 0; i < 500; i++) {
        double a = 2 * M_PI * i / 500;
        p.wall[i] = wall_plane(v3(-cos(a), -sin(a), 0), v3(cos(a), sin(a), 0), 0);
    }
    extreme("500 walls", &p, false);
    packing_free(&p);
    for (int dim = 2; dim < 4; dim++) {
        p = balls(dim, 0, NULL);
        walls(&p, dim == 2 ? 4 : 6, box);
        extreme("no bodies: their walls", &p, false);
        walls(&p, 1, (const vec3[][2]){ { { 0, 0, 0 }, { 0, dim == 2, dim == 3 } } });
        extreme("no bodies, one wall", &p, false);
        struct view v = view(64, 0, 0);
        struct failure failure = { 0 };
        v.boxed = false, p.walls = 0;
        ok(view_extend(&v, &p, &failure) == EX_DATAERR, "no bodies and no walls: %s", failure.text);
        packing_free(&p);
    }
    p = balls(2, 1, (const double[][4]){ { 0, 0, 0, 1 } });
    extreme("one disc", &p, false);
    struct view v = view(64, 0, 0);
    struct failure failure = { 0 };
    view_extend(&v, &p, &failure);
    p.dim = 3;
    ok(!failure.status && view_extend(&v, &p, &failure) == EX_DATAERR,
       "discs and balls in a series: %s", failure.text);
    packing_free(&p);
}

int main(void)
{
    test_size();
    test_fit();
    test_order();
    test_walls();
    test_glass();
    test_marks();
    test_colours();
    test_threads();
    test_extremes();
    return tap_done();
}
