/* The motor's files alone, as a library: a force goes in, its duty and the heat come out. */
#include "parts.h"

static int16_t given;
static uint32_t faults[16]; /* of each number */

void board_motor(hl_core *core, int16_t duty)
{
    (void)core;
    given = duty;
}

void hl_core_fault(hl_core *core, uint8_t fault, float value)
{
    (void)core;
    (void)value;
    faults[fault]++;
}

static hl_core core;

void configure(float full, float continuous, float tau, uint16_t us, uint8_t law, const float *curve)
{
    core.settings.force_full = full;
    core.settings.force_continuous = continuous;
    core.settings.heating_time = tau;
    core.settings.motor_law = law;
    core.settings.motor_sign = 1;
    core.period_us = us;
    core.force_limit = full;
    core.heat_sum = core.heat_ticks = core.heat_given = 0;
    core.heat_rest = 0.0f;
    core.heat = 0;
    hl_motor_configure(&core, curve, continuous);
    for (uint8_t k = 0; k < 16; k++) {
        faults[k] = 0;
    }
}

/* Of what the motor stands, after so many ticks with a force; a negative `from` goes on from where it is. */
double heat(float force, uint32_t ticks, double from, uint8_t followed)
{
    if (from >= 0.0) {
        core.heat = (int32_t)(from * HL_HEAT_STANDS);
    }
    while (ticks--) {
        hl_motor(&core, force);
        if (followed && core.heat_given && core.heat_given != HL_HEAT_OVER) {
            hl_heat_follow(&core);
        }
    }
    return (double)core.heat / HL_HEAT_STANDS;
}

void duties(const float *forces, int16_t *to, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        core.heat_ticks = 0;
        hl_motor(&core, forces[k]);
        to[k] = given;
    }
}

uint32_t found(uint8_t fault)
{
    return faults[fault];
}
