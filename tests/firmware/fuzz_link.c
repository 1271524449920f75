/* The host's board, fed with events from standard input; after each it says where the board stands. Built with
 * sanitizers by test_fuzz.py, which makes the events and judges what is said here.
 *
 *     'N'                                     power on anew, with what the store holds
 *     'R' length16 bytes                      bytes from the link
 *     'T' ticks16 counts32 step32             ticks 1 ms apart, the handle moving by `step` each
 *
 * A duty that is not 0 while nothing runs ends the program at once. */
#include "../../firmware/boards/host/host.c"

#include <stdio.h>

static int worst; /* |duty| since the last event */
static uint16_t now;

static uint32_t number(int bytes)
{
    uint32_t value = 0;
    for (int k = 0; k < bytes; k++) {
        value |= (uint32_t)(uint8_t)getchar() << 8 * k;
    }
    return value;
}

static void say(uint64_t value, int bytes)
{
    for (int k = 0; k < bytes; k++) {
        putchar((int)(value >> 8 * k & 255));
    }
}

static void look(const hl_host *host)
{
    const int duty = host->duty < 0 ? -host->duty : host->duty;
    worst = duty > worst ? duty : worst;
    if (duty != 0 && host->core.state != HL_STATE_RUN) {
        fprintf(stderr, "duty %d in state %d\n", host->duty, host->core.state);
        exit(1);
    }
}

/* Fowler, Noll and Vo's hash: a CRC of bytes that end with their CRC is always the same. */
static uint64_t hash_of(const hl_place *place)
{
    uint64_t hash = 0xcbf29ce484222325ULL;
    for (uint16_t k = 0; k < place->size; k++) {
        hash = (hash ^ place->arena.bytes[k]) * 0x100000001b3ULL;
    }
    return hash;
}

static void report(hl_host *host)
{
    static uint8_t out[OUT_BYTES];
    const hl_core *core = &host->core;
    const hl_place *place = &core->places[core->active];
    const uint32_t count = hl_host_transmit(host, out, sizeof out);
    say(core->state, 1);
    say(core->fault, 1);
    say((uint64_t)worst, 2);
    say(core->session, 4);
    say(core->obeyed, 4);
    say(core->state == HL_STATE_RUN ? hash_of(place) : 0, 8);
    for (uint16_t k = 0; k < 2; k++) {
        const int there = core->state == HL_STATE_RUN && k < place->program.count[HL_COUNT_PARAMETERS];
        say(there ? (uint32_t)place->registers[place->program.parameters + k].i : 0, 4);
    }
    say(count, 4);
    fwrite(out, 1, count, stdout);
    worst = 0;
}

static hl_host *power_on(hl_host *old)
{
    uint8_t store[HL_STORE_BYTES];
    memset(store, 0xff, sizeof store);
    if (old) {
        memcpy(store, old->store, sizeof store);
        hl_host_free(old);
    }
    return hl_host_new(store, 0);
}

int main(void)
{
    hl_host *host = power_on(NULL);
    for (int kind = getchar(); host && kind != EOF; kind = getchar()) {
        if (kind == 'N') {
            host = power_on(host);
        } else if (kind == 'R') {
            const uint32_t count = number(2);
            uint8_t *bytes = malloc(count ? count : 1); /* of exactly this length */
            for (uint32_t k = 0; k < count; k++) {
                bytes[k] = (uint8_t)getchar();
            }
            for (uint32_t k = 0; k < count; k++) {
                hl_host_receive(host, bytes + k, 1);
                look(host);
            }
            free(bytes);
        } else {
            const uint32_t ticks = number(2), counts = number(4), step = number(4);
            for (uint32_t k = 0; k < ticks; k++) {
                now = (uint16_t)(now + 1000);
                hl_host_tick(host, (int32_t)(counts + k * step), now, 10);
                look(host);
            }
        }
        report(host);
    }
    hl_host_free(host);
    return 0;
}
