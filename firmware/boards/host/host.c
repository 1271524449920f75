#include "host.h"

#include <stdlib.h>
#include <string.h>

enum { OUT_BYTES = 65536 };

struct hl_host {
    hl_core core; /* first: the core's functions get its address back */
    uint8_t store[HL_STORE_BYTES], out[OUT_BYTES];
    uint32_t out_first, out_count;
    int32_t counts;
    int16_t duty;
    uint16_t clock, step, period_us;
    uint8_t reset_cause, in_tick, tick_at; /* tick_at: HL_AT_... of the tick that comes next by itself */
    uint32_t writes_left;                  /* bytes until the power fails */
};

static hl_host *of(hl_core *core)
{
    return (hl_host *)(void *)core;
}

hl_reading board_reading(hl_core *core)
{
    const hl_host *host = of(core);
    const int32_t wrap = core->settings.wrap;
    if (core->settings.sensor == HL_SENSOR_QUADRATURE) {
        return (hl_reading)host->counts;
    }
    return (hl_reading)(host->counts % wrap + (host->counts % wrap < 0 ? wrap : 0));
}

/* Nothing is wired to this computer. */
uint8_t board_accepts(const hl_settings *settings)
{
    (void)settings;
    return 1;
}

void board_motor(hl_core *core, int16_t duty)
{
    of(core)->duty = duty;
}

/* The first look at the clock in a tick is its begin; every later one comes after the step. */
uint16_t board_clock(hl_core *core)
{
    hl_host *host = of(core);
    const uint16_t now = host->clock;
    if (host->in_tick) {
        host->clock = (uint16_t)(host->clock + host->step);
        host->in_tick = 0;
    }
    return now;
}

void board_period(hl_core *core, uint16_t us)
{
    of(core)->period_us = us;
}

uint8_t board_send(hl_core *core, const uint8_t *bytes, uint8_t count)
{
    hl_host *host = of(core);
    if (count > OUT_BYTES - host->out_count) {
        return 0;
    }
    for (uint8_t k = 0; k < count; k++) {
        host->out[(host->out_first + host->out_count++) % OUT_BYTES] = bytes[k];
    }
    return 1;
}

void board_store_read(hl_core *core, uint16_t address, uint8_t *bytes, uint16_t count)
{
    memcpy(bytes, of(core)->store + address, count);
}

uint8_t board_store_write(hl_core *core, uint16_t address, const uint8_t *bytes, uint16_t count)
{
    hl_host *host = of(core);
    for (uint16_t k = 0; k < count && host->writes_left; k++, host->writes_left--) {
        host->store[address + k] = bytes[k];
    }
    return memcmp(host->store + address, bytes, count) == 0;
}

/* One thread calls everything here: a tick comes between where a test says so, and nowhere else. */
static void come_between(hl_core *core, uint8_t at)
{
    hl_host *host = of(core);
    if (host->tick_at == at) {
        host->tick_at = HL_AT_NO_LOCK;
        host->in_tick = 1;
        hl_core_tick(core);
    }
}

void board_lock(hl_core *core)
{
    come_between(core, HL_AT_LOCK);
}

void board_unlock(hl_core *core)
{
    come_between(core, HL_AT_UNLOCK);
}

uint8_t board_reset_cause(hl_core *core)
{
    return of(core)->reset_cause;
}

void board_configure(hl_core *core)
{
    (void)core;
}

void board_alive(hl_core *core)
{
    (void)core;
}

hl_host *hl_host_new(const uint8_t *store, uint8_t reset_cause)
{
    hl_host *host = calloc(1, sizeof *host);
    if (host) {
        memcpy(host->store, store, HL_STORE_BYTES);
        host->reset_cause = reset_cause;
        host->writes_left = UINT32_MAX;
        hl_core_start(&host->core);
    }
    return host;
}

void hl_host_free(hl_host *host)
{
    free(host);
}

/* What the main loop of a board does until there is nothing left to do. */
static void poll(hl_host *host)
{
    const hl_core *core = &host->core;
    do {
        hl_core_poll(&host->core);
    } while (core->tx_count == 0 && (core->rx_ready || core->fault_unsent || core->head != core->tail));
    hl_core_poll(&host->core); /* a little of the audit */
}

void hl_host_receive(hl_host *host, const uint8_t *bytes, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        hl_core_byte(&host->core, bytes[k]);
        if (host->core.rx_ready) {
            poll(host);
        }
    }
}

uint32_t hl_host_transmit(hl_host *host, uint8_t *bytes, uint32_t room)
{
    uint32_t count = 0;
    while (count < room && host->out_count) {
        bytes[count++] = host->out[host->out_first];
        host->out_first = (host->out_first + 1) % OUT_BYTES;
        host->out_count--;
    }
    return count;
}

int hl_host_tick(hl_host *host, int32_t counts, uint16_t clock, uint16_t step)
{
    host->counts = counts;
    host->clock = clock;
    host->step = step;
    host->in_tick = 1;
    hl_core_tick(&host->core);
    poll(host);
    return host->duty;
}

int hl_host_duty(const hl_host *host)
{
    return host->duty;
}

uint32_t hl_host_period_us(const hl_host *host)
{
    return host->period_us;
}

const uint8_t *hl_host_store(const hl_host *host)
{
    return host->store;
}

uint8_t *hl_host_program(hl_host *host)
{
    return host->core.places[host->core.active].arena.bytes;
}

void hl_host_race(hl_host *host, int at)
{
    host->tick_at = (uint8_t)at;
}

void hl_host_cut(hl_host *host, uint32_t bytes)
{
    host->writes_left = bytes;
}

void hl_host_fault(hl_host *host, int fault)
{
    hl_core_fault(&host->core, (uint8_t)fault, 0.0f);
}
