/* What the device says of itself: one CDC ACM port (USB CDC 1.2, PSTN 1.2), for which every system has a driver. */
#ifndef HL_USB_DESCRIPTORS_H
#define HL_USB_DESCRIPTORS_H

#include <stdint.h>

/* Raspberry Pi's numbers for a serial port on an RP2040: README.md */
enum { VENDOR = 0x2e8a, PRODUCT = 0x000a };

enum { NOTIFY = 1, DATA = 2, PACKET = 64 }; /* endpoints, and the bytes of a packet */
enum { DEVICE = 1, CONFIGURATION = 2, STRING = 3, INTERFACE = 4, ENDPOINT = 5, ASSOCIATION = 11, CDC = 0x24 };
enum { CLASS_CDC = 2, ACM = 2, CLASS_DATA = 10, BULK = 2, INTERRUPT = 3, TO_COMPUTER = 0x80, LINE_REQUESTS = 2 };
enum { GET_STATUS = 0, CLEAR_FEATURE = 1, SET_ADDRESS = 5, GET_DESCRIPTOR = 6, GET_CONFIGURATION = 8, SET_CONFIGURATION = 9, SET_INTERFACE = 11 };
enum { SET_LINE_CODING = 0x20, GET_LINE_CODING = 0x21, SET_LINE_STATE = 0x22, SEND_BREAK = 0x23 };
enum { CONFIGURATION_BYTES = 75, LONGEST_STRING = 16 };

static const uint8_t device_descriptor[] = {
    18, DEVICE, 0x00, 0x02, 0xef, 2, 1, PACKET, /* USB 2.0, classes by association */
    VENDOR & 0xff, VENDOR >> 8, PRODUCT & 0xff, PRODUCT >> 8, 0x00, 0x01, 1, 2, 0, 1,
};

static const uint8_t configuration_descriptor[CONFIGURATION_BYTES] = {
    9, CONFIGURATION, CONFIGURATION_BYTES, 0, 2, 1, 0, 0x80, 50, /* from the bus, 100 mA */
    8, ASSOCIATION, 0, 2, CLASS_CDC, ACM, 0, 0,
    9, INTERFACE, 0, 0, 1, CLASS_CDC, ACM, 0, 0,
    5, CDC, 0, 0x20, 0x01, /* CDC 1.2 */
    5, CDC, 1, 0, 1, /* no call management */
    4, CDC, 2, LINE_REQUESTS,
    5, CDC, 6, 0, 1, /* interfaces 0 and 1 are one function */
    7, ENDPOINT, TO_COMPUTER | NOTIFY, INTERRUPT, 8, 0, 255,
    9, INTERFACE, 1, 0, 2, CLASS_DATA, 0, 0, 0,
    7, ENDPOINT, DATA, BULK, PACKET, 0, 0,
    7, ENDPOINT, TO_COMPUTER | DATA, BULK, PACKET, 0, 0,
};

static const char *const strings[] = {"\x09\x04" /* English */, "hapticlab", "hapticlab paddle"};

#endif
