// An RP2040 that can be reset: rp2040js, and what it models wrongly or not at all.
//
// * A reset by the watchdog, by the RUN pin or by power gives new peripherals; flash stays, and RAM but for power.
//   VREG_AND_CHIP_RESET says why.
// * An exception costs 15 cycles on its way in and 15 on its way out; rp2040js takes none.
// * An alarm of the timer comes when the counter shows its number; in rp2040js up to 1 us before.
// * The ADC holds its input when a conversion begins, not when it ends.
// * State machines of the PIO run in step with the processor, at their own divider; see pio.mjs.
// Not modelled: misses of the flash's cache (code in flash runs as if it were in RAM), bus conflicts, the second core,
// the clock before the firmware has set its 125 MHz (it counts as 125 MHz), and silicon's own start-up times.
import { RP2040 } from "rp2040js";
import { runInStep } from "./pio.mjs";

export const CYCLE = 8; // ns, at 125 MHz
const EXCEPTION = 15; // cycles
const HAD_POR = 1 << 8, HAD_RUN = 1 << 16, HAD_PSM_RESTART = 1 << 20;
export const POWER = "power", RUN_PIN = "run", WATCHDOG = "watchdog";
const CAUSES = { [POWER]: HAD_POR, [RUN_PIN]: HAD_RUN, [WATCHDOG]: HAD_PSM_RESTART };
const ALARM0 = 0x10, ALARM3 = 0x1c;

export class Chip {
    constructor(flash) {
        this.clock = new RP2040().clock;
        this.flash = flash; // Uint8Array
        this.warnings = [];
        this.extra = 0; // cycles of exceptions not yet counted
        this.idleUntil = 0; // ns: the processor waits for the flash
        this.flights = []; // of the ADC's channels
        this.onReset = []; // called with (rp, cause)
        this.stepped = [], this.inSteps = 0; // cycles of each interrupt: the firmware has one
        this.watched = null, this.between = [], this.passed = 0; // cycles from one visit of an address to the next, interrupts apart
    }

    get cycle() { return Math.floor(this.clock.nanos / CYCLE + 1e-6); }

    warn(text) { if (this.warnings.length < 200) this.warnings.push(`${this.cycle}: ${text}`); }

    reset(cause) {
        const old = this.rp, { clock } = this;
        clock.nextAlarm = null; // every alarm belongs to a peripheral that is gone
        const rp = this.rp = new RP2040(clock);
        rp.logger = { debug() {}, info() {}, warn: (_, text) => this.warn(text), error: (_, text) => this.warn(text) };
        rp.flash.set(this.flash);
        this.flash = rp.flash;
        if (old && cause !== POWER) rp.sram.set(old.sram);
        if (old) rp.adc.channelValues = old.adc.channelValues; // what is connected stays
        if (old) old.gpio.forEach((pin, k) => { rp.gpio[k].rawInputValue = pin.rawInputValue; });
        this.halted = null;
        this.idleUntil = this.extra = 0;
        this.#correct(rp, cause, old);
        for (const call of this.onReset) call(rp, cause);
    }

    #correct(rp, cause, old) {
        const { core, adc, clock } = { core: rp.core, adc: rp.adc, clock: rp.clock };
        const { exceptionEntry, exceptionReturn } = core;
        core.exceptionEntry = (n) => {
            this.extra += EXCEPTION;
            this.entered = core.cycles;
            exceptionEntry.call(core, n);
        };
        core.exceptionReturn = (n) => {
            this.extra += EXCEPTION;
            this.stepped.push(core.cycles - this.entered + 2 * EXCEPTION);
            this.inSteps += core.cycles - this.entered;
            exceptionReturn.call(core, n);
        };
        const watchdog = rp.peripherals[0x40058];
        if (old && cause === WATCHDOG) {
            watchdog.reason = old.peripherals[0x40058].reason;
            watchdog.scratchData.set(old.peripherals[0x40058].scratchData);
        }
        watchdog.onWatchdogTrigger = () => {
            watchdog.timer.enable = false; // it would come again at once, for ever
            this.pendingReset = WATCHDOG;
        };
        rp.peripherals[0x40064] = Object.assign(Object.create(rp.peripherals[0x40064]), {
            readUint32: (offset) => (offset === 8 ? CAUSES[cause] : 0),
            writeUint32() {},
        });
        const timer = rp.peripherals[0x40054], write = timer.writeUint32;
        timer.writeUint32 = (offset, value) => {
            write.call(timer, offset, value);
            if (offset < ALARM0 || offset > ALARM3) return;
            const now = clock.nanos / 1000, whole = Math.floor(now);
            const wait = ((value - whole) >>> 0) - (now - whole);
            timer.alarms[(offset - ALARM0) / 4].clockAlarm.schedule(Math.max(wait, 0) * 1000);
        };
        adc.onADCRead = (channel) => {
            const held = this.input(channel);
            adc.cs &= ~4; // START_ONE clears itself
            conversion.value = held;
            conversion.alarm.schedule(2000);
        };
        const conversion = { value: 0, alarm: clock.createAlarm(() => adc.completeADCRead(conversion.value, false)) };
        this.pio = runInStep(rp);
    }

    // What a channel of the ADC shows now; an angle sensor flies from its last count back to its first.
    input(channel) {
        const flight = this.flights[channel], shown = this.rp.adc.channelValues[channel];
        if (!flight || this.cycle >= flight.end) return flight ? flight.to : shown;
        const part = Math.max(0, (this.cycle - flight.begin) / (flight.end - flight.begin));
        return Math.round(flight.from + (flight.to - flight.from) * part);
    }

    show(channel, counts) {
        this.flights[channel] = null;
        this.rp.adc.channelValues[channel] = counts;
    }

    fly(channel, to, begin, end) {
        this.flights[channel] = { from: this.input(channel), to, begin, end };
    }

    // Run to the first instruction that ends at this cycle or behind it.
    runTo(cycle) {
        const end = cycle * CYCLE, { clock } = this;
        while (clock.nanos < end && !this.halted) {
            const { core } = this.rp;
            if (this.idleUntil > clock.nanos) {
                this.#pass(Math.min(end, this.idleUntil) - clock.nanos);
            } else if (core.waiting) {
                this.#pass(Math.min(clock.nextAlarm ? clock.nanosToNextAlarm : Infinity, end - clock.nanos));
            } else {
                if (core.PC === this.watched) {
                    const now = core.cycles - this.inSteps;
                    this.between.push(now - this.passed);
                    this.passed = now;
                }
                let cycles = core.executeInstruction();
                if (this.extra) { cycles += this.extra; this.extra = 0; }
                clock.tick(cycles * CYCLE);
            }
            if (this.pendingReset) {
                const cause = this.pendingReset;
                this.pendingReset = null;
                this.reset(cause);
            }
        }
        if (this.halted) this.#pass(Math.max(0, end - clock.nanos));
        this.pio.catchUp();
    }

    #pass(nanos) { this.clock.tick(Math.max(nanos, 0)); }
}
