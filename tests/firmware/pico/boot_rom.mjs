// What the chip's own ROM does for a firmware, and the flash behind it: made here, as the ROM itself is not in rp2040js.
//
// It starts boot2 as the ROM does (256 bytes with a right CRC-32, run at the end of RAM), and answers calls of its functions by their two
// letters. Erasing and programming take the typical time of a W25Q16JV and clear, then set bits; whoever takes the
// power away in between leaves a page half written, a sector half erased. Code that runs from flash while that is
// busy, and interrupts that could, are noted in `violations`: silicon would crash.
const BOOT2 = 256, BOOT2_AT = 0x20041f00, FLASH_AT = 0x10000000, ROM_TABLE = 0x200, ENTRY = 0x100;
const SECTOR = 4096, PAGE = 256, ERASE = 45e6, PROGRAM = 0.4e6; // bytes, ns
const NAMES = ["lookup", "IF", "EX", "RE", "RP", "FC", "CX", "UB", "MS", "S4", "MC", "C4"];

export function crc32(bytes) { // MPEG-2: 0x04c11db7, not reflected, no last inversion
    let crc = 0xffffffff;
    for (const byte of bytes) {
        crc ^= byte << 24;
        for (let k = 0; k < 8; k++) crc = crc & 0x80000000 ? crc << 1 ^ 0x04c11db7 : crc << 1;
    }
    return crc >>> 0;
}

export class BootRom {
    constructor(chip) {
        this.chip = chip;
        this.violations = [];
        this.operations = 0;
        this.busy = null;
        this.cut = null; // at which operation, counted from 0, and after what part of it the power goes
        chip.onReset.push((rp) => this.#start(rp));
    }

    #start(rp) {
        const { chip } = this, view = new DataView(rp.bootrom.buffer);
        this.finish();
        this.away = false;
        NAMES.forEach((name, k) => {
            view.setUint32(ENTRY + 4 * k, 0x4770be00 | k, true); // bkpt #k; bx lr
            view.setUint16(ROM_TABLE + 4 * k, k ? name.charCodeAt(0) | name.charCodeAt(1) << 8 : 0, true);
            view.setUint16(ROM_TABLE + 4 * k + 2, ENTRY + 4 * k | 1, true);
        });
        view.setUint32(0x10, 0x0301754d, true); // "Mu", 1, version 3
        view.setUint16(0x14, ROM_TABLE, true);
        view.setUint16(0x18, ENTRY | 1, true);
        rp.onBreak = (code) => this.#called(rp, code);
        const boot2 = chip.flash.slice(0, BOOT2), sum = new DataView(boot2.buffer).getUint32(BOOT2 - 4, true);
        if (crc32(boot2.subarray(0, BOOT2 - 4)) !== sum) { chip.halted = "no boot2: the drive RPI-RP2 appears"; return; }
        rp.sram.set(boot2, BOOT2_AT - 0x20000000);
        rp.core.SP = 0x20042000, rp.core.LR = 0, rp.core.PC = BOOT2_AT;
    }

    #note(text) { if (this.violations.length < 50) this.violations.push(`${this.chip.cycle}: ${text}`); }

    #called(rp, code) {
        const { core } = rp, [r0, r1, r2] = core.registers, name = NAMES[code];
        if (core.PC > ROM_TABLE || !name) { this.chip.halted = `breakpoint ${code} at 0x${core.PC.toString(16)}`; return; }
        const back = core.LR >>> 0, ram = rp.sram;
        if (name === "lookup") {
            const letters = String.fromCharCode(r1 & 255, r1 >> 8 & 255), k = NAMES.indexOf(letters);
            core.registers[0] = k > 0 ? ENTRY + 4 * k | 1 : 0;
            if (k <= 0) this.#note(`the ROM is asked for ${letters}, which is not modelled`);
        } else if (name === "EX") this.away = true;
        else if (name === "CX") this.away = false;
        else if (name === "RE" || name === "RP") this.#flash(core, name, r0, r1, r2, ram, back);
        else if (name === "UB") this.chip.halted = "the ROM's drive RPI-RP2 appears";
        else if (name[0] === "M" && name[1] === "S" || name === "S4") ram.fill(r1 & 255, r0 - 0x20000000, r0 - 0x20000000 + r2);
        else if (name === "MC" || name === "C4") for (let k = 0; k < r2; k++) rp.writeUint8(r0 + k, rp.readUint8(r1 + k));
        if (this.away && back >= FLASH_AT && back < FLASH_AT + 0x4000000) this.#note(`${name} returns into flash, which is away`);
    }

    #flash(core, name, offset, given, count, ram, back) {
        if (!this.away) this.#note(`${name} without EX before`);
        if (!core.PM && core.enabledInterrupts) this.#note(`${name} while interrupts are let in`);
        const size = name === "RE" ? SECTOR : PAGE, length = name === "RE" ? given : count;
        if (offset % size || length % size) this.#note(`${name} of ${length} bytes at ${offset}`);
        const data = name === "RP" ? ram.slice(given - 0x20000000, given - 0x20000000 + count) : null;
        if (name === "RP" && given >>> 28 !== 2) this.#note("RP from an address that is not RAM");
        const time = length / size * (name === "RE" ? ERASE : PROGRAM), begun = this.chip.clock.nanos;
        this.busy = { name, offset, length, data, begun, time };
        if (this.cut && this.cut.operation === this.operations) {
            this.chip.clock.createAlarm(() => this.powerOff()).schedule(time * this.cut.part);
            this.cut = null;
        }
        this.operations++;
        this.chip.idleUntil = begun + time;
        this.chip.clock.createAlarm(() => this.finish()).schedule(time);
    }

    // Carry an operation out, to a part of its bytes where the power goes.
    finish(part = 1) {
        const { busy, chip } = this;
        if (!busy) return;
        this.busy = null;
        const end = busy.offset + Math.floor(busy.length * part);
        for (let at = busy.offset; at < end; at++) chip.flash[at] = busy.data ? chip.flash[at] & busy.data[at - busy.offset] : 0xff;
        if (part < 1) chip.flash[end] &= 0xa5; // a byte of which some cells have changed
    }

    powerOff() {
        if (this.busy) this.finish(Math.min(0.999, (this.chip.clock.nanos - this.busy.begun) / this.busy.time));
        this.chip.halted = "off";
    }
}
