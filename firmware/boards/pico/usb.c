/* Link: a serial port over USB, full speed.
 *
 * The controller acknowledges and repeats by itself; software fills and empties its buffers. Bytes go to the core only
 * while it has no frame to answer: until then the buffer stays full, and the controller tells the computer to wait. What
 * is to be sent gathers while a packet is under way, and the next one takes as many frames as it holds. */
#include "pico.h"
#include "usb_descriptors.h"

#include <string.h>

/* the controller's RAM: the last request, then controls of endpoints, controls of their buffers, buffers */
#define REQUEST(k) (((const volatile uint8_t *)(uintptr_t)USB_RAM)[k])
#define BUFFER(at) ((volatile uint8_t *)(uintptr_t)(USB_RAM + (at)))
#define ENDPOINT_CONTROL(endpoint, out) REGISTER(USB_RAM + 8u * (endpoint) + 4u * (out))
#define BUFFER_CONTROL(endpoint, out) REGISTER(USB_RAM + 0x80u + 8u * (endpoint) + 4u * (out))
#define DONE(endpoint, out) (UINT32_C(1) << (2 * (endpoint) + (out)))
#define ENABLED (UINT32_C(1) << 31)
enum { IN, OUT };
enum { AT_CONTROL = 0x100, AT_NOTIFY = 0x180, AT_IN = 0x1c0, AT_OUT = 0x200 };
enum { FULL = 1 << 15, DATA1 = 1 << 13, STALL = 1 << 11, AVAILABLE = 1 << 10, LENGTH = 0x3ff };
enum { EACH_BUFFER = 1 << 29, TYPE = 26 };
enum { CONTROLLER_ON = 1, PULL_UP = 1 << 16, EACH_CONTROL_BUFFER = 1 << 29, TO_PHY = 1 << 0, CONNECT = 1 << 3 };
enum { BUS_POWER = 1 << 3 | 1 << 2, BUS_RESET = 1 << 19, REQUESTED = 1 << 17, STALL_CONTROL = 3 };
enum { FROM_DEVICE = 0x80, CLASS = 0x20, OF_CLASS = 0x60, DTR = 1, LINE_CODING_BYTES = 7 };
enum { TX_BYTES = 2048 }; /* a power of two */

static uint8_t tx[TX_BYTES];
static uint16_t tx_head, tx_tail; /* count freely */
static uint8_t tx_under_way, tx_full; /* full: the computer waits for what follows a whole packet, be it nothing */
static uint8_t rx_at, rx_count;
static uint8_t configured, open;

static uint8_t toggle[3][2]; /* DATA0 and DATA1 take turns, by endpoint and direction */
static uint8_t line_coding[LINE_CODING_BYTES] = {0x20, 0xa1, 0x07, 0, 0, 0, 8}; /* 500000 8N1, to no effect */
static const uint8_t *reply;
static uint16_t reply_left;
static uint8_t address, coding_follows;

/* Hand a buffer to the controller. The bit that does so comes last, when the others have reached the other clock. */
static void give(uint8_t endpoint, uint8_t out, uint32_t control)
{
    control |= toggle[endpoint][out] ? DATA1 : 0;
    toggle[endpoint][out] ^= 1;
    BUFFER_CONTROL(endpoint, out) = control;
    for (volatile uint8_t k = 0; k < 3; k++) {
    }
    BUFFER_CONTROL(endpoint, out) = control | AVAILABLE;
}

static void receive_more(void)
{
    rx_at = rx_count = 0;
    give(DATA, OUT, PACKET);
}

/* Both ends begin with DATA0. */
static void endpoint_begin(uint8_t out)
{
    BUFFER_CONTROL(DATA, out) = 0;
    toggle[DATA][out] = 0;
    if (out) {
        receive_more();
    } else {
        tx_under_way = tx_full = 0;
    }
}

static void configure(uint8_t configuration)
{
    configured = configuration;
    open = 0;
    if (configured) {
        ENDPOINT_CONTROL(NOTIFY, IN) = ENABLED | EACH_BUFFER | INTERRUPT << TYPE | AT_NOTIFY;
        ENDPOINT_CONTROL(DATA, IN) = ENABLED | EACH_BUFFER | BULK << TYPE | AT_IN;
        ENDPOINT_CONTROL(DATA, OUT) = ENABLED | EACH_BUFFER | BULK << TYPE | AT_OUT;
        endpoint_begin(IN);
        endpoint_begin(OUT);
    }
}

/* The next part of a reply; of none, what says that a request was done. */
static void reply_next(void)
{
    const uint16_t count = reply_left < PACKET ? reply_left : PACKET;
    for (uint16_t k = 0; k < count; k++) {
        BUFFER(AT_CONTROL)[k] = *reply++;
    }
    reply_left = (uint16_t)(reply_left - count);
    give(0, IN, FULL | count);
}

static void reply_with(const uint8_t *bytes, uint16_t count, uint16_t most)
{
    reply = bytes;
    reply_left = count < most ? count : most;
    reply_next();
}

/* Take back what was given for a request that the computer gave up. */
static void control_begin(void)
{
    BUFFER_CONTROL(0, IN) = BUFFER_CONTROL(0, OUT) = 0;
    reply_left = 0;
    coding_follows = 0;
}

static void refuse(void)
{
    REGISTER(USB_STALL_ARM) = STALL_CONTROL;
    BUFFER_CONTROL(0, IN) = BUFFER_CONTROL(0, OUT) = STALL;
}

static void describe(uint8_t type, uint8_t index, uint16_t most)
{
    static uint8_t text[2 + 2 * LONGEST_STRING];
    if (type == DEVICE) {
        reply_with(device_descriptor, sizeof device_descriptor, most);
    } else if (type == CONFIGURATION) {
        reply_with(configuration_descriptor, sizeof configuration_descriptor, most);
    } else if (type == STRING && index < sizeof strings / sizeof *strings) {
        uint8_t count = 2;
        for (const char *from = strings[index]; *from; from++) { /* UTF-16 */
            text[count++] = (uint8_t)*from;
            text[count++] = index == 0 ? (uint8_t)*++from : 0; /* the first one is the language's number */
        }
        text[0] = count;
        text[1] = STRING;
        reply_with(text, count, most);
    } else {
        refuse();
    }
}

/* A port that is closed hears nothing any more. Closed at 1200 baud it asks for the boot ROM, as Arduinos have it. */
static void line_state(hl_core *core, uint8_t state)
{
    open = state & DTR;
    if (!open) {
        tx_tail = tx_head;
        if (line_coding[0] == (1200 & 0xff) && line_coding[1] == 1200 >> 8 && line_coding[2] == 0) {
            store_bootloader(core);
        }
    }
}

static void answer_request(hl_core *core)
{
    static const uint8_t zeros[2];
    const uint8_t kind = REQUEST(0), request = REQUEST(1), value = REQUEST(2), index = REQUEST(4);
    const uint16_t most = (uint16_t)(REQUEST(6) | REQUEST(7) << 8);
    control_begin();
    toggle[0][IN] = toggle[0][OUT] = 1;
    if ((kind & OF_CLASS) == CLASS) {
        if (request == SET_LINE_CODING && most == LINE_CODING_BYTES) {
            coding_follows = 1;
            give(0, OUT, PACKET);
            return;
        }
        if (request == GET_LINE_CODING) {
            reply_with(line_coding, LINE_CODING_BYTES, most);
            return;
        }
        if (request != SET_LINE_STATE && request != SEND_BREAK) {
            refuse();
            return;
        }
        reply_with(zeros, 0, 0);
        if (request == SET_LINE_STATE) {
            line_state(core, value);
        }
    } else if (kind & OF_CLASS) {
        refuse(); /* a vendor's */
    } else if (request == GET_DESCRIPTOR) {
        describe(REQUEST(3), value, most);
    } else if (kind & FROM_DEVICE) {
        const uint8_t is_configuration = request == GET_CONFIGURATION;
        reply_with(is_configuration ? &configured : zeros, request == GET_STATUS ? 2 : 1, most);
    } else if (request == SET_ADDRESS || request == SET_CONFIGURATION || request == CLEAR_FEATURE || request == SET_INTERFACE) {
        address = request == SET_ADDRESS ? value : address;
        if (request == SET_CONFIGURATION) {
            configure(value);
        } else if (request == CLEAR_FEATURE && (index & 15) == DATA) {
            endpoint_begin(!(index & FROM_DEVICE));
        }
        reply_with(zeros, 0, 0);
    } else {
        refuse();
    }
}

/* Buffers that the controller has filled or emptied. */
static void take_buffers(void)
{
    const uint32_t done = REGISTER(USB_BUFF_STATUS);
    if (done == 0) {
        return;
    }
    REGISTER(USB_BUFF_STATUS) = done;
    if (done & DONE(0, IN)) {
        REGISTER(USB_ADDRESS) = address; /* a new one holds from the end of the request that set it */
        if (reply_left) {
            reply_next();
        } else if (REQUEST(0) & FROM_DEVICE) {
            give(0, OUT, 0);
        }
    }
    if (done & DONE(0, OUT) && coding_follows) {
        coding_follows = 0;
        for (uint8_t k = 0; k < LINE_CODING_BYTES; k++) {
            line_coding[k] = BUFFER(AT_CONTROL)[k];
        }
        reply_left = 0;
        reply_next();
    }
    if (done & DONE(DATA, IN)) {
        tx_under_way = 0;
    }
    if (done & DONE(DATA, OUT)) {
        rx_count = (uint8_t)(BUFFER_CONTROL(DATA, OUT) & LENGTH);
        if (rx_count == 0) {
            receive_more();
        }
    }
}

static void feed(hl_core *core)
{
    while (rx_at < rx_count && !core->rx_ready) {
        hl_core_byte(core, BUFFER(AT_OUT)[rx_at++]);
        if (rx_at == rx_count) {
            receive_more();
        }
    }
}

static void send_packet(void)
{
    const uint16_t waiting = (uint16_t)(tx_head - tx_tail), count = waiting < PACKET ? waiting : PACKET;
    if (!configured || tx_under_way || (count == 0 && !tx_full)) {
        return;
    }
    for (uint16_t k = 0; k < count; k++) {
        BUFFER(AT_IN)[k] = tx[tx_tail++ % TX_BYTES];
    }
    tx_full = count == PACKET;
    tx_under_way = 1;
    give(DATA, IN, FULL | count);
}

void usb_poll(hl_core *core)
{
    const uint32_t status = REGISTER(USB_SIE_STATUS);
    take_buffers();
    if (status & BUS_RESET) {
        REGISTER(USB_SIE_STATUS) = BUS_RESET;
        address = 0;
        REGISTER(USB_ADDRESS) = 0;
        control_begin();
        configure(0);
    }
    if (status & REQUESTED) {
        REGISTER(USB_SIE_STATUS) = REQUESTED;
        answer_request(core);
    }
    feed(core);
    send_packet();
}

/* To a closed port everything goes, and nobody hears it. */
uint8_t board_send(hl_core *core, const uint8_t *bytes, uint8_t count)
{
    (void)core;
    if (!open) {
        return 1;
    }
    if (count > TX_BYTES - (uint16_t)(tx_head - tx_tail)) {
        return 0;
    }
    while (count--) {
        tx[tx_head++ % TX_BYTES] = *bytes++;
    }
    return 1;
}

void usb_begin(void)
{
    for (uint32_t at = 0; at < 0x1000; at += 4) {
        REGISTER(USB_RAM + at) = 0;
    }
    REGISTER(USB_MUXING) = TO_PHY | CONNECT;
    REGISTER(USB_POWER) = BUS_POWER;
    REGISTER(USB_MAIN_CTRL) = CONTROLLER_ON;
    REGISTER(USB_SIE_CTRL) = EACH_CONTROL_BUFFER;
    SET_BITS(USB_SIE_CTRL) = PULL_UP;
}
