// Scrolling traces over scene time, one panel each. A pixel's column keeps the least and the greatest value that fell into
// it, so a chatter faster than the pixels shows as a band, and drawing costs the same however many samples there were.

const MARGIN = 48 // [px] left of the panels, for numbers
const PANEL = 80 // [px] height of a panel
const GAP = 26 // above each, for its name
const TIMES = 24 // below the last, for the time
const INTENT = 4 // the column of the hand's intent, drawn into the first panel

class Traces {
  // traces: [{label, unit_shown, scale}], of columns 1, 2, 3 of a frame's rows; seconds: how much time is on view
  constructor(canvas, traces, seconds) {
    this.canvas = canvas
    this.context = canvas.getContext("2d")
    this.traces = traces
    this.seconds = seconds
    this.scales = traces.map(() => new Scale())
  }

  resize(width) {
    this.width = width
    this.height = this.traces.length * (PANEL + GAP) + TIMES
    fit(this.canvas, width, this.height)
    this.columns = Math.max(Math.floor(width - MARGIN - 8), 50)
    this.bins = new Bins(this.columns + 8, this.seconds / this.columns, this.traces.length + 1)
  }

  add(rows) {
    for (let i = 0; i < rows.length; i += COLUMNS) {
      for (let k = 0; k < this.traces.length; k++) this.bins.add(rows[i], k, rows[i + 1 + k] * this.traces[k].scale)
      this.bins.add(rows[i], this.traces.length, rows[i + INTENT] * this.traces[0].scale)
    }
  }

  draw(time, theme) {
    const context = this.context
    context.clearRect(0, 0, this.width, this.height)
    context.font = FONT
    const last = time / this.bins.step // in columns, with a fraction: scrolls smoothly
    this.traces.forEach((trace, k) => {
      const top = k * (PANEL + GAP) + GAP - 4
      const [low, high] = this.scales[k].around(...this.bins.range(k, last, this.columns))
      const y = (value) => top + (PANEL * (high - value)) / (high - low)
      this.drawPanel(trace, top, y, this.scales[k].step, low, high, theme)
      context.save()
      context.beginPath()
      context.rect(MARGIN, top - 2, this.columns, PANEL + 4)
      context.clip()
      if (k === 0) this.drawCurve(this.traces.length, last, y, theme.quiet, [4, 4], 1.2)
      this.drawCurve(k, last, y, theme.ink, [], 1.6)
      context.restore()
    })
    this.drawTime(time, theme)
  }

  drawPanel(trace, top, y, step, low, high, theme) {
    const context = this.context
    context.setLineDash([])
    context.lineWidth = 1
    context.textAlign = "right"
    context.textBaseline = "middle"
    for (let n = Math.ceil(low / step - 1e-6); n * step <= high + 1e-6 * step; n++) {
      const line = Math.round(y(n * step)) + 0.5
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
    context.fillText(`${trace.label} [${trace.unit_shown}]`, MARGIN, top - 11)
    context.font = FONT
  }

  drawCurve(series, last, y, colour, dash, width) {
    const context = this.context
    const bins = this.bins
    context.strokeStyle = colour
    context.lineWidth = width
    context.setLineDash(dash)
    context.lineJoin = "round"
    context.beginPath()
    for (let column = Math.max(Math.ceil(last - this.columns), 0); column <= last; column++) {
      const slot = bins.slot(series, column)
      if (bins.column[slot] !== column) continue
      const x = MARGIN + this.columns - (last - column)
      context.lineTo(x, y(bins.first[slot]))
      if (bins.high[slot] > bins.low[slot]) {
        context.lineTo(x, y(bins.high[slot]))
        context.lineTo(x, y(bins.low[slot]))
        context.lineTo(x, y(bins.latest[slot]))
      }
    }
    context.stroke()
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
    if (!(column >= 0) || Number.isNaN(value)) return
    if (this.column[slot] !== column) {
      this.column[slot] = column
      this.first[slot] = this.low[slot] = this.high[slot] = value
    }
    this.low[slot] = Math.min(this.low[slot], value)
    this.high[slot] = Math.max(this.high[slot], value)
    this.latest[slot] = value
  }

  range(series, last, columns) {
    let low = Infinity
    let high = -Infinity
    for (let column = Math.max(Math.ceil(last - columns), 0); column <= last; column++) {
      const slot = this.slot(series, column)
      if (this.column[slot] !== column) continue
      low = Math.min(low, this.low[slot])
      high = Math.max(high, this.high[slot])
    }
    return [low, high]
  }

  clear() {
    this.column.fill(-1)
  }
}

// An axis that grows at once and shrinks only when much too large, so that it does not flicker.
class Scale {
  constructor() {
    this.low = this.high = 0
  }

  around(low, high) {
    if (!(low <= high)) [low, high] = [0, 0]
    low = Math.min(low, 0)
    high = Math.max(high, 0)
    const needed = Math.max(high - low, 1e-3)
    if (low < this.low || high > this.high || needed < 0.3 * (this.high - this.low) || !this.step) {
      this.step = niceStep((1.1 * needed) / 3)
      this.low = Math.floor(low / this.step - 0.1) * this.step
      this.high = Math.ceil(high / this.step + 0.1) * this.step
    }
    return [this.low, this.high]
  }
}
