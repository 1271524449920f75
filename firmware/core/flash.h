/* Constant tables that stay in flash. An AVR reads its flash by an instruction of its own, lpm, and would otherwise copy
 * every constant to RAM at start. Elsewhere a table is a table. */
#ifndef HL_FLASH_H
#define HL_FLASH_H

#include <stdint.h>

#if defined(__AVR__)
#define HL_FLASH __attribute__((__progmem__))

static inline uint8_t hl_flash_byte(const uint8_t *p)
{
    uint8_t byte;
    __asm__("lpm %0, Z" : "=r"(byte) : "z"(p));
    return byte;
}

static inline uint16_t hl_flash_word(const uint16_t *p)
{
    uint16_t word;
    __asm__("lpm %A0, Z+\n\tlpm %B0, Z" : "=&r"(word), "+z"(p));
    return word;
}

/* into Z, where ijmp wants it */
static inline const void *hl_flash_pointer(const void *const *p)
{
    const void *pointer;
    __asm__("lpm __tmp_reg__, Z+\n\tlpm r31, Z\n\tmov r30, __tmp_reg__" : "=z"(pointer) : "0"(p));
    return pointer;
}
#define HL_FLASH_BYTE(p) hl_flash_byte(p)
#define HL_FLASH_WORD(p) hl_flash_word(p)
#define HL_FLASH_POINTER(p) hl_flash_pointer(p)
#else
#define HL_FLASH
#define HL_FLASH_BYTE(p) (*(p))
#define HL_FLASH_WORD(p) (*(p))
#define HL_FLASH_POINTER(p) (*(p))
#endif

static inline void hl_flash_copy(uint8_t *to, const uint8_t *from, uint8_t count)
{
    while (count--) {
        *to++ = HL_FLASH_BYTE(from++);
    }
}

#endif
