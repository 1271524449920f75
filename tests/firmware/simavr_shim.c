/* An Arduino Uno in simavr, in lockstep: for ctypes, see emulator.py. Compiled by the tests, never shipped.
 *
 * What simavr 1.6 does not do, this does: masked interrupts wait, bytes take the UART's true time both ways and overrun
 * its two-byte buffer, the EEPROM takes 3.4 ms a byte, the ADC holds its input as the conversion begins, 1 mV on a pin
 * is one of its counts, and the SPI has a sensor at the other end. */
#include "simavr_paddle.h"

#include <simavr/avr_adc.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_io.h>

#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

DEFINE_FIFO(uint8_t, uart_fifo);

enum { QUEUE = 1 << 16, LOG = 1 << 14, VECTORS = 26, RX_BUFFER = 3 /* two bytes, and the shift register */ };
enum { /* addresses of the ATmega328P's registers */
    DDRB = 0x24, PORTB = 0x25, DDRC = 0x27, PORTC = 0x28, DDRD = 0x2A, PORTD = 0x2B, TIFR1 = 0x36, EECR = 0x3F,
    TCCR0A = 0x44, TCCR0B = 0x45, OCR0A = 0x47, OCR0B = 0x48, SPCR = 0x4C, SPSR = 0x4D, SPDR = 0x4E, MCUSR = 0x54,
    TIMSK1 = 0x6F, ADCSRA = 0x7A, ADMUX = 0x7C, TCCR2A = 0xB0, TCCR2B = 0xB1, OCR2A = 0xB3, OCR2B = 0xB4,
    UCSR0A = 0xC0, UCSR0B = 0xC1, UBRR0L = 0xC4, UBRR0H = 0xC5
};
enum { SPI_MODE_1 = 0x54 /* SPE, MSTR, CPHA of SPCR */, SPIF = 0x80 };
enum { ONE_UPDATE = 400 /* cycles in which a motor's registers are written one after the other */ };
enum { EEPE = 2, EEMPE = 4 }; /* bits of EECR */
enum { ADEN = 0x80, ADSC = 0x40, ADPS = 7 }; /* of ADCSRA */

typedef struct { uint64_t cycle; int32_t value; } event;
typedef struct { uint64_t begin, count, total, worst; } cost;
typedef struct { event at[LOG]; uint64_t count; } event_log;
typedef struct { double from, to; uint64_t begin, end; } flight; /* of a voltage, from one level to another */

typedef struct {
    avr_t *avr;
    avr_uart_t *uart;
    uint8_t in[QUEUE];
    uint64_t in_head, in_tail;
    event out[QUEUE];
    uint64_t out_head, out_tail, out_free; /* out_free: when the line is idle again */
    uint64_t in_busy, overruns;
    event_log duty, pin;                   /* changes, the latest LOG of them */
    event_log sample, update;              /* conversions begun; the motor's registers written, changes or not */
    driver driver;
    as5048a sensor;
    flight analog[8];
    uint8_t received;                      /* by the SPI */
    cost costs[VECTORS];
    struct vector { struct uno *uno; int number; } vectors[VECTORS];
    avr_ioport_external_t driven;          /* pins of port D */
    struct { avr_io_write_t call; void *param; } then[MAX_IOs]; /* simavr's own hooks, behind ours */
} uno;

static void silent(avr_t *avr, const int level, const char *format, va_list arguments)
{
    (void)avr, (void)level, (void)format, (void)arguments;
}

static void append(event_log *log, uint64_t cycle, int32_t value)
{
    log->at[log->count++ % LOG] = (event){cycle, value};
}

static void note(event_log *log, uint64_t cycle, int32_t value)
{
    if (!log->count || log->at[(log->count - 1) % LOG].value != value)
        append(log, cycle, value);
}

/* Signed duty of the motor in 256ths. */
int uno_duty(uno *u) { return driver_duty(&u->driver, u->avr->data); }

/* simavr shares a register between hooks four times in all: too few. */
static void hook(uno *u, avr_io_addr_t address, avr_io_write_t call, int replace)
{
    const int k = AVR_DATA_TO_IO(address);
    if (!replace) {
        u->then[k].call = u->avr->io[k].w.c;
        u->then[k].param = u->avr->io[k].w.param;
    }
    u->avr->io[k].w.c = call;
    u->avr->io[k].w.param = u;
}

static void write_through(uno *u, avr_io_addr_t address, uint8_t value)
{
    const int k = AVR_DATA_TO_IO(address);
    if (u->then[k].call)
        u->then[k].call(u->avr, address, value, u->then[k].param);
    else
        u->avr->data[address] = value;
}

static void on_motor(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    uno *u = param;
    const uint64_t last = u->update.count ? u->update.at[(u->update.count - 1) % LOG].cycle : 0;
    write_through(u, address, value);
    driver_look(&u->driver, avr->data);
    as5048a_look(&u->sensor, avr->data, avr->cycle);
    note(&u->duty, avr->cycle, uno_duty(u));
    if (address < TCCR0A) /* a port */
        return;
    u->update.count -= last && avr->cycle - last < ONE_UPDATE;
    append(&u->update, avr->cycle, uno_duty(u));
}

static double level(const flight *f, uint64_t cycle)
{
    const double part = cycle >= f->end ? 1.0 : cycle <= f->begin ? 0.0 : (double)(cycle - f->begin) / (double)(f->end - f->begin);
    return f->from + part * (f->to - f->from);
}

static void on_conversion(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    uno *u = param;
    if ((value & ADEN) && (value & ADSC)) {
        const int divider = 1 << ((value & ADPS) ? value & ADPS : 1), channel = avr->data[ADMUX] & 7;
        append(&u->sample, avr->cycle, divider);
        const double held = level(&u->analog[channel], avr->cycle + (uint64_t)(3 * divider / 2));
        avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, channel), (uint32_t)(held + 0.5));
    }
    write_through(u, address, value);
}

static avr_cycle_count_t on_exchanged(avr_t *avr, avr_cycle_count_t when, void *param)
{
    uno *u = param;
    (void)when;
    avr->data[SPSR] |= SPIF;
    avr->data[SPDR] = u->received;
    return 0;
}

/* A byte for the SPI. What a slave in another mode would hear is no word of its language. */
static void on_exchange(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    uno *u = param;
    static const int DIVIDERS[] = {4, 16, 64, 128};
    const int divider = DIVIDERS[avr->data[SPCR] & 3] / (avr->data[SPSR] & 1 ? 2 : 1);
    (void)address;
    if ((avr->data[SPCR] & 0x50) != 0x50)
        return;
    const uint8_t mode_1 = (avr->data[SPCR] & 0x7C) == SPI_MODE_1;
    u->received = as5048a_exchange(&u->sensor, mode_1 ? value : (uint8_t)(value >> 1), avr->cycle);
    avr->data[SPSR] &= (uint8_t)~SPIF;
    avr_cycle_timer_register(avr, (avr_cycle_count_t)(8 * divider), on_exchanged, u);
}

static uint8_t on_received(avr_t *avr, avr_io_addr_t address, void *param)
{
    (void)address;
    avr->data[SPSR] &= (uint8_t)~SPIF;
    return ((uno *)param)->received;
}

static void on_pin(avr_irq_t *irq, uint32_t value, void *param)
{
    uno *u = param;
    (void)irq;
    note(&u->pin, u->avr->cycle, (int32_t)(value & 1));
}

/* simavr counts a parity bit, and takes no notice of U2X when it comes late. */
static void on_uart(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    uno *u = param;
    write_through(u, address, value);
    const unsigned divider = 1u + avr->data[UBRR0L] + 256u * (avr->data[UBRR0H] & 15u);
    u->uart->cycles_per_byte = 10u * divider * (avr->data[UCSR0A] & 2 ? 8u : 16u);
}

/* simavr forgets an interrupt that was flagged while it was masked; the processor takes it when the mask goes. */
static void on_mask(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    write_through(param, address, value);
    for (int k = 0; k < avr->interrupts.vector_count && value & avr->data[TIFR1] & 2; k++)
        if (avr->interrupts.vector[k]->vector == 11) /* timer 1, compare A */
            avr_raise_interrupt(avr, avr->interrupts.vector[k]);
}

static avr_cycle_count_t on_stored(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)when, (void)param;
    avr->data[EECR] &= (uint8_t)~EEPE;
    return 0;
}

/* simavr stores a byte at once; the chip is busy for 3.4 ms. */
static void on_store(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    const int begins = (avr->data[EECR] & EEMPE) && (value & EEPE);
    write_through(param, address, value);
    if (begins) {
        avr->data[EECR] |= EEPE;
        avr_cycle_timer_register(avr, 54400, on_stored, param);
    }
}

static void on_sent(avr_irq_t *irq, uint32_t value, void *param)
{
    uno *u = param;
    (void)irq;
    const uint64_t now = u->avr->cycle, start = u->out_free > now ? u->out_free : now;
    u->out_free = start + u->uart->cycles_per_byte;
    u->out[u->out_head++ % QUEUE] = (event){u->out_free, (int32_t)(value & 255)};
}

/* A byte begins on the line: simavr raises its interrupt one byte's time later. */
static avr_cycle_count_t on_line(avr_t *avr, avr_cycle_count_t when, void *param)
{
    uno *u = param;
    const int waiting = uart_fifo_get_read_size(&u->uart->input);
    if (u->in_tail == u->in_head)
        return 0;
    const uint8_t byte = u->in[u->in_tail++ % QUEUE];
    if (waiting >= RX_BUFFER)
        u->overruns++;
    else
        avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), byte);
    u->in_busy = when + u->uart->cycles_per_byte;
    return u->in_busy;
}

static void on_interrupt(avr_irq_t *irq, uint32_t value, void *param)
{
    struct vector *vector = param;
    uno *u = (uno *)vector->uno;
    (void)irq;
    cost *c = &u->costs[vector->number];
    if (value) {
        c->begin = u->avr->cycle;
        return;
    }
    const uint64_t cycles = u->avr->cycle - c->begin;
    c->count++;
    c->total += cycles;
    c->worst = cycles > c->worst ? cycles : c->worst;
}

static void hook_registers(uno *u, int carrier)
{
    const avr_io_addr_t timer[] = {TCCR0A, TCCR0B, OCR0A, OCR0B, TCCR2A, TCCR2B, OCR2A, OCR2B};
    const avr_io_addr_t port[] = {PORTB, PORTC, PORTD, DDRB, DDRC, DDRD}, link[] = {UCSR0B, UBRR0L};
    for (int k = 0; k < 8; k++)
        hook(u, timer[k], on_motor, !carrier);
    for (int k = 0; k < 6; k++)
        hook(u, port[k], on_motor, 0);
    for (int k = 0; k < 2; k++)
        hook(u, link[k], on_uart, 0);
    hook(u, EECR, on_store, 0);
    hook(u, ADCSRA, on_conversion, 0);
    hook(u, SPDR, on_exchange, 1);
    u->avr->io[AVR_DATA_TO_IO(SPDR)].r.c = on_received;
    u->avr->io[AVR_DATA_TO_IO(SPDR)].r.param = u;
    hook(u, TIMSK1, on_mask, 0);
}

/* carrier: a pin of port D whose timer runs in simavr, too, so that it has edges; the duty needs only registers, and time. */
uno *uno_new(const uint8_t *flash, uint32_t size, int carrier)
{
    uno *u = calloc(1, sizeof *u);
    avr_global_logger_set(silent);
    u->avr = avr_make_mcu_by_name("atmega328p");
    avr_init(u->avr);
    u->avr->frequency = 16000000;
    u->avr->vcc = u->avr->avcc = u->avr->aref = 1023; /* 1 mV is a count */
    avr_loadcode(u->avr, (uint8_t *)flash, size, 0);
    u->avr->codeend = size;
    for (avr_io_t *io = u->avr->io_port; io; io = io->next)
        if (!strcmp(io->kind, "uart"))
            u->uart = (avr_uart_t *)io;
    uint32_t none = 0;
    avr_ioctl(u->avr, AVR_IOCTL_UART_SET_FLAGS('0'), &none);
    avr_irq_register_notify(avr_io_getirq(u->avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_sent, u);
    avr_irq_register_notify(avr_io_getirq(u->avr, AVR_IOCTL_IOPORT_GETIRQ('D'), carrier ? carrier : 5), on_pin, u);
    hook_registers(u, carrier);
    u->driver = (driver){.drive = PWM_DIRECTION, .pins = {5, 8, NO_PIN, NO_PIN}, .held = 0xff};
    u->sensor = (as5048a){.select = NO_PIN, .diagnostics = 0x0140};
    u->driven.name = 'D';
    for (int k = 1; k < VECTORS; k++) {
        u->vectors[k] = (struct vector){(struct uno *)u, k};
        avr_irq_t *irq = avr_get_interrupt_irq(u->avr, (uint8_t)k);
        if (irq)
            avr_irq_register_notify(irq + AVR_INT_IRQ_RUNNING, on_interrupt, &u->vectors[k]);
    }
    return u;
}

void uno_free(uno *u)
{
    avr_terminate(u->avr);
    free(u->avr);
    free(u);
}

void uno_reset(uno *u, uint8_t mcusr)
{
    avr_reset(u->avr);
    u->avr->data[MCUSR] = mcusr;
    u->in_head = u->in_tail = 0;
    u->out_tail = u->out_head; /* what was on the line is lost */
}

static avr_cycle_count_t on_target(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)avr, (void)when, (void)param;
    return 0;
}

/* Run to the first instruction that ends at `cycle` or behind it. 0: the processor stopped. */
int uno_run(uno *u, uint64_t cycle)
{
    avr_t *avr = u->avr;
    if (avr->cycle >= cycle)
        return 1;
    avr_cycle_timer_register(avr, cycle - avr->cycle, on_target, u);
    while (avr->cycle < cycle) {
        const int state = avr_run(avr);
        if (state == cpu_Done || state == cpu_Crashed)
            return 0;
    }
    return 1;
}

uint64_t uno_cycle(uno *u) { return u->avr->cycle; }
uint64_t uno_overruns(uno *u) { return u->overruns; }
uint8_t *uno_memory(uno *u) { return u->avr->data; }
uint32_t uno_pc(uno *u) { return u->avr->pc; }

/* Let a pin of the ADC go to so many counts; it arrives when a flight under way ends, or now. */
void uno_adc(uno *u, int channel, uint16_t counts) { u->analog[channel].to = counts; }

/* Let it fly from where it is then to so many counts, between two cycles. */
void uno_fly(uno *u, int channel, uint16_t counts, uint64_t begin, uint64_t end)
{
    flight *f = &u->analog[channel];
    *f = (flight){level(f, begin), counts, begin, end};
}

void uno_drive(uno *u, int drive, const uint8_t *pins)
{
    u->driver.drive = drive;
    memcpy(u->driver.pins, pins, sizeof u->driver.pins);
    u->driver.conflicts = 0;
}

driver *uno_driver(uno *u) { return &u->driver; }
as5048a *uno_sensor(uno *u) { return &u->sensor; }
int uno_high(uno *u, int pin) { return pin_high(u->avr->data, pin); }
double uno_carrier(uno *u, int pin) { return pin_carrier(u->avr->data, pin); }

/* Drive a pin of port D, whatever pull-up the firmware gives it. */
void uno_pin(uno *u, int pin, int level)
{
    u->driven.mask |= 1u << pin;
    u->driven.value = (u->driven.value & ~(1u << pin)) | (level ? 1u << pin : 0u);
    avr_ioctl(u->avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('D'), &u->driven);
    avr_raise_irq(avr_io_getirq(u->avr, AVR_IOCTL_IOPORT_GETIRQ('D'), pin), (uint32_t)level);
}

void uno_eeprom(uno *u, int write, uint8_t *bytes, uint32_t size)
{
    avr_eeprom_desc_t all = {.ee = bytes, .offset = 0, .size = size};
    if (write) {
        avr_ioctl(u->avr, AVR_IOCTL_EEPROM_SET, &all);
    } else {
        all.ee = NULL; /* simavr gives its own memory */
        avr_ioctl(u->avr, AVR_IOCTL_EEPROM_GET, &all);
        memcpy(bytes, all.ee, size);
    }
}

void uno_write(uno *u, const uint8_t *bytes, uint32_t size)
{
    for (uint32_t k = 0; k < size; k++)
        u->in[u->in_head++ % QUEUE] = bytes[k];
    if (size && !avr_cycle_timer_status(u->avr, on_line, u)) { /* a reset by the watchdog ends all timers */
        const uint64_t now = u->avr->cycle;
        avr_cycle_timer_register(u->avr, u->in_busy > now ? u->in_busy - now : 1, on_line, u);
    }
}

/* Bytes whose stop bit is over. */
uint32_t uno_waiting(uno *u)
{
    uint32_t count = 0;
    while (u->out_tail + count < u->out_head && u->out[(u->out_tail + count) % QUEUE].cycle <= u->avr->cycle)
        count++;
    return count;
}

uint32_t uno_read(uno *u, uint8_t *bytes, uint32_t size)
{
    uint32_t count = 0;
    while (count < size && u->out_tail < u->out_head && u->out[u->out_tail % QUEUE].cycle <= u->avr->cycle)
        bytes[count++] = (uint8_t)u->out[u->out_tail++ % QUEUE].value;
    return count;
}

/* Copy the latest events of one log, oldest first; returns how many. */
uint32_t uno_events(uno *u, int which, uint64_t *cycles, int32_t *values)
{
    const event_log *const logs[] = {&u->duty, &u->pin, &u->sample, &u->update}, *log = logs[which];
    const uint64_t begin = log->count > LOG ? log->count - LOG : 0;
    for (uint64_t k = begin; k < log->count; k++) {
        cycles[k - begin] = log->at[k % LOG].cycle;
        values[k - begin] = log->at[k % LOG].value;
    }
    return (uint32_t)(log->count - begin);
}

void uno_cost(uno *u, int vector, uint64_t *numbers)
{
    const cost *c = &u->costs[vector];
    numbers[0] = c->count, numbers[1] = c->total, numbers[2] = c->worst;
}
