// What is recorded, and played again: Recorder and Replay of hapticlab/widgets/view_recorder.py.

const LONGEST_RECORD = 600_000 // samples

class Recorder {
  constructor(values) {
    Object.assign(this, { values: { ...values }, parts: [], changes: [], samples: 0 })
  }

  get full() {
    return this.samples >= LONGEST_RECORD
  }

  add(samples) {
    this.parts.push(samples)
    this.samples += samples.t.length
  }

  // Note parameters that hold from the time t on [s].
  changed(t, numbers) {
    this.changes.push([t, { ...numbers }])
  }

  // The record: {columns, arrays by name with the time from 0 s on; parameters; changes, [time, values by name]; T; fault}.
  log(T, fault) {
    const columns = Object.fromEntries(Object.keys(this.parts[0]).map((name) => [name, joined(this.parts.map((part) => part[name]))]))
    const begin = columns.t[0]
    columns.t = columns.t.map((t) => t - begin)
    if (columns.intent.every(Number.isNaN)) delete columns.intent
    return { columns, parameters: this.values, changes: this.changes.map(([t, numbers]) => [t - begin, numbers]), T, fault }
  }
}

class Replay {
  // A log, played by the clock from now on [s].
  constructor(log, speed, now) {
    const size = log.columns.t.length
    Object.assign(this, { speed, begun: now, seen: now, shown: 0, parameters: { ...log.parameters }, columns: { ...log.columns } })
    this.columns.intent ??= new Float64Array(size).fill(NaN)
    // a parameter that was changed is a column
    for (const [since, numbers] of log.changes) {
      for (const [name, value] of Object.entries(numbers)) {
        if (Object.hasOwn(log.columns, name)) continue
        if (!Object.hasOwn(this.columns, name)) this.columns[name] = new Float64Array(size).fill(this.parameters[name] ?? NaN)
        this.columns[name].fill(value, Math.max(0, Math.round(since / log.T)))
      }
    }
  }

  get done() {
    return this.shown >= this.columns.t.length
  }

  // Play on at another speed.
  passAt(speed, now) {
    this.begun = now - ((now - this.begun) * this.speed) / speed
    this.speed = speed
  }

  // Play on from here: what passed since the last look is not made up for.
  goOn(now) {
    this.begun += now - this.seen
    this.seen = now
  }

  // Return the samples since the last look, with parameters that were changed meanwhile; or null.
  take(now) {
    this.seen = now
    const { t } = this.columns
    const from = this.shown
    while (!this.done && t[this.shown] - t[0] <= (now - this.begun) * this.speed) this.shown++
    if (this.shown === from) return null
    return Object.fromEntries(Object.entries(this.columns).map(([name, column]) => [name, column.slice(from, this.shown)]))
  }
}
