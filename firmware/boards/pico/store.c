/* What survives power-off: two sectors of flash, written by turns, so that a cut in the middle leaves the other.
 *
 * A sector has a header, then HL_STORE_BYTES. Writing is erasing 4096 bytes and programming them, by the boot ROM's own
 * functions: meanwhile flash cannot be read and no interrupt comes, which is why all code is in RAM and why it happens in
 * IDLE only, with the motor off. */
#include "crc.h"
#include "pico.h"

#include <string.h>

enum { SECTOR = 4096, PAGE = 256, SECTORS = 2, FLASH_BYTES = 2 << 20, ERASE_4096 = 0x20 };
enum { WRITE_US = 1000000 }; /* longer than an erasure takes: 45 ms, 400 ms in old flash */
enum { ROM_FUNCTIONS = 0x14, ROM_LOOKUP = 0x18 }; /* where the addresses of a table and of the search in it are, 16 bits each */
#define ROM_NAME(a, b) ((uint32_t)(a) | (uint32_t)(b) << 8)
#define AT(sector) (FLASH_BYTES - SECTOR * (SECTORS - (uint32_t)(sector)))

typedef struct {
    uint32_t turn; /* the newer sector has the larger number */
    uint32_t free[2];
    uint32_t crc; /* of the bytes and the turn */
    uint8_t bytes[HL_STORE_BYTES];
} sector;
typedef char a_store_is_one_sector[sizeof(sector) == SECTOR ? 1 : -1];

static sector kept; /* as in flash, or all ones where nothing was ever written */
static uint8_t loaded, newest;

static uintptr_t rom_function(uint32_t name)
{
    typedef uintptr_t (*search)(uintptr_t table, uint32_t name);
    const search find = (search)(uintptr_t)(REGISTER(ROM_LOOKUP) & 0xffff);
    return find(REGISTER(ROM_FUNCTIONS) & 0xffff, name);
}

static uint32_t crc_of(const sector *s)
{
    return hl_crc32(hl_crc32(0, (const uint8_t *)&s->turn, 4), s->bytes, HL_STORE_BYTES);
}

static const sector *in_flash(uint8_t k)
{
    return (const sector *)(uintptr_t)(FLASH_BASE + AT(k));
}

static void load(void)
{
    if (loaded) {
        return;
    }
    loaded = 1;
    memset(&kept, 0xff, sizeof kept);
    kept.turn = 0;
    newest = 1; /* the first write goes to the first sector */
    for (uint8_t k = 0; k < SECTORS; k++) {
        const sector *s = in_flash(k);
        if (s->crc == crc_of(s) && s->turn > kept.turn) {
            memcpy(&kept, s, sizeof kept);
            newest = k;
        }
    }
}

/* Erase and program one sector. */
static void write_sector(uint8_t k)
{
    typedef void (*plain)(void);
    typedef void (*erase)(uint32_t at, uint32_t count, uint32_t block, uint8_t command);
    typedef void (*program)(uint32_t at, const uint8_t *from, uint32_t count);
    const plain connect = (plain)rom_function(ROM_NAME('I', 'F')), leave_xip = (plain)rom_function(ROM_NAME('E', 'X'));
    const plain flush = (plain)rom_function(ROM_NAME('F', 'C')), enter_xip = (plain)rom_function(ROM_NAME('C', 'X'));
    const erase range_erase = (erase)rom_function(ROM_NAME('R', 'E'));
    const program range_program = (program)rom_function(ROM_NAME('R', 'P'));
    const uint32_t before = interrupts_off();
    watchdog_wait(WRITE_US);
    connect();
    leave_xip();
    range_erase(AT(k), SECTOR, SECTOR, ERASE_4096);
    range_program(AT(k), (const uint8_t *)&kept, SECTOR);
    flush();
    enter_xip();
    interrupts_back(before);
}

void board_store_read(hl_core *core, uint16_t address, uint8_t *bytes, uint16_t count)
{
    (void)core;
    load();
    memcpy(bytes, kept.bytes + address, count);
}

uint8_t board_store_write(hl_core *core, uint16_t address, const uint8_t *bytes, uint16_t count)
{
    load();
    if (core->state == HL_STATE_RUN) {
        return 0;
    }
    if (memcmp(kept.bytes + address, bytes, count) == 0) {
        return 1;
    }
    board_motor(core, 0);
    memcpy(kept.bytes + address, bytes, count);
    kept.turn++;
    kept.crc = crc_of(&kept);
    newest ^= 1;
    write_sector(newest);
    return memcmp(in_flash(newest), &kept, SECTOR) == 0;
}

/* The boot ROM as a USB drive, for the next image. */
void store_bootloader(hl_core *core)
{
    typedef void (*usb_boot)(uint32_t led_pins, uint32_t disabled);
    if (core->state != HL_STATE_RUN) {
        board_motor(core, 0);
        ((usb_boot)rom_function(ROM_NAME('U', 'B')))(0, 0);
    }
}
