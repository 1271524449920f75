/* What each request does. */
#include "crc.h"
#include "flash.h"
#include "parts.h"
#include "wire.h"

#include <stddef.h>
#include <string.h>

enum { CRC_BYTES = 4 }; /* at the end of programs and settings */

static const uint8_t board_name[] HL_FLASH = HL_BOARD_NAME;

/* Whatever runs or was loaded belongs to an earlier session. */
static void begin_session(hl_core *core, uint32_t session)
{
    core->standalone = 0; /* before the stop: a tick may come between */
    hl_stop(core);
    core->session = session;
    core->obeyed = 0;
    core->announced = 0;
    for (uint8_t k = 0; k < HL_SLOTS; k++) {
        core->places[k].size = 0;
    }
}

static uint8_t welcome(hl_core *core, const uint8_t *payload, uint8_t *to)
{
    if (core->session != hl_get32(payload)) { /* a repeat of the session's own hello changes nothing */
        begin_session(core, hl_get32(payload));
    }
    memset(to, 0, HL_AT_WELCOME_RESET_CAUSE + 1);
    hl_flash_copy(to + HL_AT_WELCOME_BOARD, board_name, sizeof board_name - 1);
    hl_put32(to + HL_AT_WELCOME_TABLE, HL_PROTOCOL_HASH);
    if (core->calibrated) {
        board_store_read(core, (uint16_t)(core->record_at + offsetof(hl_record, ident)), to + HL_AT_WELCOME_IDENT, 2);
    }
    to[HL_AT_WELCOME_MAJOR] = HL_FIRMWARE_MAJOR;
    to[HL_AT_WELCOME_MINOR] = HL_FIRMWARE_MINOR;
    to[HL_AT_WELCOME_WORD_BYTES] = HL_WORD_BYTES;
    hl_put16(to + HL_AT_WELCOME_ARENA, HL_ARENA_BYTES);
    to[HL_AT_WELCOME_SLOTS] = HL_SLOTS;
    to[HL_AT_WELCOME_CHANNELS] = HL_CHANNELS;
    hl_put32(to + HL_AT_WELCOME_CLOCK_HZ, HL_CLOCK_HZ);
    hl_put16(to + HL_AT_WELCOME_DUTY_FULL, HL_DUTY_FULL);
    hl_put16(to + HL_AT_WELCOME_PERIOD_MIN, HL_PERIOD_MIN_US);
    hl_put16(to + HL_AT_WELCOME_PERIOD_MAX, HL_PERIOD_MAX_US);
    to[HL_AT_WELCOME_RESET_CAUSE] = board_reset_cause(core);
    return HL_AT_WELCOME_RESET_CAUSE + 1;
}

static uint8_t flags_of(const hl_core *core)
{
    const hl_settings *s = &core->settings;
    return (uint8_t)((core->homed ? HL_FLAG_HOMED : 0) | (core->calibrated ? HL_FLAG_CALIBRATED : 0)
                     | (s->checked ? HL_FLAG_SIGN_CHECKED : 0) | (core->armed ? HL_FLAG_ARMED : 0)
                     | (core->standalone ? HL_FLAG_STANDALONE : 0) | (core->mismatch ? HL_FLAG_TRAVEL_MISMATCH : 0)
                     | (core->places[core->active].size ? HL_FLAG_READY : 0));
}

static uint8_t state_of(hl_core *core, uint8_t *to)
{
    /* numbers of one tick, not of two; the tick waits for the copies alone, never for arithmetic */
    board_lock(core);
    const hl_timing t = core->timing;
    const uint32_t tick = core->tick;
    const int32_t counts = core->counts;
    const float force = core->force;
    const uint16_t lost = core->lost;
    const uint8_t state = core->state;
    board_unlock(core);
    hl_put32(to + HL_AT_STATE_SESSION, core->session);
    to[HL_AT_STATE_STATE] = state;
    to[HL_AT_STATE_FAULT] = state == HL_STATE_FAULT ? core->fault : HL_FAULT_NONE;
    to[HL_AT_STATE_FLAGS] = flags_of(core);
    hl_put32(to + HL_AT_STATE_TICK, tick);
    hl_put32(to + HL_AT_STATE_COUNTS, (uint32_t)counts);
    hl_putf(to + HL_AT_STATE_X, hl_handle_position(core, counts));
    hl_putf(to + HL_AT_STATE_FORCE, state == HL_STATE_RUN ? force : 0.0f);
    hl_putf(to + HL_AT_STATE_HEAT, (float)core->heat / (float)HL_HEAT_STANDS);
    hl_put16(to + HL_AT_STATE_PERIOD_MIN, t.period_min);
    hl_put16(to + HL_AT_STATE_PERIOD_MAX, t.period_max);
    hl_put16(to + HL_AT_STATE_STEP_LAST, t.step_last);
    hl_put16(to + HL_AT_STATE_STEP_WORST, t.step_worst);
    hl_put16(to + HL_AT_STATE_STEP_MEAN, t.steps ? (uint16_t)(t.step_sum / t.steps) : 0);
    hl_put16(to + HL_AT_STATE_OVERRUNS, t.overruns);
    hl_put16(to + HL_AT_STATE_LOST, lost);
    hl_put16(to + HL_AT_STATE_DAMAGED, core->damaged);
    return HL_AT_STATE_DAMAGED + 2;
}

/* Bytes of the settings in use, from the store; none where there are no settings. */
static uint8_t read_settings(hl_core *core, const uint8_t *payload, uint8_t *to)
{
    const uint16_t offset = hl_get16(payload + HL_AT_READ_OFFSET);
    const uint16_t left = core->calibrated && offset < HL_RECORD_BYTES ? (uint16_t)(HL_RECORD_BYTES - offset) : 0;
    uint8_t count = payload[HL_AT_READ_COUNT];
    count = count < HL_LARGEST_PAYLOAD - 2 ? count : HL_LARGEST_PAYLOAD - 2;
    count = count < left ? count : (uint8_t)left;
    hl_put16(to, offset);
    board_store_read(core, (uint16_t)(core->record_at + (left ? offset : 0)), to + 2, count);
    return (uint8_t)(2 + count);
}

/* Whether a run leaves no place for an upload: there is only one, or it is for something else than a program. */
HL_CALLED static uint8_t is_busy(const hl_core *core, uint8_t target)
{
    return core->state == HL_STATE_RUN && (HL_SLOTS == 1 || target != HL_TARGET_PROGRAM);
}

/* Begin an upload. A tick that starts a program without a host finds it, or finds it gone; it cannot come between. */
static uint8_t begin(hl_core *core, const uint8_t *payload)
{
    const uint8_t target = payload[HL_AT_BEGIN_TARGET];
    const uint16_t size = hl_get16(payload + HL_AT_BEGIN_SIZE);
    if (target > HL_TARGET_STANDALONE) {
        return HL_RESULT_RANGE;
    }
    if (size <= CRC_BYTES) {
        return HL_SIZE;
    }
    if (size > HL_ARENA_BYTES || (target == HL_TARGET_STANDALONE && size > HL_STORE_BYTES - HL_STORE_PROGRAM)) {
        return HL_RESULT_TOO_LARGE;
    }
    board_lock(core);
    const uint8_t busy = is_busy(core, target);
    if (!busy) {
        core->loading = (uint8_t)((core->active + 1) % HL_SLOTS);
        core->places[core->loading].size = 0;
        core->target = target;
        core->announced = size;
    }
    board_unlock(core);
    return busy ? (uint8_t)HL_RESULT_BUSY : (uint8_t)HL_OK;
}

static uint8_t data(hl_core *core, const uint8_t *payload, uint8_t count)
{
    const uint16_t offset = hl_get16(payload);
    const uint8_t bytes = (uint8_t)(count - 2);
    if (core->announced == 0 || offset > core->announced || bytes > core->announced - offset) {
        return HL_RESULT_RANGE;
    }
    memcpy(core->places[core->loading].arena.bytes + offset, payload + 2, bytes);
    return HL_OK;
}

/* Another wiring than the one in use is a new paddle: nobody has confirmed it, nor seen its motor push. */
static uint8_t commit_settings(hl_core *core, hl_place *place, uint16_t size)
{
    const hl_record *record = &place->arena.record;
    if (size != sizeof *record) {
        return HL_RESULT_LENGTH;
    }
    if (!hl_settings_valid(record)) {
        return HL_RESULT_RANGE;
    }
    if (!core->calibrated || memcmp(&record->loop.motor_pins, &core->settings.motor_pins, HL_WIRING_BYTES) != 0) {
        if (core->state != HL_STATE_IDLE) {
            return HL_RESULT_FAULT;
        }
        if (record->loop.wired || record->loop.checked) {
            return HL_RESULT_NOT_WIRED;
        }
    }
    return hl_settings_save(core, place);
}

/* Take an upload into use: whole, undamaged and verified, or not at all. */
static uint8_t commit(hl_core *core, const uint8_t *payload)
{
    const uint16_t size = hl_get16(payload + HL_AT_COMMIT_SIZE);
    hl_place *place = &core->places[core->loading];
    if (core->announced == 0 || core->announced != size || core->target != payload[HL_AT_COMMIT_TARGET]) {
        return HL_RESULT_NO_PROGRAM;
    }
    if (is_busy(core, core->target)) {
        return HL_RESULT_BUSY;
    }
    core->announced = 0;
    /* of all but the last 4 bytes, which are this very number: with them, every upload of one length has the same CRC-32 */
    if (hl_crc32(0, place->arena.bytes, (uint16_t)(size - CRC_BYTES)) != hl_get32(payload + HL_AT_COMMIT_LAST_CRC)) {
        return HL_CRC;
    }
    if (core->target == HL_TARGET_SETTINGS) {
        return commit_settings(core, place, size);
    }
    const uint8_t result = hl_place_verify(place, size);
    if (result != HL_OK || core->target == HL_TARGET_PROGRAM) {
        return result;
    }
    /* without a host nobody sets parameters */
    return place->program.count[HL_COUNT_PARAMETERS] ? (uint8_t)HL_RESULT_NO_VALUE : hl_store_program(core, place, size);
}

/* The place that SET and START mean: the one loaded last, if it holds a program, else the one that runs. */
static uint8_t newest(const hl_core *core)
{
    return core->places[core->loading].size ? core->loading : core->active;
}

static uint8_t set(hl_core *core, const uint8_t *payload, uint8_t count)
{
    const uint8_t values = payload[HL_AT_SET_COUNT];
    hl_place *place = &core->places[newest(core)];
    if (count != 1 + 5 * (uint16_t)values) {
        return HL_RESULT_LENGTH;
    }
    if (place->size == 0) {
        return HL_RESULT_NO_PROGRAM;
    }
    for (uint8_t k = 0; k < values; k++) { /* all of them or none */
        hl_slot value;
        value.f = hl_getf(payload + 2 + 5 * k);
        if (payload[1 + 5 * k] >= place->program.count[HL_COUNT_PARAMETERS]) {
            return HL_RESULT_RANGE;
        }
        if (!hl_is_finite(value)) {
            return HL_RESULT_NO_VALUE;
        }
    }
    board_lock(core);
    for (uint8_t k = 0; k < values; k++) {
        place->registers[place->program.parameters + payload[1 + 5 * k]].f = hl_getf(payload + 2 + 5 * k);
    }
    core->set_tick = core->first ? -1 : (int32_t)core->tick;
    board_unlock(core);
    place->sum = hl_place_sum(place);
    return HL_OK;
}

static uint8_t start(hl_core *core, const uint8_t *payload)
{
    const uint8_t index = newest(core);
    const uint16_t every = hl_get16(payload + HL_AT_START_EVERY);
    if (core->state == HL_STATE_RUN && index == core->active) {
        return HL_RESULT_BUSY;
    }
    if (core->places[index].size == 0 || core->places[index].crc != hl_get32(payload + HL_AT_START_CRC)) {
        return HL_RESULT_NO_PROGRAM;
    }
    board_lock(core);
    const float force_max = hl_getf(payload + HL_AT_START_FORCE_MAX);
    const uint8_t result = hl_place_start(core, index, every, payload[HL_AT_START_OPTIONS], force_max);
    board_unlock(core);
    if (result == HL_OK && HL_SLOTS > 1) {
        core->places[(index + 1) % HL_SLOTS].size = 0; /* so that the newest is the one that runs */
    }
    return result;
}

static uint8_t home(hl_core *core, float position)
{
    hl_slot s;
    s.f = position;
    if (core->state != HL_STATE_IDLE) {
        return core->state == HL_STATE_RUN ? HL_RESULT_BUSY : HL_RESULT_FAULT;
    }
    if (!core->calibrated) {
        return HL_RESULT_NOT_CALIBRATED;
    }
    if (!hl_is_finite(s) || position < core->settings.travel_min || position > core->settings.travel_max) {
        return HL_RESULT_RANGE;
    }
    board_lock(core);
    hl_handle_place(core, position);
    board_unlock(core);
    return HL_OK;
}

static uint8_t clear(hl_core *core)
{
    if (core->state == HL_STATE_FAULT) {
        core->fault_unsent = 0;
        core->fault = HL_FAULT_NONE;
        core->state = HL_STATE_IDLE;
    }
    return HL_OK;
}

static uint8_t arm(hl_core *core, uint8_t armed)
{
    if (core->state == HL_STATE_RUN) {
        return HL_RESULT_BUSY;
    }
    return armed && !core->settings.checked ? (uint8_t)HL_RESULT_NOT_CALIBRATED : hl_store_arm(core, armed);
}

/* Do what a request asks and return the result. */
static uint8_t obey(hl_core *core, uint8_t message, const uint8_t *payload, uint8_t count)
{
    switch (message) {
    case HL_MESSAGE_BEGIN:
        return begin(core, payload);
    case HL_MESSAGE_DATA:
        return data(core, payload, count);
    case HL_MESSAGE_COMMIT:
        return commit(core, payload);
    case HL_MESSAGE_START:
        return start(core, payload);
    case HL_MESSAGE_STOP:
        return HL_OK; /* done already; but no older START is obeyed from here on */
    case HL_MESSAGE_SET:
        return set(core, payload, count);
    case HL_MESSAGE_HOME:
        return home(core, hl_getf(payload));
    case HL_MESSAGE_CLEAR:
        return clear(core);
    case HL_MESSAGE_ARM:
        return arm(core, payload[0]);
    default:
        return HL_RESULT_UNKNOWN;
    }
}

/* Which of the session's guarded requests a sequence number means: the one nearest to the last obeyed. */
static uint32_t number_of(const hl_core *core, uint8_t sequence)
{
    const uint8_t ahead = (uint8_t)(sequence - core->obeyed);
    return core->obeyed + ahead - (ahead > 127 ? 256u : 0u);
}

/* Obey a guarded request once: a repeat is answered as it was, an older one refused. */
static uint8_t obey_once(hl_core *core, uint8_t message, uint8_t sequence, const uint8_t *payload, uint8_t count)
{
    const uint32_t number = number_of(core, sequence), ahead = number - core->obeyed;
    if (ahead > 127) {
        return HL_RESULT_STALE;
    }
    core->heard = 1;
    if (ahead == 0) {
        return core->result;
    }
    core->obeyed = number;
    core->result = obey(core, message, payload, count);
    return core->result;
}

static uint8_t acknowledge(hl_core *core, uint8_t message, uint8_t result, uint8_t *to)
{
    board_lock(core);
    const int32_t tick = message == HL_MESSAGE_SET ? core->set_tick : (int32_t)core->tick;
    board_unlock(core);
    to[HL_AT_ACK_REQUEST] = message;
    to[HL_AT_ACK_RESULT] = result;
    hl_put32(to + HL_AT_ACK_TICK, (uint32_t)tick);
    return HL_AT_ACK_TICK + 4;
}

static const uint8_t rules[][4] HL_FLASH = {
#define RULE(name, number, bytes, guarded, open) {number, bytes, guarded, open},
    HL_MESSAGES(RULE)
#undef RULE
};

/* HL_OK where the message may be looked into, else the result to answer with. */
static uint8_t check(const hl_core *core, const uint8_t *frame, uint8_t *count)
{
    const uint8_t message = frame[0] & 31;
    for (uint8_t k = 0; k < sizeof rules / sizeof rules[0]; k++) {
        uint8_t rule[4];
        if (HL_FLASH_BYTE(rules[k]) != message || message >= HL_MESSAGE_ACK) {
            continue;
        }
        hl_flash_copy(rule, rules[k], sizeof rule);
        const uint8_t guard = rule[2] ? 4 : 0;
        if (*count < rule[1] + guard || (!rule[3] && *count > rule[1] + guard)) {
            return HL_RESULT_LENGTH;
        }
        *count = (uint8_t)(*count - guard);
        const uint32_t begin = core->session + (number_of(core, frame[1]) >> 8);
        if (guard && (core->session == 0 || hl_crc32(begin, frame, 2u + *count) != hl_get32(frame + 2 + *count))) {
            return HL_RESULT_GUARD;
        }
        return HL_OK;
    }
    return HL_RESULT_UNKNOWN;
}

uint8_t hl_answer(hl_core *core, const uint8_t *frame, uint8_t count, uint8_t *to, uint8_t *reply)
{
    const uint8_t message = frame[0] & 31, sequence = frame[1];
    const uint8_t *payload = frame + 2;
    uint8_t result = check(core, frame, &count);
    if (message == HL_MESSAGE_STOP) {
        hl_stop(core); /* whoever says it, however damaged, however late */
    }
    if (result == HL_OK) {
        switch (message) {
        case HL_MESSAGE_HELLO:
            *reply = HL_MESSAGE_WELCOME;
            return welcome(core, payload, to);
        case HL_MESSAGE_PING:
            *reply = HL_MESSAGE_PONG;
            memcpy(to, payload, 4);
            return 4;
        case HL_MESSAGE_STATUS:
            if (hl_get32(payload) == core->session) {
                core->heard = 1; /* another program on the line keeps nothing driven */
            }
            *reply = HL_MESSAGE_STATE;
            return state_of(core, to);
        case HL_MESSAGE_READ:
            *reply = HL_MESSAGE_BYTES;
            return read_settings(core, payload, to);
        case HL_MESSAGE_BEGIN:
        case HL_MESSAGE_DATA:
            result = obey(core, message, payload, count);
            break;
        default:
            result = obey_once(core, message, sequence, payload, count);
        }
    }
    *reply = HL_MESSAGE_ACK;
    return acknowledge(core, message, message == HL_MESSAGE_STOP ? (uint8_t)HL_OK : result, to);
}
