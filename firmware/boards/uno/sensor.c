/* Sensor: a magnetoresistive KMA210 on an analog pin, an AS5048A on the SPI, or a quadrature encoder on D2 and D3. */
#include "uno.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

/* The KMA210's output stays between 5 % and 95 % of the supply; broken wires and lost magnets send it beyond. The limits
 * are 2 % and 98 % of the 1023 counts. */
#define READING_MIN 20
#define READING_MAX 1003

#define CONVERSION (_BV(ADEN) | _BV(ADPS2) | _BV(ADPS0)) /* prescaler 32: 26 us */
#define ENCODER_PINS (_BV(PIND2) | _BV(PIND3))

/* AS5048A: 16 bits a frame, mode 1, 4 MHz of the 10 it allows: its wires are long. Every answer comes with the next frame.
 * A tick asks for the angle, and then, taking it, for the diagnostics, which the next tick takes as it asks again. */
#define SPI_ON (_BV(SPE) | _BV(MSTR) | _BV(CPHA))
#define BUS_OUT (_BV(PORTB2) | _BV(PORTB3) | _BV(PORTB5)) /* D10 too: as an input it could end the SPI's mastery */
#define NS_350 6 /* cycles from the chip's select to the clock, and between frames */
#define READ_ANGLE 0xFFFF
#define READ_DIAGNOSTICS 0x7FFD
#define CLEAR_ERRORS 0x4001
#define ERROR_FLAG 0x4000
#define READY 0x0100 /* diagnostics: its offsets are compensated */
#define OVERFLOWN 0x0200 /* the angle is not valid */
#define ANGLE 0x3FFF

static uno_line select;
static uint16_t diagnostics;
static uint16_t last; /* reading of an angle that could be right */

static volatile uint16_t edges;
static volatile uint8_t lost; /* both lines changed at once: an edge was missed */
static uint8_t lines;

/* Between frames the bus is low: its D11 may be a driver's enable on a board that is wired otherwise. */
static uint16_t exchange(uint16_t word)
{
    SPCR = SPI_ON;
    uno_low(select);
    __builtin_avr_delay_cycles(NS_350);
    SPDR = (uint8_t)(word >> 8);
    while (!(SPSR & _BV(SPIF))) {
    }
    uint16_t answer = (uint16_t)(SPDR << 8);
    SPDR = (uint8_t)word;
    while (!(SPSR & _BV(SPIF))) {
    }
    answer |= SPDR;
    uno_high(select);
    SPCR = 0;
    __builtin_avr_delay_cycles(NS_350);
    return answer;
}

static void begin_bus(void)
{
    uno_high(select);
    uno_drive(select);
    DDRB |= BUS_OUT;
    exchange(CLEAR_ERRORS);
    exchange(READ_DIAGNOSTICS);
}

void uno_sensor_configure(const hl_settings *s)
{
    const uint8_t pin = (uint8_t)s->sensor_pins;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        EIMSK = ADCSRA = DIDR0 = lost = select.mask = 0;
        if (s->sensor == HL_SENSOR_AS5048A) {
            select = uno_line_of(pin);
            begin_bus();
        } else if (s->sensor == HL_SENSOR_QUADRATURE) {
            PORTD |= ENCODER_PINS; /* pull-ups, for open collectors */
            lines = PIND & ENCODER_PINS;
            EICRA = _BV(ISC10) | _BV(ISC00); /* any edge */
            EIFR = _BV(INTF1) | _BV(INTF0);
            EIMSK = _BV(INT1) | _BV(INT0);
        } else {
            ADMUX = (uint8_t)(_BV(REFS0) | ((pin - 14) & 7)); /* against AVCC; no pin at all is A2 */
            DIDR0 = (uint8_t)(1 << (ADMUX & 7));
            ADCSRA = CONVERSION;
        }
    }
}

void uno_sensor_sample(void)
{
    if (ADCSRA & _BV(ADEN))
        ADCSRA = CONVERSION | _BV(ADSC);
    else if (select.mask)
        diagnostics = exchange(READ_ANGLE);
}

ISR(INT0_vect)
{
    uint8_t now = PIND & ENCODER_PINS, changed = now ^ lines;
    /* D2 leads D3 when counting up: after an edge of D2 the lines differ, after one of D3 they agree */
    uint8_t differ = now == _BV(PIND2) || now == _BV(PIND3);
    if (changed == ENCODER_PINS)
        lost = 1;
    else if (changed)
        edges += (changed == _BV(PIND2)) == differ ? 1 : 0xFFFFU;
    lines = now;
}

ISR(INT1_vect, ISR_ALIASOF(INT0_vect));

static uint16_t count(hl_core *core)
{
    uint16_t now;
    uint8_t missed;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        now = edges;
        missed = lost;
        lost = 0;
    }
    if (missed)
        hl_core_fault(core, HL_FAULT_SENSOR, (float)now);
    return now;
}

static uint16_t level(hl_core *core)
{
    while (ADCSRA & _BV(ADSC)) {
    }
    const uint16_t reading = ADC;
    /* a sensor that uses all of the range has no band that says it is broken */
    const uint8_t banded = core->settings.wrap <= READING_MAX - READING_MIN;
    if (banded && (reading < READING_MIN || reading > READING_MAX))
        hl_core_fault(core, HL_FAULT_SENSOR, (float)reading);
    else
        last = reading;
    return last;
}

static uint8_t is_damaged(uint16_t answer)
{
    return (answer & ERROR_FLAG) || __builtin_parity(answer);
}

/* A line that is always low has a right parity: the bit that says the sensor is ready tells. */
static uint16_t angle(hl_core *core)
{
    const uint16_t answer = exchange(READ_DIAGNOSTICS);
    if (is_damaged(answer) || is_damaged(diagnostics) || (diagnostics & (READY | OVERFLOWN)) != READY) {
        exchange(CLEAR_ERRORS);
        exchange(READ_DIAGNOSTICS);
        hl_core_fault(core, HL_FAULT_SENSOR, (float)answer);
    } else {
        last = answer & ANGLE;
    }
    return last;
}

uint16_t board_reading(hl_core *core)
{
    if (ADCSRA & _BV(ADEN))
        return level(core);
    return select.mask ? angle(core) : count(core);
}
