/* What survives power-off: settings, a program, and whether it may start without a host. */
#include "crc.h"
#include "parts.h"
#include "wire.h"

#include <string.h>

enum { ARMED = 0xa5 };

/* Whether every number is one that the loop can work with. */
int hl_settings_valid(const hl_settings *s)
{
    const uint16_t before_crc = (uint16_t)(sizeof *s - sizeof s->crc);
    if (s->layout != HL_SETTINGS_HASH || s->crc != hl_crc32(0, (const uint8_t *)s, before_crc)) {
        return 0;
    }
#define REFUSE(name, low, high) \
    if (!(s->name >= low && s->name <= high)) { \
        return 0; \
    }
    HL_SETTING_RANGES(REFUSE)
#undef REFUSE
    const float step = hl_absf(s->metres_per_count);
    if (!(step >= HL_METRES_PER_COUNT_MIN) || !(s->travel_min < s->travel_max)) {
        return 0;
    }
    if (!(hl_absf(s->travel_min / step) < HL_COUNTS_MAX) || !(hl_absf(s->travel_max / step) < HL_COUNTS_MAX)) {
        return 0; /* sums of counts must fit 32 bits */
    }
    if ((s->motor_sign != 1 && s->motor_sign != -1) || s->motor_law > HL_MOTOR_SQRT) {
        return 0;
    }
    return s->sensor == HL_SENSOR_QUADRATURE || (s->sensor == HL_SENSOR_MAGNETORESISTIVE && s->wrap >= HL_WRAP_MIN && s->wrap <= HL_WRAP_MAX);
}

void hl_settings_load(hl_core *core)
{
    hl_settings *s = &core->settings;
    board_store_read(core, 0, (uint8_t *)s, (uint16_t)sizeof *s);
    core->calibrated = (uint8_t)hl_settings_valid(s);
    if (!core->calibrated) {
        memset(s, 0, sizeof *s);
        s->metres_per_count = 1.0f; /* counts for metres: nothing can be commanded without settings */
        s->force_full = s->force_continuous = s->heating_time = 1.0f;
        s->motor_sign = 1;
        s->wrap = 1024;
    }
    core->duty_per_force = 1.0f / s->force_full;
    /* opening the port resets many boards, which then do not know how hot the motor is: take half of what it stands */
    const float half = 0.5f * s->force_continuous * s->force_continuous;
    core->heat = core->heat > half ? core->heat : half;
    hl_place_idle(core);
    hl_handle_lose(core);
    board_configure(core);
}

/* Write settings and take them into use; what was written is read back. */
uint8_t hl_settings_save(hl_core *core, const hl_settings *settings)
{
    const uint8_t kept = board_store_write(core, 0, (const uint8_t *)settings, (uint16_t)sizeof *settings);
    board_lock(core);
    hl_settings_load(core);
    board_unlock(core);
    return kept && core->calibrated ? (uint8_t)HL_OK : (uint8_t)HL_RESULT_STORE;
}

/* Keep a verified program for a start without a host. A cut in the middle leaves none: its CRC-32 tells. */
uint8_t hl_store_program(hl_core *core, const hl_place *place, uint16_t size)
{
    uint8_t length[2];
    hl_put16(length, size);
    hl_store_arm(core, 0);
    if (!board_store_write(core, HL_STORE_PROGRAM, place->arena.bytes, size)) {
        return HL_RESULT_STORE;
    }
    return board_store_write(core, HL_STORE_SIZE, length, 2) ? (uint8_t)HL_OK : (uint8_t)HL_RESULT_STORE;
}

uint8_t hl_store_arm(hl_core *core, uint8_t armed)
{
    const uint8_t mark = armed ? ARMED : 0;
    const uint8_t kept = board_store_write(core, HL_STORE_ARMED, &mark, 1);
    core->armed = armed && kept;
    return kept ? (uint8_t)HL_OK : (uint8_t)HL_RESULT_STORE;
}

/* Read the kept program into the active place and verify it; returns an hl_result, or HL_RESULT_NO_PROGRAM. */
uint8_t hl_load_standalone(hl_core *core)
{
    uint8_t head[3];
    hl_place *place = &core->places[core->active];
    board_store_read(core, HL_STORE_ARMED, head, 3);
    const uint16_t size = hl_get16(head + 1);
    core->armed = head[0] == ARMED;
    if (!core->armed || size < HL_HEADER_BYTES || size > HL_STORE_BYTES - HL_STORE_PROGRAM || size > HL_ARENA_BYTES) {
        return HL_RESULT_NO_PROGRAM;
    }
    board_store_read(core, HL_STORE_PROGRAM, place->arena.bytes, size);
    return hl_place_verify(place, size);
}
