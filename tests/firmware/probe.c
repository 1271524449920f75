/* A core that lets the tests see and drive the board underneath: in place of firmware/core. */
#include "uno.h"

#include <stddef.h>
#include <string.h>

struct {
    /* written by the test; `taken` means back to 0 (at: to 0xFFFF) once it was done */
    uint16_t period_us; /* taken */
    int16_t duty;
    uint16_t spin;      /* clocks one tick lasts longer, taken */
    uint8_t echo;
    uint16_t at;        /* write `byte` into the store here, taken */
    uint8_t byte, kept;
    uint8_t pieces;     /* send so many pieces of 50 bytes, one after the other; counts down to 0 */
    /* read by the test */
    uint32_t ticks;
    uint16_t begin, shortest, longest; /* clock at this tick; distances of ticks */
    uint8_t fault, cause;
    float value;
    uint32_t received;
    uint16_t refused;
} volatile probe;

volatile int32_t counts;
static volatile uint8_t head, tail;
#define QUEUED(k) uno_core.places[0].arena.bytes[k] /* memory nobody else needs here */

void hl_core_start(hl_core *core)
{
    memset(core, 0, sizeof *core);
    core->rx_ready = 1; /* every byte comes to hl_core_byte */
    board_store_read(core, offsetof(hl_record, loop), (uint8_t *)&core->settings, sizeof core->settings);
    core->track.unread = 1;
    probe.cause = board_reset_cause(core);
    probe.at = 0xFFFF;
    board_configure(core);
    board_motor(core, 0);
}

/* Unwrap the reading, without judging it. */
static void count(hl_core *core)
{
    const uint16_t reading = board_reading(core);
    const int16_t wrap = (int16_t)core->settings.wrap;
    int16_t way = core->track.unread ? 0 : (int16_t)(reading - core->track.reading);
    if (core->settings.sensor != HL_SENSOR_QUADRATURE) {
        way = 2 * way > wrap ? way - wrap : 2 * way < -wrap ? way + wrap : way;
    }
    core->track.unread = 0;
    core->track.reading = reading;
    counts += way;
}

void hl_core_tick(hl_core *core)
{
    const uint16_t begin = board_clock(core), gap = (uint16_t)(begin - probe.begin);
    count(core);
    core->ran = 1;
    probe.begin = begin;
    if (probe.ticks++) {
        probe.shortest = gap < probe.shortest || probe.ticks == 2 ? gap : probe.shortest;
        probe.longest = gap > probe.longest || probe.ticks == 2 ? gap : probe.longest;
    }
    board_motor(core, probe.duty);
    if (probe.spin) {
        const uint16_t spin = probe.spin;
        probe.spin = 0;
        while ((uint16_t)(board_clock(core) - begin) < spin) {
        }
    }
}

void hl_core_byte(hl_core *core, uint8_t byte)
{
    (void)core;
    probe.received++;
    if (probe.echo) {
        QUEUED(head) = byte;
        head++;
    }
}

void hl_core_poll(hl_core *core)
{
    if (probe.period_us) {
        board_period(core, probe.period_us);
        probe.ticks = 0;
        probe.period_us = 0;
    }
    if (probe.at != 0xFFFF) {
        const uint8_t byte = probe.byte;
        probe.kept = board_store_write(core, probe.at, &byte, 1);
        probe.at = 0xFFFF;
    }
    while (tail != head) {
        const uint8_t byte = QUEUED(tail);
        if (!board_send(core, &byte, 1))
            break;
        tail++;
    }
    if (probe.pieces) {
        uint8_t piece[50];
        for (uint8_t k = 0; k < sizeof piece; k++)
            piece[k] = (uint8_t)(probe.pieces * 50 + k);
        if (board_send(core, piece, sizeof piece))
            probe.pieces--;
        else
            probe.refused++;
    }
    board_alive(core);
}

void hl_core_fault(hl_core *core, uint8_t fault, float value)
{
    (void)core;
    board_motor(core, 0);
    probe.fault = fault;
    probe.value = value;
}
