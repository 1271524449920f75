/* Arduino Uno: reset, clock, tick, watchdog.
 *
 * The tick runs in timer 1's compare interrupt, which masks itself and lets the others in: a byte from the link or an
 * edge of the encoder never waits for a step. hl_core_poll runs in the main loop. */
#include "uno.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <util/atomic.h>

#define CLOCKS_PER_US (HL_CLOCK_HZ / 1000000)
#define SOONEST 8 /* clocks: a compare value nearer than this could be passed before it is written */
#define GUARD 0x5AC3A50FUL

hl_core uno_core;

extern volatile uint32_t _end; /* behind all variables: the stack grows down to here */

static uint8_t reset_flags __attribute__((section(".noinit")));
static volatile uint8_t ticking;
static uint16_t period; /* clocks */

/* The first instructions after a reset, before memory is initialised: whatever driver there is gets a firm low on the pin
 * that has its PWM, but for D3, which an encoder may drive. Then the cause is read, and the watchdog is stopped: after its
 * own reset it would run on, at its shortest. */
void uno_reset(void) __attribute__((naked, used, section(".init3")));
void uno_reset(void)
{
    PORTD &= (uint8_t)~UNO_LOW_D;
    DDRD |= UNO_LOW_D;
    PORTB &= (uint8_t)~UNO_LOW_B;
    DDRB |= UNO_LOW_B;
    reset_flags = MCUSR;
    MCUSR = 0;
    wdt_disable();
}

/* Bootloaders older than Optiboot 7, the Uno's own among them, clear the flags: then nobody can tell. */
uint8_t board_reset_cause(hl_core *core)
{
    (void)core;
    if (reset_flags & _BV(PORF))
        return HL_RESET_POWER;
    if (reset_flags & _BV(BORF))
        return HL_RESET_BROWN_OUT;
    if (reset_flags & _BV(WDRF))
        return HL_RESET_WATCHDOG;
    return reset_flags & _BV(EXTRF) ? HL_RESET_EXTERNAL : HL_RESET_POWER_OR_RESET;
}

uint16_t board_clock(hl_core *core)
{
    (void)core;
    uint16_t now;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) /* the timer's 16 bits pass through one register that interrupts share */
    {
        now = TCNT1;
    }
    return now;
}

/* The grid begins anew, on an odd count for good: simavr never matches a compare value of 0. */
void board_period(hl_core *core, uint16_t us)
{
    (void)core;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        period = (uint16_t)(us * CLOCKS_PER_US);
        OCR1A = (uint16_t)(TCNT1 + (ticking ? 0 : period)) | 1; /* after a tick, next_tick goes on from here */
        TIFR1 = _BV(OCF1A);
    }
}

void board_lock(hl_core *core)
{
    (void)core;
    TIMSK1 = 0;
}

void board_unlock(hl_core *core)
{
    (void)core;
    if (!ticking) /* the tick holds itself off until it is over */
        TIMSK1 = _BV(OCIE1A);
}

/* The next point of the grid that is still to come. */
static void next_tick(void)
{
    uint16_t here = OCR1A;
    uint32_t step = period;
    while (step <= (uint16_t)(TCNT1 - here + SOONEST))
        step += period;
    OCR1A = (uint16_t)(here + step);
}

ISR(TIMER1_COMPA_vect)
{
    uno_sensor_sample();
    ticking = 1;
    TIMSK1 = 0;
    sei();
    hl_core_tick(&uno_core);
    cli();
    next_tick();
    ticking = 0;
    TIMSK1 = _BV(OCIE1A);
}

void board_configure(hl_core *core)
{
    uno_motor_configure(&core->settings);
    uno_sensor_configure(&core->settings);
}

void uno_watchdog_feed(hl_core *core)
{
    if (core->ran) {
        core->ran = 0;
        wdt_reset();
    }
}

void board_alive(hl_core *core)
{
    uno_watchdog_feed(core);
    if (_end != GUARD) {
        _end = GUARD;
        hl_core_fault(core, HL_FAULT_MEMORY, (float)SP);
    }
}

int main(void)
{
    _end = GUARD;
    board_configure(&uno_core); /* of settings that name no pins */
    uno_uart_begin();
    TCCR1B = _BV(CS11);
    board_period(&uno_core, 1000);
    hl_core_start(&uno_core);
    wdt_enable(WDTO_120MS);
    board_unlock(&uno_core);
    sei();
    for (;;)
        hl_core_poll(&uno_core);
}
