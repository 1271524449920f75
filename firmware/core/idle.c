/* The tick while nothing runs, and the start without a host. */
#include "parts.h"

/* Without a host: a program kept in the store starts when the handle, led to both stops, rests in the middle for 1 s. */
static void await_standalone(hl_core *core)
{
    const int32_t middle = core->limits.span >> 3, still = (core->limits.span >> 8) + 2;
    const int32_t off = hl_moved(core->origin, core->counts) - ((core->limits.lowest + core->limits.highest) >> 1);
    const int32_t moved = hl_moved(core->resting, core->counts);
    if (!core->homed || off > middle || off < -middle || moved > still || moved < -still) {
        core->resting = core->counts;
        core->rested = 0;
        return;
    }
    if (++core->rested > core->ticks_per_second && core->heat_given == 0) {
        core->rested = 0;
        hl_place_start(core, core->active, 1, 0, core->settings.force_max);
    }
}

/* A tick in which nothing runs: the handle is watched, the motor cools. */
void hl_idle(hl_core *core)
{
    if (core->period_us != HL_IDLE_PERIOD_US && core->heat_given == 0) {
        hl_place_idle(core); /* after a fault */
    }
    if (core->track.doubted == 0) {
        hl_handle_watch(core);
    }
    hl_heat(core, 0);
    if (core->standalone && core->state == HL_STATE_IDLE) {
        await_standalone(core);
    }
}
