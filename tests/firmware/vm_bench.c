/* The virtual machine alone in an image, for emulators that write its memory, call its functions and count. */
#include "vm.h"

#ifndef BENCH_ARENA
#define BENCH_ARENA 1600
#endif

/* as the core lays them: a program's bytes, then its registers; the outputs last */
union {
    uint8_t bytes[BENCH_ARENA];
    hl_slot slots[BENCH_ARENA / 4];
} arena;
hl_program program;

/* Never run to its end: it keeps what is called from outside. */
int main(void)
{
    if (hl_verify(&program, arena.bytes, BENCH_ARENA, arena.slots, 0) == HL_OK) {
        hl_init(&program, arena.slots);
        hl_tick(&program, arena.slots, arena.slots);
    }
    for (;;) {
    }
}
