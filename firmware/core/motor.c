#include "parts.h"

enum { HEAT_TICKS = 16 };

/* The duty for a force at the handle, to the nearest step. */
int16_t hl_duty(const hl_core *core, float force)
{
    float part = hl_absf(force) * core->duty_per_force; /* of the full force */
    if (core->settings.motor_law == HL_MOTOR_SQRT) {
        part = sqrtf(part);
    }
    if (!(part < 1.0f)) {
        part = 1.0f;
    }
    const int16_t duty = (int16_t)(part * (float)HL_DUTY_FULL + 0.5f);
    return (force < 0.0f) == (core->settings.motor_sign < 0) ? duty : (int16_t)-duty;
}

/* The motor's temperature as a mean square of force, first order: the current is as the force. */
void hl_heat(hl_core *core, float force)
{
    core->heat_sum += force * force;
    if (++core->heat_ticks < HEAT_TICKS) {
        return;
    }
    core->heat += (core->heat_sum - (float)HEAT_TICKS * core->heat) * core->heat_gain;
    core->heat_sum = 0.0f;
    core->heat_ticks = 0;
    if (core->heat > core->settings.force_continuous * core->settings.force_continuous) {
        hl_core_fault(core, HL_FAULT_OVER_HEAT, core->heat);
    }
}
