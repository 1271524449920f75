/* From a force to a duty, in whole numbers: every board finds the same, and soon. */
#include "flash.h"
#include "parts.h"

enum { HEAT_TICKS = 16 };

#if defined(__GNUC__)
#define HL_APART __attribute__((noinline)) /* in one function they keep all registers of a small processor on its stack */
#else
#define HL_APART
#endif

/* 2^15 times the roots of 1, 1 + 1/32 ... 2, 2 + 1/16 ... 4 */
static const uint16_t roots[] HL_FLASH = {
    32768, 33276, 33776, 34270, 34756, 35235, 35708, 36175, 36636, 37091, 37540, 37985, 38424, 38858, 39287, 39712, 40132,
    40548, 40960, 41368, 41771, 42171, 42567, 42959, 43348, 43733, 44115, 44494, 44869, 45242, 45611, 45977, 46341, 47059,
    47767, 48465, 49152, 49830, 50499, 51159, 51811, 52454, 53090, 53719, 54340, 54954, 55561, 56162, 56756, 57344, 57926,
    58503, 59073, 59639, 60199, 60753, 61303, 61848, 62388, 62924, 63455, 63982, 64504, 65022, 65535,
};

/* The root of a positive float, without its exponent: 2^15 or more, to the nearest. An even exponent counts one less, for
 * a number from 2 to 4. */
HL_APART static uint16_t root_of(uint32_t bits)
{
    const uint8_t odd = (uint8_t)(bits >> 16) >> 7, k = ((uint8_t)(bits >> 16) & 0x7f) >> 2;
    const uint16_t *chord = roots + (odd ? k : k | 32);
    uint16_t root = HL_FLASH_WORD(chord);
    const uint16_t rise = (uint16_t)(HL_FLASH_WORD(chord + 1) - root);
    root = (uint16_t)(root + ((uint32_t)rise * (uint16_t)(bits >> 2) >> 16));
    uint32_t left = ((bits << 8) | UINT32_C(0x80000000)) >> odd;
    left -= (uint32_t)root * root; /* a chord is below its arc, by three steps at most */
    while (left > root && !(left >> 31)) {
        left -= 2 * (uint32_t)root + 1;
        root++;
    }
    return root;
}

/* A part of a whole, mantissa / 2^15 * 2^(exponent - 127), as a whole number below HL_ONE, to the nearest. */
HL_APART static uint16_t part_of(uint16_t mantissa, uint8_t exponent)
{
    uint8_t shift = (uint8_t)(126 - exponent), behind = 0;
    if (shift > 16) {
        return 0;
    }
    if (shift >= 8) {
        shift = (uint8_t)(shift - 8);
        behind = (uint8_t)mantissa >> 7;
        mantissa >>= 8;
    }
    for (; shift; shift--) {
        behind = mantissa & 1;
        mantissa >>= 1;
    }
    return (uint16_t)(mantissa + behind);
}

/* The duty for a part of the motor's force, along its curve: straight lines between five points. */
HL_APART static int16_t duty_of(const uint16_t *curve, uint16_t part)
{
    const uint16_t *from = curve + ((uint8_t)(part >> 8) >> 6);
    const uint32_t rise = (uint32_t)(uint16_t)(from[1] - from[0]) * (uint16_t)(part << 2);
    return (int16_t)((((uint32_t)from[0] + ((rise + HL_ONE / 2) >> 16)) * HL_DUTY_FULL + HL_ONE / 2) >> 16);
}

/* Drive the motor with a force at the handle, which is finite and within its limits, and follow its heat. */
void hl_motor(hl_core *core, float force)
{
    const uint32_t bits = hl_bits(hl_absf(force) * core->duty_per_force); /* of a part of the full force */
    const uint8_t exponent = (uint8_t)((uint16_t)(bits >> 16) >> 7);
    int16_t duty = 0; /* where no force is asked for, the dead band is not passed either */
    uint16_t part = 0;
    if (exponent > 126) {
        part = HL_ONE - 1;
        duty = HL_DUTY_FULL;
    } else if (bits) {
        uint16_t along;
        if (core->settings.motor_law == HL_MOTOR_SQRT) {
            along = part_of(root_of(bits), (uint8_t)((exponent + 127) >> 1));
            part = (uint16_t)((uint32_t)along * along >> 16);
            part = (uint16_t)(part + (part < HL_ONE - 1)); /* rounded up: of this is the heat */
        } else {
            const uint16_t above = (uint16_t)(bits >> 8) | 0x8000;
            part = along = part_of(bits & 0x80 && above < HL_ONE - 1 ? above + 1 : above, exponent);
        }
        duty = duty_of(core->curve, along);
    }
    board_motor(core, (hl_bits(force) >> 31) == (core->settings.motor_sign < 0) ? duty : (int16_t)-duty);
    hl_heat(core, part);
}

/* Add to what hl_heat_follow takes, a part of full force, rounded up: heat may be found too large, never too small. */
void hl_heat(hl_core *core, uint16_t part)
{
    if (core->heat_given == HL_HEAT_OVER) {
        core->heat_given = 0;
        hl_core_fault(core, HL_FAULT_OVER_HEAT, (float)core->heat / (float)HL_HEAT_STANDS);
    }
    if (core->heat_ticks == UINT8_MAX) { /* in RUN only where steps leave no time for anything else */
        if (core->heat_given) {
            hl_core_fault(core, HL_FAULT_OVERRUN, (float)core->timing.step_last / (float)core->period_clocks);
            return;
        }
        core->heat_ticks--; /* the main loop is back, from writing its store: what it missed cooled nothing */
    }
    core->heat_sum += part ? ((uint32_t)part * part >> 8) + (part >> 8) + 2 : 0;
    if (++core->heat_ticks >= HEAT_TICKS && core->heat_given == 0) {
        core->heat_taken = core->heat_sum;
        core->heat_given = core->heat_ticks;
        core->heat_sum = 0;
        core->heat_ticks = 0;
    }
}
