/* The seam: what a board gives the portable core, and what it calls.
 *
 * A board is a folder with board_constants.h, these functions, and a main that calls hl_core_start once, hl_core_tick
 * from its timer, hl_core_byte for every byte that arrives, and hl_core_poll for ever. The core is the first member of
 * whatever the board keeps about itself, so that a board may have more than one (the host does).
 *
 * board_constants.h defines:
 *   HL_BOARD_NAME        up to 8 characters
 *   HL_WORD_BITS         8 or 16, of a program's words
 *   HL_ARENA_BYTES       memory of one program: its bytes, then its registers; a multiple of 4
 *   HL_SLOTS             2 where a new program may be loaded while the old one runs, else 1
 *   HL_CHANNELS          numbers of one sample, x, v and F included
 *   HL_RING              samples kept until the link has room; a power of two
 *   HL_CLOCK_HZ          of board_clock
 *   HL_DUTY_FULL         the largest duty
 *   HL_PERIOD_MIN_US, HL_PERIOD_MAX_US
 *   HL_READING_BITS      32 where an encoder's count has 32 bits; 16 if it is not defined
 *   HL_STORE_BYTES       of the memory that survives power-off: two copies of the settings, the standalone program behind them */
#ifndef HL_BOARD_H
#define HL_BOARD_H

#include "core.h"

/* The handle's sensor, raw: an angle sensor's reading, which repeats after settings.wrap counts, or the low bits of an
 * encoder's running count. Called once a tick; the core unwraps it, and judges what cannot be a motion. A sensor that
 * cannot be right calls hl_core_fault(core, HL_FAULT_SENSOR, reading) and returns what it returned before. */
hl_reading board_reading(hl_core *core);

/* Whether this board can do that wiring: sensor, drive, pins and carrier; every number is within its range. */
uint8_t board_accepts(const hl_settings *settings);

/* Drive the motor: duty from -HL_DUTY_FULL to HL_DUTY_FULL, positive pushes the handle to larger counts' positions as
 * the core sees them. 0 switches the driver off at once. Callable from anywhere. */
void board_motor(hl_core *core, int16_t duty);

/* A free-running clock of HL_CLOCK_HZ, 16 bits; one turn is longer than two of the longest periods. */
uint16_t board_clock(hl_core *core);

/* Call hl_core_tick every `us` from now on; the grid does not drift, and a tick that comes late is not repeated. */
void board_period(hl_core *core, uint16_t us);

/* Take `count` bytes for the link if all of them have room; return whether they had. */
uint8_t board_send(hl_core *core, const uint8_t *bytes, uint8_t count);

/* The memory that survives power-off. Written in IDLE only. board_store_write returns whether the bytes are there. */
void board_store_read(hl_core *core, uint16_t address, uint8_t *bytes, uint16_t count);
uint8_t board_store_write(hl_core *core, uint16_t address, const uint8_t *bytes, uint16_t count);

/* Hold the tick off, and let it in again: what stands between them happens between two samples. Not nested. */
void board_lock(hl_core *core);
void board_unlock(hl_core *core);

/* HL_RESET_..., as far as the bootloader leaves it. */
uint8_t board_reset_cause(hl_core *core);

/* Take the wiring in core->settings into use: the sensor always, the motor's pins only where `wired` says that a person
 * has confirmed them; else they stay low, or inputs. Called with the motor off; the sensor may begin anywhere. */
void board_configure(hl_core *core);

/* Called from hl_core_poll: feed the hardware watchdog if the tick ran since, look at the stack's guard. */
void board_alive(hl_core *core);

#endif
