/* What survives power-off: settings, a program, and whether it may start without a host. */
#include "crc.h"
#include "flash.h"
#include "parts.h"
#include "wire.h"

#include <stddef.h>
#include <string.h>

enum { ARMED = 0xa5 };

typedef char record_is_not_padded[sizeof(hl_record) == HL_RECORD_BYTES ? 1 : -1];

typedef struct {
    float lowest, highest;
    uint8_t at;
} range;

static const range ranges[] HL_FLASH = {
#define RANGE(name, lowest, highest) {lowest, highest, offsetof(hl_record, name)},
    HL_SETTING_RANGES(RANGE)
#undef RANGE
};

/* What relates numbers that are each within their range. */
static int fit_together(const hl_record *record)
{
    const hl_settings *s = &record->loop;
    const float step = hl_absf(s->metres_per_count);
    if (!(step >= HL_METRES_PER_COUNT_MIN) || !(s->travel_min < s->travel_max)) {
        return 0;
    }
    if (!(hl_absf(s->travel_min / step) < HL_COUNTS_MAX) || !(hl_absf(s->travel_max / step) < HL_COUNTS_MAX)) {
        return 0; /* sums of counts must fit 32 bits */
    }
    if (s->motor_law == HL_MOTOR_MEASURED
        && !(record->duty_dead < record->duty_25 && record->duty_25 < record->duty_50 && record->duty_50 < record->duty_75
             && record->duty_75 < 1.0f)) {
        return 0; /* the force grows with the duty */
    }
    if ((s->motor_sign != 1 && s->motor_sign != -1) || s->motor_law > HL_MOTOR_MEASURED || s->wired > 1) {
        return 0;
    }
    if (s->checked > s->wired || s->sensor > HL_SENSOR_AS5048A || s->drive > HL_DRIVE_SHIFT_REGISTER) {
        return 0; /* a motor's sign is checked on a confirmed wiring */
    }
    return s->sensor == HL_SENSOR_QUADRATURE || (s->wrap >= HL_WRAP_MIN && s->wrap <= HL_WRAP_MAX);
}

/* Whether every number is one that the loop can work with, and the board can do the wiring. */
int hl_settings_valid(const hl_record *record)
{
    const uint16_t before_crc = (uint16_t)(sizeof *record - sizeof record->crc);
    if (record->layout != HL_SETTINGS_HASH || record->crc != hl_crc32(0, (const uint8_t *)record, before_crc)) {
        return 0;
    }
    for (uint8_t k = 0; k < sizeof ranges / sizeof ranges[0]; k++) {
        range r;
        float value;
        hl_flash_copy((uint8_t *)&r, (const uint8_t *)&ranges[k], sizeof r);
        memcpy(&value, (const uint8_t *)record + r.at, sizeof value);
        if (!(value >= r.lowest && value <= r.highest)) {
            return 0;
        }
    }
    return fit_together(record) && board_accepts(&record->loop);
}

static void turn_copy(hl_core *core)
{
    core->record_at = (uint16_t)(HL_RECORD_BYTES - core->record_at);
}

/* Read the settings through a place whose program is not needed any more: the first copy that is whole. */
void hl_settings_load(hl_core *core, hl_place *place)
{
    hl_record *record = &place->arena.record;
    hl_settings *s = &core->settings;
    core->record_at = HL_RECORD_BYTES;
    do {
        turn_copy(core);
        board_store_read(core, core->record_at, (uint8_t *)record, HL_RECORD_BYTES);
        core->calibrated = (uint8_t)hl_settings_valid(record);
    } while (!core->calibrated && core->record_at == 0);
    const float stood = s->force_continuous;
    float curve[4] = {0.0f};
    if (core->calibrated) {
        *s = record->loop;
        memcpy(curve, (const uint8_t *)record + offsetof(hl_record, duty_dead), sizeof curve); /* with duty_25, _50 and _75 */
    } else {
        memset(s, 0, sizeof *s);
        s->metres_per_count = 1.0f; /* counts for metres: nothing can be commanded without settings */
        s->force_full = s->force_continuous = s->heating_time = 1.0f;
        s->motor_sign = 1;
        s->wrap = 1024;
    }
    hl_motor_configure(core, curve, stood);
    memset(&core->track, 0, sizeof core->track);
    core->track.unread = 1;
    hl_place_idle(core);
    hl_handle_lose(core);
    board_configure(core);
}

/* Write the settings that a place holds and take them into use; what was written is read back. The copy in use is written
 * last, so that whenever the power fails one copy is whole: the old settings, or the new ones. */
uint8_t hl_settings_save(hl_core *core, hl_place *place)
{
    uint8_t kept = 1;
    for (uint8_t k = 0; k < HL_COPIES && kept; k++) {
        turn_copy(core);
        kept = board_store_write(core, core->record_at, place->arena.bytes, HL_RECORD_BYTES);
    }
    board_lock(core);
    hl_settings_load(core, place);
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
