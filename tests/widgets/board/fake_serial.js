// A board behind a fake navigator.serial: the firmware's own core around a handle of a twentieth of a kilogram, in a hand that
// means to be somewhere. A duty pushes the handle its own way: the board gives -F. Its ticks are counted by whoever calls run(); what is told of time is told by them.

const HANDLE = { m: 0.05, b: 0.3, k: 400, damping: 3 }

class FakeBoard {
  // cores: boards of core.js, the first one in use and the others for resets; known: what the test knows of the settings
  constructor(cores, known) {
    Object.assign(this, { cores, known, core: cores.shift(), ticks: 0, time: 0, x: 0, v: 0, hand: 0, held: true, duties: [], powered: true })
    this.sensor = (counts) => counts
  }

  get T() {
    return this.core.period
  }

  // Go on until a time [s], and hand on what the board says.
  run(until) {
    while (this.time + this.T <= until + 1e-9) {
      this.tick()
      this.port?.deliver()
    }
  }

  tick() {
    const { metres_per_count: step, force_full, travel_max } = this.known
    const counts = this.sensor(Math.round(this.x / step))
    const duty = this.powered ? this.core.tick(counts, this.time) : 0
    this.duties.push(duty)
    for (let k = 0; k < 4; k++) {
      const hand = this.held ? HANDLE.k * (this.hand - this.x) - HANDLE.damping * this.v : 0
      this.v += ((hand - HANDLE.b * this.v + duty * force_full) / HANDLE.m) * (this.T / 4)
      this.x += this.v * (this.T / 4)
      if (Math.abs(this.x) > travel_max && !this.beyond) [this.x, this.v] = [Math.sign(this.x) * travel_max, 0] // a stop
    }
    this.ticks += 1
    this.time += this.T
  }

  // [s] from a tick on until the motor was off for good; null where it is not.
  offAfter(tick) {
    let last = this.duties.length - 1
    if (this.duties[last]) return null
    while (last >= tick && this.duties[last] === 0) last--
    return Math.max(0, last + 1 - tick) * this.T
  }

  reset() {
    this.core = this.cores.shift()
  }
}

// A SerialPort of the browser, as far as a page may ask.
class FakePort extends EventTarget {
  constructor(board, usb = { usbVendorId: 0x2341, usbProductId: 0x0043 }) {
    super()
    Object.assign(this, { board, usb, taken: false, stuck: false, forgotten: false, signals: [], sent: [], readable: null, writable: null })
    board.port = this
    this.onWire = (bytes) => bytes // what arrives of what the board says
    this.onWay = (bytes) => bytes // what arrives at the board
    this.waiting = []
  }

  getInfo() {
    return this.usb
  }

  async open(options) {
    if (this.readable) throw new DOMException("The port is already open.", "InvalidStateError")
    if (this.taken) throw new DOMException("Failed to open serial port.", "NetworkError")
    this.options = options
    this.readable = new ReadableStream({ start: (out) => void (this.out = out) })
    this.writable = new WritableStream({ write: (bytes) => this.take(bytes) })
  }

  async setSignals(signals) {
    this.signals.push(signals)
  }

  take(bytes) {
    this.sent.push(bytes)
    if (this.stuck) return new Promise(() => {})
    if (this.board.powered) this.board.core.receive(this.onWay(bytes))
    this.deliver()
    return undefined
  }

  deliver() {
    const said = this.board.core.transmit()
    if (!said.length || !this.readable || !this.board.powered) return
    const bytes = this.onWire(said)
    if (bytes.length) this.out.enqueue(bytes)
  }

  async close() {
    this.closed = true
    this.readable = this.writable = null
  }

  async forget() {
    this.forgotten = true
  }

  // The cable is pulled.
  unplug() {
    const gone = new DOMException("The device has been lost.", "NetworkError")
    this.out.error(gone)
    this.readable = this.writable = null
    this.onWay = () => new Uint8Array(0)
    this.dispatchEvent(new Event("disconnect"))
  }
}

// navigator.serial: a person who is asked chooses the port; nobody may ask for ports without a person.
class FakeSerial extends EventTarget {
  constructor(port, mayAsk = () => true) {
    super()
    Object.assign(this, { port, mayAsk, asked: [], gotten: 0 })
  }

  async requestPort(options) {
    this.asked.push(options)
    if (!this.mayAsk()) throw new DOMException("Must be handling a user gesture to show a permission request.", "SecurityError")
    if (!this.port) throw new DOMException("No port selected by the user.", "NotFoundError")
    return this.port
  }

  async getPorts() {
    this.gotten += 1
    return [this.port]
  }
}
