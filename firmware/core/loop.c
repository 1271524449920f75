/* The tick: one sample of the closed loop, and what stops it. */
#include "parts.h"

void hl_core_fault(hl_core *core, uint8_t fault, float value)
{
    board_motor(core, 0);
    if (fault == HL_FAULT_SENSOR || fault == HL_FAULT_FROZEN || fault == HL_FAULT_OVER_TRAVEL) {
        hl_handle_lose(core); /* counts may have been missed: what was seen of the stops is worth nothing either */
    }
    if (core->state != HL_STATE_RUN) {
        return; /* nothing was running, or an earlier fault stands */
    }
    core->state = HL_STATE_FAULT;
    board_motor(core, 0); /* again: called outside the tick, a tick may have come between */
    core->force = 0.0f;
    core->fault = fault;
    core->fault_tick = core->tick;
    core->fault_value = value;
    core->fault_unsent = 1;
}

/* Measure the period that ended with this tick; returns how many periods of the grid it was long. */
static uint16_t measure(hl_core *core, uint16_t begin)
{
    const uint16_t since = (uint16_t)(begin - core->last_begin);
    hl_timing *t = &core->timing;
    core->last_begin = begin;
    if (core->first) {
        return 0;
    }
    t->period_min = since < t->period_min ? since : t->period_min;
    t->period_max = since > t->period_max ? since : t->period_max;
    const uint16_t half = core->period_clocks / 2;
    return since < core->period_clocks + half ? 1 : (uint16_t)(((uint32_t)since + half) / core->period_clocks);
}

/* What stops the loop before the scene runs: host, position, speed. */
static uint8_t is_unsafe(hl_core *core, uint16_t periods)
{
    core->silent = core->heard || core->standalone ? 0 : (uint16_t)(core->silent + periods);
    core->heard = 0;
    if (core->silent >= core->silence) {
        hl_core_fault(core, HL_FAULT_HOST_SILENT, 0.0f);
        return 1;
    }
    if (core->track.verdict == HL_TRACK_LOST) {
        hl_core_fault(core, HL_FAULT_OVER_SPEED, core->v); /* with the motor off too: the position is lost */
        return 1;
    }
    if (!core->calibrated || core->force_limit == 0.0f) {
        return 0; /* the motor is off: nothing to protect */
    }
    if (core->track.doubted == 0 && hl_handle_outside(core, 0)) {
        hl_core_fault(core, HL_FAULT_OVER_TRAVEL, core->x);
        return 1;
    }
    if (core->track.verdict == HL_TRACK_FAST && !core->first) {
        hl_core_fault(core, HL_FAULT_OVER_SPEED, core->v);
        return 1;
    }
    return 0;
}

static void record(hl_core *core, const hl_slot *outputs, uint8_t flags)
{
    if (--core->countdown != 0) {
        return;
    }
    core->countdown = core->every;
    const uint8_t next = (uint8_t)((core->head + 1u) % HL_RING);
    if (next == core->tail) {
        core->lost++;
        return;
    }
    hl_sample *sample = &core->ring[core->head];
    sample->tick = core->tick;
    sample->flags = flags;
    sample->values[0].f = core->x;
    sample->values[1].f = core->v;
    sample->values[2].f = core->force;
    for (uint8_t k = 3; k < core->channels; k++) {
        sample->values[k] = outputs[k - 2];
    }
    core->head = next;
}

/* Account for the time of this step; returns whether it missed its period. */
static uint8_t is_late(hl_core *core, uint16_t begin)
{
    hl_timing *t = &core->timing;
    const uint16_t step = (uint16_t)(board_clock(core) - begin);
    t->step_last = step;
    t->step_worst = step > t->step_worst ? step : t->step_worst;
    t->step_sum += step;
    t->steps++;
    if (t->step_sum > UINT32_C(0x7fffffff)) {
        t->step_sum /= 2;
        t->steps /= 2;
    }
    return step > core->period_clocks;
}

/* A step that missed its period, by itself or by what came after its clock was read: then the grid lost a tick. */
static void count_late(hl_core *core, uint8_t late)
{
    if (late) {
        core->timing.overruns++;
        core->late++;
        core->late_second++;
    } else {
        core->late = 0;
    }
    core->was_late = late;
}

static void watch_overruns(hl_core *core)
{
    if (core->late >= HL_OVERRUNS_IN_A_ROW || core->late_second >= HL_OVERRUNS_PER_SECOND) {
        hl_core_fault(core, HL_FAULT_OVERRUN, (float)core->timing.step_last / (float)core->period_clocks);
    }
    if (--core->second == 0) {
        core->second = core->ticks_per_second;
        core->late_second = 0;
    }
}

/* Run the scene on the sample; returns whether every number is finite. */
static int compute(hl_core *core, hl_slot *outputs)
{
    const hl_place *place = &core->places[core->active];
    const hl_program *program = &place->program;
    hl_slot *registers = place->registers;
    if (program->count[HL_COUNT_INPUTS]) {
        registers[program->inputs].f = core->x;
    }
    hl_result result = core->first ? hl_init(program, registers) : HL_OK;
    if (result == HL_OK) {
        result = hl_tick(program, registers, outputs);
    }
    if (result != HL_OK) {
        hl_core_fault(core, HL_FAULT_NOT_FINITE, (float)result);
        return 0;
    }
    return 1;
}

static void run(hl_core *core, uint16_t begin, uint16_t periods)
{
    hl_slot outputs[HL_CHANNELS];
    const uint8_t skipped = periods > 1 && !core->was_late;
    const float x = hl_handle_position(core, core->counts);
    core->tick += periods;
    core->v = core->first ? 0.0f : (x - core->x) * core->rate;
    if (periods > 1) {
        core->v /= (float)periods; /* the scene's own difference takes one period, and its sample says so */
    }
    core->x = x;
    if (is_unsafe(core, periods) || !compute(core, outputs)) {
        return;
    }
    uint8_t flags = core->first ? HL_SAMPLE_FIRST : 0;
    hl_slot force = outputs[0];
    hl_slot limit;
    limit.f = core->force_limit;
    if ((force.i & INT32_MAX) > limit.i) { /* without its sign a float is ordered as its bits are */
        force.i = limit.i | (force.i & INT32_MIN);
        flags |= HL_SAMPLE_SATURATED;
    }
    hl_slot kept;
    kept.f = hl_handle_fade(core, force.f);
    if (kept.i != force.i) {
        force = kept;
        flags |= HL_SAMPLE_SATURATED;
    }
    core->force = force.f;
    hl_motor(core, -force.f);
    const uint8_t late = is_late(core, begin);
    if (late || skipped) {
        flags |= HL_SAMPLE_OVERRUN;
    }
    if (skipped) {
        count_late(core, 1); /* the step before, which nobody counted */
    }
    count_late(core, late);
    watch_overruns(core);
    record(core, outputs, flags); /* with no force where one of them switched the motor off */
    core->first = 0;
}

void hl_core_tick(hl_core *core)
{
    const uint16_t begin = board_clock(core);
    core->ran = 1;
    if (core->state == HL_STATE_RUN) {
        const uint16_t periods = measure(core, begin);
        hl_handle_read(core, core->first ? 1 : periods);
        if (core->state == HL_STATE_RUN) { /* a sensor that cannot be right has ended it */
            run(core, begin, periods);
        }
    } else {
        hl_handle_read(core, 1);
        hl_idle(core);
        core->last_begin = begin;
    }
}
