// An emulated Raspberry Pi Pico for pico_emulator.py: one request a line on stdin, one answer a line on stdout, in JSON.
//
// Between two requests the board's time stands still. What each part models is said in its own file.
import { readSync, writeSync } from "node:fs";
import { BootRom } from "./boot_rom.mjs";
import { Chip } from "./chip.mjs";
import { Motor } from "./motor.mjs";
import { AngleSensor } from "./sensors.mjs";
import { UsbHost } from "./usb_host.mjs";

const FLASH = 2 << 20, RAM_AT = 0x20000000, BACK = 0x20041ff0;
const hex = (bytes) => Buffer.from(bytes).toString("hex"), unhex = (text) => Buffer.from(text, "hex");

const chip = new Chip(new Uint8Array(FLASH).fill(0xff));
const rom = new BootRom(chip), usb = new UsbHost(chip), motor = new Motor(chip), angle = new AngleSensor(chip);

const SET = {
    adc: (channel, counts) => chip.show(channel, counts),
    fly: (...given) => chip.fly(...given),
    pin: (pin, level) => { chip.rp.gpio[pin].setInputValue(!!level); },
    angle: (value) => { angle.angle = value; },
    fault: (what) => { angle.fault = what; },
    wire: (drive, pins, select) => { motor.drive = drive, motor.pins = pins, angle.select = select; motor.note(); },
    lines: (on, rate) => usb.setLines(on, rate),
    attach: (on) => usb.attach(on),
    setup: (bytes) => usb.strange(bytes),
    listen: (on) => usb.listen(on),
    cut: (operation, part) => { rom.cut = { operation: rom.operations + operation, part }; },
    out: (text) => usb.write(unhex(text)),
};

const DO = {
    load: ({ flash }) => { for (const [at, text] of flash) chip.flash.set(unhex(text), at); },
    reset: ({ cause }) => { chip.reset(cause); },
    run: ({ to }) => chip.runTo(to),
    duties: () => ({ cycles: motor.cycles, duties: motor.duties }),
    levels: ({ pins }) => ({ levels: pins.map((pin) => motor.level(pin)) }),
    peek: ({ at, count }) => ({ bytes: hex(at >= RAM_AT ? chip.rp.sram.subarray(at - RAM_AT, at - RAM_AT + count) : chip.flash.subarray(at, at + count)) }),
    poke: ({ at, bytes }) => { for (const byte of unhex(bytes)) chip.rp.sram[at++ - RAM_AT] = byte; },
    word: ({ at, value }) => { chip.rp.writeUint32(at, value); },
    find: ({ bytes }) => ({ at: Buffer.from(chip.rp.sram.buffer).indexOf(unhex(bytes)) }),
    watch: ({ at }) => { chip.watched = at; },
    costs: () => { const found = { steps: chip.stepped, between: chip.between }; chip.stepped = [], chip.between = []; return found; },
    call: ({ pc, given }) => call(pc, given),
    rows: ({ pc, given, to, size, times, rows, source, count }) => {
        const bytes = unhex(rows), out = [], cycles = [], ram = chip.rp.sram;
        for (let k = 0; k < times; k++) {
            ram.set(bytes.subarray(k * size, (k + 1) * size), to - RAM_AT);
            cycles.push(call(pc, given).cycles);
            out.push(hex(ram.subarray(source - RAM_AT, source - RAM_AT + count)));
        }
        return { out: out.join(""), cycles };
    },
    facts: () => ({ usb: { configured: usb.configured, device: usb.device, descriptors: usb.descriptors, strings: usb.strings,
                           packets: usb.packets, errors: usb.errors }, flashed: rom.operations,
                    violations: rom.violations, warnings: chip.warnings, pc: chip.rp.core.PC }), // prettier-ignore
};

// Call a function of an image that never runs by itself; return its first register, and its cycles.
function call(pc, given) {
    const { core } = chip.rp, stack = 0x20041f00;
    given.forEach((value, k) => { if (k < 4) core.registers[k] = value; else chip.rp.writeUint32(stack + 4 * (k - 4), value); });
    core.SP = stack, core.LR = BACK | 1, core.PC = pc & ~1;
    let cycles = 0;
    while (core.PC !== BACK) {
        cycles += core.executeInstruction();
        if (cycles > 1e8) throw new Error(`0x${pc.toString(16)} does not return`);
    }
    return { result: core.registers[0], cycles };
}

function* lines() {
    const piece = Buffer.alloc(1 << 20);
    let text = "";
    for (;;) {
        const count = readSync(0, piece);
        if (!count) return;
        text += piece.toString("latin1", 0, count);
        let end;
        while ((end = text.indexOf("\n")) >= 0) { yield text.slice(0, end); text = text.slice(end + 1); }
    }
}

function answer(value) {
    const bytes = Buffer.from(JSON.stringify(value) + "\n");
    for (let at = 0; at < bytes.length;) at += writeSync(1, bytes, at);
}

chip.reset("power");
for (const line of lines()) {
    const request = JSON.parse(line);
    try {
        for (const [what, ...given] of request.set ?? []) SET[what](...given);
        const more = DO[request.do](request) ?? {};
        answer({ cycle: chip.cycle, duty: motor.duty, in: hex(usb.take()), halted: chip.halted, configured: usb.configured, unsent: usb.sending.length, ...more });
    } catch (problem) {
        answer({ error: problem.stack });
    }
}
