/* Written by hapticlab/compiler/boards/c_headers.py: change the Python tables, not this file. */

#ifndef HL_OPCODES_H
#define HL_OPCODES_H

#define HL_TABLE_HASH 0x51336eefUL
#define HL_FORMAT_VERSION 1
#define HL_MAGIC_0 0x48
#define HL_MAGIC_1 0x4c
#define HL_MAGIC_2 0x56
#define HL_MAGIC_3 0x4d
#define HL_HEADER_BYTES 36
#define HL_OP_END 0

/* order of the counts in the header, 16 bits each */
enum {
    HL_COUNT_REGISTERS,
    HL_COUNT_CONSTANTS,
    HL_COUNT_PARAMETERS,
    HL_COUNT_INPUTS,
    HL_COUNT_STATES,
    HL_COUNT_OUTPUTS,
    HL_COUNT_INIT_WORDS,
    HL_COUNT_TICK_WORDS,
    HL_COUNT_INIT_MOVES,
    HL_COUNT_TICK_MOVES,
    HL_COUNTS
};

enum {
    HL_TYPE_F32 = 1,
    HL_TYPE_BOOL = 2,
    HL_TYPE_I32 = 3,
};

/* what hl_verify, hl_init and hl_tick return */
typedef enum {
    HL_OK = 0, /* nothing is wrong */
    HL_SIZE = 1, /* the program is incomplete, or longer than its header says: send it again */
    HL_MAGIC = 2, /* these bytes are not a program: send one made by hapticlab */
    HL_VERSION = 3, /* another format version: flash the firmware of this hapticlab */
    HL_WORD = 4, /* another word size: encode the program for this board */
    HL_TABLE = 5, /* another table of operations: flash the firmware of this hapticlab */
    HL_CRC = 6, /* the program was changed during transfer: send it again */
    HL_REGISTERS = 7, /* more registers than the board has: use a smaller scene or fewer substeps */
    HL_TYPE = 8, /* a type byte or a bool constant has no meaning */
    HL_OPCODE = 9, /* an instruction has no meaning, or the code does not end where it should */
    HL_OPERAND = 10, /* an operand is not an earlier result of the right type */
    HL_UNSET = 11, /* a state or an output has no value of its type */
    HL_OUTPUT_NOT_FINITE = 12, /* an output is nan or infinite: look for a division by zero or an unstable scene */
    HL_STATE_NOT_FINITE = 13, /* a state is nan or infinite: look for a division by zero or an unstable scene */
} hl_result;

/* X(name, number, operands, type of the result, types of the operands or 0) */
#define HL_OPERATIONS(X) \
    X(NEG, 1, 1, 1, 1, 0, 0) \
    X(ABS, 2, 1, 1, 1, 0, 0) \
    X(ADD, 3, 2, 1, 1, 1, 0) \
    X(SUB, 4, 2, 1, 1, 1, 0) \
    X(MUL, 5, 2, 1, 1, 1, 0) \
    X(DIV, 6, 2, 1, 1, 1, 0) \
    X(SQRT, 7, 1, 1, 1, 0, 0) \
    X(FLOOR, 8, 1, 1, 1, 0, 0) \
    X(LT, 9, 2, 2, 1, 1, 0) \
    X(LE, 10, 2, 2, 1, 1, 0) \
    X(EQ, 11, 2, 2, 1, 1, 0) \
    X(AND, 12, 2, 2, 2, 2, 0) \
    X(OR, 13, 2, 2, 2, 2, 0) \
    X(NOT, 14, 1, 2, 2, 0, 0) \
    X(SELECT, 15, 3, 1, 2, 1, 1) \
    X(SIN, 16, 1, 1, 1, 0, 0) \
    X(COS, 17, 1, 1, 1, 0, 0) \
    X(EXP, 18, 1, 1, 1, 0, 0) \
    X(LOG, 19, 1, 1, 1, 0, 0) \
    X(ATAN, 20, 1, 1, 1, 0, 0) \
    X(TANH, 21, 1, 1, 1, 0, 0) \
    X(EXP2I, 22, 1, 1, 1, 0, 0) \
    X(EXPONENT, 23, 1, 1, 1, 0, 0) \
    X(IADD, 24, 2, 3, 3, 3, 0) \
    X(ITOF, 25, 1, 1, 3, 0, 0)

#endif
