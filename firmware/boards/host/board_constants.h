/* This computer as a board. HL_WORD_BITS is given by the build. */
#ifndef HL_BOARD_CONSTANTS_H
#define HL_BOARD_CONSTANTS_H

#define HL_BOARD_NAME "host"
#define HL_ARENA_BYTES 32768
#ifndef HL_SLOTS /* as on a board of little memory: 1 */
#define HL_SLOTS 2
#endif
#define HL_CHANNELS 10
#define HL_RING 64
#define HL_CLOCK_HZ 1000000
#define HL_DUTY_FULL 32767
#define HL_PERIOD_MIN_US 50
#define HL_PERIOD_MAX_US 30000
#define HL_READING_BITS 32 /* a simulated encoder may be as fine as an ideal one */
#define HL_STORE_BYTES 4096

#endif
