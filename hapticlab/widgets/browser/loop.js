// The loop of force over position, live: the motor holds the force of each sample until the next, so its path has steps.
// What a closed loop encloses is energy that the scene gave back more than it took, or less.

const WINDOW = 2 // [s] of the path on view
const LONGER = 0.25 // [s] between two readings of the energy: a chattering handle closes thirty loops a second
const ROOM = { left: 44, right: 10, top: 17, bottom: 24 } // [px] for numbers and names

class Loop {
  constructor(canvas, about, samples) {
    this.canvas = canvas
    this.context = canvas.getContext("2d")
    this.samples = samples
    this.touches = about.touches
    this.board = about.kind === "board"
    this.speed = 1 // scene time over the clock's
    this.across = new Scale(2) // mm
    this.up = new Scale(0.2) // N
    this.clear()
  }

  clear() {
    this.seen = 0 // rows
    this.began = null // of the contact that goes on: the last row before it, and the energy there
    this.cut = false // the beginning of the contact that goes on is missing
    this.gapAt = -Infinity // [s] when rows were missing last
    this.closed = [] // contacts that ended: {from, to} in rows, energy given back more than taken [J], whether it is too long
    this.shown = null
    this.readAt = -Infinity
  }

  resize(width, height) {
    this.width = width
    this.height = height
    fit(this.canvas, width, height)
  }

  // Note contacts that began or ended in rows that came.
  follow() {
    const samples = this.samples
    for (let row = Math.max(this.seen, samples.oldest); row < samples.count; row++) {
      const touching = samples.at(row, "contact") === 1
      const acts = touching || (samples.at(row, "F") === 0 && samples.at(row, "F_applied") !== 0) // a force that is late
      if (!samples.follows(row)) {
        this.began = null
        if (row) this.gapAt = samples.at(row, "t")
      }
      this.cut = acts && (this.cut || !samples.follows(row))
      if (touching && this.began === null && !this.cut) this.began = { row: row - 1, energy: this.energyAt(row - 1) }
      if (acts || this.began === null) continue
      const { row: from, energy } = this.began // kept, for a long contact outlives its first rows
      this.closed.push({ from, to: row, energy: this.energyAt(row) - energy, long: from < samples.oldest })
      this.began = null
    }
    this.seen = samples.count
    const old = samples.last("t") - 1
    this.closed = this.closed.filter((each, k) => k === this.closed.length - 1 || (each.from >= samples.oldest && samples.at(each.to, "t") > old))
  }

  // The energy up to where the force of a row begins to act [J]: under a delay that is later than the row.
  energyAt(row) {
    const { samples } = this
    const before = row > samples.oldest ? samples.at(row - 1, "F_applied") : 0
    const way = samples.at(row, "x_switch") - samples.at(row, "x_true")
    return samples.at(row, "E") - (samples.complete ? before * way : 0)
  }

  // The loop to shade: the last contact that ended, or the last cycle of x where nothing can be touched.
  latest() {
    if (this.touches) return this.closed[this.closed.length - 1]
    const cycle = this.samples.count > 2 ? lastCycle(this.samples, "x_true", WINDOW) : undefined
    return cycle && { from: cycle[0], to: cycle[1], energy: this.energyAt(cycle[1]) - this.energyAt(cycle[0]) }
  }

  draw(now, theme) {
    this.follow()
    if (now - this.readAt > LONGER) {
      this.readAt = now
      this.shown = this.latest()
      this.many = this.closed.length
      this.mean = this.closed.reduce((sum, each) => sum + each.energy, 0) / this.many
    }
    const context = this.context
    const from = this.samples.since(this.samples.last("t") - WINDOW)
    context.clearRect(0, 0, this.width, this.height)
    this.reach(from)
    this.drawAxes(theme)
    context.lineJoin = "round"
    if (this.shown && this.shown.from >= this.samples.oldest) {
      this.path(this.shown.from, this.shown.to)
      context.closePath()
      context.fillStyle = this.shown.energy > 0 ? theme.given : theme.taken
      if (this.samples.complete) context.fill() // else the area is not the energy
      context.strokeStyle = theme.ink
      context.lineWidth = 1.4
      context.stroke()
    }
    this.path(from, this.samples.count - 1)
    context.strokeStyle = theme.quiet
    context.lineWidth = this.many > 2 ? 0.4 : 1.2
    context.stroke()
    if (this.samples.count) this.drawPoint(theme)
  }

  reach(from) {
    let [low, high, least, most] = [Infinity, -Infinity, 0, 0]
    for (let row = from; row < this.samples.count; row++) {
      const [x, F] = [1000 * this.samples.at(row, "x_switch"), this.samples.at(row, "F_applied")]
      low = Math.min(low, x)
      high = Math.max(high, x)
      least = Math.min(least, F)
      most = Math.max(most, F)
    }
    if (low > high) [low, high] = [0, 0]
    this.across.reach(low, high, 4)
    this.up.reach(least, most, 3)
  }

  x(metres) {
    const { low, high } = this.across
    return ROOM.left + ((this.width - ROOM.left - ROOM.right) * (1000 * metres - low)) / (high - low)
  }

  y(newtons) {
    const { low, high } = this.up
    return ROOM.top + ((this.height - ROOM.top - ROOM.bottom) * (high - newtons)) / (high - low)
  }

  // Trace the force over the position where it began to act: held until the next, where every sample is there.
  path(from, to) {
    const { samples, context } = this
    context.beginPath()
    let before = 0
    for (let row = from; row <= to; row++) {
      const [x, y] = [this.x(samples.at(row, "x_switch")), this.y(samples.at(row, "F_applied"))]
      const joins = row > from && samples.follows(row)
      if (joins && samples.complete) context.lineTo(x, before)
      if (joins) context.lineTo(x, y)
      else context.moveTo(x, y)
      before = y
    }
  }

  drawPoint(theme) {
    const context = this.context
    context.beginPath()
    context.arc(this.x(this.samples.last("x_switch")), this.y(this.samples.last("F_applied")), 3.5, 0, 7)
    context.fillStyle = theme.ink
    context.fill()
  }

  drawAxes(theme) {
    const context = this.context
    const [left, right, top, bottom] = [ROOM.left, this.width - ROOM.right, ROOM.top, this.height - ROOM.bottom]
    context.font = FONT
    context.lineWidth = 1
    context.setLineDash([])
    const line = (value, x0, y0, x1, y1) => {
      context.strokeStyle = Math.abs(value) < 1e-9 ? theme.quiet : theme.grid
      context.beginPath()
      context.moveTo(x0, y0)
      context.lineTo(x1, y1)
      context.stroke()
    }
    context.fillStyle = theme.quiet
    context.textBaseline = "middle"
    context.textAlign = "right"
    for (const F of this.up.lines()) {
      const y = Math.round(this.y(F)) + 0.5
      line(F, left, y, right, y)
      context.fillText(tidy(F), left - 6, y)
    }
    context.textBaseline = "top"
    context.textAlign = "center"
    for (const x of this.across.lines()) {
      const place = Math.round(this.x(x / 1000)) + 0.5
      line(x, place, top, place, bottom)
      if (place < right - 40) context.fillText(tidy(x), place, bottom + 6)
    }
    context.fillStyle = theme.ink
    context.textAlign = "right"
    context.fillText("x [mm]", this.width - 4, bottom + 6)
    context.textAlign = "left"
    context.textBaseline = "middle"
    symbol(context, "F", left, top - 9)
    context.fillText(" [N] over x", left + 8, top - 9)
  }

  // What the loop says, in two short sentences: how much, and who gave it.
  words() {
    const who = this.touches ? "contact" : "cycle"
    if (!this.shown) return [`No whole ${who} yet`, this.touches ? "Push in, and come out again." : "Move the handle back and forth."]
    const several = this.many > 2
    const energy = 1000 * (several ? this.mean : this.shown.energy)
    const none = Math.abs(energy) < 0.005
    const much = `${none ? "" : energy < 0 ? "−" : "+"}${shown(Math.abs(energy))} mJ`
    const head = several ? `${much} per contact (${this.many} in 1 s${this.speed === 1 ? "" : " of t"})` : `${much} in the last ${who}`
    if (this.board && this.samples.last("t") - this.gapAt < WINDOW) return [head, "samples are missing: loop not counted"]
    const means = none ? "as much given back as taken" : energy < 0 ? "more taken than given back" : "more given back than taken"
    return [head, means + (this.shown.long ? "; too long to draw" : this.samples.complete ? "" : "; not to scale")]
  }
}
