// Frames as they come, and the samples of the last seconds: what traces, loop and sound are drawn from.

// A frame's bytes: dispatch [s], scene time [s], number of rows as float64; the rows; then every point of the picture.
function decode(buffer, shape, width) {
  const [sent, time, count] = new Float64Array(buffer.slice(0, 24))
  const numbers = new Float32Array(buffer.slice(24))
  return { sent, time, rows: numbers.subarray(0, count * width), points: numbers.subarray(count * width), shape }
}

// A point of what is shown: between this frame and the next, if both have the same items.
function between(frame, next, part) {
  if (!next || !part || next.points.length !== frame.points.length) return frame.points
  const a = frame.points
  const b = next.points
  return a.map((value, i) => value + part * (b[i] - value))
}

const KEPT = 8192 // rows: 4 s at 2 kHz

const ROUNDED = 2 ** -22 // of a time: float32 is so coarse

// A ring of the newest rows. ``at(k, name)`` is a value of row k, counted from the beginning; rows from ``oldest`` on are there.
class Samples {
  constructor(columns) {
    this.T = this.apart = Infinity // [s] from sample to sample, and from row to row
    this.width = columns.length
    this.column = Object.fromEntries(columns.map((name, k) => [name, k]))
    this.data = new Float32Array(KEPT * this.width)
    this.clear()
  }

  clear() {
    this.count = 0
  }

  add(rows) {
    for (let i = 0; i < rows.length; i += this.width) {
      this.data.set(rows.subarray(i, i + this.width), (this.count % KEPT) * this.width)
      this.count += 1
    }
  }

  get oldest() {
    return Math.max(0, this.count - KEPT)
  }

  at(row, name) {
    return this.data[(row % KEPT) * this.width + this.column[name]]
  }

  // Every sample has its row.
  get complete() {
    return this.apart < 1.5 * this.T
  }

  // Whether a row comes next after the row before it: nothing is missing between them.
  follows(row) {
    if (row <= this.oldest) return false
    const t = this.at(row, "t")
    const step = t - this.at(row - 1, "t")
    return step >= 0 && step < 1.5 * this.apart + ROUNDED * t
  }

  // The newest value of a column; NaN before the first.
  last(name) {
    return this.count ? this.at(this.count - 1, name) : NaN
  }

  // The first row at a time [s] or later: rows are in the order of time.
  since(time) {
    let [low, high] = [this.oldest, this.count]
    while (low < high) {
      const middle = (low + high) >> 1
      if (this.at(middle, "t") < time) low = middle + 1
      else high = middle
    }
    return low
  }
}

// The last two rows before which a column rises through its mean over the newest seconds
// since a gap; undefined where it does not.
function lastCycle(samples, name, seconds) {
  const since = samples.since(samples.last("t") - seconds)
  let from = samples.count - 1
  while (from > since && samples.follows(from)) from--
  let sum = 0
  for (let k = from; k < samples.count; k++) sum += samples.at(k, name)
  const mean = sum / (samples.count - from)
  const rises = []
  for (let k = samples.count - 1; k > from && rises.length < 2; k--) {
    if (samples.at(k - 1, name) < mean && samples.at(k, name) >= mean) rises.unshift(k)
  }
  return rises.length === 2 ? rises : undefined
}
