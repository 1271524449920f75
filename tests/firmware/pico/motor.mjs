// What the pins say to the motor's driver, whatever the firmware means: duty of full, -1 to 1.
//
// A pin that nothing drives is low: the drivers' inputs have pull-downs. A PWM's new level holds from the carrier's next
// turn, as the chip latches it.
const PWM = 4;
const LOG = 1 << 14;

export class Motor {
    constructor(chip) {
        this.chip = chip;
        this.drive = "PWM_DIRECTION", this.pins = [];
        this.cycles = [], this.duties = [];
        chip.onReset.push((rp) => this.#watch(rp));
    }

    #watch(rp) {
        this.rp = rp;
        const after = (object, name, call) => {
            const own = object[name];
            object[name] = (...given) => { const value = own.apply(object, given); call(...given); return value; };
        };
        const look = () => this.note();
        after(rp.pwm, "writeUint32", look);
        after(rp.peripherals[0x40014], "writeUint32", look);
        after(rp.peripherals[0x4001c], "writeUint32", look);
        after(rp.sio, "writeUint32", look);
        for (const channel of rp.pwm.channels) { channel.wrap = channel.wrap.bind(channel); after(channel, "wrap", look); }
        this.note();
    }

    // Part of the time in which a pin is high; null where nothing drives it.
    level(index) {
        const pin = this.rp.gpio[index];
        if (!pin || pin.outputDisable) return null;
        if (pin.functionSelect !== PWM) return pin.outputEnable ? +pin.outputValue : null;
        const channel = this.rp.pwm.channels[(index >> 1) & 7], { csr } = channel;
        if (!(csr & 1)) return +pin.outputValue;
        const high = Math.min(1, (index & 1 ? channel.alarmB : channel.alarmA).target / (channel.timer.top + 1));
        return csr & (index & 1 ? 8 : 4) ? 1 - high : high;
    }

    get duty() {
        const [a = 0, b = 0, c = 0] = this.pins.map((pin) => this.level(pin) ?? 0);
        if (this.drive === "PWM_DIRECTION") return b > 0.5 ? a : -a || 0;
        const between = this.drive === "TWO_INPUTS" ? a - b : (a > 0.5) - (b > 0.5);
        return (this.drive === "TWO_INPUTS" ? between : between * c) || 0;
    }

    note() {
        const { duty } = this;
        if (this.duties.at(-1) === duty) return;
        this.cycles.push(this.chip.cycle), this.duties.push(duty);
        if (this.duties.length > 2 * LOG) { this.cycles.splice(0, LOG); this.duties.splice(0, LOG); }
    }
}
