/* The second stage of the boot ROM: 252 bytes and a checksum, which the build adds.
 *
 * The ROM copies them to RAM, checks them and runs them there: code and constants are reached relative to the program
 * counter only. It makes the flash readable with the command 03h, which every chip knows: nothing but the copy of the
 * image to RAM reads it. */
#include "pico.h"

enum {
    EEPROM_READ = 3 << 8, /* of CTRLR0: send command and address, then receive */
    FRAME_BITS = 31 << 16, /* 32 bits at once */
    ADDRESS_24 = 6 << 2, /* of SPI_CTRLR0, in units of 4 bits */
    INSTRUCTION_8 = 2 << 8,
};
#define READ_COMMAND (UINT32_C(0x03) << 24)

__attribute__((section(".boot2"), used, noreturn)) void pico_boot2(void)
{
    REGISTER(SSI_ENABLE) = 0;
    REGISTER(SSI_BAUD) = 4; /* 31 MHz at most: 03h goes to 50 MHz */
    REGISTER(SSI_CTRLR0) = EEPROM_READ | FRAME_BITS;
    REGISTER(SSI_CTRLR1) = 0; /* one frame */
    REGISTER(SSI_SPI_CTRLR0) = READ_COMMAND | INSTRUCTION_8 | ADDRESS_24;
    REGISTER(SSI_ENABLE) = 1;
    const uint32_t stack = REGISTER(FLASH_BASE + 0x100), start = REGISTER(FLASH_BASE + 0x104);
    REGISTER(VECTOR_TABLE) = FLASH_BASE + 0x100;
    __asm__ volatile("msr msp, %0\n\tbx %1" : : "r"(stack), "r"(start));
    __builtin_unreachable();
}
