// A scene on a simulated paddle, advanced some ticks at a time while a hand leads it: what Stepping is in Python
// (hapticlab/device/simulated/stepping.py), bit for bit. Only noise is drawn by another generator, for NumPy is not here.

class Stepping {
  // told: the data of the page; programs: {held, free}, with a hand on the handle and without
  constructor(told, programs) {
    Object.assign(this, { told, programs, T: told.T })
    this.numbers = told.parameters.map((parameter) => parameter.value)
    this.held = true
    this.start()
  }

  get program() {
    return this.programs[this.held ? "held" : "free"]
  }

  // The scene's parameters as they are now, by name, SI.
  get values() {
    return Object.fromEntries(this.told.parameters.map(({ name }, k) => [name, this.numbers[k]]))
  }

  // Begin anew: the handle where it was at first, the values as they are now.
  start() {
    Object.assign(this, { states: null, ticks: 0, fault: null, place: this.told.start })
    this.noise = Object.entries(this.told.noise).map(([name, deviation], k) => ({ name, deviation, draw: normal(this.told.seed, k) }))
  }

  // Advance by one tick less than there are places where the hand means to be [m]; return what was sampled, by name.
  advance(intent) {
    const ticks = intent.length - 1
    const plant = this.told.plant[this.held ? "held" : "free"]
    const { columns, states } = this.program.run(ticks, this.inputs(intent), [...this.numbers, ...plant], this.states)
    const { fault, ...found } = columns
    const t = Float64Array.from({ length: ticks }, (_, k) => (this.ticks + k) * this.T)
    const first = fault.findIndex((code) => code > 0)
    if (this.fault === null && first >= 0) this.fault = this.stopped(fault[first], this.ticks + first)
    this.states = states
    this.ticks += ticks
    this.place = states[this.program.states.indexOf("plant.x")]
    return { t, ...found, intent: this.held ? intent.slice(0, ticks) : new Float64Array(ticks).fill(NaN) }
  }

  inputs(intent) {
    const names = this.program.inputs
    const rows = new Float64Array((intent.length - 1) * names.length)
    const noise = Object.fromEntries(this.noise.map((each) => [each.name, () => each.deviation * each.draw()]))
    const value = { intent: (k) => intent[k], "intent.rate": (k) => (intent[k + 1] - intent[k]) / this.T, ...noise }
    for (let k = 0; k < intent.length - 1; k++) names.forEach((name, j) => (rows[k * names.length + j] = value[name](k)))
    return rows
  }

  // What stopped the motor, in words.
  stopped(code, tick) {
    const { names, cause } = this.told.faults
    const when = `tick ${tick} (t = ${general(tick * this.T)} s)`
    return `${when}: ${names[code - 1]} of ${this.told.scene} was not finite; the motor is off from then on${cause}`
  }

  set(numbers) {
    for (const [name, value] of Object.entries(numbers)) this.numbers[this.told.parameters.findIndex((each) => each.name === name)] = value
  }

  // Take the handle, or let go of it; position and velocity stay as they are at that tick.
  hold(held) {
    if (held === this.held) return
    const known = this.states && Object.fromEntries(this.program.states.map((name, k) => [name, this.states[k]]))
    this.held = held
    if (known) this.states = Float64Array.from(this.program.states, (name) => known[name] ?? 0)
  }
}

// A generator of standard normal numbers: sfc32 (C. Doty-Humphrey, PractRand, 2010) and the transform of Box and Muller (1958).
function normal(seed, stream) {
  let [a, b, c, counter] = [seed | 0, (seed / 2 ** 32) | 0, stream, 1]
  const next = () => {
    const sum = (a + b + counter++) | 0
    a = b ^ (b >>> 9)
    b = (c + (c << 3)) | 0
    c = (((c << 21) | (c >>> 11)) + sum) | 0
    return (sum >>> 0) / 2 ** 32
  }
  for (let k = 0; k < 15; k++) next() // until a small seed has reached every bit
  return () => Math.sqrt(-2 * Math.log(1 - next())) * Math.cos(2 * Math.PI * next())
}
