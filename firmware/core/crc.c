#include "crc.h"

uint16_t hl_crc16(const uint8_t *bytes, uint8_t count)
{
    uint16_t crc = 0xffff;
    while (count--) {
        /* a byte at once: x^16 + x^12 + x^5 + 1 has so few terms that shifts replace the table */
        uint8_t x = (uint8_t)((crc >> 8) ^ *bytes++);
        x ^= (uint8_t)(x >> 4);
        crc = (uint16_t)((crc << 8) ^ ((uint16_t)x << 12) ^ ((uint16_t)x << 5) ^ x);
    }
    return crc;
}

uint32_t hl_crc32(uint32_t crc, const uint8_t *bytes, size_t count)
{
    crc = ~crc;
    while (count--) {
        crc ^= *bytes++;
        for (uint8_t bit = 0; bit < 8; bit++) {
            crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320UL : 0);
        }
    }
    return ~crc;
}
