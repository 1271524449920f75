#include "vm.h"

#include "elementary.h"

HL_NO_CONTRACTION

#if HL_WORD_BITS == 8
#define WORD(p, k) ((p)[k])
#else
#define WORD(p, k) ((uint16_t)((p)[2 * (k)] | (unsigned)(p)[2 * (k) + 1] << 8))
#endif
#define ADVANCE(p, words) ((p) += (words) * HL_WORD_BYTES)

/* ------------------------------------------------------------------ running */

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

enum {
#define NUMBER(name, number, operands, result, a, b, c) OP_##name = number,
    HL_OPERATIONS(NUMBER)
#undef NUMBER
    OPCODES
};

#if defined(__GNUC__) && !defined(HL_NO_COMPUTED_GOTO)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
static void run(const uint8_t *pc, hl_slot *registers)
{
    static const void *const bodies[OPCODES] = {
        [HL_OP_END] = &&end,
#define LABEL(name, operands, body) [OP_##name] = &&body_##name,
        BODIES(LABEL)
#undef LABEL
    };
    goto *bodies[WORD(pc, 0)];
#define BODY(name, operands, body) \
    body_##name: \
    body; \
    ADVANCE(pc, 2 + operands); \
    goto *bodies[WORD(pc, 0)];
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

/* ------------------------------------------------------------------ verifying */

enum { UNWRITTEN = 0 };

typedef struct {
    uint8_t operands, result, operand[3];
} signature;

static const signature signatures[OPCODES] = {
#define SIGNATURE(name, number, operands, result, a, b, c) [number] = {operands, result, {a, b, c}},
    HL_OPERATIONS(SIGNATURE)
#undef SIGNATURE
};

static uint16_t read_16(const uint8_t *p)
{
    return (uint16_t)(p[0] | (unsigned)p[1] << 8);
}

static uint32_t read_32(const uint8_t *p)
{
    return read_16(p) | (uint32_t)read_16(p + 2) << 16;
}

static uint32_t crc_32(const uint8_t *p, uint32_t size)
{
    uint32_t crc = 0xffffffffUL;
    while (size--) {
        crc ^= *p++;
        for (uint8_t bit = 0; bit < 8; bit++) {
            crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320UL : 0);
        }
    }
    return ~crc;
}

/* Find the parts of a program. Sums are of 16-bit counts, so 32 bits hold them. */
static hl_result locate(hl_program *p, const uint8_t *bytes, uint32_t size)
{
    if (size < HL_HEADER_BYTES + 4u) {
        return HL_SIZE;
    }
    if (bytes[0] != HL_MAGIC_0 || bytes[1] != HL_MAGIC_1 || bytes[2] != HL_MAGIC_2 || bytes[3] != HL_MAGIC_3) {
        return HL_MAGIC;
    }
    if (bytes[4] != HL_FORMAT_VERSION) {
        return HL_VERSION;
    }
    if (bytes[5] != HL_WORD_BYTES) {
        return HL_WORD;
    }
    if (read_32(bytes + 8) != HL_TABLE_HASH) {
        return HL_TABLE;
    }
    p->period_us = read_32(bytes + 12);
    for (uint8_t k = 0; k < HL_COUNTS; k++) {
        p->count[k] = read_16(bytes + 16 + 2 * k);
    }
    const uint16_t *n = p->count;
    const uint32_t parameters = n[HL_COUNT_CONSTANTS], inputs = parameters + n[HL_COUNT_PARAMETERS];
    const uint32_t states = inputs + n[HL_COUNT_INPUTS], temporaries = states + n[HL_COUNT_STATES];
    const uint32_t init = HL_HEADER_BYTES + 4 * parameters;
    const uint32_t tick = init + HL_WORD_BYTES * (uint32_t)n[HL_COUNT_INIT_WORDS];
    const uint32_t init_moves = tick + HL_WORD_BYTES * (uint32_t)n[HL_COUNT_TICK_WORDS];
    const uint32_t tick_moves = init_moves + 2 * HL_WORD_BYTES * (uint32_t)n[HL_COUNT_INIT_MOVES];
    const uint32_t outputs = tick_moves + 2 * HL_WORD_BYTES * (uint32_t)n[HL_COUNT_TICK_MOVES];
    const uint32_t types = outputs + HL_WORD_BYTES * (uint32_t)n[HL_COUNT_OUTPUTS];
    if (size != types + temporaries + n[HL_COUNT_OUTPUTS] + 4) {
        return HL_SIZE;
    }
    if (temporaries > n[HL_COUNT_REGISTERS]) {
        return HL_REGISTERS;
    }
#if HL_WORD_BITS == 8
    if (n[HL_COUNT_REGISTERS] > 256) {
        return HL_REGISTERS;
    }
#endif
    p->parameters = (uint16_t)parameters;
    p->inputs = (uint16_t)inputs;
    p->states = (uint16_t)states;
    p->temporaries = (uint16_t)temporaries;
    p->init = bytes + init;
    p->tick = bytes + tick;
    p->init_moves = bytes + init_moves;
    p->tick_moves = bytes + tick_moves;
    p->outputs = bytes + outputs;
    p->types = bytes + types;
    return HL_OK;
}

static int is_written(const hl_program *p, const hl_slot *types, uint16_t k)
{
    return k < p->count[HL_COUNT_REGISTERS] && types[k].i != UNWRITTEN;
}

/* One pass over straight-line code. `types` holds the type of what each register holds now. */
static hl_result check_code(const hl_program *p, const uint8_t *pc, uint16_t words, hl_slot *types)
{
    while (words > 1) {
        const uint16_t opcode = WORD(pc, 0);
        if (opcode == HL_OP_END || opcode >= OPCODES || signatures[opcode].result == 0) {
            return HL_OPCODE;
        }
        const signature *s = &signatures[opcode];
        if (words < s->operands + 3u) { /* opcode, destination, operands, and END after them */
            return HL_OPCODE;
        }
        for (uint8_t k = 0; k < s->operands; k++) {
            const uint16_t operand = WORD(pc, 2 + k);
            if (!is_written(p, types, operand) || types[operand].i != s->operand[k]) {
                return HL_OPERAND;
            }
        }
        const uint16_t to = WORD(pc, 1);
        if (to < p->temporaries || to >= p->count[HL_COUNT_REGISTERS]) {
            return HL_OPERAND;
        }
        types[to].i = s->result;
        ADVANCE(pc, 2 + s->operands);
        words = (uint16_t)(words - 2 - s->operands);
    }
    return words == 1 && WORD(pc, 0) == HL_OP_END ? HL_OK : HL_OPCODE;
}

/* Moves go to states and temporaries; a state keeps the type its channel declares. */
static hl_result check_moves(const hl_program *p, const uint8_t *moves, uint16_t count, hl_slot *types)
{
    for (uint16_t k = 0; k < count; k++) {
        const uint16_t to = WORD(moves, 0), from = WORD(moves, 1);
        if (!is_written(p, types, from) || to < p->states || to >= p->count[HL_COUNT_REGISTERS]) {
            return HL_OPERAND;
        }
        if (to < p->temporaries && p->types[to] != types[from].i) {
            return HL_OPERAND;
        }
        types[to].i = types[from].i;
        ADVANCE(moves, 2);
    }
    for (uint16_t k = p->states; k < p->temporaries; k++) {
        if (types[k].i == UNWRITTEN) {
            return HL_UNSET;
        }
    }
    return HL_OK;
}

static hl_result check_outputs(const hl_program *p, const hl_slot *types)
{
    for (uint16_t k = 0; k < p->count[HL_COUNT_OUTPUTS]; k++) {
        const uint16_t from = WORD(p->outputs, k);
        if (!is_written(p, types, from) || types[from].i != hl_output_type(p, k)) {
            return HL_UNSET;
        }
    }
    return HL_OK;
}

/* Start a pass: constants, parameters and inputs are there, states if `with_states`, temporaries not. */
static void begin_pass(const hl_program *p, hl_slot *types, int with_states)
{
    const uint16_t there = with_states ? p->temporaries : p->states;
    for (uint16_t k = 0; k < p->count[HL_COUNT_REGISTERS]; k++) {
        types[k].i = k < there ? p->types[k] : UNWRITTEN;
    }
}

static hl_result check_types(const hl_program *p, const uint8_t *constants)
{
    const uint32_t count = (uint32_t)p->temporaries + p->count[HL_COUNT_OUTPUTS];
    for (uint32_t k = 0; k < count; k++) {
        if (p->types[k] < HL_TYPE_F32 || p->types[k] > HL_TYPE_I32) {
            return HL_TYPE;
        }
    }
    for (uint16_t k = 0; k < p->parameters; k++) {
        if (p->types[k] == HL_TYPE_BOOL && read_32(constants + 4 * (uint32_t)k) > 1) {
            return HL_TYPE;
        }
    }
    return HL_OK;
}

static hl_result check_program(const hl_program *p, hl_slot *types)
{
    hl_result result;
    begin_pass(p, types, 0);
    if ((result = check_code(p, p->init, p->count[HL_COUNT_INIT_WORDS], types)) != HL_OK) {
        return result;
    }
    if ((result = check_moves(p, p->init_moves, p->count[HL_COUNT_INIT_MOVES], types)) != HL_OK) {
        return result;
    }
    begin_pass(p, types, 1);
    if ((result = check_code(p, p->tick, p->count[HL_COUNT_TICK_WORDS], types)) != HL_OK) {
        return result;
    }
    if ((result = check_outputs(p, types)) != HL_OK) {
        return result;
    }
    return check_moves(p, p->tick_moves, p->count[HL_COUNT_TICK_MOVES], types);
}

hl_result hl_verify(hl_program *program, const uint8_t *bytes, uint32_t size, hl_slot *registers, uint16_t capacity)
{
    hl_result result = locate(program, bytes, size);
    if (result != HL_OK) {
        return result;
    }
    if (crc_32(bytes, size - 4) != read_32(bytes + size - 4)) {
        return HL_CRC;
    }
    if (program->count[HL_COUNT_REGISTERS] > capacity) {
        return HL_REGISTERS;
    }
    const uint8_t *constants = bytes + HL_HEADER_BYTES;
    if ((result = check_types(program, constants)) != HL_OK) {
        return result;
    }
    if ((result = check_program(program, registers)) != HL_OK) {
        return result;
    }
    for (uint16_t k = 0; k < program->count[HL_COUNT_REGISTERS]; k++) {
        const uint32_t bits = k < program->parameters ? read_32(constants + 4 * (uint32_t)k) : 0;
        registers[k].i = (int32_t)bits;
    }
    return HL_OK;
}
