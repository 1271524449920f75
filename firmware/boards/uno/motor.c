/* Motor: what a tick does with the driver's pins. Which they are, wiring.c has put into uno_motor. */
#include "uno.h"

#include <avr/interrupt.h>
#include <avr/io.h>

enum { OFF, AHEAD, BACK };

uno_driver uno_motor;

static uint8_t heading;
static volatile uint8_t *compare; /* of the PWM that runs */

/* Give the shield's shift register its outputs. */
void uno_shift(void)
{
    if (uno_motor.shifted == uno_motor.outputs)
        return;
    uno_motor.shifted = uno_motor.outputs;
    PORTB &= (uint8_t)~UNO_LATCH;
    for (uint8_t bit = 0x80; bit; bit >>= 1) {
        PORTD &= (uint8_t)~UNO_SHIFT_CLOCK;
        if (uno_motor.outputs & bit)
            PORTB |= UNO_SHIFT_DATA;
        else
            PORTB &= (uint8_t)~UNO_SHIFT_DATA;
        PORTD |= UNO_SHIFT_CLOCK;
    }
    PORTB |= UNO_LATCH;
}

/* The PWM's pins go to their ports' level, which is low; only then the others change, and never are two of them high. */
static void turn(uint8_t to) __attribute__((noinline)); /* most ticks keep the way, and need not save its registers */
static void turn(uint8_t to)
{
    const uno_way *way = &uno_motor.ways[to == BACK];
    TCCR0A = TCCR2A = uno_motor.waveform;
    OCR0A = OCR0B = OCR2A = OCR2B = 0; /* taken over at the carrier's next turn: no pin shall begin with an old duty */
    heading = to;
    uno_low(uno_motor.ways[0].line);
    uno_low(uno_motor.ways[1].line);
    if (to != OFF)
        uno_high(way->line);
    if (uno_motor.shifts)
        uno_shift();
    if (to == OFF)
        return;
    compare = way->compare;
    TCCR0A = way->control_0;
    TCCR2A = way->control_2;
}

void board_motor(hl_core *core, int16_t duty)
{
    (void)core;
    const uint8_t to = duty > 0 ? AHEAD : duty < 0 ? BACK : OFF;
    const uint8_t interrupts = SREG;
    cli(); /* direction and duty belong together, whoever else calls */
    if (to != heading)
        turn(to);
    if (to != OFF)
        *compare = (uint8_t)((duty > 0 ? duty : -duty) - 1); /* fast PWM is high for one clock more than it says */
    else
        TCCR0A = TCCR2A = uno_motor.waveform; /* however often */
    SREG = interrupts;
}
