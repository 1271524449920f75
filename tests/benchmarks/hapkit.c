/* The control loop of the published Hapkit sketches, for the benchmark: built and measured by hapkit.py, never shipped.
 *
 * Modelled on the public description of the Hapkit (Stanford, hapkit.stanford.edu, and the course slides on its board)
 * and of the Arduino core it runs on; written afresh from them. Described there:
 *   - loop() runs freely, as fast as it gets round; nothing times it
 *   - analogRead of a KMA210 on A2: 10 bits at prescaler 128, waited for
 *   - wraps counted by a flip number: a jump of more than 700 counts between two readings is one
 *   - position by a straight line, counts to degrees of the sector, times the handle's radius
 *   - velocity by a second-order filter, both poles at 0.95, of a difference divided by a hard-coded 0.0001 s
 *   - a wall: a spring beyond a position
 *   - torque of the motor's pulley from the radii 0.004191 m, 0.073152 m and 0.065659 m; duty = sqrt(torque / 0.03)
 *   - PWM on D5, timer 0 at prescaler 1; direction on D8
 *   - the core's clock, millis(), counts timer 0's overflows in an interrupt: every 256 cycles at that prescaler
 *   - Serial: 115200 baud, 64 bytes of buffer, print waits for room in it
 * Assumed, since sketches differ or nothing is said:
 *   - what goes out is the position with 5 digits, a line every EVERY loops (0: never); sketches print more or less
 *   - divisions are where the described formulas have them: by the period, and by the motor's constant
 *   - a flip is 920 counts, and the line is the emulated sensor's: a well calibrated device
 *   - the tables by which digitalWrite and analogWrite look up a pin are left out, the filter's and the torque's
 *     constants are folded: all in favour of this loop
 *   - the wall's force does not use the velocity, which is computed all the same, as in hapticlab's firmware
 * MILLIS=0 leaves out the interrupt of the core's clock, to show its share. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <math.h>
#include <stdint.h>

#ifndef EVERY
#define EVERY 0
#endif
#ifndef MILLIS
#define MILLIS 1
#endif

#define FLIP_THRESHOLD 700
#define FLIP 920
#define MIDDLE 352 /* the reading at x = 0 */
#define DEGREES_PER_COUNT 0.01116962f /* 12.8 um at the handle */
#define RADIANS (3.14159265f / 180.0f)
#define R_PULLEY 0.004191f /* [m] */
#define R_SECTOR 0.073152f
#define R_HANDLE 0.065659f
#define POLE 0.95f
#define HARD_CODED_PERIOD 0.0001f /* [s] */
#define X_WALL 0.002f /* [m] */
#define K_WALL 150.0f /* [N/m] */
#define TORQUE_FULL 0.03f /* [N m] at full duty */
#define TX_BYTES 64
#define DIGITS 5

float xh, vh; /* position [m] and velocity [m/s] of the handle */
uint32_t lines; /* of telemetry, written so far */
static int16_t last_reading, flips;
static float last_xh, last_vh, last_last_vh;

static volatile uint8_t tx[TX_BYTES], tx_head, tx_tail;
static volatile uint32_t overflows, milliseconds;
static uint8_t fraction; /* of a millisecond, in 1/125 */

ISR(TIMER0_OVF_vect) /* 1.024 ms at the prescaler of 64 that the core takes for granted */
{
    uint32_t now = milliseconds + 1;
    fraction = (uint8_t)(fraction + 3);
    if (fraction >= 125) {
        fraction = (uint8_t)(fraction - 125);
        now++;
    }
    milliseconds = now;
    overflows++;
}

ISR(USART_UDRE_vect)
{
    if (tx_head == tx_tail) {
        UCSR0B &= (uint8_t)~_BV(UDRIE0);
        return;
    }
    UDR0 = tx[tx_tail];
    tx_tail = (uint8_t)((tx_tail + 1) % TX_BYTES);
}

#if EVERY
static void put(uint8_t byte)
{
    const uint8_t next = (uint8_t)((tx_head + 1) % TX_BYTES);
    while (next == tx_tail) {
    }
    tx[tx_head] = byte;
    tx_head = next;
    UCSR0B |= _BV(UDRIE0);
}

static void print_whole(uint32_t number)
{
    uint8_t digits[10], count = 0;
    do {
        digits[count++] = (uint8_t)('0' + number % 10);
        number /= 10;
    } while (number);
    while (count)
        put(digits[--count]);
}

static void print_line(float number)
{
    if (number < 0.0f) {
        put('-');
        number = -number;
    }
    number += 0.5e-5f; /* of the last digit */
    const uint32_t whole = (uint32_t)number;
    print_whole(whole);
    put('.');
    float rest = number - (float)whole;
    for (uint8_t k = 0; k < DIGITS; k++) {
        rest *= 10.0f;
        const uint8_t digit = (uint8_t)rest;
        print_whole(digit);
        rest -= (float)digit;
    }
    put('\r');
    put('\n');
    lines++;
}
#endif

static int16_t read_sensor(void)
{
    ADMUX = _BV(REFS0) | _BV(MUX1);
    ADCSRA |= _BV(ADSC);
    while (ADCSRA & _BV(ADSC)) {
    }
    return (int16_t)ADC;
}

static float position(void)
{
    const int16_t reading = read_sensor(), jump = (int16_t)(reading - last_reading);
    if (jump > FLIP_THRESHOLD)
        flips--;
    else if (jump < -FLIP_THRESHOLD)
        flips++;
    last_reading = reading;
    const float degrees = DEGREES_PER_COUNT * (float)(reading + flips * FLIP - MIDDLE);
    return R_HANDLE * RADIANS * degrees;
}

static float velocity(void)
{
    const float difference = (xh - last_xh) / HARD_CODED_PERIOD;
    const float filtered =
        2.0f * POLE * last_vh - POLE * POLE * last_last_vh + (1.0f - POLE) * (1.0f - POLE) * difference;
    last_xh = xh;
    last_last_vh = last_vh;
    last_vh = filtered;
    return filtered;
}

static void drive(float force)
{
    const float torque = R_PULLEY * R_HANDLE / R_SECTOR * force;
    float duty = sqrtf(fabsf(torque) / TORQUE_FULL);
    if (duty > 1.0f)
        duty = 1.0f;
    const uint8_t output = (uint8_t)(duty * 255.0f);
    if (force < 0.0f)
        PORTB &= (uint8_t)~_BV(PORTB0);
    else
        PORTB |= _BV(PORTB0);
    if (output == 0 || output == 255) { /* no PWM: the pin's level */
        TCCR0A &= (uint8_t)~_BV(COM0B1);
        PORTD = (uint8_t)(output ? PORTD | _BV(PORTD5) : PORTD & ~_BV(PORTD5));
    } else {
        TCCR0A |= _BV(COM0B1);
        OCR0B = output;
    }
}

static void setup(void)
{
    DDRD |= _BV(DDD5);
    DDRB |= _BV(DDB0);
    TCCR0A = _BV(WGM01) | _BV(WGM00);
    TCCR0B = _BV(CS00);
    TIMSK0 = MILLIS ? _BV(TOIE0) : 0;
    UCSR0A = _BV(U2X0); /* 117647 baud */
    UBRR0 = 16;
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXEN0) | _BV(TXEN0);
    ADCSRA = _BV(ADEN) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0);
    last_reading = read_sensor();
    sei();
}

static void loop(void)
{
    xh = position();
    vh = velocity();
    drive(xh > X_WALL ? -K_WALL * (xh - X_WALL) : 0.0f);
#if EVERY
    static uint16_t since;
    if (++since >= EVERY) {
        since = 0;
        print_line(xh);
    }
#endif
}

int main(void)
{
    setup();
    for (;;)
        loop();
}
