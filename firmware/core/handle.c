#include "parts.h"

/* The nearest whole number; far enough from the ends of int32 for sums. */
static int32_t whole(float a)
{
    const float limited = a > 1e9f ? 1e9f : a < -1e9f ? -1e9f : a;
    return (int32_t)(limited < 0.0f ? limited - 0.5f : limited + 0.5f);
}

static int32_t counts_of(const hl_core *core, float metres)
{
    return whole(metres / core->settings.metres_per_count);
}

/* The way from one reading to the next: the nearest, as a sensor may have gone from its last count to its first. */
static hl_way way_of(const hl_core *core, hl_reading from, hl_reading to)
{
    const hl_way way = (hl_way)(to - from), wrap = (hl_way)core->settings.wrap;
    if (core->settings.sensor == HL_SENSOR_QUADRATURE) {
        return way;
    }
    return (hl_way)(2 * way > wrap ? way - wrap : 2 * way < -wrap ? way + wrap : way);
}

/* Take the sensor's reading into counts, which grow and shrink with the position without bound. */
void hl_handle_read(hl_core *core)
{
    const hl_reading reading = board_reading(core);
    core->before = core->counts;
    if (!core->unread) {
        core->counts = hl_moved(-(int32_t)way_of(core, core->reading, reading), core->counts);
    }
    core->reading = reading;
    core->unread = 0;
}

/* The speed limit in counts a period; one count of noise either way is no motion. */
int32_t hl_handle_speed(const hl_core *core, uint16_t period_us)
{
    const hl_settings *s = &core->settings;
    const int32_t speed = whole(hl_absf(s->speed_max / s->metres_per_count) * (float)period_us * 1e-6f);
    return speed < 2 ? 2 : speed;
}

/* Put the limits of settings and period into counts. */
void hl_handle_limits(hl_core *core)
{
    const hl_settings *s = &core->settings;
    const int32_t a = counts_of(core, s->travel_min), b = counts_of(core, s->travel_max);
    const int32_t low = a < b ? a : b, high = a < b ? b : a;
    const int32_t margin = (high - low) / 20; /* a stop gives a little */
    core->limits.span = high - low;
    core->limits.lowest = low - margin;
    core->limits.highest = high + margin;
    core->limits.speed = hl_handle_speed(core, core->period_us);
    /* of `wrap` counts half either way looks alike: an eighth is kept as margin */
    core->limits.alias = s->sensor == HL_SENSOR_QUADRATURE ? HL_WAY_SURE : (int32_t)s->wrap * 3 / 8;
}

/* The handle is at this position now. */
void hl_handle_place(hl_core *core, float position)
{
    core->origin = hl_moved(counts_of(core, position), core->counts);
    core->homed = 1;
    core->mismatch = 0;
}

/* The position is not known any more, nor is anything seen before. */
void hl_handle_lose(hl_core *core)
{
    core->homed = 0;
    core->mismatch = 0;
    core->seen_min = INT32_MAX; /* the next tick begins both */
    core->seen_max = INT32_MIN;
}

/* Whether the sensor may have turned over between two samples without a trace. */
uint8_t hl_handle_aliased(const hl_core *core, int32_t before)
{
    const int32_t moved = hl_moved(before, core->counts);
    return moved > core->limits.alias || moved < -core->limits.alias;
}

/* In IDLE: a handle led to both stops has told where it is. */
void hl_handle_watch(hl_core *core)
{
    const int32_t counts = core->counts;
    core->seen_min = counts < core->seen_min ? counts : core->seen_min;
    core->seen_max = counts > core->seen_max ? counts : core->seen_max;
    const int32_t seen = hl_moved(core->seen_min, core->seen_max), allowed = core->limits.span / 32;
    if (core->homed || !core->calibrated || seen < core->limits.span - allowed) {
        return;
    }
    /* the hand is still at the second stop when it turns back: wait for that, so that both ends are complete */
    if (hl_moved(counts, core->seen_max) < allowed || hl_moved(core->seen_min, counts) < allowed) {
        return;
    }
    if (seen > core->limits.span + allowed) {
        core->mismatch = 1;
        return;
    }
    const float middle = 0.5f * (core->settings.travel_min + core->settings.travel_max);
    core->origin = hl_moved(counts_of(core, middle) - seen / 2, core->seen_min);
    core->homed = 1;
}

float hl_handle_position(const hl_core *core, int32_t counts)
{
    return (float)hl_moved(core->origin, counts) * core->settings.metres_per_count;
}
