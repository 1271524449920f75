/* Motor: PWM and lines of direction, on the pins of the confirmed wiring. Until that is confirmed no pin is driven. */
#include "pico.h"

enum { CLOCK_HZ = 125000000, CARRIER_MIN = 2000, CARRIER_MAX = 100000, SLICE_ON = 1, UNDIVIDED = 1 << 4, MOST_PINS = 3 };

static uint8_t drive, wired;
static uint8_t pins[MOST_PINS]; /* PWM_DIRECTION: pwm, direction; TWO_INPUTS: in1, in2; TWO_INPUTS_ENABLE: in1, in2, enable */
static uint32_t full; /* clocks of one turn of the carrier */

static uint8_t count_of(const hl_settings *settings)
{
    return settings->drive == HL_DRIVE_TWO_INPUTS_ENABLE ? 3 : 2;
}

uint32_t motor_pins(const hl_settings *settings)
{
    uint32_t mask = 0;
    for (uint8_t k = 0; k < count_of(settings); k++) {
        const uint8_t pin = pin_of(settings->motor_pins, k);
        mask |= is_pin(pin) ? UINT32_C(1) << pin : 0;
    }
    return mask;
}

/* No shield with a shift register fits a Pico. */
uint8_t motor_can(const hl_settings *settings)
{
    uint8_t different = 0;
    for (uint32_t mask = motor_pins(settings); mask; mask &= mask - 1) {
        different++;
    }
    return settings->drive <= HL_DRIVE_TWO_INPUTS_ENABLE && different == count_of(settings)
        && settings->carrier >= CARRIER_MIN && settings->carrier <= CARRIER_MAX;
}

static void set(uint8_t pin, uint8_t high)
{
    REGISTER(high ? SIO_OUT_SET : SIO_OUT_CLEAR) = UINT32_C(1) << pin;
}

/* The pin's half of its slice's compare register; the other half may be another pin's. */
static void compare(uint8_t pin, uint32_t clocks)
{
    const uint32_t shift = 16u * (pin & 1), address = PWM_COMPARE(pwm_slice(pin));
    REGISTER(address) = (REGISTER(address) & ~(UINT32_C(0xffff) << shift)) | clocks << shift;
}

/* Low at once; and the next duty does not begin with the last one, for a compare value is taken over when the carrier
 * turns. */
static void pwm_off(uint8_t pin)
{
    set(pin, 0);
    REGISTER(IO_CTRL(pin)) = FUNCTION_SIO;
    compare(pin, 0);
}

static void pwm_on(uint8_t pin, uint32_t clocks)
{
    compare(pin, clocks);
    REGISTER(IO_CTRL(pin)) = FUNCTION_PWM;
}

void motor_release(void)
{
    board_motor(&pico_core, 0);
    wired = 0;
}

void motor_configure(const hl_settings *settings)
{
    drive = (uint8_t)settings->drive;
    full = CLOCK_HZ / settings->carrier;
    for (uint8_t k = 0; k < count_of(settings); k++) {
        const uint8_t pin = pins[k] = pin_of(settings->motor_pins, k);
        set(pin, 0);
        REGISTER(SIO_OE_SET) = UINT32_C(1) << pin;
        pin_function(pin, FUNCTION_SIO, PAD_PULL_DOWN);
        REGISTER(PWM_DIV(pwm_slice(pin))) = UNDIVIDED;
        REGISTER(PWM_TOP(pwm_slice(pin))) = full - 1;
        compare(pin, 0);
        REGISTER(PWM_CSR(pwm_slice(pin))) = SLICE_ON;
    }
    wired = 1;
}

/* Direction and duty belong together, whoever else calls. What was on goes off before the other comes on. */
void board_motor(hl_core *core, int16_t duty)
{
    (void)core;
    if (!wired) {
        return;
    }
    const uint32_t before = interrupts_off();
    const uint8_t back = duty < 0, forth = duty > 0;
    const uint32_t clocks = (uint32_t)(back ? -duty : duty) * full / HL_DUTY_FULL;
    uint8_t carrying = pins[0];
    if (duty == 0) {
        pwm_off(pins[drive == HL_DRIVE_TWO_INPUTS_ENABLE ? 2 : 0]);
    }
    if (drive == HL_DRIVE_PWM_DIRECTION) {
        set(pins[1], forth);
    } else if (drive == HL_DRIVE_TWO_INPUTS) {
        carrying = pins[back];
        pwm_off(pins[!back]);
    } else {
        carrying = pins[2];
        set(pins[forth], 0);
        set(pins[!forth], forth || back);
    }
    if (duty != 0) {
        pwm_on(carrying, clocks);
    }
    interrupts_back(before);
}
