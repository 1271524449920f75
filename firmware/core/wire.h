/* Frames: COBS around a message and its CRC-16, a zero byte at the end. Both ways work in place. */
#ifndef HL_WIRE_H
#define HL_WIRE_H

#include <stdint.h>

/* Little-endian numbers at any address. */
uint16_t hl_get16(const uint8_t *from);
uint32_t hl_get32(const uint8_t *from);
float hl_getf(const uint8_t *from);
void hl_put16(uint8_t *to, uint16_t value);
void hl_put32(uint8_t *to, uint32_t value);
void hl_putf(uint8_t *to, float value);

/* Make a frame of the `count` bytes at frame + 1, at most 251; there must be room for 4 more than count.
 * Returns the bytes to send, from frame on. */
uint8_t hl_wire_encode(uint8_t *frame, uint8_t count);

/* Undo it for the `count` bytes before the zero byte: the message is at frame + 1. Returns its length, 0 if damaged. */
uint8_t hl_wire_decode(uint8_t *frame, uint8_t count);

#endif
