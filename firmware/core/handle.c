#include "parts.h"

/* The nearest whole number; far enough from the ends of int32 for sums and small multiples. */
static int32_t whole(float a)
{
    const float limited = a > 1e8f ? 1e8f : a < -1e8f ? -1e8f : a;
    return (int32_t)(limited < 0.0f ? limited - 0.5f : limited + 0.5f);
}

static int32_t counts_of(const hl_core *core, float metres)
{
    return whole(metres / core->settings.metres_per_count);
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
    /* of `wrap` counts half either way looks alike: an eighth is kept as margin */
    core->limits.alias = s->sensor == HL_SENSOR_QUADRATURE ? HL_WAY_SURE : (hl_way)((int32_t)s->wrap * 3 / 8);
    const int32_t speed = hl_handle_speed(core, core->period_us);
    core->limits.speed = core->calibrated && speed < core->limits.alias ? (hl_way)speed : core->limits.alias;
    /* a quarter of the limit in one tick, and some noise. Beside what was expected are three jumps at most after a doubt,
     * and as many where the handle changes its speed meanwhile: six are the most that is sure to be no turn */
    const hl_way jump = (hl_way)((core->limits.speed >> 2) + 8), most = (hl_way)(s->wrap >> 4);
    core->limits.jump = jump < most ? jump : most;
    core->track.step = 0; /* it was counts of another period */
    core->track.sure = 0;
}

/* The handle is at this position now; where the last reading is doubted, it is with the next one. */
void hl_handle_place(hl_core *core, float position)
{
    if (core->track.doubted) {
        core->track.unread = 1;
        core->track.ahead = 0;
        core->track.doubted = 0;
    }
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

/* Whether the handle is beyond its travel, or nearer to its end than so many counts. */
HL_CALLED uint8_t hl_handle_outside(const hl_core *core, int32_t margin)
{
    const int32_t place = hl_moved(core->origin, core->counts);
    return place < core->limits.lowest + margin || place > core->limits.highest - margin;
}

/* In IDLE: a handle led to both stops has told where it is, and one that leaves its travel has told that it slipped. */
void hl_handle_watch(hl_core *core)
{
    const int32_t counts = core->counts;
    if (core->homed && core->calibrated && hl_handle_outside(core, 0)) {
        hl_handle_lose(core);
        core->mismatch = 1;
    }
    core->seen_min = counts < core->seen_min ? counts : core->seen_min;
    core->seen_max = counts > core->seen_max ? counts : core->seen_max;
    const int32_t seen = hl_moved(core->seen_min, core->seen_max), allowed = core->limits.span >> 5;
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
    core->mismatch = 0;
}

float hl_handle_position(const hl_core *core, int32_t counts)
{
    return (float)hl_moved(core->origin, counts) * core->settings.metres_per_count;
}
