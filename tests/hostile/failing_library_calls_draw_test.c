/* What draws when it does not get what it asks for: tests/support/failing_library_calls.h */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): asprintf
#include "failing_library_calls.h"

#include "contact/detect.h"
#include "draw/images.h"
#include "draw/page.h"
#include "draw/paint.h"
#include "draw/svg.h"

static struct packing packing;
static struct contacts contacts;

static int page(uint32_t *crc, struct failure *failure)
{
    struct page p = { 0 };
    const char *path = fresh(".html");
    FILE *out = fopen(path, "w");
    if (!out) return failure_set(failure, EX_SOFTWARE, "no file of the test's");
    if (!page_begin(&p, out, path, "a page", failure))
        for (int k = 0; k < 3; k++)
            if (page_frame(&p, &packing, &contacts, failure) ||
                page_value(&p, "a number", "m", k, failure))
                break;
    if (!failure->status) page_end(&p, failure);
    page_free(&p);
    fclose(out);
    if (packing.walls) unlink(path), *crc = 0; // walls that find no memory are left out
    if (!packing.walls) *crc = crc_of(path);
    return failure->status;
}

static int picture(uint32_t *crc, struct failure *failure)
{
    struct overlay over = { .network = true, .contacts = true, .legend = true };
    struct view v = { .width = 64,
                      .height = 64,
                      .samples = 1,
                      .threads = 1,
                      .glass = true,
                      .azimuth = 30,
                      .elevation = 15 };
    struct picture pic = { 0 };
    const struct packing *p = &packing;
    const char *path = fresh(".png"), *vector = fresh(".svg");
    paint_init(&v.paint, COLOUR_RADIUS, false);
    *crc = 0;
    if (view_extend(&v, p, failure)) return failure->status;
    view_fit(&v, p);
    if (!overlay_draw(&over, &v, p, &contacts, &pic, failure)) picture_write(&pic, path, failure);
    picture_free(&pic);
    if (!failure->status && p->dim == 2) svg_draw(&over, &v, p, &contacts, vector, failure);
    unlink(vector), unlink(path); // walls that find no memory are left out
    return failure->status;
}

static int table(uint32_t *crc, struct failure *failure)
{
    struct values v = { 0 };
    char path[100];
    snprintf(path, sizeof path, "%s/values", folder);
    values_read(&v, path, "x", failure);
    *crc = document_crc(0, v.row, (size_t)v.n * sizeof *v.row);
    values_free(&v);
    return failure->status;
}

static int images(uint32_t *crc, struct failure *failure)
{
    struct packing p = { 0 };
    int64_t *of = NULL;
    bool was = armed;
    armed = false;
    must(packing_copy(&p, &packing, failure), failure);
    armed = was;
    if (!images_append(&p, &of, failure)) *crc = document_crc(0, p.x, (size_t)p.n * sizeof *p.x);
    free(of), packing_free(&p);
    return failure->status;
}

/* Contacts with forces, as if they were solved */
static void make(int k)
{
    struct failure failure = { 0 };
    must(build(&packing, k, &failure) || detect_contacts(&contacts, &packing, 0.1, NULL, &failure),
         &failure);
    if (contacts_alloc_found(&contacts)) exit(1);
    for (int64_t i = 0; i < contacts.n; i++) contacts.found[i].r[0] = 1e-3 * (double)(i + 1);
}

int main(void)
{
    failing_begin();
    put_file("values", "# id x step\n0 1.5 1\n1 2.5 1\n2 3.5 1\n");
    for (now = 0; now < SCENES; now++) {
        make(now);
        each_fails("a page", page);
        each_fails("a picture", picture);
        each_fails("images", images);
        contacts_free(&contacts), packing_free(&packing);
    }
    each_fails("a table", table);
    return failing_done();
}
