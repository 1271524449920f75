/* Arduino Uno (ATmega328P at 16 MHz) on a Hapkit: what board.h asks for. */
#ifndef HL_BOARD_CONSTANTS_H
#define HL_BOARD_CONSTANTS_H

#define HL_BOARD_NAME "uno"
#define HL_WORD_BITS 8
#define HL_ARENA_BYTES 848 /* the stack takes what is left: test_uno_image.py knows how much it may need */
#define HL_SLOTS 1
#define HL_CHANNELS 8
#define HL_RING 4
#define HL_CLOCK_HZ 2000000UL /* timer 1, prescaler 8 */
#define HL_DUTY_FULL 256 /* of 256 clocks of the carrier the pin is high for as many as the duty says */
#define HL_PERIOD_MIN_US 250
#define HL_PERIOD_MAX_US 10000 /* the clock turns every 32768 us */
#define HL_STORE_BYTES 1024

#endif
