// Where a live view comes from on a real paddle: the board runs the scene, and the page looks at its samples. What Streaming and
// Stage are in a notebook (hapticlab/device/board/streaming.py, hapticlab/widgets/stage.py). The motor goes on by a press alone.

const TIMELY = 0.5 // [s] that a press counts which starts a motor
const CAME_LATE = "Start came late, so the motor stays off. Press Start again"
const QUIET = 1 // [s] from the motor's end on in which no press starts it: it was meant for Stop, or is the second of two
const JUST_OFF = "The motor went off just now and stays off. Press Start again"
const MISMATCH = "It met more travel than was calibrated. If this happens again, run `hapticlab calibrate` on a computer"
const RESTS = 0.25 // [s] between two pictures, and two looks at the board, while the motor is off
const WORDS = 0.25 // [s] after which words may change
const SAID = 6.0 // [s] that a note stays

class BoardSource {
  // told: of data.programs; words: of data.words; picture.at(values): [shape, points]; touching(samples, values): contact of each
  // sample; save(record): keeps a record as a file, returns words on it; gesture(): when a person pressed what is
  // being handled now [s]
  constructor(told, words, paddle, { picture, touching, save, gesture, clock = PAGE_CLOCK }) {
    Object.assign(this, { told, about: told.about, words, paddle, picture, touching, keep: save, gesture, clock })
    this.numbers = told.parameters.map((parameter) => parameter.value)
    this.period = told.T * told.every
    Object.assign(this, { running: false, busy: false, stops: 0, offSince: -Infinity, homed: true, fault: "", recorder: null, player: null, log: null, moves: new Map() })
    Object.assign(this, { note: "", noteUntil: -1, noticed: {}, last: { x: 0, F: 0 }, nextFrame: -1, nextLook: -1, nextWords: -1, status: "", vibrates: false })
    this.rows = this.freshRows(this.period)
  }

  // --- what a view says

  open(view) {
    this.view = view
  }

  // The view is seen: look at the board with every frame of the screen. One that is not seen gets none, and the board no heartbeat.
  show() {
    cancelAnimationFrame(this.due)
    this.due = requestAnimationFrame(() => this.turn())
  }

  tell(what, ...values) {
    if (what === "move") this.move(values[0], values[1])
  }

  // Do what a button asks for. Whatever it is, the motor goes on only in a press that is fresh.
  press(name) {
    if (name === "pause") this.halt()
    else if (["start", "resume", "restart"].includes(name)) this.start(name)
    else if (["record", "stop", "save", "replay"].includes(name)) this.guarded(() => this[name]())
    this.look()
  }

  close() {
    cancelAnimationFrame(this.due)
    this.closed = true
    this.halt()
  }

  // --- the motor

  // Whether the motor is on, or is about to be.
  get driving() {
    return this.running || this.busy
  }

  async start(name) {
    const pressed = this.gesture()
    if (name === "restart" && !this.running) return this.say(this.words.motor_off)
    if (this.clock.now() - pressed > TIMELY) return this.say(CAME_LATE)
    if (this.busy) return undefined
    if (!this.running && pressed - this.offSince < QUIET) return this.say(JUST_OFF)
    Object.assign(this, { busy: true, note: "" })
    const { stops } = this
    try {
      this.endReplay()
      if (this.running) await this.switchOff()
      if (stops !== this.stops) return undefined // Stop was pressed meanwhile
      const found = await this.paddle.start(this.told, this.numbers, pressed)
      this.begin()
      for (const sentence of found) this.say(sentence)
    } catch (problem) {
      if (problem.result === "NOT_HOMED") this.homed = false
      else if (!(problem instanceof Abandoned)) {
        this.say(problem.message)
        if (!problem.result) this.paddle.giveUp() // whether it runs is not known
      }
    } finally {
      this.busy = false
      this.look()
    }
    return undefined
  }

  begin() {
    this.rows = this.freshRows(this.period)
    Object.assign(this, { running: true, fault: "", homed: true, noticed: {}, last: { x: this.last.x, F: 0 } })
    if (this.recorder) this.record() // one that waited begins
  }

  // Stop: switch the motor off at once, and give up a start that is under way.
  halt() {
    this.stops += 1
    return this.switchOff()
  }

  // Switch the motor off; then ask the board whether it is, and why it was before.
  async switchOff() {
    if (this.driving) this.offSince = this.clock.now()
    this.running = false
    this.endReplay()
    this.stop()
    try {
      const words = await this.paddle.stop()
      if (words) this.fault = words
    } catch (problem) {
      if (!(problem instanceof Abandoned)) this.say(`${problem.message} The board switches its motor off by itself.`)
    }
    return this.look()
  }

  // --- parameters

  // The scene's parameters as they are now, by name, SI.
  get values() {
    return Object.fromEntries(this.told.parameters.map(({ name }, k) => [name, this.numbers[k]]))
  }

  // Move a slider; of moves that come faster than the board obeys, the last one of each counts.
  async move(slider, value) {
    if (this.busy) return this.say("The scene was just starting. Move the slider again") // its values may have been sent
    const { name } = this.about.parameters[slider]
    const refused = refusal(this.told.parameters, this.values, { [name]: value })
    if (refused) return this.say(refused)
    const place = this.told.parameters.findIndex((each) => each.name === name)
    this.numbers[place] = value
    this.recorder?.changed(this.last.t ?? 0, { [name]: value })
    if (!this.running) return undefined
    this.moves.set(place, value)
    if (this.moves.size > 1 || this.moving) return undefined
    this.moving = true
    try {
      while (this.moves.size) {
        const some = [...this.moves]
        this.moves.clear()
        await this.paddle.set(some)
      }
    } catch (problem) {
      if (!(problem instanceof Abandoned)) {
        this.say(problem.message)
        if (!problem.result) this.halt()
      }
    } finally {
      this.moving = false
      this.moves.clear()
    }
    return undefined
  }

  // --- records

  record() {
    this.recorder = new Recorder(this.values)
  }

  stop() {
    if (this.recorder?.samples) this.log = this.recorder.log(this.period, this.fault || null)
    this.recorder = null
  }

  save() {
    this.say(this.keep(this.recorded()))
  }

  replay() {
    if (this.player) return this.endReplay()
    const log = this.recorded()
    if (this.running) this.halt()
    this.live = { rows: this.rows, last: this.last }
    this.player = new Replay(log, 1, this.clock.now())
    this.rows = this.freshRows(log.T)
    return undefined
  }

  endReplay() {
    if (this.player) Object.assign(this, this.live, { player: null })
  }

  recorded() {
    if (this.recorder?.samples) return this.recorder.log(this.period, null)
    if (!this.log) throw new Error("nothing is recorded yet; press Record, and Stop recording")
    return this.log
  }

  // --- in step with the screen

  turn() {
    if (this.closed) return
    this.due = requestAnimationFrame(() => this.turn())
    const now = this.clock.now()
    const samples = this.player ? this.replayed(now) : this.sampled(now)
    if (samples || now >= this.nextFrame) this.send(samples && this.rowsOf(samples), now)
  }

  replayed(now) {
    const samples = this.player.take(now)
    if (!samples && this.player.done) this.endReplay()
    return samples
  }

  // The samples since the last look, and what the board said of its motor.
  sampled(now) {
    const { paddle } = this
    const samples = this.running ? paddle.run?.samples() : null
    const fault = this.running ? paddle.looked() : ""
    if (samples) this.notice(samples, now)
    if (fault) {
      this.fault = fault
      this.halt()
    } else if (now >= this.nextLook && !paddle.exchange.broken) this.lookAtBoard(now)
    return samples
  }

  // Now and then: is the board there, does it run, does it know where its handle is.
  async lookAtBoard(now) {
    this.nextLook = Infinity // until it was answered: a board that is slow to answer is not asked twice
    try {
      if (this.running) {
        const words = await this.paddle.silence()
        if (words) {
          this.fault = words
          this.halt()
        }
      } else if (!this.busy) {
        this.homed = await this.paddle.isHomed()
      }
    } catch (problem) {
      if (problem instanceof Abandoned) return
      this.say(problem.message)
      if (this.running) this.halt() // nobody knows what the board does: it hears nothing more
    } finally {
      this.nextLook = this.clock.now() + RESTS
    }
  }

  notice(samples, now) {
    for (const name of Object.keys(this.words.noticed)) if (samples[name].some(Boolean)) this.noticed[name] = now
    this.recorder?.add({ ...samples, intent: new Float64Array(samples.t.length).fill(NaN) })
    if (this.recorder?.full) this.stop()
  }

  rowsOf(samples) {
    this.last = Object.fromEntries(Object.entries(samples).map(([name, column]) => [name, column.at(-1)]))
    return this.rows.add(samples, this.touching(samples, this.player ? this.player.parameters : this.values))
  }

  freshRows(T) {
    return new Rows(T, this.about.columns, this.told.watched)
  }

  send(rows, now) {
    this.nextFrame = now + RESTS
    const values = this.player ? this.player.parameters : this.values
    const [shape, points] = this.picture.at({ T: this.told.T, ...values, ...this.last })
    const bytes = frameBytes(now, this.last.t ?? 0, rows ?? new Float32Array(0), this.about.columns.length, points)
    this.view.receive({ shape, ...this.news(now) }, bytes)
  }

  news(now) {
    const { running, player, recorder, log } = this
    const flags = { running, motor: running, recording: Boolean(recorder), replaying: Boolean(player), held: true, speed: 1 }
    Object.assign(flags, { recorded: Boolean(log || recorder?.samples), T: this.rows.T, apart: rowsApart(this.rows.T) })
    if (now >= this.nextWords) {
      this.nextWords = now + WORDS
      const words = running && !player ? this.vibration() : ""
      Object.assign(this, { vibrates: Boolean(words), status: this.statusWords(now, words) })
    }
    return { flags: { ...flags, vibrates: this.vibrates }, status: this.status, values: this.values }
  }

  vibration() {
    const [x, F] = this.rows.last()
    return chatterWords(x, F, this.period)
  }

  // What goes on, in sentences.
  statusWords(now, vibrates) {
    const { words } = this
    const lead = [`${TABLES.lead}. Then press Start`, this.paddle.mismatch && MISMATCH]
    let said = [...(this.busy ? ["Starting"] : this.homed ? [words.press_start] : lead), this.fault && `Stopped: ${this.fault}`]
    if (this.player) said = ["Replaying a record"]
    else if (this.running) {
      const [, , contact] = this.rows.last()
      const noticed = Object.keys(this.noticed).filter((name) => now - this.noticed[name] < RECENT)
      said = [`Motor on${contactWords(contact.slice(contact.length - Math.ceil(contact.length / 4)))}`, vibrates, ...noticed.map((name) => words.noticed[name])]
    }
    if (this.recorder) said.push(this.running ? "Recording" : "Recording waits")
    if (now < this.noteUntil) said.push(this.note)
    return said.filter(Boolean).map((sentence) => `${sentence.replace(/\.+$/, "")}.`).join(" ")
  }

  // Nothing comes any more: say so in the view, which then shows no motor.
  fallSilent(words) {
    this.running = false
    this.stop()
    cancelAnimationFrame(this.due)
    if (!this.closed) this.send(null, this.clock.now())
    this.view.fallSilent(words)
  }

  guarded(work) {
    try {
      work()
    } catch (problem) {
      this.say(problem.message)
    }
  }

  // Say something for a while.
  say(note) {
    Object.assign(this, { note, noteUntil: this.clock.now() + SAID })
    this.look()
  }

  // Have the next turn of the screen show everything.
  look() {
    this.nextFrame = this.nextWords = -1
  }
}
