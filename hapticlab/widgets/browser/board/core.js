// The firmware's core as a board inside a page: firmware/prebuilt/web.wasm is the C of a real one. Time, handle and link
// are in the page's hands, as they are in sim://: whoever calls ``tick`` is the timer. messages.js and link.js come before it.

const ROOM = 65536 // bytes: all that the board has to say at once

class Board {
  // Power on. wasm: the module's bytes; store: what the memory that survives power-off holds, 255 in each byte of a new one.
  static async open(wasm, store = new Uint8Array(TABLES.store_bytes).fill(255)) {
    const { instance } = await WebAssembly.instantiate(wasm, {})
    return new Board(instance.exports, store)
  }

  constructor(core, store) {
    this.core = core
    this.kept = core.calloc(TABLES.store_bytes, 1)
    this.room = core.calloc(ROOM, 1)
    this.bytes(this.kept, TABLES.store_bytes).fill(255).set(store)
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
    return this.core.hl_host_tick(this.board, counts, Math.round(now * 1e6) & 0xffff, Math.round(step * 1e6)) / TABLES.duty_full
  }

  get duty() {
    return this.core.hl_host_duty(this.board) / TABLES.duty_full
  }

  // [s], of the timer
  get period() {
    return this.core.hl_host_period_us(this.board) / 1e6
  }

  get store() {
    return this.bytes(this.core.hl_host_store(this.board), TABLES.store_bytes).slice()
  }

  // Flip bits of a byte of the active program, as a failing memory would.
  damageProgram(at, mask) {
    this.bytes(this.core.hl_host_program(this.board) + at, 1)[0] ^= mask
  }
}
