/* What the parts of the core ask of each other. */
#ifndef HL_PARTS_H
#define HL_PARTS_H

#include "board.h"

/* called, not copied to where it is used: a small board's flash is short */
#if defined(__AVR__)
#define HL_CALLED __attribute__((__noinline__))
#else
#define HL_CALLED
#endif

/* From one count to another; they have no bounds, so the difference may turn over, and is right again when they meet. */
static inline int32_t hl_moved(int32_t from, int32_t to)
{
    return (int32_t)((uint32_t)to - (uint32_t)from);
}

/* store.c: what survives power-off */
enum { HL_COPIES = 2 };
enum { /* addresses; the settings are at 0 */
    HL_STORE_ARMED = HL_COPIES * HL_RECORD_BYTES,
    HL_STORE_SIZE = HL_STORE_ARMED + 1,
    HL_STORE_PROGRAM = HL_STORE_ARMED + 4
};
int hl_settings_valid(const hl_record *record);
void hl_settings_load(hl_core *core, hl_place *place);
uint8_t hl_settings_save(hl_core *core, hl_place *place);
uint8_t hl_store_program(hl_core *core, const hl_place *place, uint16_t size);
uint8_t hl_store_arm(hl_core *core, uint8_t armed);
uint8_t hl_load_standalone(hl_core *core);

/* reading.c: the sensor, tick by tick */
void hl_handle_read(hl_core *core, uint16_t periods);
float hl_handle_fade(hl_core *core, float force);

/* idle.c */
void hl_idle(hl_core *core);

/* handle.c: where the handle is */
void hl_handle_limits(hl_core *core);
void hl_handle_place(hl_core *core, float position);
void hl_handle_lose(hl_core *core);
int32_t hl_handle_speed(const hl_core *core, uint16_t period_us);
uint8_t hl_handle_outside(const hl_core *core, int32_t margin);
void hl_handle_watch(hl_core *core);
float hl_handle_position(const hl_core *core, int32_t counts); /* [m] */

/* place.c: programs */
uint8_t hl_place_verify(hl_place *place, uint16_t size);
uint8_t hl_place_start(hl_core *core, uint8_t index, uint16_t every, uint8_t options, float force_max);
uint32_t hl_place_sum(const hl_place *place);
void hl_place_idle(hl_core *core);
void hl_stop(hl_core *core);

/* motor.c: parts of full force and full duty count from 0 to HL_ONE, the heat of full force to HL_FULL_HEAT */
#define HL_ONE UINT32_C(65536)
#define HL_FULL_HEAT (HL_ONE / 256 * HL_ONE)
void hl_motor(hl_core *core, float force);
void hl_heat(hl_core *core, uint16_t part);

/* heat.c: what force_continuous makes of the motor in the end, and what nothing can pass; in heat_given, that it is too hot */
#define HL_HEAT_STANDS (INT32_C(1) << 24)
#define HL_HEAT_MOST (INT32_C(1) << 29) /* so that two of them fit */
#define HL_HEAT_OVER 255
void hl_motor_configure(hl_core *core, const float curve[4], float stood);
void hl_heat_follow(hl_core *core);
void hl_heat_close(hl_core *core);

/* message.c: do what the message at `frame` asks, `count` bytes of payload and guard; write the reply's payload and its
 * number, and return how long it is */
uint8_t hl_answer(hl_core *core, const uint8_t *frame, uint8_t count, uint8_t *to, uint8_t *reply);

#endif
