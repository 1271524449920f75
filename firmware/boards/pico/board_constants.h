/* Raspberry Pi Pico (RP2040 at 125 MHz): what board.h asks for. */
#ifndef HL_BOARD_CONSTANTS_H
#define HL_BOARD_CONSTANTS_H

#define HL_BOARD_NAME "pico"
#define HL_WORD_BITS 8
#define HL_ARENA_BYTES 16384
#define HL_SLOTS 2
#define HL_CHANNELS 10
#define HL_RING 256 /* 25 ms at 10 kHz: a computer asks for USB data about once a millisecond, and sometimes later */
#define HL_CLOCK_HZ 1000000UL /* the chip's timer */
#define HL_DUTY_FULL 4096
#define HL_PERIOD_MIN_US 100
#define HL_PERIOD_MAX_US 10000 /* the clock turns every 65536 us */
#define HL_READING_BITS 32
#define HL_STORE_BYTES 4080 /* a sector of flash less its header */

#endif
