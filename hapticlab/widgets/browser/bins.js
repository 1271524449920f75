// What a pixel's column of a trace keeps, and how an axis follows it.

// A ring of columns for each series: first, least, greatest and latest value of each.
class Bins {
  constructor(columns, step, series) {
    this.columns = columns
    this.step = step // [s] a column
    const size = columns * series
    this.newest = -1 // column
    this.column = new Int32Array(size).fill(-1)
    for (const kept of ["first", "low", "high", "latest"]) this[kept] = new Float64Array(size)
  }

  slot(series, column) {
    return series * this.columns + (column % this.columns)
  }

  add(time, series, value) {
    const column = Math.floor(time / this.step)
    const slot = this.slot(series, column)
    if (!(column >= 0)) return
    this.newest = column
    if (Number.isNaN(value)) return
    if (this.column[slot] !== column) {
      this.column[slot] = column
      this.first[slot] = this.low[slot] = this.high[slot] = value
    }
    this.low[slot] = Math.min(this.low[slot], value)
    this.high[slot] = Math.max(this.high[slot], value)
    this.latest[slot] = value
  }

  // Where the value before a column is, if it is near.
  previous(series, column) {
    for (let k = column - 1; k >= 0 && k > column - 12; k--) {
      const slot = this.slot(series, k)
      if (this.column[slot] === k) return slot
    }
  }

  // Least and greatest value of the columns from one to another.
  span(series, from, to) {
    let [low, high] = [Infinity, -Infinity]
    for (let column = Math.max(from, 0); column <= to; column++) {
      const slot = this.slot(series, column)
      if (this.column[slot] !== column) continue
      low = Math.min(low, this.low[slot])
      high = Math.max(high, this.high[slot])
    }
    return { low, high }
  }

  // How often the values turn round by more than a size in the columns from one to another.
  turns(series, from, to, size) {
    let [turns, rises, end] = [0, 0, NaN] // whether it rises, 0 before that is known, and how far it came
    for (let column = Math.max(from, 0); column <= to; column++) {
      const slot = this.slot(series, column)
      if (this.column[slot] !== column) continue
      const ends = [this.low[slot], this.high[slot]]
      if (this.latest[slot] < this.first[slot]) ends.reverse()
      for (const value of [this.first[slot], ...ends, this.latest[slot]]) {
        if (Number.isNaN(end)) end = value
        else if ((value - end) * rises > 0) end = value
        else if (Math.abs(value - end) > size) {
          turns += rises ? 1 : 0
          rises = Math.sign(value - end)
          end = value
        }
      }
    }
    return turns
  }
}

const FINEST = 2 ** -22 // of the values: float32 does not tell apart what is finer
const LINES = 100 // of an axis, at most

// An axis that grows at once and shrinks only when much too large, so that it does not flicker.
class Scale {
  constructor(least) {
    this.least = least // an axis shows no less
    this.low = this.high = 0
  }

  // Show from low to high; return whether the axis had to change.
  reach(low, high, lines) {
    const room = Math.max(this.least, FINEST * Math.max(Math.abs(low), Math.abs(high)))
    const needed = Math.max(high - low, room)
    if (this.step && low >= this.low && high <= this.high && needed >= 0.3 * (this.high - this.low)) return false
    const [least, most] = [this.low, this.high]
    this.step = niceStep(needed / lines)
    this.low = Math.floor(low / this.step + 1e-9) * this.step
    this.high = Math.max(Math.ceil(high / this.step - 1e-9), Math.round(this.low / this.step) + Math.ceil(room / this.step - 1e-9)) * this.step
    return least !== this.low || most !== this.high
  }

  // The values at which an axis has a line.
  *lines() {
    const first = Math.ceil(this.low / this.step - 1e-6)
    for (let k = 0; k < LINES && (first + k) * this.step <= this.high + 1e-6 * this.step; k++) yield (first + k) * this.step
  }
}
