/* Checksums: CRC-16 of a frame, CRC-32 of what is kept or can move the motor. */
#ifndef HL_CRC_H
#define HL_CRC_H

#include <stddef.h>
#include <stdint.h>

/* CRC-16 CCITT, most significant bit first, initial value 0xffff. */
uint16_t hl_crc16(const uint8_t *bytes, uint8_t count);

/* CRC-32 as in zlib: begin with 0, or go on from an earlier result. */
uint32_t hl_crc32(uint32_t crc, const uint8_t *bytes, size_t count);

#endif
