/* Calls functions of a bare AVR image on simavr's processor core, and counts their cycles.
 *
 * Nothing but the core runs: no timers, no interrupts. A call begins with the stack empty and ends when the function
 * has returned to address 0, so the figure is of the function's own instructions, its `ret` included. */
#include <simavr/avr_ioport.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_core.h>

#include <stdint.h>
#include <string.h>

enum { RETURN = 0, STACK_POINTER = 0x5d, CALL_CYCLES = 4 };

avr_t *bare_open(const char *mcu, uint8_t *code, uint32_t size)
{
    avr_t *avr = avr_make_mcu_by_name(mcu);
    if (avr) {
        avr_init(avr);
        avr->frequency = 16000000;
        avr_loadcode(avr, code, size, 0);
    }
    return avr;
}

uint8_t *bare_memory(avr_t *avr)
{
    return avr->data;
}

/* Run until pc is `stop`; return the cycles, or -1 if it took more than `most` or crashed. */
int64_t bare_run(avr_t *avr, uint32_t stop, int64_t most)
{
    const avr_cycle_count_t begin = avr->cycle;
    do {
        avr->run_cycle_count = 0; /* one instruction, not a burst */
        avr->pc = avr_run_one(avr);
        if ((int64_t)(avr->cycle - begin) > most || avr->state == cpu_Crashed) {
            return -1;
        }
    } while (avr->pc != stop);
    return (int64_t)(avr->cycle - begin);
}

/* Call the function at `pc` with 16-bit arguments, as avr-gcc does: the first in r25:r24, the next two registers lower.
 * The cycles are those of a `call` and of all until the function has returned. */
int64_t bare_call(avr_t *avr, uint32_t pc, const uint16_t *arguments, int count, int64_t most)
{
    const uint16_t top = avr->ramend - 2;
    for (int k = 0; k < count; k++) {
        avr->data[24 - 2 * k] = arguments[k] & 255;
        avr->data[25 - 2 * k] = arguments[k] >> 8;
    }
    avr->data[1] = 0; /* what the compiler takes for zero */
    avr->data[top + 1] = avr->data[top + 2] = RETURN;
    avr->data[STACK_POINTER] = top & 255;
    avr->data[STACK_POINTER + 1] = (uint8_t)(top >> 8);
    avr->pc = pc;
    const int64_t cycles = bare_run(avr, RETURN, most);
    return cycles < 0 ? cycles : cycles + CALL_CYCLES;
}

/* One call a row: write the row's bytes, call, read the row's bytes, count. Returns how many rows returned. */
int64_t bare_rows(avr_t *avr, uint32_t pc, const uint16_t *arguments, int count, int64_t rows, uint16_t to, int in_bytes,
                  const uint8_t *in, uint16_t from, int out_bytes, uint8_t *out, uint32_t *cycles)
{
    for (int64_t k = 0; k < rows; k++) {
        memcpy(avr->data + to, in + k * in_bytes, (size_t)in_bytes);
        const int64_t taken = bare_call(avr, pc, arguments, count, 10000000);
        if (taken < 0) {
            return k;
        }
        memcpy(out + k * out_bytes, avr->data + from, (size_t)out_bytes);
        cycles[k] = (uint32_t)taken;
    }
    return rows;
}
