/* Reads programs from standard input, each a 32-bit length and its bytes; a line says what the machine makes of each.
 * Built with sanitizers by the tests: every program lies in memory of exactly its length. */
#include "vm.h"

#include <stdio.h>
#include <stdlib.h>

enum { CAPACITY = 128 };

static uint32_t bits_of(hl_slot s)
{
    return (uint32_t)s.i;
}

/* Two samples of a program that verified; returns a sum of what came out. */
static uint32_t run(const hl_program *p, hl_slot *registers, hl_result *result)
{
    hl_slot *outputs = malloc((p->count[HL_COUNT_OUTPUTS] + 1u) * sizeof *outputs);
    uint32_t sum = 0;
    *result = hl_init(p, registers);
    for (int tick = 0; outputs && tick < 2; tick++) {
        *result = hl_tick(p, registers, outputs);
        for (uint16_t k = 0; k < p->count[HL_COUNT_OUTPUTS]; k++) {
            sum = sum * 31 + bits_of(outputs[k]);
        }
    }
    free(outputs);
    return sum;
}

int main(void)
{
    uint8_t length[4];
    while (fread(length, 1, 4, stdin) == 4) {
        const uint32_t low = length[0] | (uint32_t)length[1] << 8, high = length[2] | (uint32_t)length[3] << 8;
        const uint32_t size = low | high << 16;
        uint8_t *bytes = malloc(size ? size : 1);
        hl_slot *registers = malloc(CAPACITY * sizeof *registers);
        hl_program program;
        hl_result ran = HL_OK;
        if (!bytes || !registers || fread(bytes, 1, size, stdin) != size) {
            return 1;
        }
        const hl_result verified = hl_verify(&program, bytes, size, registers, CAPACITY);
        const uint32_t sum = verified == HL_OK ? run(&program, registers, &ran) : 0;
        printf("%d %d %lu\n", (int)verified, (int)ran, (unsigned long)sum);
        free(registers);
        free(bytes);
    }
    return 0;
}
