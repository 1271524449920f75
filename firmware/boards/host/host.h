/* This computer as a board: the whole core, with time, position and link in the caller's hands. */
#ifndef HL_HOST_H
#define HL_HOST_H

#include "board.h"

#if defined(_WIN32)
#define HL_EXPORT __declspec(dllexport)
#elif defined(__wasm__)
#define HL_EXPORT __attribute__((visibility("default")))
#else
#define HL_EXPORT
#endif

typedef struct hl_host hl_host;

/* Power on, with HL_STORE_BYTES of kept memory; NULL where there is no memory. */
HL_EXPORT hl_host *hl_host_new(const uint8_t *store, uint8_t reset_cause);
HL_EXPORT void hl_host_free(hl_host *host);

/* Bytes from the link; every whole frame among them is answered. */
HL_EXPORT void hl_host_receive(hl_host *host, const uint8_t *bytes, uint32_t count);

/* Take at most `room` bytes for the link; returns how many. */
HL_EXPORT uint32_t hl_host_transmit(hl_host *host, uint8_t *bytes, uint32_t room);

/* One tick at `clock` [us], with the handle at `counts`, in which the step takes `step` [us]. Returns the duty. */
HL_EXPORT int hl_host_tick(hl_host *host, int32_t counts, uint16_t clock, uint16_t step);

HL_EXPORT int hl_host_duty(const hl_host *host);
HL_EXPORT uint32_t hl_host_period_us(const hl_host *host);
HL_EXPORT const uint8_t *hl_host_store(const hl_host *host);
/* The first byte of the running program, for tests that damage it. */
HL_EXPORT uint8_t *hl_host_program(hl_host *host);
/* Let a tick come just before the next time that ticks are held off, or just after it, as an interrupt may. */
enum { HL_AT_NO_LOCK, HL_AT_LOCK, HL_AT_UNLOCK };
HL_EXPORT void hl_host_race(hl_host *host, int at);
/* The power fails after so many bytes written to the store. */
HL_EXPORT void hl_host_cut(hl_host *host, uint32_t bytes);
HL_EXPORT void hl_host_fault(hl_host *host, int fault);

#endif
