/* From reset to main: pins at rest first, then clocks, then the image into RAM, which takes 20 ms at 125 MHz. */
#include "pico.h"

extern uint32_t pico_stack_top[], pico_code[], pico_code_end[], pico_bss[], pico_bss_end[];
extern const uint32_t pico_code_load[];

int main(void);
void pico_reset(void);
void pico_tick(void);
void pico_broken(void);

/* What the processor's vector table begins with: 16 exceptions of its own, then the chip's interrupts. */
typedef void (*handler)(void);
typedef struct {
    uint32_t *stack;
    handler reset, exceptions[14], interrupts[26];
} vectors;

enum { XOSC_12_MHZ = 0xaa0, XOSC_ENABLE = 0xfab000 };
enum { PLL_POWER = 4, PLL_TIMES = 8, PLL_BY = 12, PLL_OFF = 1 << 5 | 1 << 0, PLL_OUTPUT_OFF = 1 << 3 };
enum { PLLS = RESET_PLL_SYS | RESET_PLL_USB };
enum { BLOCKS = RESET_ADC | RESET_IO | RESET_PADS | RESET_PIO0 | RESET_PWM | RESET_SPI0 | RESET_TIMER | RESET_USB };
enum { CLOCK_ON = 1 << 11, TICK_ON = 1 << 9 };
#define IN_FLASH __attribute__((section(".start"))) /* until the copy is made */
#define STABLE (UINT32_C(1) << 31) /* of XOSC_STATUS, and of a PLL's first register */

/* Where boot2 looks for it, with as much as a copy needs. */
__attribute__((section(".vectors.flash"), used)) static const vectors flash_vectors = {pico_stack_top, pico_reset, {0}, {0}};

/* Whatever is not named here nobody enabled, or is a fault of the processor. */
#define BROKEN_7 pico_broken, pico_broken, pico_broken, pico_broken, pico_broken, pico_broken, pico_broken
__attribute__((section(".vectors.ram"), used)) static const vectors ram_vectors = {
    pico_stack_top,
    pico_reset,
    {BROKEN_7, BROKEN_7},
    {pico_tick, BROKEN_7, BROKEN_7, BROKEN_7, pico_broken, pico_broken, pico_broken, pico_broken},
};

/* Multiply the crystal's 12 MHz, divide by both. */
IN_FLASH static void pll_begin(uint32_t pll, uint32_t times, uint32_t by, uint32_t and_by)
{
    REGISTER(pll) = 1;
    REGISTER(pll + PLL_TIMES) = times;
    CLEAR_BITS(pll + PLL_POWER) = PLL_OFF;
    while (!(REGISTER(pll) & STABLE)) {
    }
    REGISTER(pll + PLL_BY) = by << 16 | and_by << 12;
    CLEAR_BITS(pll + PLL_POWER) = PLL_OUTPUT_OFF;
}

IN_FLASH static void blocks_begin(uint32_t blocks)
{
    SET_BITS(RESETS) = blocks;
    CLEAR_BITS(RESETS) = blocks;
    while ((REGISTER(RESETS_DONE) & blocks) != blocks) {
    }
}

IN_FLASH static void clock_select(uint32_t control, uint32_t selected, uint32_t source)
{
    REGISTER(control) = source;
    while (REGISTER(selected) != UINT32_C(1) << source) {
    }
}

/* 125 MHz for the processor, PWM and SPI, 48 MHz for USB and ADC, 1 MHz for timer and watchdog. */
IN_FLASH static void chip_begin(void)
{
    REGISTER(XOSC_CTRL) = XOSC_12_MHZ;
    REGISTER(XOSC_STARTUP) = 47; /* 1 ms, in units of 256 periods */
    SET_BITS(XOSC_CTRL) = XOSC_ENABLE;
    while (!(REGISTER(XOSC_STATUS) & STABLE)) {
    }
    clock_select(CLOCK_REF_CTRL, CLOCK_REF_SELECTED, 2); /* the crystal */
    clock_select(CLOCK_SYS_CTRL, CLOCK_SYS_SELECTED, 0); /* off the PLL, before it stops */
    blocks_begin(PLLS);
    pll_begin(PLL_SYS, 125, 6, 2);
    pll_begin(PLL_USB, 100, 5, 5);
    clock_select(CLOCK_SYS_CTRL, CLOCK_SYS_SELECTED, 1); /* PLL_SYS */
    REGISTER(CLOCK_PERI_CTRL) = CLOCK_ON; /* the processor's */
    REGISTER(CLOCK_USB_CTRL) = CLOCK_ON; /* PLL_USB, here and below */
    REGISTER(CLOCK_ADC_CTRL) = CLOCK_ON;
    REGISTER(WATCHDOG_TICK) = TICK_ON | 12;
    blocks_begin(BLOCKS);
}

/* A reset of pins and PWM comes first: whatever ran before, every pin is an input that is pulled low. */
IN_FLASH __attribute__((used, noreturn)) void pico_reset(void)
{
    SET_BITS(RESETS) = BLOCKS;
    chip_begin();
    /* volatile: memcpy, which a compiler would call, is not there yet */
    const volatile uint32_t *from = pico_code_load;
    for (volatile uint32_t *to = pico_code; to < pico_code_end;) {
        *to++ = *from++;
    }
    for (volatile uint32_t *to = pico_bss; to < pico_bss_end;) {
        *to++ = 0;
    }
    REGISTER(VECTOR_TABLE) = (uint32_t)(uintptr_t)&ram_vectors;
    int (*volatile go)(void) = main; /* too far for a branch */
    go();
    for (;;) {
    }
}
