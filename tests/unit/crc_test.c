/* The checksum of documents is zlib's CRC-32, of any number of bytes from anywhere, in any pieces. */
#include "file/crc.h"
#include "tap.h"

#include <zlib.h>

enum { ROOM = 5000 };

int main(void)
{
    static unsigned char bytes[ROOM];
    uint32_t x = 1;
    for (int k = 0; k < ROOM; k++) bytes[k] = (unsigned char)((x = 1664525 * x + 1013904223) >> 24);
    int wrong = 0, pieces = 0;
    for (size_t size = 0; size < 600; size++)
        for (size_t from = 0; from < 17; from++)
            wrong += document_crc(x, bytes + from, size) != crc32_z(x, bytes + from, size);
    ok(!wrong, "0 to 599 bytes from any place: zlib's");
    for (size_t cut = 0; cut < ROOM; cut++)
        pieces += document_crc(document_crc(0, bytes, cut), bytes + cut, ROOM - cut) !=
                  crc32_z(0, bytes, ROOM);
    ok(!pieces, "%d bytes in two pieces, cut anywhere: zlib's of all", ROOM);
    ok(document_crc(0, "123456789", 9) == 0xcbf43926, "123456789: the published check value");
    return tap_done();
}
