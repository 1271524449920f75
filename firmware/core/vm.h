/* The virtual machine: runs a verified straight-line program, one call a sample.
 *
 * No allocation, no recursion, no loop that a program controls. The caller gives one array of registers; the program's
 * bytes stay where they are and may be const. The format is described in hapticlab/compiler/engines/bytecode.py.
 *
 *     hl_program program;
 *     if (hl_verify(&program, bytes, size, registers, capacity) == HL_OK) {
 *         registers[program.parameters + k].f = ...;       once, and whenever a parameter changes
 *         registers[program.inputs + k].f = ...;           every sample
 *         hl_init(&program, registers);                    after the first sample
 *         hl_tick(&program, registers, outputs);           every sample
 *     } */
#ifndef HL_VM_H
#define HL_VM_H

#include "mathf.h"
#include "opcodes.h"

#include <stdint.h>

#ifndef HL_WORD_BITS
#define HL_WORD_BITS 8
#endif
#if HL_WORD_BITS != 8 && HL_WORD_BITS != 16
#error "HL_WORD_BITS is 8 or 16"
#endif
#define HL_WORD_BYTES (HL_WORD_BITS / 8)

/* Where the parts of a verified program are. */
typedef struct {
    uint32_t period_us;
    uint16_t count[HL_COUNTS];
    uint16_t parameters, inputs, states, temporaries; /* first register of each */
    const uint8_t *init, *tick, *init_moves, *tick_moves, *outputs, *types;
} hl_program;

/* Check everything about a program once, and leave its constants in the registers. Nothing runs before this is HL_OK.
 * registers: working memory of `capacity` slots, overwritten. */
hl_result hl_verify(hl_program *program, const uint8_t *bytes, uint32_t size, hl_slot *registers, uint16_t capacity);

/* Make the first states from the inputs and parameters in the registers. */
hl_result hl_init(const hl_program *program, hl_slot *registers);

/* Run one sample: write the outputs, carry the states. A result other than HL_OK says that a number is not finite:
 * the outputs are not fit for a motor. */
hl_result hl_tick(const hl_program *program, hl_slot *registers, hl_slot *outputs);

/* The type of output k, HL_TYPE_F32 and so on. */
uint8_t hl_output_type(const hl_program *program, uint16_t k);

#endif
