/* What survives power-off: the EEPROM, 3.4 ms a byte that changes. */
#include "uno.h"

#include <avr/eeprom.h>

#define AT(address) ((uint8_t *)(uintptr_t)(address))

void board_store_read(hl_core *core, uint16_t address, uint8_t *bytes, uint16_t count)
{
    (void)core;
    eeprom_read_block(bytes, AT(address), count);
}

uint8_t board_store_write(hl_core *core, uint16_t address, const uint8_t *bytes, uint16_t count)
{
    uint8_t same = 1;
    for (uint16_t k = 0; k < count; k++) {
        eeprom_update_byte(AT(address + k), bytes[k]);
        uno_watchdog_feed(core); /* a program takes longer than the watchdog waits */
    }
    for (uint16_t k = 0; k < count; k++)
        same = same && eeprom_read_byte(AT(address + k)) == bytes[k];
    return same;
}
