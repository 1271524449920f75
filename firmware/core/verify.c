#include "crc.h"
#include "flash.h"
#include "word.h"

enum { UNWRITTEN = 0 };

typedef struct {
    uint8_t operands, result, operand[3];
} signature;

static const signature signatures[OPCODES] HL_FLASH = {
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
        if (opcode == HL_OP_END || opcode >= OPCODES || HL_FLASH_BYTE(&signatures[opcode].result) == 0) {
            return HL_OPCODE;
        }
        const signature *s = &signatures[opcode];
        const uint8_t operands = HL_FLASH_BYTE(&s->operands);
        if (words < operands + 3u) { /* opcode, destination, operands, and END after them */
            return HL_OPCODE;
        }
        for (uint8_t k = 0; k < operands; k++) {
            const uint16_t operand = WORD(pc, 2 + k);
            if (!is_written(p, types, operand) || types[operand].i != HL_FLASH_BYTE(&s->operand[k])) {
                return HL_OPERAND;
            }
        }
        const uint16_t to = WORD(pc, 1);
        if (to < p->temporaries || to >= p->count[HL_COUNT_REGISTERS]) {
            return HL_OPERAND;
        }
        types[to].i = HL_FLASH_BYTE(&s->result);
        ADVANCE(pc, 2 + operands);
        words = (uint16_t)(words - 2 - operands);
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
    if (hl_crc32(0, bytes, (size_t)(size - 4)) != read_32(bytes + size - 4)) {
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
