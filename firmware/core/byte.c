/* A byte from the link: taken in an interrupt, so this is the part of it that has to be quick. */
#include "core.h"

void hl_core_byte(hl_core *core, uint8_t byte)
{
    if (core->rx_ready) {
        core->rx_bad = byte != 0; /* the frame before is not answered yet: what comes now is lost, to its end */
    } else if (byte != 0) {
        if (core->rx_count < HL_WIRE_BYTES) {
            core->rx[core->rx_count++] = byte;
        } else {
            core->rx_bad = 1;
        }
    } else if (core->rx_bad) {
        core->rx_count = 0;
        core->rx_bad = 0;
        core->damaged++;
    } else if (core->rx_count) {
        core->rx_ready = 1;
    }
}
