/* Raspberry Pi Pico: tick, watchdog, causes of a reset.
 *
 * The tick is the only interrupt. USB is served by the main loop, between ticks: what comes in its place waits, because
 * the controller answers for itself that it is not ready. So nothing makes a tick late but board_lock. */
#include "pico.h"

enum {
    TICK = 1, /* of the processor's interrupts, and of the timer's alarms */
    SOONEST_US = 3, /* an alarm nearer than this could be passed before it is written: it matches one microsecond only */
    WATCHDOG_US = 125000,
    WATCHDOG_ON = 1 << 30,
    WATCHDOG_STEPS = 2, /* it counts by two each microsecond (RP2040-E1) */
    ALL_BUT_OSCILLATORS = 0x1fffc,
    RAN = 0x48617074, /* in a scratch register: this firmware ran before a watchdog's reset, no bootloader */
    GUARD = 0x5AC3A50F,
    RESET_BY_POWER = 1 << 8, /* of CHIP_RESET; too low a supply is one of them */
    RESET_BY_PIN = 1 << 16,
};

hl_core pico_core;

extern volatile uint32_t pico_stack_guard; /* the stack's last word */

static uint8_t reset_cause;
static volatile uint8_t ticking;
static uint32_t here, period; /* the grid's point of this tick or the next, and to the one after it [us] */

void pico_tick(void);
void pico_broken(void);

uint8_t board_reset_cause(hl_core *core)
{
    (void)core;
    return reset_cause;
}

static uint8_t look_at_reset(void)
{
    const uint32_t chip = REGISTER(CHIP_RESET);
    const uint8_t bitten = REGISTER(WATCHDOG_REASON) != 0 && REGISTER(WATCHDOG_SCRATCH0) == RAN;
    REGISTER(WATCHDOG_SCRATCH0) = RAN;
    if (bitten) {
        return HL_RESET_WATCHDOG;
    }
    return chip & RESET_BY_PIN ? HL_RESET_EXTERNAL : chip & RESET_BY_POWER ? HL_RESET_POWER : HL_RESET_POWER_OR_RESET;
}

uint16_t board_clock(hl_core *core)
{
    (void)core;
    return (uint16_t)REGISTER(TIMER_NOW);
}

void board_period(hl_core *core, uint16_t us)
{
    (void)core;
    const uint32_t before = interrupts_off();
    period = us;
    if (!ticking) { /* else the tick goes on from here */
        here = REGISTER(TIMER_NOW) + us;
        REGISTER(TIMER_ALARM0) = here;
        REGISTER(TIMER_INTR) = TICK;
    }
    interrupts_back(before);
}

void board_lock(hl_core *core)
{
    (void)core;
    REGISTER(NVIC_DISABLE) = TICK;
    __asm__ volatile("dsb\n\tisb" : : : "memory");
}

void board_unlock(hl_core *core)
{
    (void)core;
    __asm__ volatile("" : : : "memory");
    REGISTER(NVIC_ENABLE) = TICK; /* a tick does not interrupt itself */
}

/* The next point of the grid that is still to come. */
static void next_tick(void)
{
    const int32_t passed = (int32_t)(REGISTER(TIMER_NOW) - here) + SOONEST_US;
    uint32_t step = period;
    while ((int32_t)step <= passed) {
        step += period;
    }
    here += step;
    REGISTER(TIMER_ALARM0) = here;
}

void pico_tick(void)
{
    sensor_sample();
    REGISTER(TIMER_INTR) = TICK;
    ticking = 1;
    hl_core_tick(&pico_core);
    next_tick();
    ticking = 0;
}

void watchdog_wait(uint32_t us)
{
    REGISTER(WATCHDOG_LOAD) = us * WATCHDOG_STEPS;
}

void board_alive(hl_core *core)
{
    if (core->ran) {
        core->ran = 0;
        watchdog_wait(WATCHDOG_US);
    }
    if (pico_stack_guard != GUARD) {
        pico_stack_guard = GUARD;
        uint32_t stack;
        __asm__ volatile("mov %0, sp" : "=r"(stack));
        hl_core_fault(core, HL_FAULT_MEMORY, (float)stack);
    }
    usb_poll(core);
}

/* A fault of the processor: motor off; the watchdog bites. */
void pico_broken(void)
{
    board_motor(&pico_core, 0);
    for (;;) {
    }
}

int main(void)
{
    pico_stack_guard = GUARD;
    reset_cause = look_at_reset();
    board_period(&pico_core, HL_IDLE_PERIOD_US);
    hl_core_start(&pico_core);
    usb_begin();
    REGISTER(PSM_WDSEL) = ALL_BUT_OSCILLATORS;
    watchdog_wait(WATCHDOG_US);
    REGISTER(WATCHDOG_CTRL) = WATCHDOG_ON;
    REGISTER(TIMER_INTE) = TICK;
    board_unlock(&pico_core);
    for (;;) {
        hl_core_poll(&pico_core);
    }
}
