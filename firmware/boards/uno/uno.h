/* What the files of this board share. */
#ifndef HL_UNO_H
#define HL_UNO_H

#include "board.h"

#define UNO_PWM_PIN _BV(PORTD5)
#define UNO_DIRECTION_PIN _BV(PORTB0)

extern hl_core uno_core;

/* The carrier runs, the motor is off. */
void uno_motor_begin(void);

/* 500000 baud, 8N1. */
void uno_uart_begin(void);

/* Start a conversion; board_counts takes its result. */
void uno_sensor_sample(void);

/* Feed the hardware watchdog if the tick ran since it was last fed. */
void uno_watchdog_feed(hl_core *core);

#endif
