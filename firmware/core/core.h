/* The loop of a paddle: what is kept between ticks and messages. Everything of one board is in one hl_core. */
#ifndef HL_CORE_H
#define HL_CORE_H

#include "board_constants.h"
#include "messages.h"
#include "vm.h"

/* bytes of the largest frame: version and message, sequence, payload, guard, CRC-16; COBS adds one, and the end one */
#define HL_FRAME_BYTES (2 + HL_LARGEST_PAYLOAD + 4 + 2)
#define HL_WIRE_BYTES (HL_FRAME_BYTES + 2)
/* how often the handle is looked at while nothing runs */
#define HL_IDLE_PERIOD_US 1000
#if 5 + 4 * HL_CHANNELS > HL_LARGEST_PAYLOAD
#error "a sample of HL_CHANNELS numbers is larger than HL_LARGEST_PAYLOAD"
#endif

/* A sensor's reading, and the way from one to another. Both turn over by themselves where an encoder's count does. */
#if defined(HL_READING_BITS) && HL_READING_BITS == 32
typedef uint32_t hl_reading;
typedef int32_t hl_way;
#define HL_WAY_SURE (INT32_MAX - 0x10000) /* counts a tick that are no turn */
#else
typedef uint16_t hl_reading;
typedef int16_t hl_way;
#define HL_WAY_SURE 24576
#endif

/* One tick for the link. */
typedef struct {
    uint32_t tick;
    hl_slot values[HL_CHANNELS]; /* x, v, F, then what the scene watches */
    uint8_t flags;               /* HL_SAMPLE_... */
} hl_sample;

/* A place for one program: its bytes, then its registers. */
typedef struct {
    union {
        uint8_t bytes[HL_ARENA_BYTES];
        hl_slot slots[HL_ARENA_BYTES / 4];
        hl_record record; /* settings pass through here too */
    } arena;
    hl_program program;
    hl_slot *registers;
    uint32_t crc;  /* the program's own, its last 4 bytes */
    uint16_t size; /* of its bytes; 0 while nothing verified is here */
    uint32_t sum;  /* of its parameters' bits as they were set, for the audit */
} hl_place;

/* What the tick has measured of itself, in counts of board_clock; begun anew with every start. */
typedef struct {
    uint16_t period_min, period_max, step_last, step_worst, overruns;
    uint32_t step_sum, steps; /* both are halved before the sum turns over */
} hl_timing;

/* Limits of the handle as counts, so that the tick compares whole numbers. */
typedef struct {
    int32_t lowest, highest; /* beyond them is over-travel */
    hl_way speed;            /* counts a tick */
    hl_way jump;             /* counts a tick by which the speed changes: more is doubted */
    hl_way alias;            /* counts from sample to sample, beyond them the sensor may have turned over unseen */
    int32_t span;            /* between the stops */
} hl_limits;

/* How the handle was followed from reading to reading. */
enum { HL_TRACK_FINE, HL_TRACK_FAST, HL_TRACK_LOST };
typedef struct {
    hl_reading reading; /* the last trusted one */
    hl_way step;        /* counts a period, as it was trusted last */
    hl_way ahead;       /* counts that the handle is taken to have gone since */
    uint8_t unread;     /* there is no reading yet */
    uint8_t sure;       /* `step` is of this period and no guess */
    uint8_t strained;   /* `step` was faster than the limit, though that may be a reading before it */
    uint8_t doubted;    /* periods for which the last reading was not trusted */
    uint8_t verdict;    /* at this tick: HL_TRACK_... */
} hl_track;

/* How long the sensor has not moved under a force, and what that leaves of the force. */
typedef struct {
    uint16_t counts; /* where it stands: the lower bits */
    uint16_t ticks;
    float gain, gain_step;
} hl_still;

typedef struct hl_core {
    /* link: rx is filled by hl_core_byte, tx holds a frame the board had no room for */
    uint8_t rx[HL_WIRE_BYTES], tx[HL_WIRE_BYTES];
    volatile uint8_t rx_count, rx_ready, rx_bad;
    uint8_t tx_count;
    uint8_t result;                           /* of the last guarded request obeyed in this session */
    uint8_t sent;                             /* sequence of samples and fault reports */
    uint16_t damaged;                         /* frames that were */
    uint32_t session;                         /* the host's number, 0 until it says hello */
    uint32_t obeyed;                          /* which of its guarded requests was obeyed last, counted from 1 */

    /* programs: `active` runs; `loading` is filled, and differs from it where the board has two places */
    hl_place places[HL_SLOTS];
    uint8_t active, loading, target;
    uint16_t announced; /* bytes of the upload under way, 0: none */

    /* state */
    volatile uint8_t state, fault, fault_unsent;
    uint32_t fault_tick;
    float fault_value;
    hl_settings settings;
    uint16_t record_at; /* in the store: the copy of the settings that is in use */
    uint8_t calibrated, homed, mismatch, armed, standalone;

    /* the handle */
    int32_t counts;            /* at this tick: readings, unwrapped, without bound */
    hl_track track;
    hl_still still;
    int32_t origin;            /* position = (counts - origin) * settings.metres_per_count */
    int32_t seen_min, seen_max; /* since the position became unknown */
    hl_limits limits;

    /* the loop */
    uint32_t tick;
    int32_t set_tick; /* set_tick: the last one before the parameters that were set last, -1: none */
    float x, v, force;
    float rate, force_limit, duty_per_force;
    uint16_t period_us, period_clocks, ticks_per_second, last_begin;
    uint8_t first;
    uint16_t every, countdown; /* decimation */
    uint16_t silent, silence;  /* ticks since the host was heard, and how many are too many */
    volatile uint8_t heard, ran;
    uint8_t late, was_late;    /* overruns in a row; the step before was one */
    uint16_t late_second, second;
    uint16_t curve[5];         /* motor.c: duty for no force and each quarter of the full one */
    int32_t heat;              /* of the motor, and what of it is less than one */
    float heat_rest, heat_scale;
    uint32_t heat_sum;         /* over heat_ticks; then in heat_taken over heat_given, until the main loop took it */
    volatile uint32_t heat_taken;
    volatile uint8_t heat_given;
    uint8_t heat_ticks;
    uint16_t rested;           /* ticks the handle has rested in the middle, for the standalone start */
    int32_t resting;           /* where */
    hl_timing timing;

    /* telemetry: head is written by the tick, tail by the link */
    hl_sample ring[HL_RING];
    volatile uint8_t head, tail;
    uint8_t channels; /* numbers of a sample of the running program */
    volatile uint16_t lost;

    /* audit of the running program, a few bytes a poll */
    uint32_t audit_crc;
    uint16_t audit_at;
} hl_core;

/* Motor off, settings read, nothing loaded, position unknown. Call once, after the board's clock and timer exist. */
void hl_core_start(hl_core *core);

/* One sample: read the handle, run the scene, drive the motor, record. Called by the board's timer. */
void hl_core_tick(hl_core *core);

/* One byte from the link. Safe to call from an interrupt that interrupts the tick. */
void hl_core_byte(hl_core *core, uint8_t byte);

/* What there is time for between ticks: answer a frame, send samples, audit the program. Call for ever. */
void hl_core_poll(hl_core *core);

/* Motor off, now; then say why. The first fault stays. Callable from the tick and outside it. */
void hl_core_fault(hl_core *core, uint8_t fault, float value);

#endif
