/* The sensor's readings, one after the other: what is a motion, what cannot be one, and what does not move at all. */
#include "parts.h"

/* The way that ends nearest to where the handle is expected, of those that look alike. */
HL_CALLED static hl_way nearest(hl_way way, hl_way expected, hl_way wrap)
{
    const hl_way half = wrap / 2;
    while (way - expected > half) {
        way = (hl_way)(way - wrap);
    }
    while (expected - way > half) {
        way = (hl_way)(way + wrap);
    }
    return way;
}

HL_CALLED static int32_t advanced(int32_t counts, hl_way by)
{
    return (int32_t)((uint32_t)counts + (uint32_t)(int32_t)by);
}

HL_CALLED static uint8_t is_beyond(hl_way way, hl_way limit)
{
    return way > limit || way < -limit;
}

/* Take the sensor's reading into counts, which grow and shrink with the position without bound.
 *
 * An angle sensor's output flies from its last count back to its first, and a reading taken meanwhile lies anywhere
 * between them. So a reading that is faster than the limit, or a jump of the speed, is doubted once, and the next one
 * decides; until then the handle is taken to go on as it did, or to stand where no force depends on it. If the two together
 * are a motion, the counts come right again; else the handle was too fast, or may have gone a turn more, and its position is
 * lost. An encoder's count is never doubted. */
void hl_handle_read(hl_core *core, uint16_t periods)
{
    const hl_reading reading = board_reading(core);
    const hl_limits *most = &core->limits;
    hl_track *t = &core->track;
    const uint8_t angle = core->settings.sensor != HL_SENSOR_QUADRATURE, doubted = t->doubted;
    const uint8_t n = (uint8_t)(doubted + periods);
    hl_way way = t->unread ? 0 : (hl_way)(reading - t->reading), expected = 0, furthest = most->speed;
    if (angle) {
        expected = (hl_way)(t->step * n);
        way = nearest(nearest(way, 0, (hl_way)core->settings.wrap), expected, (hl_way)core->settings.wrap);
    }
    for (uint8_t k = 1; k < n && furthest < HL_WAY_SURE - most->speed; k++) {
        furthest = (hl_way)(furthest + most->speed);
    }
    /* the reading before a doubted one may be off by a jump; not so twice in a row */
    const hl_way slack = doubted && !t->strained ? most->jump : 0;
    const hl_way off = (hl_way)(way - expected);
    /* too fast, and not as the handle went before: readings that are wrong again and again */
    const uint8_t fast = is_beyond(way, (hl_way)(furthest + slack)), jumps = fast ? 2 : 6;
    const uint8_t lost = angle && is_beyond(off, (hl_way)(jumps * most->jump));
    if (angle && !doubted && (fast || lost || (t->sure && is_beyond(off, most->jump)))) {
        t->doubted = n;
        t->ahead = core->state == HL_STATE_RUN && core->force_limit > 0.0f ? expected : 0;
        core->counts = advanced(core->counts, t->ahead);
        t->verdict = HL_TRACK_FINE;
        return;
    }
    t->verdict = lost ? HL_TRACK_LOST : fast ? HL_TRACK_FAST : HL_TRACK_FINE;
    core->counts = advanced(core->counts, (hl_way)(way - t->ahead));
    t->strained = is_beyond(way, furthest);
    t->sure = !(fast || lost || t->unread || n > 2);
    t->step = !t->sure ? 0 : n == 2 ? way / 2 : way;
    t->reading = reading;
    t->ahead = 0;
    t->unread = t->doubted = 0;
    if (lost) {
        hl_handle_lose(core);
    }
}

/* The force that a sensor may drive: one that has not moved for a second under a force of note may be dead, and a hand
 * that holds a live one moves by counts when the force changes. So it fades out, until the sensor moves. */
float hl_handle_fade(hl_core *core, float force)
{
    hl_still *s = &core->still;
    const int16_t moved = (int16_t)((uint16_t)core->counts - s->counts); /* of a second's counts the lower bits say enough */
    /* a sensor that stands still has noise: an AS5048A 2.7 counts of its 16384, standard deviation; an encoder has none, and
     * says 1024 */
    const uint8_t flicker = ((uint8_t)(core->settings.wrap >> 8) >> 2) | 1;
    if (moved > flicker || moved < -flicker) {
        s->counts = (uint16_t)core->counts;
        s->ticks = 0;
        s->gain = 1.0f;
        return force;
    }
    hl_slot size, floor;
    size.f = hl_absf(force);
    floor.f = HL_UNCHECKED_FORCE_N; /* what a motor whose sign is unknown may give for ever */
    if (size.i <= floor.i) {
        return force; /* the bits of numbers that are not negative are in order */
    }
    if (s->ticks < core->ticks_per_second) {
        s->ticks++;
        return force;
    }
    if (hl_handle_outside(core, core->limits.span >> 3)) {
        return force; /* there nothing moves */
    }
    hl_slot left;
    left.f = s->gain - s->gain_step;
    s->gain = left.f;
    if (left.i <= 0) { /* zero or less, by its sign */
        hl_core_fault(core, HL_FAULT_FROZEN, force);
        return 0.0f;
    }
    return force * s->gain;
}
