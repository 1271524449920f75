/* Quadrature by PIO: every edge of both lines, without an interrupt, and whether one was missed.
 *
 * The state machine keeps the lines as they were in its OSR and the count in X. It looks at both lines, jumps to the entry
 * of a table by what they were and are, counts, and puts the count into its FIFO if there is room. One turn takes 8 to 12
 * clocks of 125 MHz, so that edges may follow one another in 96 ns.
 *
 * The table has to begin at address 0. The first line leads the second when the count grows. */
#include "pico.h"

enum { UP = 16, LOST = 20, DOWN = 22, PUBLISH = 23, LOOK = 25 };
enum { JUMP = 0x0000, MACHINE_ON = 1, SHIFT_LEFT = 0, FIFO_EMPTY = 1 << 8, LOST_FLAG = 1, INSTRUCTIONS = 30 };

static const uint16_t program[INSTRUCTIONS] = {
    /* what the lines were, what they are, second line first */
    JUMP | PUBLISH, /*  0  00 00 */
    JUMP | UP, /*       1  00 01 */
    JUMP | DOWN, /*     2  00 10 */
    JUMP | LOST, /*     3  00 11 */
    JUMP | DOWN, /*     4  01 00 */
    JUMP | PUBLISH, /*  5  01 01 */
    JUMP | LOST, /*     6  01 10 */
    JUMP | UP, /*       7  01 11 */
    JUMP | UP, /*       8  10 00 */
    JUMP | LOST, /*     9  10 01 */
    JUMP | PUBLISH, /* 10  10 10 */
    JUMP | DOWN, /*    11  10 11 */
    JUMP | LOST, /*    12  11 00 */
    JUMP | DOWN, /*    13  11 01 */
    JUMP | UP, /*      14  11 10 */
    JUMP | PUBLISH, /* 15  11 11 */
    0xa029, /*         16 up:      mov x, ~x    PIO can only count down: so does the complement */
    0x0052, /*         17          jmp x--, 18 */
    0xa029, /*         18          mov x, ~x */
    JUMP | PUBLISH, /* 19          jmp publish */
    0xc010, /*         20 lost:    irq 0 rel    both lines at once: an edge was missed */
    JUMP | PUBLISH, /* 21          jmp publish */
    0x0057, /*         22 down:    jmp x--, publish */
    0xa0c1, /*         23 publish: mov isr, x */
    0x8000, /*         24          push noblock */
    0xa0c3, /*         25 look:    mov isr, null */
    0x40e2, /*         26          in osr, 2 */
    0x4002, /*         27          in pins, 2 */
    0xa0e6, /*         28          mov osr, isr */
    0xa0a6, /*         29          mov pc, isr */
};
enum { SET_X_0 = 0xe020, MOV_OSR_PINS = 0xa0e0 };

void quadrature_begin(uint8_t first_pin)
{
    REGISTER(PIO_CTRL) = 0;
    for (uint8_t k = 0; k < INSTRUCTIONS; k++) {
        REGISTER(PIO_MEMORY(k)) = program[k];
    }
    pin_function(first_pin, FUNCTION_NONE, PAD_PULL_UP); /* for open collectors */
    pin_function((uint8_t)(first_pin + 1), FUNCTION_NONE, PAD_PULL_UP);
    REGISTER(PIO_SM0_CLKDIV) = 1 << 16;
    REGISTER(PIO_SM0_SHIFTCTRL) = SHIFT_LEFT;
    REGISTER(PIO_SM0_PINCTRL) = (uint32_t)first_pin << 15;
    REGISTER(PIO_SM0_INSTR) = SET_X_0;
    REGISTER(PIO_SM0_INSTR) = MOV_OSR_PINS;
    REGISTER(PIO_SM0_INSTR) = JUMP | LOOK;
    REGISTER(PIO_IRQ) = LOST_FLAG;
    REGISTER(PIO_CTRL) = MACHINE_ON;
}

/* The FIFO is full of old counts: the one after them is of now. */
uint32_t quadrature_count(void)
{
    uint32_t old = REGISTER(PIO_FLEVEL) >> 4 & 15, count;
    do {
        while (REGISTER(PIO_FSTAT) & FIFO_EMPTY) {
        }
        count = REGISTER(PIO_RX0);
    } while (old-- > 0);
    return count;
}

uint8_t quadrature_lost(void)
{
    const uint8_t lost = (REGISTER(PIO_IRQ) & LOST_FLAG) != 0;
    if (lost) {
        REGISTER(PIO_IRQ) = LOST_FLAG;
    }
    return lost;
}
