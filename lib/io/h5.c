#include "io/h5.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void h5_start(void)
{
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

bool h5_has(hid_t place, const char *path)
{
    return H5Oexists_by_name(place, path, H5P_DEFAULT) > 0;
}

int h5_shape(hid_t place, const char *path, hsize_t shape[4])
{
    hid_t set = H5Dopen2(place, path, H5P_DEFAULT);
    if (set < 0) return -1;
    hid_t space = H5Dget_space(set);
    int rank = H5Sget_simple_extent_ndims(space);
    if (rank > 4 || H5Sget_simple_extent_dims(space, shape, NULL) != rank) rank = -1;
    H5Sclose(space);
    H5Dclose(set);
    return rank;
}

/*
 * Do numbers of this type on disk keep their values in type `want`? Integers may become reals, not
 * the reverse. A type of a damaged, huge size would make libhdf5 clear gigabytes to convert it.
 */
static bool suits(hid_t disk, hid_t want)
{
    H5T_class_t class = H5Tget_class(disk);
    if (H5Tget_size(disk) > 16) return false;
    return class == H5T_INTEGER || (class == H5T_FLOAT && H5Tget_class(want) == H5T_FLOAT);
}

static const char *wanted(hid_t type)
{
    return H5Tget_class(type) == H5T_FLOAT ? "numbers" : "integers";
}

/*
 * Can the file hold as much as the dataset's shape says? If not, nothing is allocated for it. gzip
 * packs at most 1032 to 1. Data that were never written take no room; 1 MiB of those is allowed.
 */
static bool plausible(hid_t set, hsize_t count, size_t size)
{
    hsize_t length = 0, stored = H5Dget_storage_size(set);
    hid_t file = H5Iget_file_id(set);
    if (H5Fget_filesize(file, &length) >= 0 && stored > length) stored = length;
    H5Fclose(file);
    return count / 1100 <= (stored + 1024) / size;
}

/* Opens the dataset if it holds numbers that suit `type`; else returns -1. */
static hid_t open_numbers(hid_t place, const char *path, hid_t type, hsize_t *count,
                          struct why *why)
{
    hid_t set = H5Dopen2(place, path, H5P_DEFAULT);
    if (set < 0) return why_set(why, EX_DATAERR, "%s: no such dataset", path), -1;
    hid_t disk = H5Dget_type(set), space = H5Dget_space(set);
    hssize_t points = H5Sget_simple_extent_npoints(space);
    bool good = suits(disk, type);
    H5Sclose(space);
    H5Tclose(disk);
    *count = points < 0 ? 0 : (hsize_t)points;
    if (good && points >= 0 && plausible(set, *count, H5Tget_size(type))) return set;
    if (!good)
        why_set(why, EX_DATAERR, "%s: %s are wanted, and it holds something else", path,
                wanted(type));
    else
        why_set(why, EX_DATAERR,
                "%s: %lld values are said to be there, more than the file can hold", path,
                (long long)points);
    H5Dclose(set);
    return -1;
}

static int read_numbers(hid_t set, const char *path, hid_t type, hsize_t count, void *out,
                        struct why *why)
{
    herr_t e = count ? H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out) : 0;
    return e < 0 ? why_set(why, EX_DATAERR, "%s: cannot be read (damaged?)", path) : 0;
}

int h5_read(hid_t place, const char *path, hid_t type, hsize_t count, void *out, struct why *why)
{
    hsize_t found;
    hid_t set = open_numbers(place, path, type, &found, why);
    if (set < 0) return why->status;
    int e = found == count ? read_numbers(set, path, type, count, out, why)
                           : why_set(why, EX_DATAERR, "%s: %llu values, %llu are wanted", path,
                                     (unsigned long long)found, (unsigned long long)count);
    H5Dclose(set);
    return e;
}

void *h5_read_all(hid_t place, const char *path, hid_t type, hsize_t *count, struct why *why)
{
    hid_t set = open_numbers(place, path, type, count, why);
    if (set < 0) return NULL;
    void *out = calloc(*count + 1, H5Tget_size(type));
    if (!out) {
        why_set(why, EX_SOFTWARE, "%s: out of memory for %llu values", path,
                (unsigned long long)*count);
    } else if (read_numbers(set, path, type, *count, out, why)) {
        free(out);
        out = NULL;
    }
    H5Dclose(set);
    return out;
}

/* A scalar string of fixed or variable length as a new C string; of set and attr, one is -1. */
static char *text_of(hid_t set, hid_t attr)
{
    hid_t disk = set >= 0 ? H5Dget_type(set) : H5Aget_type(attr);
    hid_t space = set >= 0 ? H5Dget_space(set) : H5Aget_space(attr);
    char *out = NULL, *text = NULL;
    bool single = H5Tget_class(disk) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1;
    if (single && H5Tis_variable_str(disk) > 0) {
        hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE);
        H5Tset_cset(type, H5Tget_cset(disk));
        herr_t e = set >= 0 ? H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text)
                            : H5Aread(attr, type, &text);
        if (e >= 0) out = strdup(text ? text : "");
        H5free_memory(text);
        H5Tclose(type);
    } else if (single && (set < 0 ? H5Tget_size(disk) <= 1 << 20 // attributes are small
                                  : plausible(set, 1, H5Tget_size(disk)))) {
        out = calloc(H5Tget_size(disk) + 1, 1);
        herr_t e = !out       ? 0
                   : set >= 0 ? H5Dread(set, disk, H5S_ALL, H5S_ALL, H5P_DEFAULT, out)
                              : H5Aread(attr, disk, out);
        if (e < 0) free(out), out = NULL;
    }
    H5Sclose(space);
    H5Tclose(disk);
    return out;
}

char *h5_read_text(hid_t place, const char *path)
{
    const char *at = strrchr(path, '@');
    if (!at) {
        hid_t set = H5Dopen2(place, path, H5P_DEFAULT);
        char *text = set < 0 ? NULL : text_of(set, -1);
        if (set >= 0) H5Dclose(set);
        return text;
    }
    char *object = at == path ? strdup(".") : strndup(path, (size_t)(at - path));
    hid_t attr = object ? H5Aopen_by_name(place, object, at + 1, H5P_DEFAULT, H5P_DEFAULT) : -1;
    char *text = attr < 0 ? NULL : text_of(-1, attr);
    if (attr >= 0) H5Aclose(attr);
    free(object);
    return text;
}

hid_t h5_dataset_plist(void)
{
    hid_t plist = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(plist, false);
    return plist;
}

/* Makes the groups above an object. */
static int make_parents(hid_t place, const char *path, struct why *why)
{
    const char *slash = strrchr(path, '/');
    if (!slash || slash == path) return 0;
    char *parent = strndup(path, (size_t)(slash - path));
    int e = parent ? h5_group(place, parent, why) : why_set(why, EX_SOFTWARE, "out of memory");
    free(parent);
    return e;
}

int h5_group(hid_t place, const char *path, struct why *why)
{
    H5O_info_t info;
    hid_t group = -1;
    bool there = H5Oget_info_by_name2(place, path, &info, H5O_INFO_BASIC, H5P_DEFAULT) >= 0;
    if (!there) {
        if (make_parents(place, path, why)) return why->status;
        hid_t plist = H5Pcreate(H5P_GROUP_CREATE);
        H5Pset_obj_track_times(plist, false);
        group = H5Gcreate2(place, path, H5P_DEFAULT, plist, H5P_DEFAULT);
        H5Pclose(plist);
    }
    bool good = there ? info.type == H5O_TYPE_GROUP : group >= 0 && H5Gclose(group) >= 0;
    return good ? 0 : why_set(why, EX_IOERR, "%s: cannot make the group", path);
}

static int write_data(hid_t place, const char *path, hid_t memory, hid_t disk, hid_t space,
                      const void *data, const char *units, struct why *why)
{
    if (make_parents(place, path, why)) return why->status;
    hid_t plist = h5_dataset_plist();
    hid_t set = H5Dcreate2(place, path, disk, space, H5P_DEFAULT, plist, H5P_DEFAULT);
    H5Pclose(plist);
    bool bad = set < 0;
    if (!bad && H5Sget_simple_extent_npoints(space) > 0)
        bad = H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0;
    if (!bad && units) bad = h5_attr_text(set, ".", "units", units, why);
    if (set >= 0) bad |= H5Dclose(set) < 0;
    return bad ? why_set(why, EX_IOERR, "%s: cannot be written", path) : 0;
}

/* The type on disk for this type of memory. To be closed. */
static hid_t little_endian(hid_t type)
{
    hid_t disk = H5Tcopy(type);
    H5Tset_order(disk, H5T_ORDER_LE);
    return disk;
}

/* A C string of just this length with its zero, as libfclib stores and expects it. To be closed. */
static hid_t text_type(const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text) + 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

int h5_write(hid_t place, const char *path, hid_t type, int rank, const hsize_t *shape,
             const void *data, const char *units, struct why *why)
{
    hid_t disk = little_endian(type);
    hid_t space = rank ? H5Screate_simple(rank, shape, NULL) : H5Screate(H5S_SCALAR);
    int e = write_data(place, path, type, disk, space, data, units, why);
    H5Sclose(space);
    H5Tclose(disk);
    return e;
}

int h5_write_text(hid_t place, const char *path, const char *text, struct why *why)
{
    hid_t type = text_type(text), space = H5Screate(H5S_SCALAR);
    int e = write_data(place, path, type, type, space, text, NULL, why);
    H5Sclose(space);
    H5Tclose(type);
    return e;
}

static hid_t make_attr(hid_t place, const char *path, const char *name, hid_t disk, hid_t space)
{
    return H5Acreate_by_name(place, path, name, disk, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

static int write_attr(hid_t place, const char *path, const char *name, hid_t memory, hid_t disk,
                      int count, const void *data, struct why *why)
{
    hsize_t shape = count < 0 ? 1 : (hsize_t)count;
    hid_t space = count < 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &shape, NULL);
    hid_t attr = make_attr(place, path, name, disk, space);
    if (attr < 0 && H5Adelete_by_name(place, path, name, H5P_DEFAULT) >= 0)
        attr = make_attr(place, path, name, disk, space);
    bool bad = attr < 0 || (count != 0 && H5Awrite(attr, memory, data) < 0);
    if (attr >= 0) bad |= H5Aclose(attr) < 0;
    H5Sclose(space);
    return bad ? why_set(why, EX_IOERR, "%s@%s: cannot be written", path, name) : 0;
}

int h5_attr(hid_t place, const char *path, const char *name, hid_t type, int count,
            const void *data, struct why *why)
{
    hid_t disk = little_endian(type);
    int e = write_attr(place, path, name, type, disk, count, data, why);
    H5Tclose(disk);
    return e;
}

int h5_attr_text(hid_t place, const char *path, const char *name, const char *text, struct why *why)
{
    hid_t type = text_type(text);
    int e = write_attr(place, path, name, type, type, -1, text, why);
    H5Tclose(type);
    return e;
}

int h5_attr_read(hid_t place, const char *path, const char *name, hid_t type, int count, void *out,
                 struct why *why)
{
    hid_t attr = H5Aopen_by_name(place, path, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attr < 0) return why_set(why, EX_DATAERR, "%s@%s: no such attribute", path, name);
    hid_t disk = H5Aget_type(attr), space = H5Aget_space(attr);
    hssize_t points = H5Sget_simple_extent_npoints(space), want = count < 0 ? 1 : count;
    int e = 0;
    if (!suits(disk, type))
        e = why_set(why, EX_DATAERR, "%s@%s: %s are wanted", path, name, wanted(type));
    else if (points != want)
        e = why_set(why, EX_DATAERR, "%s@%s: %lld values, %lld are wanted", path, name,
                    (long long)points, (long long)want);
    else if (want && H5Aread(attr, type, out) < 0)
        e = why_set(why, EX_DATAERR, "%s@%s: cannot be read", path, name);
    H5Sclose(space);
    H5Tclose(disk);
    H5Aclose(attr);
    return e;
}

/* The type of memory for numbers of this type on disk; -1: these are not numbers. */
static hid_t plain_type(hid_t disk)
{
    H5T_class_t class = H5Tget_class(disk);
    if (class == H5T_FLOAT) return H5T_NATIVE_DOUBLE;
    if (class != H5T_INTEGER) return -1;
    return H5Tget_size(disk) > 4 ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32;
}

struct target {
    hid_t to;
    const char *path;
    struct why *why;
};

static herr_t copy_attr(hid_t from, const char *name, const H5A_info_t *info, void *data)
{
    const struct target *t = data;
    enum { MOST = 1 << 16 }; /* bytes, HDF5's own limit for attributes in object headers */
    char at[200];
    if (info->data_size > MOST) return 0;
    snprintf(at, sizeof at, "@%s", name);
    char *text = h5_read_text(from, at);
    hid_t attr = H5Aopen(from, name, H5P_DEFAULT), disk = attr < 0 ? -1 : H5Aget_type(attr);
    hid_t space = attr < 0 ? -1 : H5Aget_space(attr), type = disk < 0 ? -1 : plain_type(disk);
    int rank = space < 0 ? 2 : H5Sget_simple_extent_ndims(space), e = 0;
    hssize_t points = space < 0 ? 0 : H5Sget_simple_extent_npoints(space);
    static double numbers[MOST];
    if (text)
        e = h5_attr_text(t->to, t->path, name, text, t->why);
    else if (type >= 0 && rank >= 0 && rank < 2 && points <= MOST &&
             H5Aread(attr, type, numbers) >= 0)
        e = h5_attr(t->to, t->path, name, type, rank ? (int)points : -1, numbers, t->why);
    if (space >= 0) H5Sclose(space);
    if (disk >= 0) H5Tclose(disk);
    if (attr >= 0) H5Aclose(attr);
    free(text);
    return e ? -1 : 0;
}

static int copy_numbers(hid_t set, hid_t from, const char *name, const struct target *t)
{
    hsize_t shape[4], count;
    int rank = h5_shape(from, name, shape);
    hid_t disk = H5Dget_type(set), type = plain_type(disk);
    H5Tclose(disk);
    if (rank < 0 || type < 0) return 0;
    void *data = h5_read_all(from, name, type, &count, t->why);
    if (!data) return t->why->status;
    int e = h5_write(t->to, t->path, type, rank, shape, data, NULL, t->why);
    free(data);
    return e;
}

int h5_copy_plain(hid_t from, const char *name, hid_t to, const char *path, struct why *why)
{
    struct target t = { to, path, why };
    hid_t set = H5Dopen2(from, name, H5P_DEFAULT);
    if (set < 0) return why_set(why, EX_DATAERR, "%s: cannot be opened (damaged?)", name);
    char *text = h5_read_text(from, name);
    int e = text ? h5_write_text(to, path, text, why) : copy_numbers(set, from, name, &t);
    if (!e && h5_has(to, path) &&
        H5Aiterate2(set, H5_INDEX_NAME, H5_ITER_INC, NULL, copy_attr, &t) < 0)
        e = why_set(why, EX_DATAERR, "%s: attributes cannot be read (damaged?)", name);
    free(text);
    H5Dclose(set);
    return e;
}
