/* Sensor: a magnetoresistive KMA210 on A2, or a quadrature encoder on D2 and D3. */
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

static uint16_t last; /* of either sensor */

static volatile uint16_t edges;
static volatile uint8_t lost; /* both lines changed at once: an edge was missed */
static uint8_t lines;

void board_configure(hl_core *core)
{
    uint8_t quadrature = core->settings.sensor == HL_SENSOR_QUADRATURE;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        lost = 0;
        edges = last = 0;
        ADMUX = _BV(REFS0) | _BV(MUX1); /* AVCC, ADC2 */
        ADCSRA = quadrature ? 0 : CONVERSION;
        DIDR0 = _BV(ADC2D);
        DDRD &= (uint8_t)~ENCODER_PINS;
        if (quadrature)
            PORTD |= ENCODER_PINS; /* pull-ups, for open collectors */
        else
            PORTD &= (uint8_t)~ENCODER_PINS;
        lines = PIND & ENCODER_PINS;
        EICRA = _BV(ISC10) | _BV(ISC00); /* any edge */
        EIFR = _BV(INTF1) | _BV(INTF0);
        EIMSK = quadrature ? _BV(INT1) | _BV(INT0) : 0;
    }
}

void uno_sensor_sample(void)
{
    if (ADCSRA & _BV(ADEN))
        ADCSRA = CONVERSION | _BV(ADSC);
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

static uint16_t quadrature_reading(hl_core *core)
{
    uint8_t missed;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        last = edges;
        missed = lost;
        lost = 0;
    }
    if (missed)
        hl_core_fault(core, HL_FAULT_SENSOR, (float)last);
    return last;
}

static uint16_t magnetoresistive_reading(hl_core *core)
{
    while (ADCSRA & _BV(ADSC)) {
    }
    uint16_t reading = ADC;
    /* a sensor that uses all of the range has no band that says it is broken */
    uint8_t banded = core->settings.wrap <= READING_MAX - READING_MIN;
    if (banded && (reading < READING_MIN || reading > READING_MAX))
        hl_core_fault(core, HL_FAULT_SENSOR, (float)reading);
    else
        last = reading;
    return last;
}

uint16_t board_reading(hl_core *core)
{
    return ADCSRA & _BV(ADEN) ? magnetoresistive_reading(core) : quadrature_reading(core);
}

#define PINS(first, second) (0xFFFF0000UL | (second) << 8 | (first))
#define A2 16

/* The wiring of a Hapkit, or an encoder in the place of its sensor. */
uint8_t board_accepts(const hl_settings *s)
{
    if (s->drive != HL_DRIVE_PWM_DIRECTION || s->motor_pins != PINS(5UL, 8UL) || s->carrier != 62500)
        return 0;
    if (s->sensor == HL_SENSOR_QUADRATURE)
        return s->sensor_pins == PINS(2UL, 3UL);
    return s->sensor == HL_SENSOR_MAGNETORESISTIVE && s->wrap <= 1024 && s->sensor_pins == PINS((uint32_t)A2, (uint32_t)HL_NO_PIN);
}
