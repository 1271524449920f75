// The firmware's core as a board inside a page: firmware/prebuilt/web.wasm is the C of a real one. Time, handle and link
// are in the page's hands, as they are in sim://: whoever calls ``tick`` is the timer.

const STORE = 4096 // bytes that survive power-off
const DUTY_FULL = 32767
const ROOM = 65536 // bytes: all that the board has to say at once
const SAMPLE = 21 // as in hapticlab/device/link/messages.py

class Board {
  // Power on. wasm: the module's bytes; store: what the memory that survives power-off holds, 255 in each byte of a new one.
  static async open(wasm, store = new Uint8Array(STORE).fill(255)) {
    const { instance } = await WebAssembly.instantiate(wasm, {})
    return new Board(instance.exports, store)
  }

  constructor(core, store) {
    this.core = core
    this.kept = core.calloc(STORE, 1)
    this.room = core.calloc(ROOM, 1)
    new Uint8Array(core.memory.buffer, this.kept, STORE).set(store)
    this.board = core.hl_host_new(this.kept, 0)
    if (!this.board) throw new Error("no memory for a board")
  }

  // The memory may have grown since, so it is looked at anew each time.
  bytes(at, count) {
    return new Uint8Array(this.core.memory.buffer, at, count)
  }

  // Take bytes from the link; every whole frame among them is answered.
  receive(data) {
    for (let from = 0; from < data.length; from += ROOM) {
      const part = data.subarray(from, from + ROOM)
      this.bytes(this.room, part.length).set(part)
      this.core.hl_host_receive(this.board, this.room, part.length)
    }
  }

  // Return the bytes that the board has to say: whole frames.
  transmit() {
    return this.bytes(this.room, this.core.hl_host_transmit(this.board, this.room, ROOM)).slice()
  }

  // One tick at ``now`` [s] with the handle at ``counts``; return the duty, -1 to 1. The motor pushes by minus the force.
  tick(counts, now, step = 0) {
    return this.core.hl_host_tick(this.board, counts, Math.round(now * 1e6) & 0xffff, Math.round(step * 1e6)) / DUTY_FULL
  }

  get duty() {
    return this.core.hl_host_duty(this.board) / DUTY_FULL
  }

  // [s], of the timer
  get period() {
    return this.core.hl_host_period_us(this.board) / 1e6
  }

  get store() {
    return this.bytes(this.core.hl_host_store(this.board), STORE).slice()
  }
}

// The frames among bytes of the board: {message, sequence, payload}. Nothing on the way can damage them, so no CRC is looked at.
function frames(data) {
  const found = []
  for (let from = 0, end; (end = data.indexOf(0, from)) >= 0; from = end + 1) {
    const body = unstuff(data.subarray(from, end))
    if (body.length >= 4) found.push({ message: body[0] & 31, sequence: body[1], payload: body.slice(2, -2) })
  }
  return found
}

// Undo COBS: each run up to a zero is led by its length plus one.
function unstuff(data) {
  const body = []
  for (let at = 0; at < data.length; at += data[at]) {
    if (at) body.push(0)
    body.push(...data.subarray(at + 1, at + data[at]))
  }
  return Uint8Array.from(body)
}

// The samples among frames: {tick, flags, values}, values being x [m], v [m/s], F [N] and what the scene watches.
function samplesOf(all) {
  return all.filter(({ message }) => message === SAMPLE).map(({ payload }) => {
    const view = new DataView(payload.buffer)
    const values = Array.from({ length: (payload.length - 5) / 4 }, (_, k) => view.getFloat32(5 + 4 * k, true))
    return { tick: view.getUint32(0, true), flags: payload[4], values }
  })
}
