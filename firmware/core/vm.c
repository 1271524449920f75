#include "vm.h"

#include "elementary.h"
#include "flash.h"
#include "word.h"

HL_NO_CONTRACTION

#define A registers[WORD(pc, 2)]
#define B registers[WORD(pc, 3)]
#define C registers[WORD(pc, 4)]
#define TO registers[WORD(pc, 1)]

/* X(name, operands, body): the one table of what instructions do, under either way of dispatch */
#define BODIES(X) \
    X(NEG, 1, TO.f = -A.f) \
    X(ABS, 1, TO.f = hl_absf(A.f)) \
    X(ADD, 2, TO.f = A.f + B.f) \
    X(SUB, 2, TO.f = A.f - B.f) \
    X(MUL, 2, TO.f = A.f * B.f) \
    X(DIV, 2, TO.f = A.f / B.f) \
    X(SQRT, 1, TO.f = sqrtf(A.f)) \
    X(FLOOR, 1, TO.f = hl_floorf(A.f)) \
    X(LT, 2, TO.i = A.f < B.f) \
    X(LE, 2, TO.i = A.f <= B.f) \
    X(EQ, 2, TO.i = A.f == B.f) \
    X(AND, 2, TO.i = A.i & B.i) \
    X(OR, 2, TO.i = A.i | B.i) \
    X(NOT, 1, TO.i = !A.i) \
    X(SELECT, 3, TO = A.i ? B : C) \
    X(SIN, 1, TO.f = hl_sinf(A.f)) \
    X(COS, 1, TO.f = hl_cosf(A.f)) \
    X(EXP, 1, TO.f = hl_expf(A.f)) \
    X(LOG, 1, TO.f = hl_logf(A.f)) \
    X(ATAN, 1, TO.f = hl_atanf(A.f)) \
    X(TANH, 1, TO.f = hl_tanhf(A.f)) \
    X(EXP2I, 1, TO.f = hl_exp2if(A.f)) \
    X(EXPONENT, 1, TO.f = hl_exponentf(A.f)) \
    X(IADD, 2, TO.i = (int32_t)((uint32_t)A.i + (uint32_t)B.i)) \
    X(ITOF, 1, TO.f = (float)A.i)

#if defined(__GNUC__) && !defined(HL_NO_COMPUTED_GOTO)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
static void run(const uint8_t *pc, hl_slot *registers)
{
    static const void *const bodies[OPCODES] HL_FLASH = {
        [HL_OP_END] = &&end,
#define LABEL(name, operands, body) [OP_##name] = &&body_##name,
        BODIES(LABEL)
#undef LABEL
    };
    goto *HL_FLASH_POINTER(&bodies[WORD(pc, 0)]);
#define BODY(name, operands, body) \
    body_##name: \
    body; \
    ADVANCE(pc, 2 + operands); \
    goto *HL_FLASH_POINTER(&bodies[WORD(pc, 0)]);
    BODIES(BODY)
#undef BODY
end:
    return;
}
#pragma GCC diagnostic pop
#else
static void run(const uint8_t *pc, hl_slot *registers)
{
    for (;;) {
        switch (WORD(pc, 0)) {
#define BODY(name, operands, body) \
        case OP_##name: \
            body; \
            ADVANCE(pc, 2 + operands); \
            break;
        BODIES(BODY)
#undef BODY
        default:
            return;
        }
    }
}
#endif

static void move(const uint8_t *moves, uint16_t count, hl_slot *registers)
{
    for (uint16_t k = 0; k < count; k++) {
        registers[WORD(moves, 0)] = registers[WORD(moves, 1)];
        ADVANCE(moves, 2);
    }
}

static int all_finite(const hl_slot *slots, const uint8_t *types, uint16_t count)
{
    for (uint16_t k = 0; k < count; k++) {
        if (types[k] == HL_TYPE_F32 && !hl_is_finite(slots[k])) {
            return 0;
        }
    }
    return 1;
}

static hl_result check_states(const hl_program *program, const hl_slot *registers)
{
    const uint16_t first = program->states;
    const int finite = all_finite(registers + first, program->types + first, program->count[HL_COUNT_STATES]);
    return finite ? HL_OK : HL_STATE_NOT_FINITE;
}

hl_result hl_init(const hl_program *program, hl_slot *registers)
{
    run(program->init, registers);
    move(program->init_moves, program->count[HL_COUNT_INIT_MOVES], registers);
    return check_states(program, registers);
}

hl_result hl_tick(const hl_program *program, hl_slot *registers, hl_slot *outputs)
{
    const uint16_t count = program->count[HL_COUNT_OUTPUTS];
    run(program->tick, registers);
    for (uint16_t k = 0; k < count; k++) { /* before the moves: an output may be a state as it was */
        outputs[k] = registers[WORD(program->outputs, k)];
    }
    move(program->tick_moves, program->count[HL_COUNT_TICK_MOVES], registers);
    if (!all_finite(outputs, program->types + program->temporaries, count)) {
        return HL_OUTPUT_NOT_FINITE;
    }
    return check_states(program, registers);
}

uint8_t hl_output_type(const hl_program *program, uint16_t k)
{
    return program->types[program->temporaries + k];
}
