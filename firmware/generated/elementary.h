/* Written by hapticlab/compiler/boards/c_headers.py: change the Python tables, not this file. */

#ifndef HL_ELEMENTARY_H
#define HL_ELEMENTARY_H

float hl_sinf(float x);
float hl_cosf(float x);
float hl_expf(float x);
float hl_logf(float x);
float hl_atanf(float x);
float hl_tanhf(float x);

#endif
