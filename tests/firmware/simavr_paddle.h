/* What is wired to the emulated Uno, as far as its pins can tell: motor driver, shift register, AS5048A. See simavr_shim.c. */
#ifndef SIMAVR_PADDLE_H
#define SIMAVR_PADDLE_H

#include <stdint.h>

enum { NO_PIN = 255, PINS = 20 /* D0 to D13, then A0 to A5 */ };
enum { PWM_DIRECTION, TWO_INPUTS, TWO_INPUTS_ENABLE, SHIFT_REGISTER }; /* as DRIVES of the package */

typedef struct {
    int drive;
    uint8_t pins[4];
    uint64_t conflicts; /* writes after which both inputs were high, or the driver heard what nobody meant */
    uint8_t shifting, held, was; /* 74HC595: its register, its outputs, the levels of its lines before */
} driver;

typedef struct {
    uint8_t select;         /* its pin; NO_PIN: there is none */
    uint16_t angle;
    uint16_t zeros, ones;   /* bits of its answers that are stuck: 0xffff for a dead line */
    uint16_t flips;         /* bits that a noisy line turns */
    uint16_t diagnostics;   /* register 0x3ffd */
    uint16_t answer, out, in, errors;
    uint8_t bits, selected;
    uint64_t since, hasty;  /* when it was selected or let go; how often less than 350 ns passed */
    uint64_t latched;       /* when the last angle was taken */
} as5048a;

/* How much of the time a pin is high, in 256ths, from the registers; -1 where it is an input. */
int pin_high(const uint8_t *registers, int pin);

/* Frequency of the PWM on a pin [Hz], 0 where there is none. */
double pin_carrier(const uint8_t *registers, int pin);

/* The motor's signed duty in 256ths: what the pins do, whatever the firmware means. */
int driver_duty(const driver *d, const uint8_t *registers);

/* Look at the pins after a write. */
void driver_look(driver *d, const uint8_t *registers);
void as5048a_look(as5048a *sensor, const uint8_t *registers, uint64_t cycle);

/* One byte both ways. */
uint8_t as5048a_exchange(as5048a *sensor, uint8_t byte, uint64_t cycle);

#endif
