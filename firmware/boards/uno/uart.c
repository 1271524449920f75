/* Link: the USART at 500000 baud, which 16 MHz divides exactly. */
#include "uno.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#define TX_BYTES 128 /* a power of two, and more than a frame */
#define TX_AT(k) ((uint8_t)((k) & (TX_BYTES - 1)))

static uint8_t tx[TX_BYTES];
static volatile uint8_t tx_head, tx_tail; /* count freely; written by board_send, by the interrupt */

void uno_uart_begin(void)
{
    UCSR0A = _BV(U2X0); /* before the rate: simavr reads it only then */
    UBRR0 = 3;
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
}

/* Bytes interrupt steps, by dozens in a millisecond, so these two are written by hand: what hl_core_byte does with all
 * bytes of frames that come as they should, and all of sending. Saved: the flags and three registers. */
#define SAVE "push r24\n\t in r24, __SREG__\n\t push r24\n\t push r30\n\t push r31\n\t"
#define RESTORE "pop r31\n\t pop r30\n\t pop r24\n\t out __SREG__, r24\n\t pop r24\n\t"

static volatile uint8_t received;

/* A byte that there is no room or no time for, and the end of a frame with such a byte. */
void __vector_uart_rare(void) __attribute__((signal, used));
void __vector_uart_rare(void)
{
    hl_core_byte(&uno_core, received);
}

/* near the vectors, so that the jump to them is the shorter one */
void USART_RX_vect(void) __attribute__((section(".lowtext")));
void USART_UDRE_vect(void) __attribute__((section(".lowtext")));

ISR(USART_RX_vect, ISR_NAKED)
{
    __asm__ volatile(SAVE
        "lds r24, %[data]\n\t"
        "tst r24\n\t"
        "breq 2f\n\t"
        "lds r30, %[ready]\n\t"
        "tst r30\n\t"
        "brne 1f\n\t"
        "lds r30, %[count]\n\t"
        "cpi r30, %[room]\n\t"
        "brsh 1f\n\t"
        "inc r30\n\t"
        "sts %[count], r30\n\t"
        "ldi r31, 0\n\t"
        "subi r30, lo8(-(%[rx] - 1))\n\t"
        "sbci r31, hi8(-(%[rx] - 1))\n\t"
        "st Z, r24\n\t"
        RESTORE "reti\n"
        "1: sts %[received], r24\n\t"
        RESTORE "jmp __vector_uart_rare\n"
        "2: lds r30, %[ready]\n\t"
        "lds r31, %[bad]\n\t"
        "or r30, r31\n\t"
        "brne 1b\n\t"
        "lds r30, %[count]\n\t"
        "cpse r30, r24\n\t"
        "ldi r24, 1\n\t"
        "sts %[ready], r24\n\t"
        RESTORE "reti"
        ::[data] "n"(_SFR_MEM_ADDR(UDR0)), [ready] "i"(&uno_core.rx_ready), [bad] "i"(&uno_core.rx_bad), [count] "i"(&uno_core.rx_count),
        [room] "n"(HL_WIRE_BYTES), [rx] "i"(uno_core.rx), [received] "i"(&received));
}

ISR(USART_UDRE_vect, ISR_NAKED)
{
    __asm__ volatile(SAVE
        "lds r30, %[tail]\n\t"
        "lds r24, %[head]\n\t"
        "cp r24, r30\n\t"
        "breq 1f\n\t"
        "ldi r24, 1\n\t"
        "add r24, r30\n\t"
        "sts %[tail], r24\n\t"
        "andi r30, %[last]\n\t"
        "ldi r31, 0\n\t"
        "subi r30, lo8(-(%[tx]))\n\t"
        "sbci r31, hi8(-(%[tx]))\n\t"
        "ld r24, Z\n\t"
        "sts %[data], r24\n\t"
        RESTORE "reti\n"
        "1: ldi r24, %[idle]\n\t"
        "sts %[control], r24\n\t"
        RESTORE "reti"
        ::[data] "n"(_SFR_MEM_ADDR(UDR0)), [control] "n"(_SFR_MEM_ADDR(UCSR0B)), [tail] "i"(&tx_tail), [head] "i"(&tx_head),
        [tx] "i"(tx), [last] "n"(TX_BYTES - 1), [idle] "n"(_BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0)));
}

uint8_t board_send(hl_core *core, const uint8_t *bytes, uint8_t count)
{
    (void)core;
    uint8_t head = tx_head;
    if (count > TX_BYTES - (uint8_t)(head - tx_tail))
        return 0;
    while (count--)
        tx[TX_AT(head++)] = *bytes++;
    __asm__ volatile("" ::: "memory"); /* the bytes are there before the interrupt may take them */
    tx_head = head;
    UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0) | _BV(UDRIE0);
    return 1;
}
