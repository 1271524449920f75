// Scrolling traces over scene time, one panel each. A pixel's column keeps the least and the greatest value that fell into
// it. Where a signal is too fast for columns, a band shows between which values it swings: its envelope. Curves are drawn
// once, on a strip that goes round: a frame draws its new columns, and copies the rest.

const MARGIN = 44 // [px] left of the panels, for numbers
const HEAD = 17 // [px] above each, for its name
const TIMES = 22 // [px] below the last, for the time
const LEAST = { mm: 2, N: 0.2, mJ: 0.2 } // an axis shows no less: a count of the encoder is not to fill it
const BESIDE = 0.05 // [s] on either side of a column, in which its envelope is looked for
const TURNS = 4 // turns in twice that from which on a band is drawn: above 20 Hz
const WIDEST = 20 // columns that may be: with more the eye follows each swing
const ZOOM = 0.2 // [s] of scene time that the zoom shows

class Traces {
  // samples: of the last seconds; about.traces: [{name, label, unit_shown, scale, open}]; about.seconds: of the clock on view
  constructor(canvas, about, samples) {
    this.canvas = canvas
    this.context = canvas.getContext("2d")
    this.samples = samples
    this.known = about.traces
    this.seconds = about.seconds
    this.speed = 1
    this.zoomed = false
    this.notes = {} // beside a panel's name, in words
    this.strip = document.createElement("canvas")
    this.open = about.traces.filter((trace) => trace.open).map((trace) => trace.name)
    this.touches = about.touches
  }

  // Show these traces, in the order of all.
  show(open) {
    this.open = open
    this.resize(this.width, this.height)
  }

  get window() {
    return this.zoomed ? ZOOM : this.seconds * Math.min(this.speed, 1)
  }

  resize(width, height) {
    this.width = width
    this.height = height
    this.traces = this.known.filter((trace) => this.open.includes(trace.name))
    this.panel = (height - TIMES) / Math.max(this.traces.length, 1) - HEAD
    this.scales = this.traces.map((trace) => new Scale(LEAST[trace.unit_shown] ?? 0.1))
    fit(this.canvas, width, height)
    this.columns = Math.max(Math.floor(width - MARGIN - 8), 50)
    this.strip.width = Math.round(this.columns * (window.devicePixelRatio || 1))
    this.strip.height = this.canvas.height
    this.rebuild()
  }

  // Put every sample that is kept into its column: the width, the window or the traces changed.
  rebuild() {
    const series = this.traces.length + 2
    this.bins = new Bins(this.columns + WIDEST + 8, this.window / this.columns, series)
    this.around = Math.round(BESIDE / this.bins.step)
    this.drawn = -1 // the last column on the strip
    this.fill(this.samples.oldest)
  }

  add(count) {
    this.fill(this.samples.count - count)
  }

  fill(from) {
    const { samples, bins, traces } = this
    for (let row = Math.max(from, samples.oldest); row < samples.count; row++) {
      const t = samples.at(row, "t")
      traces.forEach(({ name, scale }, k) => bins.add(t, k, samples.at(row, name) * scale))
      bins.add(t, traces.length, samples.at(row, "contact"))
      bins.add(t, traces.length + 1, samples.at(row, "intent") * 1000)
    }
  }

  draw(time, theme) {
    const last = Math.floor(time / this.bins.step)
    const context = this.context
    context.clearRect(0, 0, this.width, this.height)
    context.font = FONT
    this.traces.forEach((trace, k) => {
      const series = trace.name === "x" ? [k, this.traces.length + 1] : [k]
      const spans = series.map((each) => this.bins.span(each, Math.ceil(last - this.columns), last))
      const zero = this.zoomed ? [] : [0]
      let [low, high] = [Math.min(...zero, ...spans.map((s) => s.low)), Math.max(...zero, ...spans.map((s) => s.high))]
      if (low > high) [low, high] = [0, 0]
      if (this.scales[k].reach(low, high, Math.max(this.panel / 20, 2))) this.drawn = -1
      this.drawPanel(trace, k, theme)
    })
    if (this.theme !== theme.ink) this.drawn = -1
    this.theme = theme.ink
    this.drawStrip(last, theme)
    this.copyStrip(last)
    this.drawTime(time, theme)
  }

  // The moment that stands at the right end of a zoom: where x last rose through its mean, so that a cycle stands still.
  steady(time) {
    this.drawn = -1 // it may lie before what is drawn
    const cycle = lastCycle(this.samples, "x_true", ZOOM)
    return cycle ? this.samples.at(cycle[1], "t") : time
  }

  top(k) {
    return k * (this.panel + HEAD) + HEAD
  }

  y(k, value) {
    const { low, high } = this.scales[k]
    return this.top(k) + (this.panel * (high - value)) / (high - low)
  }

  drawPanel(trace, k, theme) {
    const context = this.context
    const top = this.top(k)
    context.setLineDash([])
    context.lineWidth = 1
    context.textAlign = "right"
    context.textBaseline = "middle"
    for (const value of this.scales[k].lines()) {
      const line = Math.round(this.y(k, value)) + 0.5
      context.strokeStyle = Math.abs(value) < 1e-9 ? theme.quiet : theme.grid
      context.beginPath()
      context.moveTo(MARGIN, line)
      context.lineTo(MARGIN + this.columns, line)
      context.stroke()
      context.fillStyle = theme.quiet
      context.fillText(tidy(value), MARGIN - 6, line)
    }
    context.textAlign = "left"
    context.fillStyle = theme.ink
    const after = MARGIN + symbol(context, trace.label, MARGIN, top - 8) // a name with its index set below
    const unit = trace.unit_shown ? ` [${trace.unit_shown}]` : ""
    context.fillText(unit, after, top - 8)
    const note = this.notes[trace.name]
    const beside = after + context.measureText(unit).width + 12
    if (!note || beside + context.measureText(note).width > this.width - 8) return
    context.fillStyle = theme.quiet
    context.fillText(note, beside, top - 8)
  }

  // Draw the columns that are new, and those before whose envelope was not complete.
  drawStrip(last, theme) {
    const ratio = this.strip.width / this.columns
    const context = this.strip.getContext("2d")
    const wide = this.around <= WIDEST ? this.around : 0
    const from = Math.max(this.drawn < 0 ? 0 : this.drawn - wide, last - this.columns + 1, 0)
    context.setTransform(ratio, 0, 0, ratio, 0, 0)
    // one more, into which the line before it spilled when it was there a round ago
    for (let column = from; column <= last + 1; column++) context.clearRect(column % this.columns, 0, 1, this.height)
    for (let column = from; column <= last; column++) {
      this.drawContact(context, column, theme)
      for (let k = 0; k < this.traces.length; k++) {
        const isFast = wide && this.drawBand(context, k, column, wide, theme)
        if (this.traces[k].name === "x" && Math.floor(column / 4) % 2) this.drawColumn(context, k, this.traces.length + 1, column, theme.quiet, 1.2)
        this.drawColumn(context, k, k, column, theme.ink, isFast ? 0.7 : 1.6)
      }
    }
    this.drawn = Math.min(last, this.bins.newest) // a frame that is coming fills the columns after it
  }

  drawContact(context, column, theme) {
    const { bins } = this
    const own = bins.slot(this.traces.length, column)
    const slot = bins.column[own] === column ? own : bins.previous(this.traces.length, column) // a zoom has columns without a sample
    if (slot === undefined || column > bins.newest || !bins.high[slot]) return
    context.fillStyle = theme.contact
    for (let k = 0; k < this.traces.length; k++) context.fillRect(column % this.columns, this.top(k), 1, this.panel)
  }

  // The values between which a fast signal swings around a column; return whether it is fast.
  drawBand(context, k, column, wide, theme) {
    const [from, to] = [column - wide, Math.min(column + wide, this.bins.newest)]
    const { low, high } = this.bins.span(k, from, to)
    const [top, bottom] = [this.y(k, high), this.y(k, low)]
    if (bottom - top < 6 || this.bins.turns(k, from, to, 0.4 * (high - low)) < TURNS) return false
    const x = column % this.columns
    context.fillStyle = theme.band
    context.fillRect(x, top, 1, bottom - top)
    context.fillStyle = theme.ink
    context.fillRect(x, top - 0.5, 1, 1.2)
    context.fillRect(x, bottom - 0.5, 1, 1.2)
    return true
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
    const before = bins.previous(series, column)
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
    const step = niceStep(this.window / 8)
    context.textBaseline = "top"
    context.textAlign = "center"
    context.strokeStyle = context.fillStyle = theme.quiet
    context.setLineDash([])
    context.lineWidth = 1
    context.beginPath()
    for (let n = Math.max(Math.ceil((time - this.window) / step), 0); n * step <= time; n++) {
      const x = Math.round(MARGIN + this.columns * (1 - (time - n * step) / this.window)) + 0.5
      context.moveTo(x, line)
      context.lineTo(x, line + 4)
      if (x < this.width - 44) context.fillText(tidy(n * step), x, line + 6)
    }
    context.stroke()
    context.textAlign = "right"
    context.fillText("t [s]", this.width - 4, line + 6)
  }
}

// Write a name such as z_1 with its index below; return how wide it is [px].
function symbol(context, name, x, y) {
  const [letter, index] = name.split("_")
  const usual = context.font
  context.font = usual.replace("12px", "bold 13px")
  context.fillText(letter, x, y)
  let width = context.measureText(letter).width
  context.font = usual.replace("12px", "bold 9px")
  if (index) context.fillText(index, x + width, y + 4)
  width += index ? context.measureText(index).width : 0
  context.font = usual
  return width
}
