/* Motor: PWM on D5 (OC0B, 62.5 kHz, above hearing), direction on D8. */
#include "uno.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#define FAST_PWM (_BV(WGM01) | _BV(WGM00))
#define PWM_CONNECTED (_BV(COM0B1) | FAST_PWM)

void uno_motor_begin(void)
{
    TCCR0A = FAST_PWM;
    TCCR0B = _BV(CS00);
}

void board_motor(hl_core *core, int16_t duty)
{
    (void)core;
    uint8_t interrupts = SREG;
    cli(); /* direction and duty belong together, whoever else calls */
    if (duty == 0) {
        TCCR0A = FAST_PWM; /* the pin goes to its port's level, which is low */
        OCR0B = 0; /* it is taken over at the carrier's next turn: connected again, the pin shall not begin with an old duty */
    } else {
        if (duty > 0)
            PORTB |= UNO_DIRECTION_PIN;
        else
            PORTB &= (uint8_t)~UNO_DIRECTION_PIN;
        OCR0B = (uint8_t)((duty > 0 ? duty : -duty) - 1); /* fast PWM is high for one clock more than it says */
        TCCR0A = PWM_CONNECTED;
    }
    SREG = interrupts;
}
