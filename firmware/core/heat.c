/* The motor as its settings say it, and its heat. Nothing here runs in a tick. */
#include "parts.h"

/* The motor's temperature as a mean square of force, first order, for the current is as the force; HL_HEAT_STANDS is that
 * of force_continuous for ever. Of y = t / tau a step takes the part y / (1 + y / 2), which is 1 - exp(-y) but for
 * y^3 / 12. What is less than one stays in heat_rest, so that a heating time of days is followed too. */
void hl_heat_follow(hl_core *core)
{
    const float ticks = (float)core->heat_given, t = (float)core->period_us;
    const float away = (float)core->heat_taken * core->heat_scale - ticks * (float)core->heat;
    float change = away * t / (core->settings.heating_time * 1e6f + 0.5f * ticks * t) + core->heat_rest;
    if (change > (float)HL_HEAT_MOST) {
        change = (float)HL_HEAT_MOST;
    }
    const int32_t whole = (int32_t)change;
    core->heat_rest = change - (float)whole;
    core->heat += whole;
    if (core->heat > HL_HEAT_MOST) {
        core->heat = HL_HEAT_MOST;
    }
    /* a handle that is watched with the motor off needs no motor that is cool */
    core->heat_given = core->heat > HL_HEAT_STANDS && core->force_limit > 0.0f ? HL_HEAT_OVER : 0;
}

/* Follow all that was given until now, for from now on a tick takes another time. Nobody may be in hl_heat_follow. */
void hl_heat_close(hl_core *core)
{
    if (core->heat_given && core->heat_given != HL_HEAT_OVER) {
        hl_heat_follow(core);
    }
    if (core->heat_given == 0) {
        core->heat_taken = core->heat_sum;
        core->heat_given = core->heat_ticks;
        core->heat_sum = 0;
        core->heat_ticks = 0;
        hl_heat_follow(core);
    }
}

/* Take settings into use; `curve`: parts of full duty for no force and for each quarter of the full one; `stood`: the
 * force_continuous before. Opening the port resets many boards, which then do not know how hot the motor is: take half. */
void hl_motor_configure(hl_core *core, const float curve[4], float stood)
{
    const hl_settings *s = &core->settings;
    const float full = s->force_full / s->force_continuous, ratio = stood / s->force_continuous;
    const uint8_t measured = s->motor_law == HL_MOTOR_MEASURED;
    for (uint8_t k = 0; k < 4; k++) {
        const uint16_t duty = (uint16_t)(curve[measured ? k : 0] * (float)HL_ONE + 0.5f);
        core->curve[k] = measured ? duty : (uint16_t)(duty + ((HL_ONE - duty) * k >> 2));
    }
    core->curve[4] = 0; /* HL_ONE in 16 bits: only differences are taken */
    core->duty_per_force = 1.0f / s->force_full;
    core->heat_scale = full * full * ((float)HL_HEAT_STANDS / (float)HL_FULL_HEAT);
    if (ratio != 1.0f) {
        const float heat = (float)core->heat * ratio * ratio;
        core->heat = heat < (float)HL_HEAT_MOST ? (int32_t)heat : HL_HEAT_MOST;
    }
    if (core->heat < HL_HEAT_STANDS / 2) {
        core->heat = HL_HEAT_STANDS / 2;
    }
}
