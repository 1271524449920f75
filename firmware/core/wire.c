#include "wire.h"

#include "crc.h"
#include "mathf.h"

uint16_t hl_get16(const uint8_t *from)
{
    return (uint16_t)(from[0] | (unsigned)from[1] << 8);
}

uint32_t hl_get32(const uint8_t *from)
{
    return hl_get16(from) | (uint32_t)hl_get16(from + 2) << 16;
}

float hl_getf(const uint8_t *from)
{
    hl_slot s;
    s.i = (int32_t)hl_get32(from);
    return s.f;
}

void hl_put16(uint8_t *to, uint16_t value)
{
    to[0] = (uint8_t)value;
    to[1] = (uint8_t)(value >> 8);
}

void hl_put32(uint8_t *to, uint32_t value)
{
    hl_put16(to, (uint16_t)value);
    hl_put16(to + 2, (uint16_t)(value >> 16));
}

void hl_putf(uint8_t *to, float value)
{
    hl_slot s;
    s.f = value;
    hl_put32(to, (uint32_t)s.i);
}

uint8_t hl_wire_encode(uint8_t *frame, uint8_t count)
{
    const uint16_t crc = hl_crc16(frame + 1, count);
    frame[count + 1] = (uint8_t)(crc >> 8); /* high byte first: a message with its CRC has the CRC 0 */
    frame[count + 2] = (uint8_t)crc;
    const uint8_t end = (uint8_t)(count + 3);
    uint8_t link = 0; /* where the distance to the next zero is written; below 254 bytes one byte holds every one */
    for (uint8_t k = 1; k < end; k++) {
        if (frame[k] == 0) {
            frame[link] = (uint8_t)(k - link);
            link = k;
        }
    }
    frame[link] = (uint8_t)(end - link);
    frame[end] = 0;
    return (uint8_t)(end + 1);
}

uint8_t hl_wire_decode(uint8_t *frame, uint8_t count)
{
    uint8_t at = 0;
    while (at < count) {
        const uint8_t distance = frame[at];
        if (distance == 0 || distance > count - at) {
            return 0;
        }
        frame[at] = 0;
        at = (uint8_t)(at + distance);
    }
    if (count < 5 || hl_crc16(frame + 1, (uint8_t)(count - 1)) != 0) {
        return 0;
    }
    return (uint8_t)(count - 3);
}
