// From samples as they come to the rows that a view draws, the energy among them, and the recent second: Traces of
// hapticlab/widgets/traces.py.

const RECENT = 1.0 // [s] kept in full to say what goes on
const THINNED = 5e-4 // [s] between two rows at least
const LARGEST = (2 - 2 ** -23) * 2 ** 127 // what a row can hold: float32

// [s] between two rows, for a sample every T [s].
function rowsApart(T) {
  return T * Math.max(1, Math.ceil(THINNED / T - 1e-9))
}

class Rows {
  // T: between two samples [s]; columns: names, of a row; watched: those of its last columns in the samples
  constructor(T, columns, watched) {
    Object.assign(this, { T, columns, watched, step: Math.round(rowsApart(T) / T), energy: 0, before: null, count: 0, recent: [], length: 0 })
  }

  // Take samples, arrays by name; return their rows, thinned, one after another. contact: 1, 0 or NaN of each
  add(samples, contact) {
    const { x, F, x_true = x, F_applied = F } = samples
    const size = x.length
    const known = { x_switch: x_true, ...samples, x_true, F_applied, contact, E: this.drawn(samples) }
    const own = this.columns.length - this.watched.length
    const found = this.columns.map((name, k) => (k < own ? known[name] : samples[this.watched[k - own]]))
    const first = (this.step - (this.count % this.step)) % this.step
    const rows = []
    for (let k = first; k < size; k += this.step) {
      for (const column of found) rows.push(column ? Math.min(Math.max(column[k], -LARGEST), LARGEST) : NaN)
    }
    this.count += size
    this.keep({ x, F, contact })
    return Float32Array.from(rows)
  }

  // x [m], F [N] and the contact of the last second, as one array each.
  last() {
    return ["x", "F", "contact"].map((name) => joined(this.recent.map((part) => part[name])))
  }

  keep(part) {
    this.recent.push(part)
    this.length += part.x.length
    while (this.length - this.recent[0].x.length >= RECENT / this.T) this.length -= this.recent.shift().x.length
  }

  // The energy drawn from the environment at each sample [J]: force and displacement paired as they acted, Fig. 23.6.
  drawn({ x, F, x_true = x, F_applied = F, x_switch = x_true }) {
    let last = this.before ?? { x: x_true[0], held: F_applied[0], earlier: 0, at: x_switch[0] }
    let total = 0
    const found = Float64Array.from(x_true, (place, k) => {
      const work = last.earlier * (last.at - last.x) + last.held * (place - last.at)
      total += this.before || k ? work : 0
      last = { x: place, held: F_applied[k], earlier: last.held, at: x_switch[k] }
      return this.energy - total
    })
    this.energy = found.at(-1)
    this.before = last
    return found
  }
}

function joined(parts, type = Float64Array) {
  const whole = new type(parts.reduce((sum, part) => sum + part.length, 0))
  let end = 0
  for (const part of parts) {
    whole.set(part, end)
    end += part.length
  }
  return whole
}

// The bytes of a frame, as samples.js takes them apart.
function frameBytes(sent, time, rows, width, points) {
  const bytes = new ArrayBuffer(24 + 4 * (rows.length + points.length))
  new Float64Array(bytes, 0, 3).set([sent, time, rows.length / width])
  const numbers = new Float32Array(bytes, 24)
  numbers.set(rows)
  numbers.set(points, rows.length)
  return bytes
}
