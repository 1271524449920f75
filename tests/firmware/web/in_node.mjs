// Runs the core as WebAssembly: a request from stdin, an answer to stdout, as JSON; arrays are base64 of doubles.
// Asked: module (a path); side, whether it is a library for Pyodide; runs of hl_host_run; script, calls of core.js's Board.
import { readFileSync } from "node:fs"

const board = new URL("../../../hapticlab/widgets/browser/board/", import.meta.url)
const scripts = ["../page/npz.js", "messages.js", "link.js", "core.js"].map((name) => readFileSync(new URL(name, board), "utf-8")).join("\n")
const { Board, Decoder } = new Function(`${scripts}; return { Board, Decoder }`)()
const doubles = (text) => new Float64Array(Uint8Array.from(Buffer.from(text, "base64")).buffer)
const text = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength).toString("base64")

/** Load a dylink module as Emscripten does: its memory and table begin where the loader says. */
function side_module(code) {
  const module = new WebAssembly.Module(code)
  const section = new Uint8Array(WebAssembly.Module.customSections(module, "dylink.0")[0])
  let at = 0
  const number = () => {
    let value = 0
    for (let shift = 0; ; shift += 7) {
      value += (section[at] & 127) << shift
      if (section[at++] < 128) return value
    }
  }
  if (number() !== 1) throw new Error("dylink.0 does not begin with what the module needs")
  number()
  const [size, align, entries] = [number(), number(), number()]
  const memory = new WebAssembly.Memory({ initial: 64 }), table = new WebAssembly.Table({ initial: 8 + entries, element: "anyfunc" })
  const base = Math.ceil(4096 / 2 ** align) * 2 ** align, stack = base + size + 65536
  let end = Math.ceil(stack / 16) * 16
  const constant = (value, mutable = false) => new WebAssembly.Global({ value: "i32", mutable }, value)
  const seen = () => new Uint8Array(memory.buffer)
  const env = {
    memory, __indirect_function_table: table, __memory_base: constant(base), __table_base: constant(8), __stack_pointer: constant(end, true),
    calloc(count, bytes) {
      const from = end
      end = Math.ceil((end + count * bytes) / 16) * 16
      if (end > memory.buffer.byteLength) memory.grow(Math.ceil((end - memory.buffer.byteLength) / 65536))
      return from
    },
    free() {},
    memcmp: (a, b, count) => Buffer.compare(seen().subarray(a, a + count), seen().subarray(b, b + count)),
  }
  const { exports } = new WebAssembly.Instance(module, { env }) // a GOT it has none: it takes no address of another's things
  exports.__wasm_apply_data_relocs?.()
  exports.__wasm_call_ctors?.()
  return { ...exports, memory, calloc: env.calloc }
}

function run(core, { program, registers, ticks, outputs, states, rounds = 0, ...given }) {
  const code = Buffer.from(program, "hex"), put = (array) => {
    const at = core.calloc(array.byteLength + 8, 1)
    new Uint8Array(core.memory.buffer, at, array.byteLength).set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength))
    return at
  }
  const bytes = put(code), memory = put(new Int32Array(registers)), scratch = put(new Int32Array(outputs))
  const [inputs, values] = [put(doubles(given.inputs)), put(doubles(given.values))]
  const kept = put(new Float64Array(states)), out = put(new Float64Array(ticks * outputs)), faults = put(new Int32Array(1))
  const go = () => core.hl_host_run(bytes, code.length, memory, registers, scratch, BigInt(ticks), 1n, 1n, 0, inputs, values, kept, out, faults)
  const result = go(), times = []
  for (let k = 0; k < rounds; k++) {
    const began = performance.now()
    go()
    times.push((1e6 * (performance.now() - began)) / ticks)
  }
  const found = (at, count) => text(new Float64Array(core.memory.buffer, at, count))
  const fault = new Int32Array(core.memory.buffer, faults, 1)[0]
  return { result, fault, outputs: found(out, ticks * outputs), states: found(kept, states), ns: times.length ? Math.min(...times) : null }
}

/** Numbers of a sample: x [m], v [m/s], F [N] and what the scene watches. */
function sample({ payload }) {
  const view = new DataView(payload.buffer)
  const values = Array.from({ length: (payload.length - 5) / 4 }, (_, k) => view.getFloat32(5 + 4 * k, true))
  return { tick: view.getUint32(0, true), flags: payload[4], values }
}

/** Repeat what was done to a board; its answers, and the samples among them. */
function replay(board, script) {
  const answers = [], samples = [], decoder = new Decoder()
  for (const [call, ...given] of script) {
    if (call === "receive") board.receive(Uint8Array.from(Buffer.from(given[0], "hex")))
    if (call === "tick") answers.push(board.tick(...given))
    if (call === "transmit") {
      const said = board.transmit()
      answers.push(Buffer.from(said).toString("hex"))
      samples.push(...decoder.feed(said).filter(({ message }) => message === "SAMPLE").map(sample))
    }
  }
  return { answers, samples, duty: board.duty, period: board.period, store: Buffer.from(board.store).toString("hex") }
}

/** [ns] of a tick of a board that runs, by core.js, its samples taken every 64th. */
function timed(board, period, ticks) {
  const times = []
  for (let round = 0, now = 1; round < 200; round++) {
    const began = performance.now()
    for (let k = 0; k < ticks; k++, now += period) {
      board.tick(1000 + (k % 7), now)
      if (k % 64 === 0) board.receive(STATUS), board.transmit()
    }
    times.push((1e6 * (performance.now() - began)) / ticks)
  }
  if (!board.duty) throw new Error("it does not run: the wall would push")
  return Math.min(...times)
}

let STATUS
const asked = JSON.parse(readFileSync(0, "utf-8"))
const code = readFileSync(asked.module)
const imports = WebAssembly.Module.imports(new WebAssembly.Module(code)).map(({ name }) => name)
const core = asked.side ? side_module(code) : (await WebAssembly.instantiate(code, {})).instance.exports
const answer = { imports, runs: (asked.runs ?? []).map((one) => run(core, one)) }
if (asked.script) {
  const store = Uint8Array.from(Buffer.from(asked.store, "hex"))
  const board = asked.side ? new Board(core, store) : await Board.open(code, store)
  Object.assign(answer, replay(board, asked.script))
  if (asked.status) {
    STATUS = Uint8Array.from(Buffer.from(asked.status, "hex"))
    answer.ns = timed(board, answer.period, asked.ticks)
  }
}
console.log(JSON.stringify(answer))
