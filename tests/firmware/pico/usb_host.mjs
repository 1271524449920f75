// A USB host on the chip's device controller: enumeration, one CDC ACM port, bulk packets at full speed.
//
// rp2040js says that a packet has left at the moment it is handed over, and looks at no data toggle. Here a transaction takes
// its time on the wire, one after the other (12 Mbit/s, 16 bytes of tokens, checks and gaps each); a buffer is the
// processor's again when its transaction is over; a packet with the wrong toggle is dropped and counted, as hosts and
// controllers do. The host asks again at once where it was refused. Double buffers and isochronous endpoints are not modelled.
const BIT = 1e9 / 12e6, OVERHEAD = 16; // ns, bytes
const CONNECT = 5e6, AFTER_RESET = 2e6, SUSPEND = 3e6; // ns; real hosts wait 100 ms before the first
const AVAILABLE = 1 << 10, STALL = 1 << 11, DATA1 = 1 << 13, FULL = 1 << 15, LENGTH = 0x3ff;
const ENABLE = 1 << 31, DOUBLE = 1 << 30, EACH_BUFFER = 1 << 29, PULLUP = 1 << 16, EP0_EACH_BUFFER = 1 << 29;
const SUSPENDED = 1 << 4, RESUME = 1 << 11, VBUS = 1, SOF_RD = 0x48;
const PACKET = 64, DEVICE = 1, CONFIGURATION = 2, STRING = 3, QUALIFIER = 6;

export class UsbHost {
    constructor(chip) {
        this.chip = chip;
        this.attached = true;
        this.open = false;
        this.listening = true; // the computer asks for what the board has to send
        this.received = []; // bytes for whoever has the port open
        this.packets = { in: 0, out: 0 };
        this.errors = [];
        chip.onReset.push((rp) => this.#meet(rp));
    }

    #meet(rp) {
        const { clock } = this.chip;
        this.rp = rp, this.usb = rp.usbCtrl;
        this.#forget();
        this.pulled = false;
        this.wire = clock.createAlarm(() => { const end = this.ending; this.ending = null; end(); this.#pump(); });
        this.connect = clock.createAlarm(() => this.#busReset());
        this.begin = clock.createAlarm(() => this.#enumerate());
        this.quiet = clock.createAlarm(() => this.#status(SUSPENDED, true));
        const { usb } = this, control = usb.handleSieCtrlWrite, read = usb.readUint32;
        usb.handleSieCtrlWrite = (value) => {
            control.call(usb, value);
            const pulled = !!(value & PULLUP);
            if (pulled && !this.pulled && this.attached) this.connect.schedule(CONNECT);
            if (!pulled && this.pulled) this.#forget();
            this.pulled = pulled;
        };
        usb.readUint32 = (offset) => (offset === SOF_RD ? Math.floor(clock.nanos / 1e6) & 0x7ff : read.call(usb, offset));
        usb.onResetReceived = () => this.begin.schedule(AFTER_RESET);
        usb.DPRAMUpdated = (offset, value) => this.#handed(offset, value);
    }

    #forget() {
        this.requests = [], this.current = null, this.descriptors = null, this.configured = false;
        this.sending = [], this.toggles = new Map(), this.bulk = { in: 0, out: 0 }, this.ending = null, this.stalled = false;
        this.wire?.cancel();
    }

    #status(bit, on) {
        if (on) this.usb.sieStatus |= bit; else this.usb.sieStatus &= ~bit;
        this.usb.sieStatusUpdated();
    }

    #busReset() {
        this.#forget();
        this.#status(SUSPENDED, false);
        this.#status(1 << 19, true); // BUS_RESET
    }

    attach(on) {
        this.attached = on;
        this.#status(VBUS, on);
        if (on && this.pulled) this.connect.schedule(CONNECT);
        if (!on) { this.#forget(); this.connect.cancel(); this.begin.cancel(); this.quiet.schedule(SUSPEND); }
        else this.quiet.cancel();
    }

    #enumerate() {
        const get = (kind, index, length, then, language = 0) =>
            this.request([0x80, 6, index, kind, language & 255, language >> 8, length & 255, length >> 8], null, then);
        get(DEVICE, 0, 64);
        this.request([0, 5, 17, 0, 0, 0, 0, 0]);
        get(DEVICE, 0, 18, (bytes) => { this.device = bytes; });
        get(QUALIFIER, 0, 10); // a device without high speed refuses it
        get(CONFIGURATION, 0, 9, (bytes) => {
            get(CONFIGURATION, 0, bytes[2] | bytes[3] << 8, (all) => {
                this.descriptors = all;
                get(STRING, 0, 255);
                for (const index of this.device.slice(14, 17)) if (index) get(STRING, index, 255, (text) => this.#string(index, text), 0x409);
                this.request([0, 9, 1, 0, 0, 0, 0, 0], null, () => this.#configure(all));
            });
        });
        this.#pump();
    }

    #string(index, bytes) {
        (this.strings ??= {})[index] = Buffer.from(bytes.slice(2)).toString("utf16le");
    }

    #configure(bytes) {
        for (let at = 0, data = false; at < bytes.length && bytes[at]; at += bytes[at]) {
            if (bytes[at + 1] === 4) data = bytes[at + 5] === 10;
            if (bytes[at + 1] === 5 && data && bytes[at + 3] === 2) this.bulk[bytes[at + 2] & 0x80 ? "in" : "out"] = bytes[at + 2] & 15;
        }
        this.configured = true;
        if (this.open) this.setLines(true);
    }

    request(setup, data = null, then = null) { this.requests.push({ setup, data, then, got: [], stage: "setup" }); }

    // DTR and RTS, as opening and closing the port sets them; the rate is told before.
    setLines(on, rate = 500000) {
        this.open = on;
        if (!this.configured) return;
        if (on) this.request([0x21, 0x20, 0, 0, 0, 0, 7, 0], [rate & 255, rate >> 8 & 255, rate >> 16 & 255, rate >>> 24, 0, 0, 8]);
        this.request([0x21, 0x22, on ? 3 : 0, 0, 0, 0, 0, 0]);
        this.#pump();
    }

    write(bytes) {
        for (let at = 0; at < bytes.length; at += PACKET) this.sending.push(bytes.slice(at, at + PACKET));
        this.#pump();
    }

    // A request that a strange host gives up after a millisecond, where a real one waits for five seconds.
    strange(setup) {
        this.request(setup, new Array(setup[0] & 0x80 ? 0 : setup[6]).fill(0));
        const asked = this.requests.at(-1);
        this.chip.clock.createAlarm(() => {
            this.requests = this.requests.filter((request) => request !== asked);
            if (this.current === asked) this.current = null;
            this.#pump();
        }).schedule(1e6);
        this.#pump();
    }

    listen(on) { this.listening = on; this.#pump(); }

    take() { const got = this.received; this.received = []; return got; }

    // --- buffers: index 2 * endpoint for IN, + 1 for OUT

    #word(index) { return this.rp.usbDPRAMView.getUint32(0x80 + 4 * index, true); }

    #put(index, value) { this.rp.usbDPRAMView.setUint32(0x80 + 4 * index, value, true); }

    #control(index) { return index < 2 ? ENABLE | EACH_BUFFER : this.rp.usbDPRAMView.getUint32(4 * index, true); }

    #armed(index) { return this.#word(index) & AVAILABLE && this.#control(index) & ENABLE; }

    #handed(offset, value) {
        if (offset < 0x80 || offset >= 0x100) return;
        const index = (offset - 0x80) >> 2;
        if (index > 1 && this.#control(index) & DOUBLE) throw new Error("double buffers are not modelled");
        if (index === 0 && value & STALL) this.stalled = true;
        this.#pump();
    }

    #over(index, value) {
        this.#put(index, value);
        const wanted = index < 2 ? this.usb.sieCtrl & EP0_EACH_BUFFER : this.#control(index) & EACH_BUFFER;
        if (wanted) this.usb.indicateBufferReady(index >> 1, !!(index & 1));
    }

    #transfer(bytes, end) {
        this.ending = end;
        this.wire.schedule((bytes + OVERHEAD) * 8 * BIT);
    }

    #toggle(index, word) { // whether the packet has the expected one; then the other is next
        const expected = this.toggles.get(index) ?? 0;
        if ((word & DATA1 ? 1 : 0) !== expected) {
            this.errors.push(`${this.chip.cycle}: endpoint ${index >> 1} ${index & 1 ? "out" : "in"}: data toggle`);
            return false;
        }
        this.toggles.set(index, expected ^ 1);
        return true;
    }

    #in(index, then) {
        const word = this.#word(index), length = word & LENGTH;
        this.#transfer(length, () => {
            const at = index < 2 ? 0x100 : this.#control(index) & 0xffc0;
            const bytes = this.rp.usbDPRAM.slice(at, at + length);
            this.#over(index, this.#word(index) & ~(AVAILABLE | FULL));
            if (this.#toggle(index, word)) then(bytes);
        });
    }

    #out(index, bytes, then) {
        const word = this.#word(index);
        this.#transfer(bytes.length, () => {
            const at = index < 2 ? 0x100 : this.#control(index) & 0xffc0;
            if (bytes.length > (word & LENGTH)) this.errors.push(`${this.chip.cycle}: endpoint ${index >> 1}: packet too long`);
            if (!this.#toggle(index, word)) return;
            this.rp.usbDPRAM.set(bytes, at);
            this.#over(index, this.#word(index) & ~(AVAILABLE | LENGTH) | FULL | bytes.length);
            then();
        });
    }

    // --- what comes next on the wire

    #pump() {
        if (this.ending || !this.attached || !this.pulled) return;
        this.current ??= this.requests.shift() ?? null;
        if (this.current && this.#step(this.current)) return;
        const out = 2 * this.bulk.out + 1, into = 2 * this.bulk.in, 
            canIn = this.configured && this.open && this.listening && this.#armed(into);
        const asked = this.current || this.requests.length; // opening a port ends before anything is written to it
        const canOut = this.configured && !asked && this.sending.length && this.#armed(out);
        if (canOut && !(canIn && this.last === "out")) {
            this.last = "out";
            this.#out(out, this.sending[0], () => { this.sending.shift(); this.packets.out++; });
        } else if (canIn) {
            this.last = "in";
            this.#in(into, (bytes) => { for (const byte of bytes) this.received.push(byte); this.packets.in++; });
        }
    }

    #step(r) {
        const { setup } = r, length = setup[6] | setup[7] << 8;
        const finish = () => {
            this.current = null;
            if (setup[1] === 9 && !setup[0]) for (const index of [...this.toggles.keys()]) if (index > 1) this.toggles.delete(index);
            r.then?.(r.got);
        };
        if (r.stage === "setup") {
            this.stalled = false;
            this.#transfer(8, () => {
                this.toggles.set(0, 1), this.toggles.set(1, 1);
                r.stage = setup[0] & 0x80 ? "in" : length ? "out" : "confirm";
                this.usb.sendSetupPacket(Uint8Array.from(setup));
            });
        } else if (this.stalled) {
            this.stalled = false, this.current = null;
            return this.#pump() ?? true;
        } else if (r.stage === "in" && this.#armed(0)) {
            this.#in(0, (bytes) => {
                r.got.push(...bytes);
                if (r.got.length >= length || bytes.length < PACKET) { r.stage = "close"; this.toggles.set(1, 1); }
            });
        } else if (r.stage === "out" && this.#armed(1)) {
            this.#out(1, Uint8Array.from(r.data), () => { r.stage = "confirm"; this.toggles.set(0, 1); });
        } else if (r.stage === "close" && this.#armed(1)) this.#out(1, new Uint8Array(0), finish);
        else if (r.stage === "confirm" && this.#armed(0)) this.#in(0, finish);
        else return false;
        return true;
    }
}
