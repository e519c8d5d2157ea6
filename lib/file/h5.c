#include "file/h5.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ATTRIBUTE_MOST = 65000 /* bytes of a text: HDF5 has 64 KiB for an attribute and what it is */
};

void h5_start(void)
{
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

bool h5_has(hid_t place, const char *path)
{
    return H5Oexists_by_name(place, path, H5P_DEFAULT) > 0;
}

hid_t h5_plain(char class, size_t size)
{
    if (class == 'f') return size == 4 ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
    if (class == 'i')
        return size == 1   ? H5T_NATIVE_INT8
               : size == 2 ? H5T_NATIVE_INT16
               : size == 4 ? H5T_NATIVE_INT32
                           : H5T_NATIVE_INT64;
    return size == 1   ? H5T_NATIVE_UINT8
           : size == 2 ? H5T_NATIVE_UINT16
           : size == 4 ? H5T_NATIVE_UINT32
                       : H5T_NATIVE_UINT64;
}

hid_t h5_dataset_plist(void)
{
    hid_t plist = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(plist, false);
    return plist;
}

void h5_fill_later(hid_t plist)
{
    H5Pset_alloc_time(plist, H5D_ALLOC_TIME_EARLY), H5Pset_fill_time(plist, H5D_FILL_TIME_NEVER);
}

/* Makes the groups above an object. */
static int make_parents(hid_t place, const char *path, struct failure *failure)
{
    const char *slash = strrchr(path, '/');
    if (!slash || slash == path) return 0;
    char *parent = strndup(path, (size_t)(slash - path));
    int e = parent ? h5_group(place, parent, failure)
                   : failure_set(failure, EX_SOFTWARE, "out of memory");
    free(parent);
    return e;
}

int h5_group(hid_t place, const char *path, struct failure *failure)
{
    H5O_info_t info;
    hid_t group = -1;
    bool there = H5Oget_info_by_name2(place, path, &info, H5O_INFO_BASIC, H5P_DEFAULT) >= 0;
    if (!there) {
        if (make_parents(place, path, failure)) return failure->status;
        hid_t plist = H5Pcreate(H5P_GROUP_CREATE);
        H5Pset_obj_track_times(plist, false);
        group = H5Gcreate2(place, path, H5P_DEFAULT, plist, H5P_DEFAULT);
        H5Pclose(plist);
    }
    bool good = there ? info.type == H5O_TYPE_GROUP : group >= 0 && H5Gclose(group) >= 0;
    return good ? 0 : failure_set(failure, EX_IOERR, "%s: cannot make the group", path);
}

/* A C string of just this length with its zero, as libfclib stores and expects it. To be closed. */
static hid_t text_type(const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text) + 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

/* The type on disk for this type of memory, and the space. To be closed. */
static hid_t disk_type(const struct h5_data *data)
{
    hid_t disk = H5Tcopy(data->type);
    if (H5Tget_class(disk) != H5T_STRING) H5Tset_order(disk, H5T_ORDER_LE);
    return disk;
}

static hid_t space_of(const struct h5_data *data)
{
    return data->rank ? H5Screate_simple(data->rank, data->shape, NULL) : H5Screate(H5S_SCALAR);
}

int h5_write(hid_t place, const char *path, struct h5_data data, const char *units,
             struct failure *failure)
{
    if (make_parents(place, path, failure)) return failure->status;
    hid_t disk = disk_type(&data), space = space_of(&data), plist = h5_dataset_plist();
    bool any = H5Sget_simple_extent_npoints(space) > 0;
    if (!data.at && any) h5_fill_later(plist);
    hid_t set = H5Dcreate2(place, path, disk, space, H5P_DEFAULT, plist, H5P_DEFAULT);
    bool bad = set < 0;
    if (!bad && data.at && any)
        bad = H5Dwrite(set, data.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.at) < 0;
    if (!bad && units) bad = h5_attr_text(set, ".", "units", units, failure);
    if (set >= 0) bad |= H5Dclose(set) < 0;
    H5Pclose(plist), H5Sclose(space), H5Tclose(disk);
    return bad ? failure_set(failure, EX_IOERR, "%s: cannot be written", path) : 0;
}

int h5_write_text(hid_t place, const char *path, const char *text, struct failure *failure)
{
    hid_t type = text_type(text);
    int e = h5_write(place, path, h5_scalar(type, text), NULL, failure);
    H5Tclose(type);
    return e;
}

static hid_t make_attr(hid_t place, const char *path, const char *name, hid_t disk, hid_t space)
{
    return H5Acreate_by_name(place, path, name, disk, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

int h5_attr(hid_t place, const char *path, const char *name, struct h5_data data,
            struct failure *failure)
{
    hid_t disk = disk_type(&data), space = space_of(&data);
    hssize_t count = H5Sget_simple_extent_npoints(space);
    hid_t attr = make_attr(place, path, name, disk, space);
    if (attr < 0 && H5Adelete_by_name(place, path, name, H5P_DEFAULT) >= 0)
        attr = make_attr(place, path, name, disk, space);
    bool bad = attr < 0 || (count != 0 && H5Awrite(attr, data.type, data.at) < 0);
    if (attr >= 0) bad |= H5Aclose(attr) < 0;
    H5Sclose(space), H5Tclose(disk);
    return bad ? failure_set(failure, EX_IOERR, "%s@%s: cannot be written", path, name) : 0;
}

int h5_attr_text(hid_t place, const char *path, const char *name, const char *text,
                 struct failure *failure)
{
    if (strlen(text) > ATTRIBUTE_MOST)
        return failure_set(failure, EX_DATAERR, "%s@%s: %zu bytes, and a document has room for %d",
                           path, name, strlen(text), ATTRIBUTE_MOST);
    hid_t type = text_type(text);
    int e = h5_attr(place, path, name, h5_scalar(type, text), failure);
    H5Tclose(type);
    return e;
}
