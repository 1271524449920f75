/* This computer as a board that has no clock: many samples and many lanes in one call. */
#ifndef HL_HOST_RUN_H
#define HL_HOST_RUN_H

#include "vm.h"

#if defined(_WIN32)
#define HL_EXPORT __declspec(dllexport)
#elif defined(__wasm__)
#define HL_EXPORT __attribute__((visibility("default")))
#else
#define HL_EXPORT
#endif

/* Verify alone. */
HL_EXPORT int hl_host_verify(const uint8_t *bytes, uint32_t size, hl_slot *registers, uint16_t capacity);

/* Run `ticks` samples of every lane. inputs (ticks, inputs), parameters (parameters, lanes), states (states, lanes),
 * outputs (ticks / every, outputs, lanes), all doubles in C order. have_states: states are where a run ended, else init
 * makes them. From a sample that is not finite on, a lane's outputs and its states are nan.
 * scratch: one slot an output. faults: one int a lane, its hl_result. Returns what hl_verify returned. */
HL_EXPORT int hl_host_run(const uint8_t *bytes, uint32_t size, hl_slot *registers, uint16_t capacity, hl_slot *scratch,
                          int64_t ticks, int64_t every, int64_t lanes, int have_states, const double *inputs,
                          const double *parameters, double *states, double *outputs, int32_t *faults);

#endif
