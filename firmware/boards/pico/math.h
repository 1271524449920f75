/* What the core uses of the C library's header: no C library is linked on this board. */
#ifndef HL_MATH_H
#define HL_MATH_H

#define NAN __builtin_nanf("")
#define INFINITY __builtin_inff()

float sqrtf(float a);

#endif
