; Addition, subtraction, multiplication and division of floats: what the compiler calls for + - * /.
;
; avr-libc's, which these replace, shift bit by bit where numbers are denormal or cancel: some operands take three times as
; long as others, and what a scene is promised is the worst. Here the hardware's multiplier shifts by up to 8 bits at once.
; Every result is the one that IEEE 754 asks for, to nearest, ties to even, denormals too.
;
; a is in r25:r22, b in r21:r18, the result in r25:r22. Inside:
;     r24:r22, r20:r18  mantissas, 24 bits with the hidden one;  r25, r21 exponents as they are stored, 1 for denormals
;     r31               eight bits behind the mantissa, the lowest set if any behind it is (sticky)
;     r27               the result's sign in bit 7
;     r1                zero, but just after a mul

#define zero r1

; r = 2^n, n in 0 ... 7
.macro power_of_two r, n
    ldi \r, 1
    sbrc \n, 1
    ldi \r, 4
    sbrc \n, 0
    lsl \r
    sbrc \n, 2
    swap \r
.endm

; Shift high:mid:low and r31 right by d, 1 ... 255, given n = -d; r30 is lost.
.macro shift_right high, mid, low, n
    cpi \n, 256 - 25
    brsh 1f
    or \low, \mid       ; nothing is left of it but that it is not zero
    or \low, \high
    or \low, r31
    clr r31
    cpse \low, zero
    ldi r31, 1
    clr \low
    clr \mid
    clr \high
    rjmp 4f
1:  subi \n, -8         ; 8 - d; no carry where d > 8
    brcs 2f             ; the assembler's -8 is 0xF8: borrow means d > 8
    rjmp 3f
2:  cpse r31, zero
    ori \low, 1
    mov r31, \low
    mov \low, \mid
    mov \mid, \high
    clr \high
    rjmp 1b
3:  power_of_two r30, \n
    mul r31, r30
    mov r31, r1
    tst r0
    breq 5f
    ori r31, 1
5:  mul \low, r30
    or r31, r0
    mov \low, r1
    mul \mid, r30
    or \low, r0
    mov \mid, r1
    mul \high, r30
    or \mid, r0
    mov \high, r1
    clr zero
4:
.endm

    .section .text.float, "ax", @progbits
    .global __subsf3
    .global __addsf3
__subsf3:
    subi r21, 0x80
__addsf3:
    mov r27, r25
    mov r26, r25
    eor r26, r21        ; bit 7: their signs differ
    lsl r24
    rol r25
    lsl r20
    rol r21
    cp r22, r18         ; the larger magnitude is to be a
    cpc r23, r19
    cpc r24, r20
    cpc r25, r21
    brsh .Lordered
    movw r30, r22
    movw r22, r18
    movw r18, r30
    movw r30, r24
    movw r24, r20
    movw r20, r30
    eor r27, r26
.Lordered:
    cpi r25, 255
    brne 2f
    rjmp .Ladd_special
2:  mov r30, r21        ; the hidden bit is one unless the exponent is 0, which then counts as 1
    neg r30
    ror r20
    cpi r21, 1
    adc r21, zero
    mov r30, r25
    neg r30
    ror r24
    cpi r25, 1
    adc r25, zero
    clr r31
    sub r21, r25
    breq .Laligned
    cpi r21, -1         ; as near as that they may cancel, which takes long enough
    brne .Lfar
    lsr r20
    ror r19
    ror r18
    ror r31
    rjmp .Laligned
.Lfar:
    shift_right r20, r19, r18, r21
.Laligned:
    sbrc r26, 7
    rjmp .Lsubtract
    add r22, r18
    adc r23, r19
    adc r24, r20
    brcc .Lpack
    ror r24
    ror r23
    ror r22
    ror r31
    brcc 2f
    ori r31, 1
2:  inc r25
    cpi r25, 255
    brne .Lpack
    rjmp .Linfinity
.Lsubtract:
    neg r31
    sbc r22, r18
    sbc r23, r19
    sbc r24, r20
    brmi .Lpack
    sbrc r24, 6
    rjmp .Lone_bit
    mov r0, r24
    or r0, r23
    or r0, r22
    breq .Lcancelled
.Lnearly:
    rcall hl_float_normalise
    rjmp .Lpack
.Lcancelled:
    tst r31
    breq .Lexact_zero
    subi r25, 24        ; half a last bit is left, the highest of r31
    brcs 2f
    breq 2f
    mov r24, r31
    clr r31
    rjmp .Lpack
2:  subi r25, -24
    rjmp .Lnearly
.Lone_bit:                ; the usual case, unless it is a denormal already
    cpi r25, 1
    breq .Lpack
    dec r25
    lsl r31
    rol r22
    rol r23
    rol r24
    rjmp .Lpack
.Lexact_zero:
    clr r25
    ret
.Ladd_special:
    mov r30, r24
    or r30, r23
    or r30, r22
    brne 3f             ; nan
    cpse r21, r25
    rjmp .Linfinity
    sbrs r26, 7
    rjmp .Linfinity
3:  rjmp .Lnan

; Put sign, exponent and mantissa together, and round.
.Lpack:
    lsl r24
    brcs 1f
    dec r25             ; no hidden bit: a denormal
1:  lsl r27
    ror r25
    ror r24
    lsl r31
    brcc 3f
    brne 2f
    sbrs r22, 0
    ret
2:  subi r22, -1        ; a carry out of the mantissa makes the next exponent, at last infinity
    sbci r23, -1
    sbci r24, -1
    sbci r25, -1
3:  ret

.Lnan:
    ldi r25, 0x7f
    ldi r24, 0xc0
    clr r23
    clr r22
    clr zero
    ret
.Linfinity:
    ldi r24, 0x80
    ldi r25, 0x7f
    rjmp .Lsigned
.Lzero:
    clr r24
    clr r25
.Lsigned:
    clr r23
    clr r22
    lsl r27
    brcc 1f
    ori r25, 0x80
1:  ret

; Shift r24:r22 and behind left until the hidden bit is set, or r25 is 1. Not of zero. r26 and r30 are lost.
.macro normalise behind
1:  tst r24
    brne 2f
    cpi r25, 9
    brlo 5f
    subi r25, 8
    mov r24, r23
    mov r23, r22
    .ifnb \behind
    mov r22, \behind
    clr \behind
    .else
    clr r22
    .endif
    rjmp 1b
2:  clr r30
    mov r26, r24
    cpi r26, 0x10
    brsh 3f
    swap r26
    ldi r30, 4
3:  cpi r26, 0x40
    brsh 4f
    lsl r26
    lsl r26
    subi r30, -2
4:  sbrs r26, 7
    inc r30
    cp r30, r25
    brlo 6f
5:  mov r30, r25
    dec r30
6:  sub r25, r30
    power_of_two r26, r30
    mul r24, r26
    mov r24, r0
    mul r23, r26
    or r24, r1
    mov r23, r0
    mul r22, r26
    or r23, r1
    mov r22, r0
    .ifnb \behind
    mul \behind, r26
    or r22, r1
    mov \behind, r0
    .endif
    clr zero
.endm

hl_float_normalise:
    normalise r31
    ret

; Exponents and mantissas apart; on to `rare_a` unless a is normal, to `rare_b` if b alone is not.
.macro unpack rare_a, rare_b
    mov r27, r25
    eor r27, r21
    lsl r24
    rol r25
    lsl r20
    rol r21
    mov r30, r25
    dec r30
    cpi r30, 254
    brlo 1f
    rjmp \rare_a
1:  mov r30, r21
    dec r30
    cpi r30, 254
    brlo 2f
    rjmp \rare_b
2:  sec
    ror r24
    sec
    ror r20
.endm

hl_float_swap:
    movw r30, r22
    movw r22, r18
    movw r18, r30
    movw r30, r24
    movw r24, r20
    movw r20, r30
    ret

; Mantissas of numbers that may be denormal, whose exponents then stay 0. Z: a is zero.
hl_float_restore:
    mov r30, r25
    neg r30
    ror r24
    mov r30, r21
    neg r30
    ror r20
    mov r30, r24
    or r30, r23
    or r30, r22
    ret

    .global __mulsf3
__mulsf3:
    unpack .Lmul_rare_a, .Lmul_rare_b
    add r25, r21
    clr r21
    rol r21
    subi r25, 128
    sbc r21, zero       ; r21:r25 is the exponent less 1
.Lmul_mantissas:
    mul r22, r18
    mov r26, r0
    mov r30, r1
    clr r31
    mul r22, r19
    add r30, r0
    adc r31, r1
    mul r23, r18
    add r30, r0
    adc r31, r1
    or r26, r30         ; the lowest two bytes only matter in being zero or not
    clr r30
    rol r30
    mul r22, r20
    add r31, r0
    adc r30, r1
    clr r22
    mul r24, r18
    clr r18
    add r31, r0
    adc r30, r1
    adc r22, r18
    mul r23, r19
    add r31, r0
    adc r30, r1
    adc r22, r18
    mul r23, r20
    clr r23
    add r30, r0
    adc r22, r1
    adc r23, r18
    mul r24, r19
    add r30, r0
    adc r22, r1
    adc r23, r18
    mul r24, r20
    add r22, r0
    adc r23, r1
    clr zero
    mov r24, r23
    mov r23, r22
    mov r22, r30
    cpse r26, zero
    ori r31, 1
    sbrs r24, 7
    rjmp 1f
    subi r25, -1
    sbci r21, -1
    rjmp .Lfinish
1:  lsl r31
    rol r22
    rol r23
    rol r24
    cpse r26, zero
    ori r31, 1
; A mantissa, what is behind it, and r21:r25, its exponent less 1.
.Lfinish:
    tst r21
    brne .Lbeyond
    cpi r25, 254
    brsh .Llarge
    inc r25
    rjmp .Lpack
.Lbeyond:
    brpl .Llarge
    shift_right r24, r23, r22, r25
    ldi r25, 1          ; and no hidden bit, unless it rounds up to one
    rjmp .Lpack
.Llarge:
    rjmp .Linfinity

.Lmul_zero:
    rjmp .Lzero
.Lmul_special:
    rcall hl_float_restore
    cpi r25, 255
    brne 1f
    rcall hl_float_swap
1:          ; b is infinite or nan: is a, which may be so too, zero or nan?
    mov r30, r20
    lsl r30
    or r30, r19
    or r30, r18
    brne .Lmul_nan
    mov r30, r24
    or r30, r23
    or r30, r22
    breq .Lmul_nan
    cpi r25, 255
    brne .Lmul_infinity
    lsl r24
    or r24, r23
    or r24, r22
    brne .Lmul_nan
.Lmul_infinity:
    rjmp .Linfinity
.Lmul_nan:
    rjmp .Lnan
.Lmul_small:
    com r21             ; a denormal, however many leading zeros a has
    rjmp .Lmul_mantissas
.Lmul_rare_a:
    cpi r25, 255
    breq .Lmul_special
    cpi r21, 255
    breq .Lmul_special
    tst r21
    brne 1f
    rjmp .Lzero         ; both are below the least normal number
.Lmul_rare_b:
    cpi r21, 255
    breq .Lmul_special
    movw r30, r22
    movw r22, r18
    movw r18, r30
    movw r30, r24
    movw r24, r20
    movw r20, r30
1:  sec
    ror r20
    lsr r24             ; a is the denormal one
    mov r30, r24
    or r30, r23
    or r30, r22
    breq .Lmul_zero
    mov r25, r21
    clr r21
    subi r25, 127       ; the product's exponent less 1, where a's is 1
    brsh 2f
    rjmp .Lmul_small
2:  inc r25             ; as far to the left as it may be without becoming a denormal again
    normalise
    dec r25
    rjmp .Lmul_mantissas

    .global __divsf3
__divsf3:
    unpack .Ldiv_rare, .Ldiv_rare
    sub r25, r21
    sbc r21, r21
    subi r25, 130       ; the exponent less 1: + 126
    sbci r21, -1
.Ldiv_mantissas:
    cp r22, r18
    cpc r23, r19
    cpc r24, r20
    brsh 1f
    lsl r22
    rol r23
    rol r24
    subi r25, 1
    sbc r21, zero
1:  sub r22, r18        ; the quotient's first bit is one
    sbc r23, r19
    sbc r24, r20
    ldi r30, 3
    mov r0, r30
2:  mov r26, r31
    mov r31, r30
    .rept 8             ; eight bits of the quotient, zero for one
    lsl r22
    rol r23
    rol r24
    brcs 4f
    cp r22, r18
    cpc r23, r19
    cpc r24, r20
    brcs 5f
4:  sub r22, r18
    sbc r23, r19
    sbc r24, r20
    clc
5:  rol r30
    .endr
    com r30
    dec r0
    breq 6f
    rjmp 2b
6:  sec
    ror r26
    ror r31
    ror r30
    or r22, r23
    or r22, r24
    mov r24, r26
    mov r23, r31
    ldi r31, 0
    ror r31
    cpse r22, zero
    ori r31, 1
    mov r22, r30
    rjmp .Lfinish

.Ldiv_rare:
    rcall hl_float_restore
    cpi r25, 255
    breq .Ldiv_a_special
    mov r26, r20
    or r26, r19
    or r26, r18
    cpi r21, 255
    breq .Ldiv_b_special
    tst r26
    breq .Ldiv_by_zero
    tst r30
    breq .Ldiv_zero
    push r21
    push r25
    ldi r25, 64         ; far from the limit of hl_float_normalise
    clr r31
    rcall hl_float_normalise
    push r25
    rcall hl_float_swap
    ldi r25, 64
    clr r31
    rcall hl_float_normalise
    rcall hl_float_swap
    pop r30             ; 64 less a's leading zeros; r21: 64 less b's
    sub r30, r21
    mov r26, r30        ; what they add to the exponent
    pop r25
    pop r21
    cpi r25, 1
    adc r25, zero
    cpi r21, 1
    adc r21, zero
    sub r25, r21
    sbc r21, r21
    subi r25, 130
    sbci r21, -1
    add r25, r26
    adc r21, zero
    sbrc r26, 7
    dec r21
    rjmp .Ldiv_mantissas
.Ldiv_a_special:
    lsl r24
    or r24, r23
    or r24, r22
    brne .Ldiv_nan
    cpi r21, 255
    breq .Ldiv_nan
.Ldiv_infinity:
    rjmp .Linfinity
.Ldiv_b_special:
    lsl r20
    or r20, r19
    or r20, r18
    brne .Ldiv_nan
.Ldiv_zero:
    rjmp .Lzero
.Ldiv_by_zero:
    tst r30
    brne .Ldiv_infinity
.Ldiv_nan:
    rjmp .Lnan
