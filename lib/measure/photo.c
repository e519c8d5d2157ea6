#include "measure/photo.h"

#include <png.h>
#include <stdlib.h>

int photo_read(struct photo *photo, const char *file, struct failure *failure)
{
    png_image image = { .version = PNG_IMAGE_VERSION };
    *photo = (struct photo){ 0 };
    if (!png_image_begin_read_from_file(&image, file))
        return failure_set(failure, EX_USAGE, "%.200s: %s", file, image.message);
    image.format = PNG_FORMAT_GRAY;
    if (image.width > PHOTO_MOST || image.height > PHOTO_MOST) {
        png_image_free(&image);
        return failure_set(failure, EX_USAGE, "%.200s: has more than %d x %d pixels", file,
                           PHOTO_MOST, PHOTO_MOST);
    }
    photo->w = image.width, photo->h = image.height;
    photo->grey = malloc(PNG_IMAGE_SIZE(image));
    // a negative stride: the first row in memory is the lowest of the picture
    if (!photo->grey ||
        !png_image_finish_read(&image, NULL, photo->grey, -(png_int_32)image.width, NULL)) {
        failure_set(failure, EX_USAGE, "%.200s: %s", file,
                    photo->grey ? image.message : "no memory for it");
        png_image_free(&image), free(photo->grey);
        *photo = (struct photo){ 0 };
    }
    return failure->status;
}
