/*
 * file/crc.h: the checksum of documents [nsd-format(5)], zlib's CRC-32, by libdeflate: a filter takes it of every byte
 * twice, as it comes and as it goes; zlib 1.2 does a GB a second, libdeflate four.
 */
#pragma once

#include <libdeflate.h>
#include <stddef.h>
#include <stdint.h>

/* The checksum so far (0 to begin with), continued over more bytes. */
static inline uint32_t document_crc(uint32_t crc, const void *bytes, size_t size)
{
    return size ? libdeflate_crc32(crc, bytes, size) : crc;
}
