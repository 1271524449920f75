// A board's port by Web Serial. A person's press alone leads here: no page opens a port that was granted before by itself.

const NO_SERIAL =
  "This browser cannot open serial ports, so this page cannot reach a paddle. Use Chrome or Edge, version 89 or newer, or another "
  + "browser with Web Serial, on a computer, and open this page from an https address or from localhost."
const NO_CHOICE = "No port was chosen. If the list was empty, plug in the board. A charging cable without data lines does not work."
const FORBIDDEN = "This page may not open serial ports: it is inside another page, or the browser or its administrator forbids them."
const TAKEN =
  "The port did not open. Another tab or program may use it, such as a notebook or the serial monitor of the Arduino IDE. Close the port "
  + "there, then connect again. On Linux, `hapticlab doctor` checks whether you may open serial ports."
const LEFT = "The device disconnected during use. Check its cable and supply, plug it in again, then connect again."
const BLOCKED = "The device accepted no data. Plug it in again, then connect again."

// what ends a stream of a port that has another one: a damaged byte, or a buffer that was full
const GOES_ON = ["BufferOverrunError", "BreakError", "FramingError", "ParityError"]

class BoardPort {
  // Ask the person for a port, in their press; the browser lists the known boards and their USB bridges.
  static async request(clock) {
    if (!navigator.serial) throw new LinkProblem(NO_SERIAL)
    const filters = TABLES.usb.map(({ vendor, product }) => ({ usbVendorId: vendor, usbProductId: product }))
    try {
      return new BoardPort(await navigator.serial.requestPort({ filters }), clock)
    } catch (problem) {
      throw new LinkProblem(problem.name === "NotFoundError" ? NO_CHOICE : problem.name === "SecurityError" ? FORBIDDEN : problem.message)
    }
  }

  constructor(port, clock) {
    Object.assign(this, { port, clock, closed: false, unsent: 0 })
  }

  // What the board is, by its USB numbers, in words.
  get words() {
    const { usbVendorId: vendor, usbProductId: product } = this.port.getInfo()
    return TABLES.usb.find((usb) => usb.vendor === vendor && usb.product === product)?.words ?? "unknown device"
  }

  // Open it; heard(bytes) takes what comes, lost(problem) is told once that nothing comes any more.
  async open(heard, lost) {
    Object.assign(this, { heard, lost })
    try {
      await this.port.open({ baudRate: TABLES.baudrate, bufferSize: 16384 })
    } catch (problem) {
      throw new LinkProblem(problem.name === "SecurityError" ? FORBIDDEN : TAKEN)
    }
    // as pyserial does; it resets many a board, whose bootloader then listens first
    await this.port.setSignals({ dataTerminalReady: true, requestToSend: true }).catch(() => {}) // a bridge without these lines
    this.writer = this.port.writable.getWriter()
    this.left = () => this.lose(new LinkProblem(LEFT))
    this.port.addEventListener("disconnect", this.left)
    this.read()
  }

  // Send bytes; a device that takes none for as long as a board waits for its host is lost, and what was not sent never is.
  write(bytes) {
    if (this.closed) return
    this.unsent += 1
    if (this.unsent === 1) this.watch()
    const sent = () => {
      this.unsent -= 1
      if (!this.unsent) this.unwatch()
    }
    this.writer.write(bytes).then(sent, this.left)
  }

  watch() {
    const again = (times) => (times ? this.watchFor(() => again(times - 1)) : this.lose(new LinkProblem(BLOCKED)))
    this.watchFor(() => again(2)) // looked at again: a page that stood still has not yet heard that all was sent
  }

  watchFor(work) {
    this.unwatch = this.clock.after(TABLES.host_silence / 2, work)
  }

  async read() {
    while (this.port.readable && !this.closed) {
      this.reader = this.port.readable.getReader()
      try {
        for (;;) {
          const { value, done } = await this.reader.read()
          if (done || this.closed) return this.left()
          this.heard(value)
        }
      } catch (problem) {
        if (!GOES_ON.includes(problem.name)) return this.lose(problem.name === "NetworkError" ? new LinkProblem(LEFT) : problem)
      } finally {
        this.reader.releaseLock()
      }
    }
    return this.left()
  }

  // Nothing can be sent or heard any more; say so once. What was not sent never is.
  lose(problem) {
    if (this.closed) return
    this.lost(problem)
    this.writer?.abort().catch(() => {})
    this.close()
  }

  // Close; what was written last still goes out where the device takes it.
  async close() {
    if (this.closed) return
    this.closed = true
    this.unwatch?.()
    this.port.removeEventListener("disconnect", this.left)
    const done = Promise.allSettled([this.writer?.close(), this.reader?.cancel()])
    await Promise.race([done, new Promise((resolve) => this.clock.after(TABLES.host_silence, resolve))])
    await this.writer?.abort().catch(() => {})
    for (const half of [this.reader, this.writer]) half?.releaseLock()
    await this.port.close().catch(() => {}) // it left before
    await this.port.forget?.().catch(() => {}) // else any page of this address could open it without asking
  }
}

// The page's time: now() [s], wall() [s] of the day, which goes on in sleep, and after(seconds, work), which returns what cancels it.
const PAGE_CLOCK = {
  now: () => performance.now() / 1000,
  wall: () => Date.now() / 1000,
  after: (seconds, work) => {
    const waiting = setTimeout(work, 1000 * seconds)
    return () => clearTimeout(waiting)
  },
}
