/* An ATmega in simavr with a bootloader, seen from its serial line, in virtual time. For tests only: simavr is GPL. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_io.h>

enum { UCSR0A = 0xC0, UBRR0L = 0xC4, U2X = 2, MCUSR = 0x54, EXTRF = 2, SAID = 1 << 16 };

typedef struct {
    avr_t *avr;
    avr_irq_t *input;
    avr_uart_t *uart;
    uint8_t said[SAID];
    uint32_t first, last;
} board;

static void on_output(struct avr_irq_t *irq, uint32_t value, void *param) {
    board *b = param;
    (void)irq;
    b->said[b->last++ % SAID] = (uint8_t)value;
}

static void quiet(avr_t *avr, const int level, const char *format, va_list arguments) {
    (void)avr, (void)level, (void)format, (void)arguments;
}

/* As the line from the USB bridge does: an external reset, which is what the bootloader looks for. */
void board_reset(board *b) {
    avr_reset(b->avr);
    b->avr->data[MCUSR] = EXTRF;
}

board *board_new(const char *chip, uint32_t bootloader) {
    avr_global_logger_set(quiet);
    board *b = calloc(1, sizeof *b);
    b->avr = avr_make_mcu_by_name(chip);
    if (!b->avr || avr_init(b->avr)) return NULL;
    b->avr->frequency = 16000000;
    memset(b->avr->flash, 0xFF, b->avr->flashend + 1);
    b->avr->reset_pc = bootloader;
    b->avr->codeend = b->avr->flashend;
    uint32_t flags = 0; /* no sleeping of the host while the firmware polls, nothing on standard output */
    avr_ioctl(b->avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    for (avr_io_t *io = b->avr->io_port; io; io = io->next)
        if (!strcmp(io->kind, "uart")) b->uart = (avr_uart_t *)io;
    b->input = avr_io_getirq(b->avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    avr_irq_register_notify(avr_io_getirq(b->avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_output, b);
    return b;
}

void board_free(board *b) {
    avr_terminate(b->avr);
    free(b);
}

uint8_t *board_flash(board *b) { return b->avr->flash; }
uint8_t *board_data(board *b) { return b->avr->data; }
uint32_t board_pc(board *b) { return b->avr->pc; }
uint64_t board_cycle(board *b) { return b->avr->cycle; }

/* Cycles of one byte, as the firmware has set its UART. */
uint32_t board_byte_cycles(board *b) {
    uint8_t *data = b->avr->data;
    return 10u * (data[UCSR0A] & U2X ? 8u : 16u) * (1u + data[UBRR0L] + 256u * (data[UBRR0L + 1] & 15u));
}

/* Run until a cycle, or until so many bytes wait; return how many wait. */
uint32_t board_run(board *b, uint64_t until, uint32_t enough) {
    while (b->avr->cycle < until && b->last - b->first < enough) {
        int state = avr_run(b->avr);
        if (state == cpu_Done || state == cpu_Crashed) break;
    }
    return b->last - b->first;
}

void board_hear(board *b, uint32_t value) {
    b->uart->cycles_per_byte = board_byte_cycles(b); /* simavr 1.6 counts a parity bit that is not there */
    avr_raise_irq(b->input, value);
}

uint32_t board_say(board *b, uint8_t *into, uint32_t most) {
    uint32_t n = 0;
    while (n < most && b->first != b->last) into[n++] = b->said[b->first++ % SAID];
    return n;
}
