/* Programs: verified in their place, started between two ticks, stopped at once. */
#include "crc.h"
#include "parts.h"
#include "wire.h"

#include <string.h>

/* the force's channels before what the scene watches: x, v, F */
enum { OWN_CHANNELS = 3 };

/* Verify the first `size` bytes of a place, and leave its parameters without value. */
uint8_t hl_place_verify(hl_place *place, uint16_t size)
{
    const uint16_t first = (uint16_t)((size + 3u) / 4u);
    const uint16_t capacity = (uint16_t)(HL_ARENA_BYTES / 4u - first);
    place->size = 0;
    place->registers = place->arena.slots + first;
    const hl_result result = hl_verify(&place->program, place->arena.bytes, size, place->registers, capacity);
    if (result != HL_OK) {
        return (uint8_t)result;
    }
    const uint16_t *n = place->program.count;
    if (n[HL_COUNT_INPUTS] > 1 || n[HL_COUNT_OUTPUTS] < 1 || n[HL_COUNT_OUTPUTS] > HL_CHANNELS - OWN_CHANNELS + 1) {
        return HL_RESULT_CHANNELS;
    }
    if (hl_output_type(&place->program, 0) != HL_TYPE_F32) {
        return HL_RESULT_CHANNELS;
    }
    for (uint16_t k = 0; k < n[HL_COUNT_PARAMETERS]; k++) {
        place->registers[place->program.parameters + k].f = HL_NAN;
    }
    place->sum = hl_place_sum(place);
    place->crc = hl_get32(place->arena.bytes + size - 4);
    place->size = size;
    return HL_OK;
}

/* The sum of the parameters' bits, rotated so that two that change places are not the same. */
uint32_t hl_place_sum(const hl_place *place)
{
    uint32_t sum = 0;
    for (uint16_t k = 0; k < place->program.count[HL_COUNT_PARAMETERS]; k++) {
        sum = (sum << 1 | sum >> 31) + (uint32_t)place->registers[place->program.parameters + k].i;
    }
    return sum;
}

static int has_values(const hl_place *place)
{
    for (uint16_t k = 0; k < place->program.count[HL_COUNT_PARAMETERS]; k++) {
        if (!hl_is_finite(place->registers[place->program.parameters + k])) {
            return 0;
        }
    }
    return 1;
}

static uint8_t why_not(const hl_core *core, const hl_place *place, uint16_t every, uint8_t options, float force_max)
{
    hl_slot limit;
    limit.f = force_max;
    const uint32_t period = place->program.period_us;
    if (core->state == HL_STATE_FAULT) {
        return HL_RESULT_FAULT;
    }
    if (place->size == 0) {
        return HL_RESULT_NO_PROGRAM;
    }
    if (!has_values(place)) {
        return HL_RESULT_NO_VALUE;
    }
    if (period < HL_PERIOD_MIN_US || period > HL_PERIOD_MAX_US || every == 0 || !hl_is_finite(limit) || force_max < 0.0f) {
        return HL_RESULT_RANGE;
    }
    if (core->calibrated && hl_handle_speed(core, (uint16_t)period) > core->limits.alias) {
        return HL_RESULT_ALIAS; /* the sensor is read once a step: what turns over between two reads cannot be told */
    }
    if (options & HL_OPTION_PASSIVE) {
        return HL_OK;
    }
    if (!core->calibrated || !core->settings.wired) {
        return core->calibrated ? HL_RESULT_NOT_WIRED : HL_RESULT_NOT_CALIBRATED;
    }
    return core->heat > HL_HEAT_STANDS ? HL_RESULT_HOT : !core->homed ? HL_RESULT_NOT_HOMED : HL_OK;
}

/* Take a period into use: everything that is counted in ticks. In a tick, only while no heat waits for the main loop. */
HL_CALLED static void set_period(hl_core *core, uint16_t us)
{
    if (us != core->period_us) {
        hl_heat_close(core);
    }
    core->period_us = us;
    core->period_clocks = (uint16_t)((uint32_t)us * (HL_CLOCK_HZ / 1000000u));
    core->rate = 1e6f / (float)us;
    core->silence = (uint16_t)(HL_HOST_SILENCE_MS * UINT32_C(1000) / us);
    core->second = core->ticks_per_second = (uint16_t)(UINT32_C(1000000) / us);
    core->still.gain_step = 5e-6f * (float)us; /* out in 0.2 s */
    hl_handle_limits(core);
    board_period(core, us);
}

/* Start the program of a place with the next tick. Called where no tick can come between. */
uint8_t hl_place_start(hl_core *core, uint8_t index, uint16_t every, uint8_t options, float force_max)
{
    const hl_place *place = &core->places[index];
    const uint8_t refused = why_not(core, place, every, options, force_max);
    if (refused != HL_OK) {
        return refused;
    }
    const hl_settings *s = &core->settings;
    float limit = s->force_max < s->force_full ? s->force_max : s->force_full;
    limit = force_max < limit ? force_max : limit;
    if (!s->checked && limit > HL_UNCHECKED_FORCE_N) {
        limit = HL_UNCHECKED_FORCE_N;
    }
    core->force_limit = options & HL_OPTION_PASSIVE ? 0.0f : limit;
    if (core->force_limit == 0.0f) {
        board_motor(core, 0); /* a program may be running: its last force ends here, not with the next tick */
    }
    core->active = index;
    core->channels = (uint8_t)(OWN_CHANNELS - 1 + place->program.count[HL_COUNT_OUTPUTS]);
    core->every = every;
    core->countdown = 1;
    core->tick = 0;
    core->force = 0.0f;
    core->first = 1;
    core->silent = 0;
    core->still.counts = (uint16_t)core->counts;
    core->still.ticks = 0;
    core->still.gain = 1.0f;
    core->late = 0;
    core->was_late = 0;
    core->late_second = 0;
    core->head = core->tail = 0;
    core->lost = 0;
    core->audit_at = 0;
    core->audit_crc = 0;
    memset(&core->timing, 0, sizeof core->timing);
    core->timing.period_min = 0xffff;
    set_period(core, (uint16_t)place->program.period_us);
    core->state = HL_STATE_RUN;
    return HL_OK;
}

/* Watch the handle at 1 kHz until a program brings its own period. */
void hl_place_idle(hl_core *core)
{
    set_period(core, HL_IDLE_PERIOD_US);
}

/* Motor off and IDLE; a fault stays until it is cleared. */
void hl_stop(hl_core *core)
{
    board_lock(core);
    board_motor(core, 0);
    if (core->state == HL_STATE_RUN) {
        core->state = HL_STATE_IDLE;
        hl_place_idle(core);
    }
    board_unlock(core);
}
