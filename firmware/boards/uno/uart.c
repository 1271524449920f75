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

ISR(USART_RX_vect)
{
    hl_core_byte(&uno_core, UDR0);
}

ISR(USART_UDRE_vect)
{
    uint8_t tail = tx_tail;
    if (tail == tx_head) {
        UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
        return;
    }
    UDR0 = tx[TX_AT(tail)];
    tx_tail = (uint8_t)(tail + 1);
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
