/* Registers of the RP2040 that this board uses. Names, addresses and bits are those of its datasheet. */
#ifndef HL_RP2040_H
#define HL_RP2040_H

#include <stdint.h>

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))
/* every register outside SIO and the processor has two more addresses that set and clear the bits written there */
#define SET_BITS(address) REGISTER((address) + 0x2000)
#define CLEAR_BITS(address) REGISTER((address) + 0x3000)

/* 2.14: one bit for each block that is held in reset */
#define RESETS 0x4000c000
#define RESETS_DONE 0x4000c008
enum {
    RESET_ADC = 1 << 0,
    RESET_IO = 1 << 5,
    RESET_PADS = 1 << 8,
    RESET_PIO0 = 1 << 10,
    RESET_PLL_SYS = 1 << 12,
    RESET_PLL_USB = 1 << 13,
    RESET_PWM = 1 << 14,
    RESET_SPI0 = 1 << 16,
    RESET_TIMER = 1 << 21,
    RESET_USB = 1 << 24,
};

/* 2.15, 2.16, 2.18: clocks */
#define CLOCK_REF_CTRL 0x40008030
#define CLOCK_REF_SELECTED 0x40008038
#define CLOCK_SYS_CTRL 0x4000803c
#define CLOCK_SYS_SELECTED 0x40008044
#define CLOCK_PERI_CTRL 0x40008048
#define CLOCK_USB_CTRL 0x40008054
#define CLOCK_ADC_CTRL 0x40008060
#define XOSC_CTRL 0x40024000
#define XOSC_STATUS 0x40024004
#define XOSC_STARTUP 0x4002400c
#define PLL_SYS 0x40028000
#define PLL_USB 0x4002c000

/* 2.13, 4.6, 4.7, 2.12: power, timer, watchdog, causes of a reset */
#define PSM_WDSEL 0x40010008
#define TIMER_ALARM0 0x40054010
#define TIMER_NOW 0x40054028
#define TIMER_INTR 0x40054034
#define TIMER_INTE 0x40054038
#define WATCHDOG_CTRL 0x40058000
#define WATCHDOG_LOAD 0x40058004
#define WATCHDOG_REASON 0x40058008
#define WATCHDOG_SCRATCH0 0x4005800c
#define WATCHDOG_TICK 0x4005802c
#define CHIP_RESET 0x40064008

/* 2.19, 2.3.1: pins */
#define IO_CTRL(pin) (0x40014004 + 8 * (uint32_t)(pin))
#define PADS(pin) (0x4001c004 + 4 * (uint32_t)(pin))
enum { FUNCTION_SPI = 1, FUNCTION_PWM = 4, FUNCTION_SIO = 5, FUNCTION_NONE = 31 };
enum { PAD_PULL_DOWN = 0x56, PAD_PULL_UP = 0x5a, PAD_ANALOG = 0x90 }; /* 4 mA, Schmitt trigger */
#define SIO_OUT_SET 0xd0000014
#define SIO_OUT_CLEAR 0xd0000018
#define SIO_OE_SET 0xd0000024
#define SIO_OE_CLEAR 0xd0000028

/* 4.5: PWM; a slice has two outputs, and most outputs two pins */
static inline uint8_t pwm_slice(uint8_t pin)
{
    return pin >> 1 & 7;
}
#define PWM_CSR(slice) (0x40050000 + 0x14 * (uint32_t)(slice))
#define PWM_DIV(slice) (PWM_CSR(slice) + 0x04)
#define PWM_COMPARE(slice) (PWM_CSR(slice) + 0x0c)
#define PWM_TOP(slice) (PWM_CSR(slice) + 0x10)

/* 4.9, 4.4: ADC, SPI */
#define ADC_CS 0x4004c000
#define ADC_RESULT 0x4004c004
#define SPI0_CR0 0x4003c000
#define SPI0_CR1 0x4003c004
#define SPI0_DATA 0x4003c008
#define SPI0_STATUS 0x4003c00c
#define SPI0_PRESCALE 0x4003c010

/* 3.7: PIO, state machine 0 */
#define PIO_CTRL 0x50200000
#define PIO_FSTAT 0x50200004
#define PIO_FLEVEL 0x5020000c
#define PIO_RX0 0x50200020
#define PIO_IRQ 0x50200030
#define PIO_MEMORY(k) (0x50200048 + 4 * (uint32_t)(k))
#define PIO_SM0_CLKDIV 0x502000c8
#define PIO_SM0_SHIFTCTRL 0x502000d0
#define PIO_SM0_INSTR 0x502000d8
#define PIO_SM0_PINCTRL 0x502000dc

/* 4.1: USB */
#define USB_RAM 0x50100000
#define USB_ADDRESS 0x50110000
#define USB_MAIN_CTRL 0x50110040
#define USB_SIE_CTRL 0x5011004c
#define USB_SIE_STATUS 0x50110050
#define USB_BUFF_STATUS 0x50110058
#define USB_STALL_ARM 0x50110068
#define USB_MUXING 0x50110074
#define USB_POWER 0x50110078

/* 4.10.13: the flash's controller */
#define SSI_CTRLR0 0x18000000
#define SSI_CTRLR1 0x18000004
#define SSI_ENABLE 0x18000008
#define SSI_BAUD 0x18000014
#define SSI_SPI_CTRLR0 0x180000f4

/* 2.4: the processor's interrupts and vector table */
#define NVIC_ENABLE 0xe000e100
#define NVIC_DISABLE 0xe000e180
#define VECTOR_TABLE 0xe000ed08

#define FLASH_BASE 0x10000000

#endif
