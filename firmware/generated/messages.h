/* Written by hapticlab/device/link/message_headers.py: change the Python tables, not this file. */

#ifndef HL_MESSAGES_H
#define HL_MESSAGES_H

#include <stdint.h>

#define HL_PROTOCOL 1
#define HL_FIRMWARE_MAJOR 2
#define HL_FIRMWARE_MINOR 0
#define HL_PROTOCOL_HASH 0x6490439fUL
#define HL_SETTINGS_HASH 0xb154e035UL
#define HL_LARGEST_PAYLOAD 48
#define HL_HOST_SILENCE_MS 100
#define HL_UNCHECKED_FORCE_N 0.5f
#define HL_OVERRUNS_IN_A_ROW 4
#define HL_OVERRUNS_PER_SECOND 20

/* X(name, number, bytes of the fields, guarded, more bytes may follow) */
#define HL_MESSAGES(X) \
    X(HELLO, 1, 4, 0, 0) \
    X(PING, 2, 4, 0, 0) \
    X(STATUS, 3, 4, 0, 0) \
    X(READ, 4, 3, 0, 0) \
    X(BEGIN, 5, 3, 0, 0) \
    X(DATA, 6, 2, 0, 1) \
    X(COMMIT, 7, 7, 1, 0) \
    X(START, 8, 11, 1, 0) \
    X(STOP, 9, 0, 1, 0) \
    X(SET, 10, 1, 1, 1) \
    X(HOME, 11, 4, 1, 0) \
    X(CLEAR, 12, 0, 1, 0) \
    X(ARM, 13, 1, 1, 0) \
    X(ACK, 16, 6, 0, 0) \
    X(WELCOME, 17, 32, 0, 0) \
    X(PONG, 18, 4, 0, 0) \
    X(STATE, 19, 43, 0, 0) \
    X(BYTES, 20, 2, 0, 1) \
    X(SAMPLE, 21, 5, 0, 1) \
    X(FAULTED, 22, 9, 0, 0)

enum {
    HL_MESSAGE_HELLO = 1,
    HL_MESSAGE_PING = 2,
    HL_MESSAGE_STATUS = 3,
    HL_MESSAGE_READ = 4,
    HL_MESSAGE_BEGIN = 5,
    HL_MESSAGE_DATA = 6,
    HL_MESSAGE_COMMIT = 7,
    HL_MESSAGE_START = 8,
    HL_MESSAGE_STOP = 9,
    HL_MESSAGE_SET = 10,
    HL_MESSAGE_HOME = 11,
    HL_MESSAGE_CLEAR = 12,
    HL_MESSAGE_ARM = 13,
    HL_MESSAGE_ACK = 16,
    HL_MESSAGE_WELCOME = 17,
    HL_MESSAGE_PONG = 18,
    HL_MESSAGE_STATE = 19,
    HL_MESSAGE_BYTES = 20,
    HL_MESSAGE_SAMPLE = 21,
    HL_MESSAGE_FAULTED = 22,
};

/* where the fields of a payload begin */
enum {
    HL_AT_HELLO_SESSION = 0, /* uint32_t */
    HL_AT_PING_TOKEN = 0, /* uint32_t */
    HL_AT_STATUS_SESSION = 0, /* uint32_t */
    HL_AT_READ_OFFSET = 0, /* uint16_t */
    HL_AT_READ_COUNT = 2, /* uint8_t */
    HL_AT_BEGIN_TARGET = 0, /* uint8_t */
    HL_AT_BEGIN_SIZE = 1, /* uint16_t */
    HL_AT_DATA_OFFSET = 0, /* uint16_t */
    HL_AT_COMMIT_TARGET = 0, /* uint8_t */
    HL_AT_COMMIT_SIZE = 1, /* uint16_t */
    HL_AT_COMMIT_LAST_CRC = 3, /* uint32_t */
    HL_AT_START_CRC = 0, /* uint32_t */
    HL_AT_START_EVERY = 4, /* uint16_t */
    HL_AT_START_OPTIONS = 6, /* uint8_t */
    HL_AT_START_FORCE_MAX = 7, /* float */
    HL_AT_SET_COUNT = 0, /* uint8_t */
    HL_AT_HOME_POSITION = 0, /* float */
    HL_AT_ARM_ARMED = 0, /* uint8_t */
    HL_AT_ACK_REQUEST = 0, /* uint8_t */
    HL_AT_ACK_RESULT = 1, /* uint8_t */
    HL_AT_ACK_TICK = 2, /* int32_t */
    HL_AT_WELCOME_TABLE = 0, /* uint32_t */
    HL_AT_WELCOME_BOARD = 4, /* bytes */
    HL_AT_WELCOME_IDENT = 12, /* uint16_t */
    HL_AT_WELCOME_MAJOR = 14, /* uint8_t */
    HL_AT_WELCOME_MINOR = 15, /* uint8_t */
    HL_AT_WELCOME_WORD_BYTES = 16, /* uint8_t */
    HL_AT_WELCOME_ARENA = 17, /* uint16_t */
    HL_AT_WELCOME_SLOTS = 19, /* uint8_t */
    HL_AT_WELCOME_CHANNELS = 20, /* uint8_t */
    HL_AT_WELCOME_CLOCK_HZ = 21, /* uint32_t */
    HL_AT_WELCOME_DUTY_FULL = 25, /* uint16_t */
    HL_AT_WELCOME_PERIOD_MIN = 27, /* uint16_t */
    HL_AT_WELCOME_PERIOD_MAX = 29, /* uint16_t */
    HL_AT_WELCOME_RESET_CAUSE = 31, /* uint8_t */
    HL_AT_PONG_TOKEN = 0, /* uint32_t */
    HL_AT_STATE_SESSION = 0, /* uint32_t */
    HL_AT_STATE_STATE = 4, /* uint8_t */
    HL_AT_STATE_FAULT = 5, /* uint8_t */
    HL_AT_STATE_FLAGS = 6, /* uint8_t */
    HL_AT_STATE_TICK = 7, /* uint32_t */
    HL_AT_STATE_COUNTS = 11, /* int32_t */
    HL_AT_STATE_X = 15, /* float */
    HL_AT_STATE_FORCE = 19, /* float */
    HL_AT_STATE_HEAT = 23, /* float */
    HL_AT_STATE_PERIOD_MIN = 27, /* uint16_t */
    HL_AT_STATE_PERIOD_MAX = 29, /* uint16_t */
    HL_AT_STATE_STEP_LAST = 31, /* uint16_t */
    HL_AT_STATE_STEP_WORST = 33, /* uint16_t */
    HL_AT_STATE_STEP_MEAN = 35, /* uint16_t */
    HL_AT_STATE_OVERRUNS = 37, /* uint16_t */
    HL_AT_STATE_LOST = 39, /* uint16_t */
    HL_AT_STATE_DAMAGED = 41, /* uint16_t */
    HL_AT_BYTES_OFFSET = 0, /* uint16_t */
    HL_AT_SAMPLE_TICK = 0, /* uint32_t */
    HL_AT_SAMPLE_FLAGS = 4, /* uint8_t */
    HL_AT_FAULTED_FAULT = 0, /* uint8_t */
    HL_AT_FAULTED_TICK = 1, /* uint32_t */
    HL_AT_FAULTED_VALUE = 5, /* float */
};

enum {
    HL_RESULT_BUSY = 32,
    HL_RESULT_NO_PROGRAM = 33,
    HL_RESULT_NOT_HOMED = 34,
    HL_RESULT_LENGTH = 35,
    HL_RESULT_GUARD = 36,
    HL_RESULT_STALE = 37,
    HL_RESULT_RANGE = 38,
    HL_RESULT_TOO_LARGE = 39,
    HL_RESULT_NO_VALUE = 40,
    HL_RESULT_STORE = 41,
    HL_RESULT_UNKNOWN = 42,
    HL_RESULT_FAULT = 43,
    HL_RESULT_NOT_CALIBRATED = 44,
    HL_RESULT_CHANNELS = 45,
    HL_RESULT_ALIAS = 47,
    HL_RESULT_HOT = 46,
    HL_RESULT_NOT_WIRED = 48,
};

enum {
    HL_FAULT_NONE = 0,
    HL_FAULT_HOST_SILENT = 1,
    HL_FAULT_NOT_FINITE = 2,
    HL_FAULT_OVER_SPEED = 3,
    HL_FAULT_OVER_TRAVEL = 4,
    HL_FAULT_OVER_HEAT = 5,
    HL_FAULT_OVERRUN = 6,
    HL_FAULT_BAD_PROGRAM = 7,
    HL_FAULT_SENSOR = 8,
    HL_FAULT_FROZEN = 10,
    HL_FAULT_MEMORY = 9,
};

enum {
    HL_STATE_IDLE = 0,
    HL_STATE_RUN = 1,
    HL_STATE_FAULT = 2,
};

enum {
    HL_TARGET_PROGRAM = 0,
    HL_TARGET_SETTINGS = 1,
    HL_TARGET_STANDALONE = 2,
};

enum {
    HL_FLAG_HOMED = 1,
    HL_FLAG_CALIBRATED = 2,
    HL_FLAG_SIGN_CHECKED = 4,
    HL_FLAG_ARMED = 8,
    HL_FLAG_STANDALONE = 16,
    HL_FLAG_READY = 32,
    HL_FLAG_TRAVEL_MISMATCH = 64,
};

enum {
    HL_SAMPLE_SATURATED = 1,
    HL_SAMPLE_OVERRUN = 2,
    HL_SAMPLE_FIRST = 4,
};

enum {
    HL_OPTION_PASSIVE = 1,
};

enum {
    HL_SENSOR_MAGNETORESISTIVE = 0,
    HL_SENSOR_QUADRATURE = 1,
    HL_SENSOR_AS5048A = 2,
};

enum {
    HL_DRIVE_PWM_DIRECTION = 0,
    HL_DRIVE_TWO_INPUTS = 1,
    HL_DRIVE_TWO_INPUTS_ENABLE = 2,
    HL_DRIVE_SHIFT_REGISTER = 3,
};

enum {
    HL_MOTOR_LINEAR = 0,
    HL_MOTOR_SQRT = 1,
    HL_MOTOR_MEASURED = 2,
};

enum {
    HL_RESET_POWER_OR_RESET = 0,
    HL_RESET_POWER = 1,
    HL_RESET_EXTERNAL = 2,
    HL_RESET_BROWN_OUT = 3,
    HL_RESET_WATCHDOG = 4,
};

/* what the loop works with */
typedef struct {
    float metres_per_count; /* [m] handle travel of one count; its sign makes x grow into the wall */
    float travel_min; /* [m] position of the lower stop */
    float travel_max; /* [m] position of the upper stop */
    float force_full; /* [N] force at the handle at full duty */
    float force_max; /* [N] the largest force ever commanded */
    float force_continuous; /* [N] the largest force the motor stands for ever */
    float heating_time; /* [s] time constant of the motor's heating */
    float speed_max; /* [m/s] faster than this is a fault */
    uint32_t motor_pins; /* [1] pins of the motor's driver, one a byte */
    uint32_t sensor_pins; /* [1] pins of the sensor, one a byte */
    uint32_t carrier; /* [Hz] frequency of the PWM, rounded to what the board's timer can do */
    uint8_t sensor; /* [1] SENSORS */
    uint8_t drive; /* [1] how the motor's driver is told: DRIVES */
    uint16_t wrap; /* [1] counts after which the reading of an angle sensor repeats */
    uint8_t wired; /* [1] 1 once a person has confirmed the wiring */
    uint8_t checked; /* [1] 1 once the motor's sign was seen to be right */
    uint8_t motor_law; /* [1] duty from force: MOTOR_LAWS */
    int8_t motor_sign; /* [1] 1, or -1 where the motor's wires are swapped */
} hl_settings;

/* what survives power-off */
typedef struct {
    uint32_t layout; /* [1] CRC-32 of this table, so that settings of another firmware are not taken for these */
    hl_settings loop;
    float duty_dead; /* [1] part of full duty below which the motor gives no force */
    float duty_25; /* [1] part of full duty for a quarter of force_full, where the law is MEASURED */
    float duty_50; /* [1] part of full duty for half of force_full, where the law is MEASURED */
    float duty_75; /* [1] part of full duty for three quarters of force_full, where the law is MEASURED */
    uint32_t ident; /* [1] 16 bits that name this very paddle */
    uint32_t date; /* [1] of calibration, as 20261120; 0: never calibrated */
    float m; /* [kg] effective mass, for the computer's models */
    float b; /* [N s/m] viscous damping, for the computer's models */
    float coulomb; /* [N] Coulomb friction, for the computer's models */
    float sensor_delay; /* [s] age of the sensor's reading, for the computer's models */
    float sensor_noise; /* [m] standard deviation of the sensor's noise, for the computer's models */
    float sensor_flight; /* [s] time in which an angle sensor goes from its last count back to its first */
    uint32_t crc; /* [1] CRC-32 of all before it */
} hl_record;

#define HL_RECORD_BYTES 108 /* on the wire and in the store: no compiler may pad it */
#define HL_NO_PIN 255
#define HL_METRES_PER_COUNT_MIN 1e-12f
#define HL_COUNTS_MAX 100000000.0f
#define HL_WRAP_MIN 16
#define HL_WRAP_MAX 16384

#define HL_WIRING_BYTES 14 /* what a person confirms, from motor_pins on */

/* X(member of the record, lowest, highest) */
#define HL_SETTING_RANGES(X) \
    X(loop.metres_per_count, -0.1f, 0.1f) \
    X(loop.travel_min, -1000.0f, 1000.0f) \
    X(loop.travel_max, -1000.0f, 1000.0f) \
    X(loop.force_full, 1e-06f, 1000000.0f) \
    X(loop.force_max, 1e-06f, 1000000.0f) \
    X(loop.force_continuous, 1e-06f, 1000000.0f) \
    X(loop.heating_time, 1.0f, 1000000.0f) \
    X(loop.speed_max, 1e-06f, 1000000.0f) \
    X(duty_dead, 0.0f, 0.5f) \
    X(duty_25, 0.0f, 1.0f) \
    X(duty_50, 0.0f, 1.0f) \
    X(duty_75, 0.0f, 1.0f) \
    X(m, 0.0f, 1000000.0f) \
    X(b, 0.0f, 1000000.0f) \
    X(coulomb, 0.0f, 1000000.0f) \
    X(sensor_delay, 0.0f, 1.0f) \
    X(sensor_noise, 0.0f, 1.0f) \
    X(sensor_flight, 0.0f, 0.01f)

#endif
