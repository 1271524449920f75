#include "simavr_paddle.h"

enum { /* addresses of the ATmega328P's registers */
    DDRB = 0x24, PORTB = 0x25, DDRC = 0x27, PORTC = 0x28, DDRD = 0x2A, PORTD = 0x2B,
    TCCR0A = 0x44, OCR0A = 0x47, OCR0B = 0x48, TCCR2A = 0xB0, OCR2A = 0xB3, OCR2B = 0xB4
};
enum { FAST = 3, CORRECT = 1 }; /* waveforms of both timers, by the low bits of TCCRnA */

/* The PWM of a pin: its timer's control, its compare register, where its two bits of the control are. */
typedef struct { uint8_t pin, control, compare, shift; } pwm;
static const pwm PWM[] = {{3, TCCR2A, OCR2B, 4}, {5, TCCR0A, OCR0B, 4}, {6, TCCR0A, OCR0A, 6}, {11, TCCR2A, OCR2A, 6}};

static const pwm *pwm_of(const uint8_t *r, int pin)
{
    for (int k = 0; k < 4; k++)
        if (PWM[k].pin == pin && (r[PWM[k].control] >> PWM[k].shift & 2))
            return &PWM[k];
    return 0;
}

static int bit_of(const uint8_t *r, int pin, int of_b, int of_c, int of_d)
{
    return pin < 8 ? r[of_d] >> pin & 1 : pin < 14 ? r[of_b] >> (pin - 8) & 1 : r[of_c] >> (pin - 14) & 1;
}

int pin_high(const uint8_t *r, int pin)
{
    const pwm *p = pwm_of(r, pin);
    if (pin >= PINS || !bit_of(r, pin, DDRB, DDRC, DDRD))
        return -1;
    if (!p)
        return bit_of(r, pin, PORTB, PORTC, PORTD) ? 256 : 0;
    if (!(r[p->control + 1] & 7))
        return 0; /* its timer stands */
    const int inverted = r[p->control] >> p->shift & 1, compare = r[p->compare];
    const int part = (r[p->control] & 3) == FAST ? compare + 1 : (compare * 256 + 127) / 255;
    return inverted ? 256 - part : part;
}

double pin_carrier(const uint8_t *r, int pin)
{
    static const int OF_0[] = {0, 1, 8, 64, 256, 1024, 0, 0}, OF_2[] = {0, 1, 8, 32, 64, 128, 256, 1024};
    const pwm *p = pwm_of(r, pin);
    if (!p)
        return 0;
    const int divider = (p->control == TCCR0A ? OF_0 : OF_2)[r[p->control + 1] & 7];
    return divider ? 16e6 / divider / ((r[p->control] & 3) == FAST ? 256 : 510) : 0;
}

/* Outputs of the 74HC595 that are the two inputs of M1, M2, M3, M4, by the motor's PWM pin (Adafruit's AFMotor library). */
static const uint8_t OUTPUTS[][3] = {{11, 2, 3}, {3, 1, 4}, {6, 5, 7}, {5, 0, 6}};
enum { OUTPUT_ENABLE = 7 /* D7, low where the outputs are on; a resistor on the shield holds it high */ };

static void inputs(const driver *d, const uint8_t *r, int *first, int *second)
{
    *first = pin_high(r, d->pins[0]), *second = pin_high(r, d->pins[1]);
    if (d->drive == PWM_DIRECTION)
        *first = *second > 0 ? 256 : 0, *second = 256 - *first; /* the driver's own inverter */
    for (int k = 0; d->drive == SHIFT_REGISTER && k < 4; k++)
        if (OUTPUTS[k][0] == d->pins[0])
            *first = 256 * (d->held >> OUTPUTS[k][1] & 1), *second = 256 * (d->held >> OUTPUTS[k][2] & 1);
    if (d->drive == SHIFT_REGISTER && pin_high(r, OUTPUT_ENABLE) != 0)
        *first = *second = 256; /* inputs of an L293D that nobody drives are high */
}

int driver_duty(const driver *d, const uint8_t *r)
{
    int first, second, enable = 256;
    inputs(d, r, &first, &second);
    if (d->drive != TWO_INPUTS)
        enable = pin_high(r, d->pins[d->drive == TWO_INPUTS_ENABLE ? 2 : 0]);
    if (enable <= 0) /* a resistor at the driver holds a pin that nobody drives low */
        return 0;
    return ((first > 0 ? first : 0) - (second > 0 ? second : 0)) * enable / 256;
}

void driver_look(driver *d, const uint8_t *r)
{
    int first, second;
    if (d->drive == SHIFT_REGISTER) {
        const uint8_t now = (uint8_t)((pin_high(r, d->pins[1]) > 0) | (pin_high(r, d->pins[2]) > 0) << 1), rose = now & ~d->was;
        d->was = now;
        if (rose & 2)
            d->shifting = (uint8_t)(d->shifting << 1 | (pin_high(r, d->pins[3]) > 0));
        if (rose & 1)
            d->held = d->shifting;
    }
    inputs(d, r, &first, &second);
    const int on = d->drive != SHIFT_REGISTER || pin_high(r, OUTPUT_ENABLE) == 0;
    d->conflicts += on && first > 0 && second > 0;
}

enum { READ = 0x4000, CLEAR_ERRORS = 1, DIAGNOSTICS = 0x3ffd, ANGLE = 0x3fff, WRONG_BITS = 1, WRONG_PARITY = 4, FLAG = 0x4000 };
enum { HASTE = 6 /* cycles: 350 ns from select to clock, and between two frames */ };

static uint16_t with_parity(uint16_t word)
{
    word &= 0x7fff;
    return (uint16_t)(word | (__builtin_parity(word) << 15));
}

static void as5048a_obey(as5048a *s, uint64_t cycle)
{
    uint16_t found = 0;
    if (s->bits != 16)
        s->errors |= WRONG_BITS;
    else if (__builtin_parity(s->in))
        s->errors |= WRONG_PARITY;
    else if ((s->in & READ) && (s->in & ANGLE) == CLEAR_ERRORS)
        found = s->errors, s->errors = 0;
    else if ((s->in & READ) && (s->in & ANGLE) == DIAGNOSTICS)
        found = s->diagnostics;
    else if ((s->in & READ) && (s->in & ANGLE) == ANGLE)
        found = s->angle, s->latched = cycle;
    s->answer = with_parity((uint16_t)(found | (s->errors ? FLAG : 0)));
}

void as5048a_look(as5048a *s, const uint8_t *r, uint64_t cycle)
{
    if (s->select == NO_PIN)
        return;
    const uint8_t selected = pin_high(r, s->select) == 0;
    if (selected == s->selected)
        return;
    s->selected = selected;
    if (selected) {
        s->hasty += cycle - s->since < HASTE;
        s->out = s->answer, s->in = s->bits = 0;
    } else {
        as5048a_obey(s, cycle);
    }
    s->since = cycle;
}

uint8_t as5048a_exchange(as5048a *s, uint8_t byte, uint64_t cycle)
{
    if (s->select == NO_PIN || !s->selected)
        return 0xff; /* nobody drives the line */
    if (s->bits == 0)
        s->hasty += cycle - s->since < HASTE;
    const uint16_t seen = (uint16_t)(((s->out ^ s->flips) & ~s->zeros) | s->ones);
    const uint8_t answer = (uint8_t)(s->bits == 0 ? seen >> 8 : seen);
    s->in = (uint16_t)(s->in << 8 | byte);
    s->bits = (uint8_t)(s->bits + 8);
    return answer;
}
