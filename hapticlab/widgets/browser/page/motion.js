// The scene on its paddle, advanced to the clock, and recorded or replayed: Motion of hapticlab/widgets/motion.py.

const FASTEST = 1.0 // [m/s] that a hand goes to where the pointer is
const FOLLOWS = 0.025 // [s] that it follows late, or the steps of a pointer would shake it

class Motion {
  // clock: seconds; touching(samples, values): the contact of each sample, 1, 0 or NaN
  constructor(told, stepping, clock, touching) {
    Object.assign(this, { told, stepping, clock, touching, speed: told.about.speed })
    Object.assign(this, { running: false, held: true, log: null, recorder: null, player: null, live: null })
    this.pace = new Pace(stepping.T, this.speed)
    this.forget()
  }

  // The handle stands where it begins, and nothing was seen yet.
  forget() {
    this.rows = this.freshRows(this.stepping.T)
    this.at = this.stepping.place
    this.last = { x: this.at, F: 0 }
    Object.assign(this, { limited: -Infinity, missed: false })
  }

  freshRows(T) {
    return new Rows(T, this.told.about.columns, this.told.watched)
  }

  get recording() {
    return this.recorder !== null
  }

  get replaying() {
    return this.player !== null
  }

  get time() {
    return this.last.t ?? 0
  }

  // Of the handle as last shown [m].
  get place() {
    return this.last.x_true ?? this.last.x
  }

  // What is being recorded, or what was recorded last; null without either.
  get recorded() {
    return this.recorder?.samples ? this.recorder.log(this.stepping.T, this.stepping.fault) : this.log
  }

  // Run from the beginning; a recording that has samples ends, and a replay.
  start() {
    this.replay(null)
    const waits = this.recorder && !this.recorder.samples
    this.stopRecording()
    this.stepping.start()
    this.forget()
    this.running = true
    if (waits) this.record()
    this.wake()
  }

  // Run on; from the beginning after a fault. A replay ends.
  resume() {
    this.replay(null)
    if (this.stepping.fault) return this.start()
    if (this.running) return undefined
    this.running = true
    return this.wake()
  }

  // Stand still; a replay ends.
  pause() {
    this.replay(null)
    this.running = false
  }

  // Count time from now on: what passed before is not made up for.
  wake() {
    this.pace.start(this.clock())
    this.player?.goOn(this.clock())
  }

  // Let scene time pass at another speed over the clock's from now on.
  passAt(speed) {
    this.speed = speed
    this.pace.passAt(speed)
    this.player?.passAt(speed, this.clock())
  }

  hold(held) {
    if (held === this.held) return
    this.held = held
    this.at = this.stepping.place
    this.stepping.hold(held)
  }

  // Set parameters between two ticks.
  set(numbers) {
    this.stepping.set(numbers)
    this.recorder?.changed(this.stepping.ticks * this.stepping.T, numbers)
  }

  record() {
    this.recorder = new Recorder(this.stepping.values)
  }

  stopRecording() {
    if (this.recorder?.samples) this.log = this.recorder.log(this.stepping.T, this.stepping.fault)
    this.recorder = null
  }

  // Play a log, while the scene stands still; null ends it.
  replay(log) {
    if (log) {
      this.live ??= { rows: this.rows, last: this.last }
      this.player = new Replay(log, this.speed, this.clock())
      this.rows = this.freshRows(log.T)
    } else if (this.player) {
      Object.assign(this, this.live, { live: null, player: null })
      this.wake()
    }
  }

  // Go on to the clock, with a hand that means to be at a place [m]; return rows, or null.
  advance(wanted) {
    const now = this.clock()
    let samples = null
    if (this.player) {
      samples = this.player.take(now)
      if (!samples && this.player.done) this.replay(null)
    } else if (this.running) {
      samples = this.lead(this.pace.due(now), wanted)
    }
    return samples && this.show(samples)
  }

  // Make so many ticks while the scene stands still; return rows.
  step(ticks, wanted) {
    return this.show(this.lead(ticks, wanted))
  }

  show(samples) {
    this.last = Object.fromEntries(Object.entries(samples).map(([name, column]) => [name, column.at(-1)]))
    return this.rows.add(samples, this.touching(samples, this.values))
  }

  get values() {
    return this.player ? this.player.parameters : this.stepping.values
  }

  // What a picture is drawn from: the last sample, the parameters, and where the hand is wanted now [m].
  drawn(wanted) {
    const pointer = this.held && !this.replaying ? { intent: wanted } : {}
    return { T: this.stepping.T, ...this.values, ...this.last, x: this.place, ...pointer }
  }

  // Whether the motor was at its limit within the last second.
  get atLimit() {
    return this.clock() - this.limited < RECENT
  }

  lead(ticks, wanted) {
    if (!ticks) return null
    const { stepping, recorder } = this
    const began = this.clock()
    const seconds = ticks * stepping.T
    const way = (wanted - this.at) * -Math.expm1(-seconds / this.speed / FOLLOWS)
    const to = this.at + Math.min(Math.max(way, -FASTEST * seconds), FASTEST * seconds)
    const samples = stepping.advance(linspace(this.at, to, ticks + 1))
    this.at = to
    this.pace.spent(ticks, this.clock() - began)
    this.notice(samples)
    recorder?.add(samples)
    if (recorder?.full) this.stopRecording()
    if (stepping.fault) this.pause()
    return samples
  }

  notice({ F, unlocated }) {
    const limit = this.told.force_max
    if (limit !== null && F.some((force) => Math.abs(force) >= limit)) this.limited = this.clock()
    this.missed ||= Boolean(unlocated?.some((left) => left > 0))
  }
}

// Places from one to another, evenly apart, as NumPy makes them.
function linspace(from, to, count) {
  const step = (to - from) / (count - 1)
  return Float64Array.from({ length: count }, (_, k) => (k === count - 1 ? to : k * step + from))
}
