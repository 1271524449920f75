/* What the files of this board share. */
#ifndef HL_PICO_H
#define HL_PICO_H

#include "board.h"
#include "rp2040.h"

extern hl_core pico_core;

/* A byte of the 4 in a setting of pins; NO_PIN for none. */
enum { NO_PIN = 255, PINS = 29 }; /* GP23 to GP25 are the Pico's own */
static inline uint8_t pin_of(uint32_t pins, uint8_t k)
{
    return (uint8_t)(pins >> (8 * k));
}

/* Whether a pin is on the Pico's edge. */
static inline uint8_t is_pin(uint8_t pin)
{
    return pin < PINS && (pin < 23 || pin > 25);
}

/* Let no interrupt in; what it was before goes back. */
static inline uint32_t interrupts_off(void)
{
    uint32_t before;
    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(before) : : "memory");
    return before;
}

static inline void interrupts_back(uint32_t before)
{
    __asm__ volatile("msr primask, %0" : : "r"(before) : "memory");
}

/* Give a pin to a block of the chip, with these bits of its pad. */
static inline void pin_function(uint8_t pin, uint32_t function, uint32_t pad)
{
    REGISTER(PADS(pin)) = pad;
    REGISTER(IO_CTRL(pin)) = function;
}

/* As after a reset: an input that is pulled low. */
static inline void pin_rest(uint8_t pin)
{
    REGISTER(SIO_OE_CLEAR) = UINT32_C(1) << pin;
    pin_function(pin, FUNCTION_NONE, PAD_PULL_DOWN);
}

/* sensor.c: start a conversion; board_reading takes its result */
void sensor_sample(void);

/* quadrature.c: an encoder on a pin and the next; its count, whether an edge was missed since asked */
void quadrature_begin(uint8_t first_pin);
uint32_t quadrature_count(void);
uint8_t quadrature_lost(void);

/* motor.c: whether settings name a drive that this board has; its pins, a bit each; take them into use, or let go */
uint8_t motor_can(const hl_settings *settings);
uint32_t motor_pins(const hl_settings *settings);
void motor_configure(const hl_settings *settings);
void motor_release(void);

/* usb.c: serve the port; called between ticks */
void usb_begin(void);
void usb_poll(hl_core *core);

/* store.c: leave for the boot ROM, which shows itself as a USB drive; not while a program runs */
void store_bootloader(hl_core *core);

/* main.c: the watchdog bites in so many microseconds, unless this is called again */
void watchdog_wait(uint32_t us);

#endif
