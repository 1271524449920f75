/* Sensor: an analog magnet angle (KMA210) on GP26 to GP28, an AS5048A by SPI, or a quadrature encoder by PIO. */
#include "pico.h"

/* The KMA210's output stays between 5 % and 95 % of its supply; broken wires and lost magnets send it beyond. The limits
 * are 2 % and 98 % of the 4095 counts, for a divider that makes 3.3 V of that supply. */
enum { READING_MIN = 82, READING_MAX = 4013 };
enum { FIRST_ANALOG = 26, LAST_ANALOG = 28, ADC_ON = 1, ADC_START = 1 << 2, ADC_READY = 1 << 8 };

/* AS5048A: 16 bits a frame, clock idle low, data taken with its falling edge. It allows 10 MHz; its wires are long. Every
 * answer comes with the next frame: a tick asks for the angle, and then, taking it, for the diagnostics, which the next tick
 * takes as it asks again. Bit 15 of a frame is even parity, bit 14 of an answer an error, until it is read. */
enum { MISO = 16, CLOCK = 18, MOSI = 19 };
enum { READ_ANGLE = 0xffff, READ_DIAGNOSTICS = 0x7ffd, CLEAR_ERROR = 0x4001, ERROR = 1 << 14, ANGLE = 0x3fff };
enum { READY = 1 << 8, OVERFLOWN = 1 << 9 }; /* of the diagnostics: offsets are compensated; the angle is not valid */
enum { SPI_16_BITS = 15, SPI_SECOND_EDGE = 1 << 7, SPI_ON = 2, SPI_BUSY = 1 << 4, SPI_PRESCALE = 28 }; /* 4.5 MHz */
enum { NO_SENSOR = 255 }; /* until there are settings */
enum { PAUSE = 5 }; /* turns of about 10 clocks: 350 ns from select to clock, and between frames */

static uint8_t sensor = NO_SENSOR, select_pin;
static uint16_t diagnostics; /* of the tick before */
static hl_reading last;

static uint8_t sensor_can(const hl_settings *settings)
{
    const uint8_t first = pin_of(settings->sensor_pins, 0), second = pin_of(settings->sensor_pins, 1);
    switch (settings->sensor) {
    case HL_SENSOR_MAGNETORESISTIVE:
        return first >= FIRST_ANALOG && first <= LAST_ANALOG && settings->wrap <= 4096;
    case HL_SENSOR_QUADRATURE: /* the PIO reads pins in a row */
        return is_pin(first) && is_pin(second) && second == first + 1;
    case HL_SENSOR_AS5048A:
        return is_pin(first) && first != MISO && first != CLOCK && first != MOSI;
    default:
        return 0;
    }
}

static uint32_t sensor_pins(const hl_settings *settings)
{
    const uint32_t first = UINT32_C(1) << pin_of(settings->sensor_pins, 0);
    if (settings->sensor == HL_SENSOR_QUADRATURE) {
        return first | first << 1;
    }
    return settings->sensor == HL_SENSOR_AS5048A ? first | 1u << MISO | 1u << CLOCK | 1u << MOSI : first;
}

static void pause(void)
{
    for (volatile uint8_t k = 0; k < PAUSE; k++) {
    }
}

static uint16_t spi(uint16_t command)
{
    REGISTER(SIO_OUT_CLEAR) = UINT32_C(1) << select_pin;
    pause();
    REGISTER(SPI0_DATA) = command;
    while (REGISTER(SPI0_STATUS) & SPI_BUSY) {
    }
    pause();
    REGISTER(SIO_OUT_SET) = UINT32_C(1) << select_pin;
    pause();
    return (uint16_t)REGISTER(SPI0_DATA);
}

static void spi_begin(uint8_t pin)
{
    select_pin = pin;
    REGISTER(SIO_OUT_SET) = UINT32_C(1) << pin;
    REGISTER(SIO_OE_SET) = UINT32_C(1) << pin;
    pin_function(pin, FUNCTION_SIO, PAD_PULL_UP);
    pin_function(MISO, FUNCTION_SPI, PAD_PULL_UP); /* an open line reads as an error */
    pin_function(CLOCK, FUNCTION_SPI, PAD_PULL_DOWN);
    pin_function(MOSI, FUNCTION_SPI, PAD_PULL_DOWN);
    REGISTER(SPI0_CR1) = 0;
    REGISTER(SPI0_CR0) = SPI_SECOND_EDGE | SPI_16_BITS;
    REGISTER(SPI0_PRESCALE) = SPI_PRESCALE;
    REGISTER(SPI0_CR1) = SPI_ON;
    spi(CLEAR_ERROR); /* of before the supply was there */
    spi(READ_DIAGNOSTICS);
}

static uint8_t is_damaged(uint16_t answer)
{
    uint16_t folded = answer ^ answer >> 8;
    folded ^= folded >> 4;
    const uint8_t odd = 0x6996 >> (folded & 15) & 1; /* of the parities of every 4 bits */
    return odd || (answer & ERROR);
}

/* A line that is always low has a right parity: the bit that says the sensor is ready tells. */
static hl_reading as5048a(hl_core *core)
{
    const uint16_t answer = spi(READ_DIAGNOSTICS);
    if (is_damaged(answer) || is_damaged(diagnostics) || (diagnostics & (READY | OVERFLOWN)) != READY) {
        spi(CLEAR_ERROR);
        spi(READ_DIAGNOSTICS);
        hl_core_fault(core, HL_FAULT_SENSOR, (float)answer);
        return last;
    }
    return answer & ANGLE;
}

static hl_reading analog(hl_core *core)
{
    while (!(REGISTER(ADC_CS) & ADC_READY)) {
    }
    const uint16_t reading = (uint16_t)REGISTER(ADC_RESULT);
    /* a sensor that uses all of the range has no band that says it is broken */
    const uint8_t banded = core->settings.wrap <= READING_MAX - READING_MIN;
    if (banded && (reading < READING_MIN || reading > READING_MAX)) {
        hl_core_fault(core, HL_FAULT_SENSOR, (float)reading);
        return last;
    }
    return reading;
}

static hl_reading quadrature(hl_core *core)
{
    const uint32_t count = quadrature_count();
    if (quadrature_lost()) {
        hl_core_fault(core, HL_FAULT_SENSOR, (float)count);
    }
    return count;
}

void sensor_sample(void)
{
    if (sensor == HL_SENSOR_MAGNETORESISTIVE) {
        SET_BITS(ADC_CS) = ADC_START;
    } else if (sensor == HL_SENSOR_AS5048A) {
        diagnostics = spi(READ_ANGLE);
    }
}

hl_reading board_reading(hl_core *core)
{
    switch (sensor) {
    case HL_SENSOR_MAGNETORESISTIVE:
        return last = analog(core);
    case HL_SENSOR_QUADRATURE:
        return last = quadrature(core);
    case HL_SENSOR_AS5048A:
        return last = as5048a(core);
    default:
        return last;
    }
}

uint8_t board_accepts(const hl_settings *settings)
{
    return sensor_can(settings) && motor_can(settings) && !(sensor_pins(settings) & motor_pins(settings));
}

/* What earlier settings had let go of comes first: every pin is an input that is pulled low. */
void board_configure(hl_core *core)
{
    const hl_settings *s = &core->settings;
    const uint8_t first = pin_of(s->sensor_pins, 0);
    const uint32_t before = interrupts_off();
    motor_release();
    for (uint8_t pin = 0; pin < PINS; pin++) {
        if (is_pin(pin)) {
            pin_rest(pin);
        }
    }
    REGISTER(ADC_CS) = 0;
    sensor = board_accepts(s) ? (uint8_t)s->sensor : NO_SENSOR;
    if (sensor == HL_SENSOR_MAGNETORESISTIVE) {
        pin_function(first, FUNCTION_NONE, PAD_ANALOG);
        REGISTER(ADC_CS) = ADC_ON | (uint32_t)(first - FIRST_ANALOG) << 12;
    } else if (sensor == HL_SENSOR_QUADRATURE) {
        quadrature_begin(first);
    } else if (sensor == HL_SENSOR_AS5048A) {
        spi_begin(first);
    }
    if (sensor != NO_SENSOR && s->wired) {
        motor_configure(s);
    }
    interrupts_back(before);
}
