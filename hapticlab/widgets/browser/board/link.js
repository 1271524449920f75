// Frames on the wire, and requests with their replies: what hapticlab/device/link/wire.py and exchange.py are to a notebook.
// messages.py there describes the format. messages.js and, for CRC-32, npz.js come before it. tests/vectors/link_frames.json holds both to the same bytes.

const NAMES = Object.fromEntries(Object.entries(TABLES.messages).map(([name, { number }]) => [number, name]))
const SIZES = { B: 1, b: 1, H: 2, I: 4, i: 4, f: 4, "8s": 8 }
const LONGEST = 256 // bytes: no frame is as long, and what precedes is noise

// CCITT, as binascii.crc_hqx
function crc16(bytes, crc = 0xffff) {
  for (const byte of bytes) {
    crc ^= byte << 8
    for (let k = 0; k < 8; k++) crc = (crc & 0x8000 ? (crc << 1) ^ 0x1021 : crc << 1) & 0xffff
  }
  return crc
}

// Bytes without a zero: each run up to a zero is led by its length plus one (COBS, below 254 bytes).
function stuff(bytes) {
  const out = [0]
  let lead = 0
  for (const byte of bytes) {
    out[lead] = out.length - lead
    if (byte === 0) lead = out.length
    out.push(byte)
  }
  out[lead] = out.length - lead
  return Uint8Array.from(out)
}

// Undo stuff; null where the bytes are not of it.
function unstuff(bytes) {
  const body = []
  for (let at = 0; at < bytes.length; at += bytes[at]) {
    if (bytes[at] === 0 || at + bytes[at] > bytes.length) return null
    if (at) body.push(0)
    body.push(...bytes.subarray(at + 1, at + bytes[at]))
  }
  return Uint8Array.from(body)
}

// Numbers of these types, little endian, as bytes. rows: [[type, name], ...]
function pack(rows, values) {
  const bytes = new Uint8Array(rows.reduce((sum, [type]) => sum + SIZES[type], 0))
  const view = new DataView(bytes.buffer)
  let at = 0
  rows.forEach(([type], k) => {
    if (type === "8s") bytes.set(values[k], at)
    else if (type === "f") view.setFloat32(at, values[k], true)
    else if (SIZES[type] === 4) view.setUint32(at, values[k], true)
    else if (SIZES[type] === 2) view.setUint16(at, values[k], true)
    else view.setUint8(at, values[k])
    at += SIZES[type]
  })
  return bytes
}

// The numbers of these types at the beginning of bytes, by name; and how many bytes they take.
function unpack(rows, bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength)
  const values = {}
  let at = 0
  for (const [type, name] of rows) {
    if (type === "8s") values[name] = bytes.slice(at, at + 8)
    else values[name] = { B: "getUint8", b: "getInt8", H: "getUint16", I: "getUint32", i: "getInt32", f: "getFloat32" }[type]
    if (type !== "8s") values[name] = view[values[name]](at, true)
    at += SIZES[type]
  }
  return { values, size: at }
}

// The bytes of one frame, the zero at its end included. values: of the message's fields, in their order
function encodeFrame(message, sequence, values = [], { rest = [], session = 0 } = {}) {
  const row = TABLES.messages[message]
  let body = [(TABLES.protocol << 5) | row.number, sequence & 255, ...pack(row.fields, values), ...rest]
  if (row.guarded) body = [...body, ...pack([["I", "guard"]], [crc32(body, (session + Math.floor(sequence / 256)) >>> 0)])]
  const crc = crc16(body)
  return Uint8Array.of(...stuff([...body, crc >> 8, crc & 255]), 0)
}

// The frame in the bytes before a zero, {message, sequence, payload}, or null where they are damaged. With a session the guard
// of a guarded message is checked and taken off too.
function decodeFrame(stuffed, session) {
  const body = unstuff(stuffed)
  if (!body || body.length < 4 || crc16(body) !== 0 || body[0] >> 5 !== TABLES.protocol) return null
  const message = NAMES[body[0] & 31]
  if (!message) return null
  let end = body.length - 2
  if (session !== undefined && TABLES.messages[message].guarded) {
    end -= 4
    if (end < 2 || crc32(body.subarray(0, end), session) !== unpack([["I", "guard"]], body.subarray(end)).values.guard) return null
  }
  return { message, sequence: body[1], payload: body.slice(2, end) }
}

// The fields of a frame by name, bytes after them under "rest"; null where the payload has another length.
function fieldsOf({ message, payload }) {
  const row = TABLES.messages[message]
  const least = row.fields.reduce((sum, [type]) => sum + SIZES[type], 0)
  if (payload.length < least || (payload.length > least && !row.open)) return null
  const { values, size } = unpack(row.fields, payload)
  return row.open ? { ...values, rest: payload.slice(size) } : values
}

// Frames out of bytes as they come, whatever came before them; damaged counts what was none.
class Decoder {
  constructor() {
    this.damaged = 0
    this.begun = []
  }

  feed(bytes) {
    const found = []
    for (const byte of bytes) {
      if (byte !== 0) {
        this.begun.push(byte)
        continue
      }
      const piece = Uint8Array.from(this.begun)
      this.begun = []
      if (!piece.length) continue
      const frame = decodeFrame(piece)
      if (frame) found.push(frame)
      else this.damaged += 1
    }
    if (this.begun.length > LONGEST) this.begun = this.begun.slice(-LONGEST)
    return found
  }
}

// The name and the words of the row with a number, of TABLES.results, faults or reset_causes; undefined for no such row.
function rowOf(table, number) {
  const found = Object.entries(table).find(([, row]) => row[0] === number)
  return found && [found[0], ...found[1].slice(1)]
}

// What a board or a port says no with. result: the board's word for it
class LinkProblem extends Error {
  constructor(words, result) {
    super(words)
    this.result = result
  }
}

// Somebody switched the motor off meanwhile: what was under way ends, and nobody is told of it.
class Abandoned extends Error {}

// Requests and replies over one open port. It has no thread and no worker: where the page stands still so do its heartbeats,
// and the board switches its motor off.
class Exchange {
  // port: write(bytes) and what it heard comes to hear(bytes); clock: now() and wall() [s], of which wall() goes on while the
  // computer sleeps, after(seconds, work) returns what cancels it;
  // onFrame: takes samples and fault reports
  constructor(port, clock, onFrame) {
    this.port = port
    this.clock = clock
    this.onFrame = onFrame
    this.decoder = new Decoder()
    this.session = (crypto.getRandomValues(new Uint32Array(1))[0] >>> 1) + 1 // never 0, a board's word for no session
    this.beating = () => false // whether heartbeats are due: with none of them a board stops its motor
    this.sent = { true: 0, false: 0 } // guarded requests count by themselves
    this.state = this.broken = this.wanted = this.beatSequence = null
    this.waiting = new Set()
    this.turn = Promise.resolve()
    this.era = 0 // grows where all that is under way is given up
    this.lastSent = this.lastLook = clock.now()
    this.lastWall = clock.wall()
    this.absent = 0 // the longest time for which the page did not run since the last START [s]
    this.look()
  }

  // Send a request until its reply comes; return the reply's fields. A repeat has the same sequence number, so that a board obeys
  // it once. then: called between the frames that came before the reply and those after it, if the board did what was asked
  async ask(message, values = [], { rest, patience = TABLES.patience, tries = TABLES.tries, then = () => {} } = {}) {
    const era = this.era
    const before = this.turn
    let done
    this.turn = new Promise((resolve) => (done = resolve))
    await before
    try {
      this.require(era)
      const sequence = this.next(message)
      const frame = encodeFrame(message, sequence, values, { rest, session: this.session })
      const wanted = { message, sequence: sequence & 255, reply: null, then }
      this.wanted = wanted
      for (let k = 0; k < tries; k++) {
        // a board takes one frame at a time: a heartbeat under way is answered first
        await this.until(() => this.beatSequence === null, TABLES.heartbeat / 2)
        this.require(era)
        this.beatSequence = null
        this.send(frame, keepsAlive(message))
        if (await this.until(() => wanted.reply, patience)) return wanted.reply
      }
    } finally {
      done()
    }
    throw new LinkProblem(`The board did not answer ${message} for ${tidySeconds(tries * patience)} s. Check its power and its cable, then connect again.`)
  }

  // Ask for something to be done; return the tick after which it was.
  async command(message, values, options) {
    if (message === "START") this.absent = 0
    const { result, tick } = await this.ask(message, values, options)
    if (result === 0) return tick
    const [name, words] = rowOf(TABLES.results, result) ?? [`result ${result}`, "unknown"]
    throw new LinkProblem(`The board rejected ${message}: ${name}: ${INSTEAD[name] ?? words}.`, name)
  }

  refresh() {
    return this.ask("STATUS", [this.session])
  }

  // Say STOP at once, before all that waits, which is given up; end the heartbeats whatever becomes of it.
  giveUp() {
    this.beating = () => false
    this.era += 1
    this.wanted = this.beatSequence = null
    if (!this.broken) this.send(encodeFrame("STOP", this.next("STOP"), [], { session: this.session }))
    this.settle()
  }

  // Nothing can be sent or heard any more.
  fail(problem) {
    this.beating = () => false
    this.broken = this.broken ?? problem
    this.stopLooking?.()
    this.settle()
  }

  require(era) {
    if (this.broken) throw this.broken
    if (era !== this.era) throw new Abandoned()
  }

  // Wait until condition() holds; return whether it did within so many seconds.
  until(condition, seconds) {
    if (condition() || this.broken) return Promise.resolve(Boolean(condition()))
    const era = this.era
    return new Promise((resolve) => {
      const waits = { over: () => condition() || this.broken || era !== this.era, end: () => resolve(Boolean(condition())) }
      const cancel = this.clock.after(seconds, () => this.waiting.delete(waits) && waits.end())
      waits.cancel = cancel
      this.waiting.add(waits)
    })
  }

  settle() {
    for (const waits of this.waiting) {
      if (!waits.over()) continue
      this.waiting.delete(waits)
      waits.cancel()
      waits.end()
    }
  }

  next(message) {
    return (this.sent[TABLES.messages[message].guarded] += 1)
  }

  send(frame, alive = true) {
    if (alive) this.lastSent = this.clock.now()
    this.port.write(frame)
  }

  // Take bytes of the board: replies to whoever waits, states kept, the rest to onFrame.
  hear(bytes) {
    for (const frame of this.decoder.feed(bytes)) {
      const known = fieldsOf(frame)
      if (!known) {
        this.decoder.damaged += 1
        continue
      }
      if (frame.message === "STATE") {
        this.state = known
        if (frame.sequence === this.beatSequence) this.beatSequence = null
      }
      if (frame.message === "SAMPLE" || frame.message === "FAULTED") this.onFrame(frame, known)
      else if (this.isWanted(frame, known)) {
        const { wanted } = this
        this.wanted = null // a request sent twice is answered twice; the second is nobody's
        wanted.reply = known
        if (!known.result) wanted.then()
      }
    }
    this.settle()
    this.beat()
  }

  isWanted(frame, known) {
    const { wanted } = this
    if (!wanted || frame.sequence !== wanted.sequence) return false
    if (frame.message === "ACK") return known.request === TABLES.messages[wanted.message].number
    return (TABLES.answers[wanted.message] ?? []).includes(frame.message)
  }

  // Look after the heartbeats, a few times for each; note for how long nobody did.
  look() {
    this.beat()
    if (this.broken) return
    this.stopLooking = this.clock.after(TABLES.heartbeat / 4, () => this.look())
  }

  // Say that the page is there, where that is due.
  beat() {
    const [now, wall] = [this.clock.now(), this.clock.wall()]
    const pause = Math.max(now - this.lastLook, wall - this.lastWall)
    Object.assign(this, { lastLook: now, lastWall: wall })
    if (pause > TABLES.host_silence) this.absent = Math.max(this.absent, pause)
    if (this.broken || now - this.lastSent < TABLES.heartbeat || !this.beating()) return
    const sequence = this.next("STATUS")
    this.beatSequence = sequence & 255
    this.send(encodeFrame("STATUS", sequence, [this.session]))
  }
}

// Whether a board takes a message for the word of the session that drives it.
function keepsAlive(message) {
  return TABLES.messages[message].guarded || message === "HELLO" || message === "STATUS"
}

function tidySeconds(seconds) {
  return Number(seconds.toPrecision(2))
}

// In place of what a notebook's user would do.
const INSTEAD = {
  BUSY: "a scene runs: press Stop first",
  NOT_HOMED: "the position is unknown since the last reset: move the handle to both stops, then press Start",
  FAULT: "a fault is pending: remove its cause, then press Start again",
}
