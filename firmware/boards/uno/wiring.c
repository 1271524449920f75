/* Wiring: which pins a motor's driver and a sensor may have on this board, and what drives them then. */
#include "uno.h"

#include <avr/io.h>
#include <avr/pgmspace.h>

#define PIN(number) (1UL << (number))
#define LINK (PIN(0) | PIN(1))
#define BLINKS PIN(13) /* a bootloader's LED */
#define FREE (0xFFFFFUL & ~(LINK | BLINKS)) /* D2 to D12, A0 to A5 */
#define ANALOG (0x3FUL << 14)
#define PWM (PIN(3) | PIN(5) | PIN(6) | PIN(11)) /* of timers 0 and 2 */
#define BUS (PIN(11) | PIN(12) | PIN(13))
#define SHIELD_ENABLE 7 /* low where the outputs of its shift register are on; a resistor holds it high */

enum { NONE = 4 }; /* no pin of the four */
enum { CARRIER_MIN = 490, ADC_COUNTS = 1024 };

/* by drive and by sensor: what each pin may be, nothing where there is none */
static const uint32_t MOTORS[][4] PROGMEM = {
    {PWM, FREE}, {PWM, PWM}, {FREE, FREE, PWM}, {PWM, PIN(12), PIN(4), PIN(8)}
};
static const uint32_t SENSORS[][4] PROGMEM = {{ANALOG}, {PIN(2), PIN(3)}, {FREE}};

/* by drive: which of its pins has the PWM ahead and back, and which is high ahead and back */
static const uint8_t ROLES[][4] PROGMEM = {{0, 0, 1, NONE}, {0, 1, NONE, NONE}, {2, 2, 0, 1}, {0, 0, NONE, NONE}};

/* Frequencies of the PWM, and the waveforms and prescalers that give them. */
static const struct {
    uint16_t hz;
    uint8_t waveform, prescaler_0, prescaler_2;
} CARRIERS[] PROGMEM = {
    {62500, _BV(WGM01) | _BV(WGM00), _BV(CS00), _BV(CS20)},
    {31372, _BV(WGM00), _BV(CS00), _BV(CS20)},
    {7812, _BV(WGM01) | _BV(WGM00), _BV(CS01), _BV(CS21)},
    {3921, _BV(WGM00), _BV(CS01), _BV(CS21)},
    {976, _BV(WGM01) | _BV(WGM00), _BV(CS01) | _BV(CS00), _BV(CS22)},
    {CARRIER_MIN, _BV(WGM00), _BV(CS01) | _BV(CS00), _BV(CS22)},
};

/* Outputs of the shield's shift register that are a motor's inputs, by the pin that has its PWM: M1 to M4 of the Adafruit
 * motor shield (v1), by its library AFMotor. */
static const uint8_t SHIELD[][3] PROGMEM = {{11, _BV(2), _BV(3)}, {3, _BV(1), _BV(4)}, {6, _BV(5), _BV(7)}, {5, _BV(0), _BV(6)}};

/* Add `pins` to those in use; 0 where one may not be there, or is in use already. */
static uint32_t with(uint32_t used, uint32_t pins, const uint32_t *allowed)
{
    for (uint8_t k = 0; k < 4; k++, pins >>= 8) {
        const uint32_t may = pgm_read_dword(allowed + k);
        const uint8_t pin = (uint8_t)pins;
        if (may == 0 && pin == HL_NO_PIN)
            continue;
        const uint32_t bit = pin < UNO_PINS ? PIN(pin) : 0;
        if (!(may & bit & ~used))
            return 0;
        used |= bit;
    }
    return used;
}

uint8_t board_accepts(const hl_settings *s)
{
    uint32_t used = LINK;
    if (s->carrier < CARRIER_MIN || (s->sensor == HL_SENSOR_MAGNETORESISTIVE && s->wrap > ADC_COUNTS))
        return 0;
    if (s->sensor == HL_SENSOR_AS5048A)
        used |= BUS;
    if (s->drive == HL_DRIVE_SHIFT_REGISTER)
        used |= PIN(SHIELD_ENABLE);
    used = with(used, s->motor_pins, MOTORS[s->drive]);
    return used && with(used, s->sensor_pins, SENSORS[s->sensor]);
}

uno_line uno_line_of(uint8_t pin)
{
    uno_line line = {&PORTD, 0};
    if (pin >= UNO_PINS)
        return line;
    if (pin >= 14) {
        line.port = &PORTC;
        pin = (uint8_t)(pin - 14);
    } else if (pin >= 8) {
        line.port = &PORTB;
        pin = (uint8_t)(pin - 8);
    }
    line.mask = (uint8_t)(1 << pin);
    return line;
}

/* The highest frequency that is not above the setting's. */
static void set_carrier(uint32_t hz)
{
    uint8_t k = 0;
    while (k < sizeof CARRIERS / sizeof CARRIERS[0] - 1 && pgm_read_word(&CARRIERS[k].hz) > hz)
        k++;
    uno_motor.waveform = pgm_read_byte(&CARRIERS[k].waveform);
    TCCR0B = pgm_read_byte(&CARRIERS[k].prescaler_0);
    TCCR2B = pgm_read_byte(&CARRIERS[k].prescaler_2);
}

/* Turn a way by the PWM on `pin`; by none on no pin. */
static void set_pwm(uno_way *way, uint8_t pin)
{
    const uint8_t a = pin == 6 || pin == 11;
    const uint8_t connected = (uint8_t)(uno_motor.waveform | (a ? _BV(COM0A1) : _BV(COM0B1)));
    way->control_0 = way->control_2 = uno_motor.waveform;
    way->compare = a ? &OCR0A : &OCR0B;
    if (pin == 3 || pin == 11) {
        way->compare = a ? &OCR2A : &OCR2B;
        way->control_2 = connected;
    } else if (pin < UNO_PINS) {
        way->control_0 = connected;
    }
}

/* The shield's outputs stay off until its register is known to hold none. */
static void enable_shield(uint8_t pin)
{
    uint8_t k = 0;
    while (k < sizeof SHIELD / sizeof SHIELD[0] - 1 && pgm_read_byte(&SHIELD[k][0]) != pin)
        k++;
    for (uint8_t way = 0; way < 2; way++)
        uno_motor.ways[way].line = (uno_line){&uno_motor.outputs, pgm_read_byte(&SHIELD[k][1 + way])};
    uno_motor.outputs = 0;
    uno_motor.shifted = 0xFF;
    uno_motor.shifts = 1;
    uno_shift();
    uno_drive(uno_line_of(SHIELD_ENABLE));
}

/* Nothing is driven but low, on pins that no sensor drives; then the driver's pins, if a person has confirmed them. */
void uno_motor_configure(const hl_settings *s)
{
    uint8_t pins[NONE + 1];
    TCCR0A = TCCR2A = uno_motor.shifts = 0; /* no pin has a PWM */
    PORTB = PORTC = 0;
    PORTD &= UNO_LINK_PINS;
    DDRB = UNO_LOW_B;
    DDRC = 0;
    DDRD = UNO_LOW_D;
    for (uint8_t k = 0; k <= NONE; k++) {
        pins[k] = k < NONE && s->wired ? (uint8_t)(s->motor_pins >> (8 * k)) : HL_NO_PIN;
        uno_drive(uno_line_of(pins[k]));
    }
    set_carrier(s->carrier);
    for (uint8_t way = 0; way < 2; way++) {
        set_pwm(&uno_motor.ways[way], pins[pgm_read_byte(&ROLES[s->drive][way])]);
        uno_motor.ways[way].line = uno_line_of(pins[pgm_read_byte(&ROLES[s->drive][2 + way])]);
    }
    if (s->wired && s->drive == HL_DRIVE_SHIFT_REGISTER)
        enable_shield(pins[0]);
    board_motor(&uno_core, 0);
}
