/* Words of a program, 1 or 2 bytes each, low byte first, at any address. */
#ifndef HL_WORD_H
#define HL_WORD_H

#include "vm.h"

#if HL_WORD_BITS == 8
#define WORD(p, k) ((p)[k])
#else
#define WORD(p, k) ((uint16_t)((p)[2 * (k)] | (unsigned)(p)[2 * (k) + 1] << 8))
#endif
#define ADVANCE(p, words) ((p) += (words) * HL_WORD_BYTES)

enum {
#define NUMBER(name, number, operands, result, a, b, c) OP_##name = number,
    HL_OPERATIONS(NUMBER)
#undef NUMBER
    OPCODES
};

#endif
