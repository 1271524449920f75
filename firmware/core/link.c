/* Between ticks: frames in, frames out. */
#include "crc.h"
#include "parts.h"
#include "wire.h"

#include <string.h>

/* bytes of the running program that one poll audits */
enum { AUDIT_BYTES = 8 };

static void transmit(hl_core *core)
{
    if (board_send(core, core->tx, core->tx_count)) {
        core->tx_count = 0;
    }
}

/* Send the payload of `count` bytes that is in tx already. */
static void finish(hl_core *core, uint8_t message, uint8_t sequence, uint8_t count)
{
    core->tx[1] = (uint8_t)(HL_PROTOCOL << 5 | message);
    core->tx[2] = sequence;
    core->tx_count = hl_wire_encode(core->tx, (uint8_t)(2 + count));
    transmit(core);
}

static void receive(hl_core *core)
{
    const uint8_t *frame = core->rx + 1;
    const uint8_t length = hl_wire_decode(core->rx, core->rx_count);
    const uint8_t sequence = frame[1];
    uint8_t reply = 0, count = 0;
    /* a board's own words come back where a line is looped: they are no host */
    if (length >= 2 && frame[0] >> 5 == HL_PROTOCOL && (frame[0] & 31) < HL_MESSAGE_ACK) {
        count = hl_answer(core, frame, (uint8_t)(length - 2), core->tx + 3, &reply);
    } else {
        core->damaged++;
    }
    core->rx_count = 0; /* before the reply leaves: the host answers it at once, a tick may come first */
    core->rx_ready = 0;
    if (reply) {
        finish(core, reply, sequence, count);
    }
}

static void send_fault(hl_core *core)
{
    uint8_t *to = core->tx + 3;
    core->fault_unsent = 0;
    to[HL_AT_FAULTED_FAULT] = core->fault;
    hl_put32(to + HL_AT_FAULTED_TICK, core->fault_tick);
    hl_putf(to + HL_AT_FAULTED_VALUE, core->fault_value);
    finish(core, HL_MESSAGE_FAULTED, core->sent++, HL_AT_FAULTED_VALUE + 4);
}

static void send_sample(hl_core *core)
{
    const hl_sample *sample = &core->ring[core->tail];
    uint8_t *to = core->tx + 3;
    hl_put32(to + HL_AT_SAMPLE_TICK, sample->tick);
    to[HL_AT_SAMPLE_FLAGS] = sample->flags;
    for (uint8_t k = 0; k < core->channels; k++) {
        hl_put32(to + HL_AT_SAMPLE_FLAGS + 1 + 4 * k, (uint32_t)sample->values[k].i);
    }
    core->tail = (uint8_t)((core->tail + 1u) % HL_RING);
    finish(core, HL_MESSAGE_SAMPLE, core->sent++, (uint8_t)(HL_AT_SAMPLE_FLAGS + 1 + 4 * core->channels));
}

/* The bytes of the running program are still those that were verified, its constants in the registers too, and its
 * parameters those that were set. */
static void audit(hl_core *core)
{
    const hl_place *place = &core->places[core->active];
    if (core->state != HL_STATE_RUN || place->size == 0) {
        return;
    }
    const uint16_t end = (uint16_t)(place->size - 4);
    const uint16_t left = (uint16_t)(end - core->audit_at), count = left < AUDIT_BYTES ? left : AUDIT_BYTES;
    core->audit_crc = hl_crc32(core->audit_crc, place->arena.bytes + core->audit_at, count);
    core->audit_at = (uint16_t)(core->audit_at + count);
    if (core->audit_at < end) {
        return;
    }
    const uint16_t constants = (uint16_t)(4u * place->program.count[HL_COUNT_CONSTANTS]);
    if (core->audit_crc != place->crc || memcmp(place->registers, place->arena.bytes + HL_HEADER_BYTES, constants) != 0
        || hl_place_sum(place) != place->sum) {
        hl_core_fault(core, HL_FAULT_BAD_PROGRAM, 0.0f);
    }
    core->audit_at = 0;
    core->audit_crc = 0;
}

void hl_core_poll(hl_core *core)
{
    board_alive(core);
    if (core->heat_given && core->heat_given != HL_HEAT_OVER) {
        hl_heat_follow(core);
    } else if (core->tx_count) {
        transmit(core);
    } else if (core->rx_ready) {
        receive(core);
    } else if (core->fault_unsent) {
        send_fault(core);
    } else if (core->head != core->tail) {
        send_sample(core);
    } else {
        audit(core);
    }
}

void hl_core_start(hl_core *core)
{
    memset(core, 0, sizeof *core);
    board_motor(core, 0);
    hl_settings_load(core, &core->places[0]);
    core->standalone = hl_load_standalone(core) == HL_OK && core->calibrated && core->settings.checked;
}
