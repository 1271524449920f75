// Scrolling traces over scene time, one panel each. A pixel's column keeps the least and the greatest value that fell into
// it, so a chatter faster than the pixels shows as a band. Curves are drawn once, on a strip that goes round: a frame draws
// its new columns, and copies the rest.

const MARGIN = 48 // [px] left of the panels, for numbers
const PANEL = 80 // [px] height of a panel
const GAP = 26 // above each, for its name
const TIMES = 24 // below the last, for the time
const LEAST = 0.1 // mm, N, mJ: an axis shows no less
const INTENT = 4 // the column of the hand's intent, drawn into the first panel

class Traces {
  // traces: [{label, unit_shown, scale}], of columns 1, 2, 3 of a frame's rows; seconds: how much time is on view
  constructor(canvas, traces, seconds) {
    this.canvas = canvas
    this.context = canvas.getContext("2d")
    this.traces = traces
    this.seconds = seconds
    this.notes = {} // beside a panel's name, in words
    this.scales = traces.map(() => new Scale())
    this.strip = document.createElement("canvas")
    this.drawn = -1 // the last column on the strip
  }

  resize(width) {
    this.width = width
    this.height = this.traces.length * (PANEL + GAP) + TIMES
    fit(this.canvas, width, this.height)
    this.columns = Math.max(Math.floor(width - MARGIN - 8), 50)
    this.bins = new Bins(this.columns + 8, this.seconds / this.columns, this.traces.length + 1)
    this.strip.width = Math.round(this.columns * (window.devicePixelRatio || 1))
    this.strip.height = this.canvas.height
    this.drawn = -1
  }

  clear() {
    this.bins.clear()
    this.drawn = -1
  }

  add(rows) {
    for (let i = 0; i < rows.length; i += COLUMNS) {
      for (let k = 0; k < this.traces.length; k++) this.bins.add(rows[i], k, rows[i + 1 + k] * this.traces[k].scale)
      this.bins.add(rows[i], this.traces.length, rows[i + INTENT] * this.traces[0].scale)
    }
  }

  draw(time, theme) {
    const context = this.context
    const last = Math.floor(time / this.bins.step)
    context.clearRect(0, 0, this.width, this.height)
    context.font = FONT
    this.traces.forEach((trace, k) => {
      const series = k === 0 ? [k, this.traces.length] : [k]
      if (this.scales[k].reach(...this.bins.range(series, last, this.columns))) this.drawn = -1
      this.drawPanel(trace, k, theme)
    })
    if (this.theme !== theme.ink) this.drawn = -1
    this.theme = theme.ink
    this.drawStrip(last, theme)
    this.copyStrip(last)
    this.drawTime(time, theme)
  }

  top(k) {
    return k * (PANEL + GAP) + GAP - 4
  }

  y(k, value) {
    const { low, high } = this.scales[k]
    return this.top(k) + (PANEL * (high - value)) / (high - low)
  }

  drawPanel(trace, k, theme) {
    const context = this.context
    const { low, high, step } = this.scales[k]
    const top = this.top(k)
    context.setLineDash([])
    context.lineWidth = 1
    context.textAlign = "right"
    context.textBaseline = "middle"
    for (let n = Math.ceil(low / step - 1e-6); n * step <= high + 1e-6 * step; n++) {
      const line = Math.round(this.y(k, n * step)) + 0.5
      context.strokeStyle = n === 0 ? theme.quiet : theme.grid
      context.beginPath()
      context.moveTo(MARGIN, line)
      context.lineTo(MARGIN + this.columns, line)
      context.stroke()
      context.fillStyle = theme.quiet
      context.fillText(tidy(n * step), MARGIN - 6, line)
    }
    context.textAlign = "left"
    context.fillStyle = theme.ink
    context.font = "bold " + FONT
    const name = `${trace.label} [${trace.unit_shown}]`
    context.fillText(name, MARGIN, top - 11)
    const after = MARGIN + context.measureText(name).width
    context.font = FONT
    if (this.notes[trace.name]) context.fillText(this.notes[trace.name], after + 14, top - 11)
  }

  // Draw the columns that are new, and the last one again, which was not complete.
  drawStrip(last, theme) {
    const ratio = this.strip.width / this.columns
    const context = this.strip.getContext("2d")
    const from = Math.max(this.drawn < 0 ? 0 : this.drawn, last - this.columns + 1, 0)
    context.setTransform(ratio, 0, 0, ratio, 0, 0)
    // one more, into which the line before it spilled when it was there a round ago
    for (let column = from; column <= last + 1; column++) context.clearRect(column % this.columns, 0, 1, this.height)
    for (let column = from; column <= last; column++) {
      if (Math.floor(column / 4) % 2) this.drawColumn(context, 0, this.traces.length, column, theme.quiet, 1.2)
      for (let k = 0; k < this.traces.length; k++) this.drawColumn(context, k, k, column, theme.ink, 1.6)
    }
    this.drawn = Math.min(last, this.bins.newest) // a frame that is coming fills the columns after it
  }

  drawColumn(context, panel, series, column, colour, width) {
    const bins = this.bins
    const slot = bins.slot(series, column)
    if (bins.column[slot] !== column) return
    const x = column % this.columns
    const y = (value) => this.y(panel, value)
    context.strokeStyle = colour
    context.lineWidth = width
    context.beginPath()
    const before = bins.before(series, column)
    if (before !== undefined) context.moveTo(x - (column - bins.column[before]) + 0.5, y(bins.latest[before]))
    for (const each of [bins.first, bins.high, bins.low, bins.latest]) context.lineTo(x + 0.5, y(each[slot]))
    context.stroke()
  }

  // Copy the strip so that its last column is at the right end.
  copyStrip(last) {
    const seam = (last + 1) % this.columns // columns from here on are the older ones
    const ratio = this.strip.width / this.columns
    for (const [from, to, count] of [[seam, 0, this.columns - seam], [0, this.columns - seam, seam]]) {
      if (!count) continue
      const source = [Math.round(from * ratio), 0, Math.round(count * ratio), this.strip.height]
      this.context.drawImage(this.strip, ...source, MARGIN + to, 0, count, this.height)
    }
  }

  drawTime(time, theme) {
    const context = this.context
    const line = this.height - TIMES + 2
    const step = niceStep(this.seconds / 8)
    context.textBaseline = "top"
    context.textAlign = "center"
    context.strokeStyle = context.fillStyle = theme.quiet
    context.setLineDash([])
    context.lineWidth = 1
    context.beginPath()
    for (let n = Math.max(Math.ceil((time - this.seconds) / step), 0); n * step <= time; n++) {
      const x = Math.round(MARGIN + this.columns * (1 - (time - n * step) / this.seconds)) + 0.5
      context.moveTo(x, line)
      context.lineTo(x, line + 4)
      if (x < this.width - 44) context.fillText(tidy(n * step), x, line + 7)
    }
    context.stroke()
    context.textAlign = "right"
    context.fillText("t [s]", this.width - 4, line + 7)
  }
}

// A ring of columns for each series: first, least, greatest and latest value of each.
class Bins {
  constructor(columns, step, series) {
    this.columns = columns
    this.step = step // [s] a column
    const size = columns * series
    this.newest = -1 // column
    this.column = new Int32Array(size).fill(-1)
    this.first = new Float64Array(size)
    this.low = new Float64Array(size)
    this.high = new Float64Array(size)
    this.latest = new Float64Array(size)
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
  before(series, column) {
    for (let k = column - 1; k >= 0 && k > column - 12; k--) {
      const slot = this.slot(series, k)
      if (this.column[slot] === k) return slot
    }
  }

  // Least and greatest value of several series in the columns on view, zero included.
  range(series, last, columns) {
    let [low, high] = [0, 0]
    for (const each of series) {
      for (let column = Math.max(Math.ceil(last - columns), 0); column <= last; column++) {
        const slot = this.slot(each, column)
        if (this.column[slot] !== column) continue
        low = Math.min(low, this.low[slot])
        high = Math.max(high, this.high[slot])
      }
    }
    return [low, high]
  }

  clear() {
    this.column.fill(-1)
    this.newest = -1
  }
}

// An axis that grows at once and shrinks only when much too large, so that it does not flicker.
class Scale {
  constructor() {
    this.low = this.high = 0
  }

  // Show from low to high; return whether the axis had to change.
  reach(low, high) {
    const needed = Math.max(high - low, LEAST)
    if (this.step && low >= this.low && high <= this.high && needed >= 0.3 * (this.high - this.low)) return false
    this.step = niceStep(needed / 2.5)
    const [least, most] = [this.low, this.high]
    this.low = Math.floor(low / this.step + 1e-9) * this.step
    this.high = Math.max(Math.ceil(high / this.step - 1e-9), 1) * this.step
    return least !== this.low || most !== this.high
  }
}
