/* What the files of this board share. */
#ifndef HL_UNO_H
#define HL_UNO_H

#include "board.h"

#define UNO_PINS 20 /* D0 to D13, then A0 to A5 */
#define UNO_LINK_PINS (_BV(PORTD0) | _BV(PORTD1))

/* Pins that are low from the first instructions on, whatever is wired: no sensor drives them, and with D3 they are all that
 * can carry PWM; D8 is a Hapkit's direction. */
#define UNO_LOW_B (_BV(PORTB0) | _BV(PORTB3)) /* D8, D11 */
#define UNO_LOW_D (_BV(PORTD5) | _BV(PORTD6))

/* The shift register of a motor shield. */
#define UNO_LATCH _BV(PORTB4)
#define UNO_SHIFT_CLOCK _BV(PORTD4)
#define UNO_SHIFT_DATA _BV(PORTB0)

/* A pin of a port; the port's direction register lies before it. A mask of 0 is no pin. */
typedef struct {
    volatile uint8_t *port;
    uint8_t mask;
} uno_line;

/* What turns the motor one way: a PWM, and a pin that is high. */
typedef struct {
    volatile uint8_t *compare;
    uint8_t control_0, control_2; /* of the timers, with this PWM connected */
    uno_line line;
} uno_way;

typedef struct {
    uno_way ways[2];          /* ahead, back */
    uint8_t waveform;         /* of the timers, with no PWM connected */
    uint8_t shifts, outputs, shifted; /* a shift register's: whether there is one, what it shall hold, what it holds */
} uno_driver;

extern hl_core uno_core;
extern uno_driver uno_motor;

uno_line uno_line_of(uint8_t pin);
void uno_shift(void);

/* Let go of all pins, then take the driver's if their wiring is confirmed. The motor is off. */
void uno_motor_configure(const hl_settings *settings);

void uno_sensor_configure(const hl_settings *settings);

/* The sample is of now; board_reading takes it. */
void uno_sensor_sample(void);

/* 500000 baud, 8N1. */
void uno_uart_begin(void);

/* Feed the hardware watchdog if the tick ran since it was last fed. */
void uno_watchdog_feed(hl_core *core);

static inline void uno_low(uno_line line)
{
    *line.port &= (uint8_t)~line.mask;
}

static inline void uno_high(uno_line line)
{
    *line.port |= line.mask;
}

/* Make a pin an output. */
static inline void uno_drive(uno_line line)
{
    line.port[-1] |= line.mask;
}

#endif
