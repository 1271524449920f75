#include "run.h"

static hl_slot to_slot(double value, uint8_t type)
{
    hl_slot s;
    if (type == HL_TYPE_F32) {
        s.f = (float)value;
    } else if (type == HL_TYPE_BOOL) {
        s.i = value != 0.0;
    } else {
        s.i = value > -2147483649.0 && value < 2147483648.0 ? (int32_t)value : INT32_MIN;
    }
    return s;
}

static double to_double(hl_slot s, uint8_t type)
{
    return type == HL_TYPE_F32 ? (double)s.f : (double)s.i;
}

static void load(const hl_program *p, hl_slot *registers, uint16_t first, uint16_t count, const double *from,
                 int64_t stride)
{
    for (uint16_t k = 0; k < count; k++) {
        registers[first + k] = to_slot(from[k * stride], p->types[first + k]);
    }
}

static hl_result run_lane(const hl_program *p, hl_slot *registers, hl_slot *scratch, int64_t ticks, int64_t every,
                          int64_t lanes, int have_states, const double *inputs, double *states, double *outputs)
{
    const uint16_t *n = p->count;
    const uint16_t n_inputs = n[HL_COUNT_INPUTS], n_outputs = n[HL_COUNT_OUTPUTS];
    hl_result result = HL_OK;
    if (have_states) {
        load(p, registers, p->states, n[HL_COUNT_STATES], states, lanes);
    }
    for (int64_t tick = 0; tick < ticks; tick++) {
        if (result == HL_OK) {
            load(p, registers, p->inputs, n_inputs, inputs + tick * n_inputs, 1);
        }
        if (result == HL_OK && tick == 0 && !have_states) {
            result = hl_init(p, registers);
        }
        if (result == HL_OK) {
            result = hl_tick(p, registers, scratch);
        }
        if ((tick + 1) % every == 0) {
            double *row = outputs + tick / every * n_outputs * lanes;
            for (uint16_t k = 0; k < n_outputs; k++) {
                row[k * lanes] = result == HL_OK ? to_double(scratch[k], hl_output_type(p, k)) : (double)HL_NAN;
            }
        }
    }
    for (uint16_t k = 0; k < n[HL_COUNT_STATES]; k++) {
        const uint16_t r = (uint16_t)(p->states + k);
        states[k * lanes] = result == HL_OK ? to_double(registers[r], p->types[r]) : (double)HL_NAN;
    }
    return result;
}

int hl_host_verify(const uint8_t *bytes, uint32_t size, hl_slot *registers, uint16_t capacity)
{
    hl_program program;
    return (int)hl_verify(&program, bytes, size, registers, capacity);
}

int hl_host_run(const uint8_t *bytes, uint32_t size, hl_slot *registers, uint16_t capacity, hl_slot *scratch,
                int64_t ticks, int64_t every, int64_t lanes, int have_states, const double *inputs,
                const double *parameters, double *states, double *outputs, int32_t *faults)
{
    hl_program program;
    const hl_result verified = hl_verify(&program, bytes, size, registers, capacity);
    if (verified != HL_OK) {
        return (int)verified;
    }
    for (int64_t lane = 0; lane < lanes; lane++) {
        load(&program, registers, program.parameters, program.count[HL_COUNT_PARAMETERS], parameters + lane, lanes);
        faults[lane] = (int32_t)run_lane(&program, registers, scratch, ticks, every, lanes, have_states, inputs,
                                         states + lane, outputs + lane);
    }
    return (int)HL_OK;
}
