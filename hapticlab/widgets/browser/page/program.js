// A linked program in a page: one module of the engine wasm with its arrays in a memory of its own, see
// hapticlab/compiler/engines/wasm_emit.py. All numbers are float64 there, whatever the program computes with.

const BYTES = 8
const PAGE_BYTES = 65536

class Program {
  // told: {code, the module as base64; inputs, parameters, states, outputs, their names}
  static async open(told) {
    const code = Uint8Array.from(atob(told.code), (letter) => letter.charCodeAt(0))
    return new Program(await WebAssembly.compile(code), told) // at once, a browser compiles small modules only
  }

  constructor(module, told) {
    Object.assign(this, { inputs: told.inputs, states: told.states, outputs: told.outputs })
    this.parameters = told.parameters.length
    this.memory = new WebAssembly.Memory({ initial: 1 })
    this.tick = new WebAssembly.Instance(module, { env: { memory: this.memory } }).exports.run
  }

  // Run so many ticks. inputs: a Float64Array, the rows one after another; states: those where a run ended, or null at the
  // beginning. Return {columns, the outputs by name; states}.
  run(ticks, inputs, parameters, states) {
    const sizes = [inputs.length, this.parameters, this.states.length, ticks * this.outputs.length]
    const starts = sizes.map((_, k) => sizes.slice(0, k).reduce((sum, size) => sum + size, 0))
    this.grow(BYTES * (starts[3] + sizes[3]))
    const [given, bound, carried, found] = starts.map((start, k) => new Float64Array(this.memory.buffer, BYTES * start, sizes[k]))
    given.set(inputs)
    bound.set(parameters)
    if (states) carried.set(states)
    this.tick(ticks, 1, BYTES, states ? 1 : 0, ...starts.map((start) => BYTES * start))
    const width = this.outputs.length
    const column = (k) => Float64Array.from({ length: ticks }, (_, row) => found[row * width + k])
    return { columns: Object.fromEntries(this.outputs.map((name, k) => [name, column(k)])), states: carried.slice() }
  }

  grow(bytes) {
    const missing = bytes - this.memory.buffer.byteLength
    if (missing > 0) this.memory.grow(Math.ceil(missing / PAGE_BYTES))
  }
}
