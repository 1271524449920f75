#include "parts.h"

enum { HEAT_TICKS = 16 };

/* The part of full duty at which the motor gives a part of its full force, 0 ... 1. */
static float duty_of(const hl_settings *s, float part)
{
    if (s->motor_law == HL_MOTOR_MEASURED) {
        const float curve[] = {s->duty_dead, s->duty_25, s->duty_50, s->duty_75, 1.0f};
        const uint8_t k = part < 1.0f ? (uint8_t)(4.0f * part) : 3;
        return curve[k] + (4.0f * part - (float)k) * (curve[k + 1] - curve[k]);
    }
    const float duty = s->motor_law == HL_MOTOR_SQRT ? sqrtf(part) : part;
    return s->duty_dead > 0.0f ? s->duty_dead + (1.0f - s->duty_dead) * duty : duty;
}

/* The duty for a force at the handle, to the nearest step. */
int16_t hl_duty(const hl_core *core, float force)
{
    const float part = hl_absf(force) * core->duty_per_force; /* of the full force */
    if (!(part > 0.0f)) {
        return 0; /* where no force is asked for, the dead band is not passed either */
    }
    const int16_t duty = (int16_t)(duty_of(&core->settings, part < 1.0f ? part : 1.0f) * (float)HL_DUTY_FULL + 0.5f);
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
