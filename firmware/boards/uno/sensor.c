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

static int32_t counts; /* only ever moved by differences: where they begin means nothing */
static uint8_t first; /* there is no reading yet to compare with */
static uint16_t last; /* of either sensor */

static volatile uint16_t edges;
static volatile uint8_t lost; /* both lines changed at once: an edge was missed */
static uint8_t lines;

void board_configure(hl_core *core)
{
    uint8_t quadrature = core->settings.sensor == HL_SENSOR_QUADRATURE;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        first = 1;
        lost = 0;
        edges = last = 0; /* counts go on from where they are */
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

static int16_t quadrature_step(hl_core *core)
{
    uint16_t now;
    uint8_t missed;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        now = edges;
        missed = lost;
        lost = 0;
    }
    int16_t step = (int16_t)(now - last);
    last = now;
    if (missed)
        hl_core_fault(core, HL_FAULT_SENSOR, (float)counts);
    return step;
}

/* Readings rise and fall by `wrap` where the sensor turns over: more than half of that in one sample is a turn. */
static int16_t magnetoresistive_step(hl_core *core)
{
    while (ADCSRA & _BV(ADSC)) {
    }
    uint16_t reading = ADC;
    int16_t wrap = (int16_t)core->settings.wrap;
    /* a sensor that uses all of the range has no band that says it is broken */
    uint8_t banded = wrap <= READING_MAX - READING_MIN;
    if (banded && (reading < READING_MIN || reading > READING_MAX)) {
        hl_core_fault(core, HL_FAULT_SENSOR, (float)reading);
        return 0;
    }
    int16_t step = (int16_t)(reading - last);
    last = reading;
    if (first) {
        first = 0;
        return 0;
    }
    if (2 * step > wrap)
        step = (int16_t)(step - wrap);
    else if (2 * step < -wrap)
        step = (int16_t)(step + wrap);
    return step;
}

int32_t board_counts(hl_core *core)
{
    int16_t step = ADCSRA & _BV(ADEN) ? magnetoresistive_step(core) : quadrature_step(core);
    counts += step;
    return counts;
}
