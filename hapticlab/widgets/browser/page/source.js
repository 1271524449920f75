// Where a live view comes from in a shared file: the scene runs in the page itself, in step with the screen. What Session and
// Stage are in a notebook (hapticlab/widgets/stage.py); the view knows of neither.

const RESTING = 0.25 // [s] between two pictures of a scene that rests
const LOOK = 0.25 // [s] after which words may change
const NOTE = 6.0 // [s] that a note stays
const PAST = 5e-3 // [m] past where a hand goes: there a handle that was let go is caught
const CAUGHT = "The handle that was let go came to the end of its way: the hand holds it there"

class PageSource {
  // told: the data of the page; programs: {held, free}; picture.at(values): [shape, points]; touching: as Motion takes it;
  // save(record): keeps a record as a file, and returns words on it
  constructor(told, programs, { picture, touching, save, clock = () => performance.now() / 1000 }) {
    Object.assign(this, { told, about: told.about, picture, keep: save, clock, waiting: "" })
    this.stepping = new Stepping(told, programs)
    this.motion = new Motion(told, this.stepping, clock, touching)
    this.usual = this.about.speed > this.about.slow ? this.about.speed : 1
    Object.assign(this, { wanted: this.stepping.place, wantsToRun: true, goesOn: false, said: {} })
    Object.assign(this, { note: "", noteUntil: -1, lost: "", vibration: "", status: "", nextLook: -1, nextFrame: -1 })
  }

  // --- what a view says

  open(view) {
    this.view = view
  }

  // Nothing moves in a view that nobody sees, as in a tab that is hidden.
  show(seen) {
    if (seen === this.seen) return
    this.seen = seen
    this.goesOn = seen && this.wantsToRun
    cancelAnimationFrame(this.due)
    if (!seen) {
      this.motion.running = false
      return
    }
    this.said = {} // a view that comes back hears everything
    this.look()
    this.motion.wake()
    this.due = requestAnimationFrame(() => this.turn())
  }

  tell(what, ...values) {
    if (what === "intend") this.wanted = values[0]
    else this.look()
    if (what === "hold") this.motion.hold(Boolean(values[0]))
    if (what === "move") this.set({ [this.about.parameters[values[0]].name]: values[1] })
  }

  // Do what a button asks for, by its name in ``about.presses``.
  press(name) {
    if (this.about.presses.includes(name)) this.guarded(() => this[name]())
    this.look()
  }

  close() {
    this.show(false)
  }

  // --- presses

  start() {
    this.wantsToRun = true
    this.lost = ""
    this.motion.start()
    this.motion.hold(true) // the hand begins where the handle does
    this.wanted = this.stepping.place
  }

  restart() {
    this.start()
  }

  resume() {
    if (this.lost || this.stepping.fault) return this.start()
    this.wantsToRun = true
    return this.motion.resume()
  }

  pause() {
    this.wantsToRun = false
    this.motion.pause()
  }

  slow() {
    this.motion.passAt(this.motion.speed === this.about.slow ? this.usual : this.about.slow)
    this.changed?.(this.values)
  }

  record() {
    this.motion.record()
  }

  stop() {
    this.motion.stopRecording()
  }

  save() {
    this.say(this.keep(this.recorded()))
  }

  replay() {
    this.motion.replay(this.motion.replaying ? null : this.recorded())
  }

  recorded() {
    const log = this.motion.recorded
    if (!log) throw new Refusal("nothing is recorded yet; press Record, and Stop recording")
    return log
  }

  // --- what the page around the view asks for

  // The scene's parameters as they are now, by name, SI.
  get values() {
    return this.stepping.values
  }

  // Set parameters from the next tick on; return why they are refused, in words, or "".
  set(numbers) {
    const words = refusal(this.told.parameters, this.values, numbers)
    if (words) this.say(words)
    else this.motion.set(numbers)
    this.look()
    if (!words) this.changed?.(this.values)
    return words
  }

  // Make so many ticks, and stand still.
  step(ticks = 1) {
    this.pause()
    if (this.lost || this.stepping.fault) return
    this.guarded(() => this.send(this.motion.step(ticks, this.wanted)))
  }

  // The values of the file again, and the scene from its first state.
  reset() {
    this.set(Object.fromEntries(this.told.parameters.map(({ name, value }) => [name, value])))
    this.motion.passAt(this.about.speed)
    this.press("start")
  }

  // Say something for a while.
  say(note) {
    Object.assign(this, { note, noteUntil: this.clock() + NOTE, nextLook: -1 })
  }

  // Have the next frame show everything at once.
  look() {
    this.nextFrame = this.nextLook = -1
  }

  // --- in step with the screen

  turn() {
    this.due = requestAnimationFrame(() => this.turn())
    this.guarded(() => {
      if (this.goesOn && !this.motion.replaying) {
        this.goesOn = false
        if (this.wantsToRun) this.resume()
      }
      const recording = this.motion.recording
      const rows = this.motion.advance(this.wanted)
      this.catchHandle()
      if (rows) this.lookForHandle()
      if (recording && !this.motion.recording) this.say("The recording ended: it was long")
      if (rows || this.clock() >= this.nextFrame) this.send(rows)
    })
  }

  // What is thrown is told, and anything but a refusal stops what moves.
  guarded(work) {
    try {
      work()
    } catch (problem) {
      this.say(problem.message)
      if (!(problem instanceof Refusal)) this.pause()
    }
  }

  // The hand holds a handle that was let go at the end of its way.
  catchHandle() {
    const { motion, about } = this
    const [low, high] = about.x_range
    if (motion.held || motion.replaying || (low - PAST <= motion.place && motion.place <= high + PAST)) return
    motion.hold(true)
    this.wanted = Math.min(Math.max(motion.place, low), high)
    this.say(CAUGHT)
  }

  // Stop a scene whose handle is far out of the picture: no hand holds it there.
  lookForHandle() {
    const [low, high] = this.about.x_range
    const x = this.motion.place
    if (!this.motion.running || this.motion.replaying || Math.max(low - x, x - high) <= high - low) return
    this.pause()
    this.lost = `The loop is unstable: the handle left the picture (x = ${general(1e3 * x, 3)} mm). Press Start again`
    this.look()
  }

  // Give the view a frame; within the frame of the screen that is under way, it paints at once.
  send(rows) {
    const now = this.clock()
    this.nextFrame = now + RESTING
    if (now >= this.nextLook) {
      this.nextLook = now + LOOK
      this.vibration = vibrationWords(this.motion)
      const note = now < this.noteUntil ? this.note : ""
      this.status = statusWords(this.motion, now, { vibration: this.vibration, lost: this.lost, note })
    }
    const [shape, points] = this.picture.at(this.motion.drawn(this.wanted))
    const width = this.about.columns.length
    const bytes = frameBytes(now, this.motion.time, rows ?? new Float32Array(0), width, points)
    this.inStep = true
    this.view.receive({ shape, ...this.news() }, bytes)
    this.inStep = false
  }

  // What is not as it was when it was said last, and the values with every frame, so that a slider goes back.
  news() {
    const { motion } = this
    const { running, recording, replaying, held, speed } = motion
    const flags = { running, recording, replaying, held, speed, motor: false, recorded: Boolean(motion.log || motion.recorder?.samples) }
    Object.assign(flags, { vibrates: Boolean(this.vibration), T: motion.rows.T, apart: rowsApart(motion.rows.T) })
    const now = { flags, status: this.status }
    const news = Object.fromEntries(Object.entries(now).filter(([name, value]) => JSON.stringify(value) !== this.said[name]))
    this.said = Object.fromEntries(Object.entries(now).map(([name, value]) => [name, JSON.stringify(value)]))
    return { ...news, values: this.values, wanted: motion.held ? this.wanted : motion.place }
  }
}

// Why something that was pressed cannot be done: nothing is wrong with what moves.
class Refusal extends Error {}
