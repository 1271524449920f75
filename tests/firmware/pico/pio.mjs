// State machines of the PIO in step with the processor. rp2040js runs them by timeouts, whenever JavaScript is idle.
//
// They are brought up to date when an input changes, when the processor reads or writes them, and at the end of a run.
// A program that polls its inputs comes back to the state it was in: those rounds are not stepped one by one.
// Interrupts and pins driven by a state machine are seen only then.
const WINDOW = 64; // steps in which a poll comes round

export function runInStep(rp) {
    const parts = rp.pio.map((pio) => new InStep(rp, pio));
    const catchUp = () => parts.forEach((part) => part.catchUp());
    for (const pin of rp.gpio) {
        const set = pin.setInputValue;
        pin.setInputValue = (value) => {
            if (value !== pin.rawInputValue) catchUp();
            set.call(pin, value);
        };
    }
    return { catchUp };
}

class InStep {
    constructor(rp, pio) {
        this.rp = rp, this.pio = pio, this.steps = pio.machines.map(() => 0), this.since = rp.clock.nanos;
        pio.run = () => {};
        for (const name of ["readUint32", "writeUint32"]) {
            const call = pio[name];
            pio[name] = (...given) => { this.catchUp(); return call.apply(pio, given); };
        }
    }

    catchUp() {
        const { pio, rp } = this, now = rp.clock.nanos, cycles = (now - this.since) / 8;
        this.since = now;
        if (pio.stopped) return;
        pio.machines.forEach((machine, k) => {
            if (!machine.enabled) return;
            this.steps[k] += cycles / (machine.clockDivInt + machine.clockDivFrac / 256 || 65536);
            this.steps[k] -= this.#advance(machine, Math.floor(this.steps[k]));
        });
        pio.checkChangedPins();
    }

    // Make so many steps of one machine, delays included; return how many were made: a delay may go beyond.
    #advance(machine, count) {
        const begin = machine.cycles;
        const done = () => machine.cycles - begin;
        const known = new Map();
        let idle = 0;
        while (done() + idle < count) {
            const before = machine.cycles;
            machine.step();
            if (machine.cycles === before) idle = count - done(); // it waits, and nothing changes
            else if (known && count - done() > WINDOW) {
                const state = stateOf(machine), seen = known.get(state);
                if (seen !== undefined) {
                    const round = machine.cycles - seen;
                    machine.cycles += Math.floor((count - done()) / round) * round;
                }
                if (known.size < WINDOW) known.set(state, machine.cycles);
            }
        }
        return done() + idle;
    }
}

const stateOf = (m) => [m.pc, m.x, m.y, m.inputShiftReg, m.inputShiftCount, m.outputShiftReg, m.outputShiftCount,
                        m.rxFIFO.itemCount, m.txFIFO.itemCount, m.pio.irq].join(); // prettier-ignore
