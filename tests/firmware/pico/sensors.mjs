// An AS5048A on the SPI bus: 14 bits of angle, each answer to the frame before, even parity in the highest bit.
//
// A frame is 16 clocks while its select line is low; data sheet v1-11, 5.2. The bus takes its true time.
const ANGLE = 0x3fff, DIAGNOSTICS = 0x3ffd, READY = 1 << 8, ERROR = 1 << 14;

const withParity = (word) => {
    let ones = 0;
    for (let bits = word & 0x7fff; bits; bits &= bits - 1) ones++;
    return word & 0x7fff | (ones & 1) << 15;
};

export class AngleSensor {
    constructor(chip) {
        this.chip = chip;
        this.select = null, this.angle = 0, this.fault = null; // fault: "parity", "error", "wire", "low"
        chip.onReset.push((rp) => this.#wire(rp));
    }

    #wire(rp) {
        this.rp = rp, this.answer = 0, this.bits = 0, this.shift = 0;
        for (const spi of rp.spi) {
            spi.onTransmit = (value) => {
                const bits = spi.dataBits, reply = this.#exchange(value, bits);
                alarm.reply = reply;
                alarm.alarm.schedule(bits * 1e9 / (spi.clockFrequency || 1e6));
            };
            const alarm = { reply: 0, alarm: this.chip.clock.createAlarm(() => spi.completeTransmit(alarm.reply)) };
        }
        const { gpio } = rp;
        for (const pin of gpio) pin.addListener(() => { if (pin.index === this.select && pin.outputValue) this.#end(); });
    }

    #exchange(value, bits) {
        const pin = this.rp.gpio[this.select];
        if (this.fault === "low") return 0;
        if (!pin || this.fault === "wire") return (1 << bits) - 1;
        if (pin.functionSelect === 5 && pin.outputValue) return (1 << bits) - 1; // not selected: the line is pulled up
        const reply = this.answer >> (16 - this.bits - bits) & ((1 << bits) - 1);
        this.shift = this.shift << bits | value, this.bits += bits;
        if (pin.functionSelect !== 5 && this.bits >= 16) this.#end();
        return reply;
    }

    #end() {
        if (this.bits !== 16) { this.bits = this.shift = 0; return; }
        const register = this.shift & 0x3fff;
        const word = register === ANGLE ? this.angle & 0x3fff : register === DIAGNOSTICS ? READY : 0;
        this.answer = withParity(word | (this.fault === "error" ? ERROR : 0)) ^ (this.fault === "parity" ? 1 << 15 : 0);
        this.bits = this.shift = 0;
    }
}
