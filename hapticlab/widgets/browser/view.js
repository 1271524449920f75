// The live view: what it shows of plain data, and what a pointer, a key, a slider or a button says to where that comes from.
// Who prefers reduced motion sees the picture follow the hand, for that motion is their own; traces, loop and numbers, which
// move by themselves, change twice a second.

const TRACED = 25 // [ms] between two pictures of the traces: they scroll, and wait for nobody
const LOOPED = 100 // [ms] between two pictures of the loop
const CALM = 500 // [ms] between two of either where motion is reduced, and of a zoom that stands still
const READOUT = 250 // [ms] between two readouts in text
const HIDDEN = 3000 // [ms] until a board's motor goes off whose view nobody sees
const LONG = 90 // letters
const FOLDED = 3 // sliders that are not folded away
const UPRIGHT = 2.4 // times as wide as high: below this a picture stands or hangs
const NARROW = 560 // [px]: the loop goes below the traces
const WAITING = "Waiting for the kernel: this moves in a running notebook only."

class View {
  constructor(source, el) {
    this.source = source
    this.about = source.about
    this.id = `hl-${Math.floor(Math.random() * 2 ** 48)}`
    this.playback = new Playback()
    this.samples = new Samples(this.about.columns)
    Object.assign(this.samples, { T: this.about.T, apart: this.about.apart })
    this.flags = {}
    this.words = "" // of the source, on what goes on
    this.silent = true // no word from the source, now
    this.shape = []
    this.cleanups = []
    this.sound = new Sound(this.samples)
    this.build(el)
    this.picture = new Picture(this.stage, this.about)
    this.traces = new Traces(this.graph, this.about, this.samples)
    this.loop = this.about.loop ? new Loop(this.ring, this.about, this.samples) : null
    this.traces.notes = { x: this.about.kind === "simulated" ? "dashed: target of the hand" : "", F: "on the environment; the motor applies -F" }
    const observer = new ResizeObserver(() => this.resize())
    observer.observe(this.root)
    this.cleanups.push(() => observer.disconnect())
    this.resize()
    this.source.open(this)
    this.watch()
  }

  // --- what it consists of

  build(el) {
    const about = this.about
    this.root = make("section", { class: "hl-live", "aria-label": about.title })
    const overview = make("p", { class: "hl-unseen" }, [about.overview])
    this.controls = new Controls(about, (name) => this.press(name))
    this.stage = make("canvas", { class: "hl-stage", ...this.stageRole() })
    this.numbers = new Numbers(about.traces, (open) => this.traces.show(open))
    this.status = make("p", { class: "hl-status" }, [this.source.waiting ?? WAITING])
    this.hint = make("p", { class: "hl-hint" })
    this.spoken = new Spoken()
    this.graph = make("canvas", { class: "hl-graph", role: "img", "aria-label": "traces over time; the numbers above give the present values" })
    this.ring = make("canvas", { class: "hl-ring", role: "img", "aria-label": "loop of force over position; the text below says its energy" })
    this.energy = make("p", { class: "hl-energy" })
    const loop = about.loop ? [make("div", { class: "hl-loop" }, [this.ring, this.energy])] : []
    const graphs = make("div", { class: "hl-graphs" }, [make("div", {}, [this.graph]), ...loop])
    this.sliders = about.parameters.map(
      (parameter, k) => new Slider(parameter, `${this.id}-${k}`, (value) => this.tell("move", k, value)),
    )
    const said = make("div", { class: "hl-said" }, [this.status, this.hint])
    this.root.append(overview, this.controls.row, this.stage, this.numbers.row, said, this.spoken.element, graphs, ...this.parameters())
    el.append(this.root)
    // JupyterLab takes keys for its own, d d to delete a cell, unless the very element that has the focus says no.
    for (const each of this.root.querySelectorAll("[tabindex], input, button, summary")) each.dataset.lmSuppressShortcuts = "true"
    if (about.kind === "simulated") this.hand = new Hand(this)
    this.root.addEventListener("keydown", (event) => this.shortcut(event))
    this.showFlags({})
  }

  stageRole() {
    const about = this.about
    return about.kind === "simulated" ? Hand.role(about) : { role: "img", "aria-label": `${about.title}: moving picture` }
  }

  // Up to three sliders; the others and the help folded, in one row.
  parameters() {
    const rows = this.sliders.map((slider) => slider.row)
    const group = (words, some) => make("div", { class: "hl-sliders", role: "group", "aria-label": words }, some)
    const first = rows.length ? [group("parameters", rows.slice(0, FOLDED))] : []
    const more = rows.slice(FOLDED)
    const names = this.sliders.slice(FOLDED).map((slider) => slider.name).join(", ")
    const summary = make("summary", {}, [`${more.length} more parameter${more.length > 1 ? "s" : ""}: ${names}`])
    const folded = more.length ? [make("details", { class: "hl-more" }, [summary, group("more parameters", more)])] : []
    return [...first, make("div", { class: "hl-folds" }, [...folded, this.help()])]
  }

  help() {
    const keys = "Keys: P run or pause, A start again, L let go, M slow motion, Z zoom, U sound, R record, S save, Y replay, D details."
    return make("details", { class: "hl-help" }, [make("summary", {}, ["Help"]), make("p", {}, [this.about.help]), make("p", {}, [keys])])
  }

  // --- what a hand says

  tell(what, ...values) {
    if (what === "intend") this.touched = true
    this.source.tell(what, ...values)
  }

  press(name) {
    const flags = this.flags
    const runs = flags.running && !flags.replaying
    const said = {
      run: runs ? "pause" : this.about.kind === "board" ? "start" : "resume", again: "restart", slow: "slow",
      record: flags.recording ? "stop" : "record", save: "save", replay: "replay",
    }
    // the focus stays in a view that was scrolled away: a motor that started there would run unseen
    if (!this.seen && said[name] !== "pause") return this.root.scrollIntoView({ block: "nearest" })
    if (name === "hold") return flags.held ? this.tell("hold", 0) : this.hand.take(this.hand.x)
    if (said[name]) return this.source.press(said[name])
    if (name === "zoom") this.zoom()
    else this.sound.toggle()
    this.showFlags(flags)
  }

  zoom() {
    this.traces.zoomed = !this.traces.zoomed
    this.traces.rebuild()
    this.tracedAt = 0
    this.ask()
  }

  shortcut(event) {
    if (this.about.keys === false) return
    if (this.controls.key(event, this.flags.held)) return event.preventDefault()
    const plain = !event.ctrlKey && !event.altKey && !event.metaKey && event.target.type !== "text"
    if (!plain || event.key.toLowerCase() !== "d") return
    event.preventDefault()
    if (!event.repeat) this.spoken.answer(details(this))
  }

  // --- who sees it

  // Nothing runs for a view that nobody sees; a board gets 3 s, and then waits for Start.
  watch() {
    const look = (seen) => {
      clearTimeout(this.hiding)
      this.seen = seen
      this.hush()
      if (seen || this.about.kind !== "board") this.source.show(seen)
      else this.hiding = setTimeout(() => this.source.press("pause"), HIDDEN)
    }
    this.cleanups.push(watchSight(this.root, look), () => clearTimeout(this.hiding))
  }

  hush() {
    this.sound.follow(this.seen && !this.silent && Boolean(this.flags.running || this.flags.replaying))
  }

  close() {
    clearTimeout(this.hand?.intending)
    this.source.close()
    this.sound.close()
    this.closed = true
    for (const clean of this.cleanups) clean()
  }

  // --- what the source says

  // Nothing comes: what was said of a motion or a motor is no longer known to be true.
  fallSilent(words) {
    this.silent = true
    this.hint.textContent = ""
    this.say(words)
    this.showFlags(this.flags)
    this.spoken.status(this.status.textContent)
  }

  // Take news, {shape, flags, values, status, wanted}, and the bytes of a frame.
  receive(news, bytes) {
    if (news.shape) this.shape = news.shape
    if (news.flags) this.showFlags(news.flags)
    if (news.values) for (const slider of this.sliders) slider.follow(news.values[slider.name])
    if (news.wanted !== undefined) this.hand?.led(news.wanted)
    if (news.status) this.words = news.status
    if (!bytes) return
    this.say(this.words)
    this.spoken.status(this.status.textContent)
    if (this.silent) {
      this.silent = false
      this.showFlags(this.flags)
    }
    this.playback.push(decode(bytes, this.shape, this.samples.width), performance.now() / 1000)
    this.ask()
  }

  // Show what goes on; long words take the room of the hint.
  say(words) {
    if (this.status.textContent === words) return
    this.status.textContent = this.status.title = words
    this.root.classList.toggle("hl-long", words.length > LONG)
  }

  showFlags(flags) {
    this.flags = flags
    this.controls.show(flags, { silent: this.silent, zoomed: this.traces?.zoomed, sounds: this.sound.on })
    for (const each of [...this.sliders, this.hand]) each?.switchOff(this.silent)
    this.root.classList.toggle("hl-recording", Boolean(flags.recording))
    this.root.classList.toggle("hl-silent", this.silent)
    this.hush()
    if (flags.T) Object.assign(this.samples, { T: flags.T, apart: flags.apart }) // a record that is replayed may have its own
    if (!this.traces || flags.speed === undefined || flags.speed === this.traces.speed) return
    if (this.loop) this.loop.speed = flags.speed
    this.traces.speed = flags.speed
    this.traces.rebuild()
  }

  // --- drawing

  ask() {
    if (this.painting || this.closed) return
    this.painting = true
    const paint = () => {
      this.painting = false
      this.paint(performance.now() / 1000)
      if (this.playback.waiting) this.ask()
    }
    if (this.source.inStep) paint() // what it gives within a frame of the screen is seen in that frame
    else requestAnimationFrame(paint)
  }

  paint(now) {
    const { frame, next, part, passed } = this.playback.at(now)
    for (const each of passed) this.take(each)
    if (!frame || this.closed) return
    const theme = this.theme(now)
    const last = (name) => this.samples.last(name)
    const { running, motor, replaying } = this.flags
    const isOff = this.about.kind === "board" && !replaying && !(motor && !this.silent) // the last force is over
    const state = { F: isOff ? 0 : last("F"), x: last("x"), intent: last("intent"), contact: last("contact") === 1, running: Boolean(running) && !this.silent }
    this.picture.draw(frame.shape, between(frame, next, part), theme, state)
    const stands = this.traces.zoomed && this.traces.speed >= 0.5 && this.flags.running
    if (this.due("tracedAt", now, stands ? CALM : TRACED) || !frame.rows.length) {
      const time = part && next ? frame.time + part * (next.time - frame.time) : frame.time
      this.traces.draw(stands ? this.traces.steady(time) : time, theme)
    }
    if (this.loop && this.due("loopedAt", now, LOOPED)) {
      this.loop.draw(now, theme)
      const [much, means] = this.loop.words()
      this.energy.title = means // where it is cut off
      this.energy.replaceChildren(make("b", {}, [much]), make("br", {}), means)
    }
    if (this.due("readAt", now, READOUT)) this.read()
    this.root.dispatchEvent(new CustomEvent("painted", { detail: frame }))
  }

  // Take the rows of a frame that has come due.
  take(frame) {
    if (frame.time < this.time - 1e-6) {
      // the scene began again, or a replay
      this.samples.clear()
      this.traces.rebuild()
      this.loop?.clear()
    }
    this.time = frame.time
    this.samples.add(frame.rows)
    const count = frame.rows.length / this.samples.width
    this.traces.add(count)
    this.sound.play(count, this.traces.speed)
    if (this.hand && count) this.hand.x = this.samples.last("x")
    if (count) this.spoken.follow(this.samples)
  }

  // Whether what was drawn at a moment [s] is old enough to be drawn again; seldom where motion is reduced.
  due(what, now, milliseconds) {
    if (now - this[what] < (calm.matches ? Math.max(CALM, milliseconds) : milliseconds) / 1000) return false
    this[what] = now
    return true
  }

  // The present values in words, and what to do, a few times a second.
  read() {
    if (this.samples.count) this.numbers.read(this.samples)
    this.hint.textContent = hint(this)
  }

  // Ink and paper as the notebook's theme has them, looked up twice a second.
  theme(now) {
    if (this.known && now - this.known.at < 0.5) return this.known
    const style = getComputedStyle(this.root)
    const paper = components(this.picture.context, style.backgroundColor)
    const dark = paper[0] + paper[1] + paper[2] < 384
    this.root.classList.toggle("hl-dark", dark)
    this.known = { at: now, dark, ink: style.color, paper: style.backgroundColor }
    for (const name of ["quiet", "grid", "contact", "band", "given", "taken"]) {
      this.known[name] = style.getPropertyValue(`--hl-${name}${dark ? "-dark" : ""}`).trim()
    }
    return this.known
  }

  resize() {
    const width = Math.floor(this.root.clientWidth) - 2
    if (width < 100 || width === this.width) return
    this.width = width
    const narrow = width < NARROW
    this.root.classList.toggle("hl-narrow", narrow)
    const [left, right, bottom, top] = this.about.box
    const upright = right - left < UPRIGHT * (top - bottom) // what stands or hangs takes more height
    this.picture.resize(width, narrow ? 170 : upright ? 230 : 200)
    this.traces.resize(this.graph.parentElement.clientWidth, 190)
    this.loop?.resize(this.ring.parentElement.clientWidth, narrow ? 180 : 152)
    this.ask()
  }
}

const calm = window.matchMedia("(prefers-reduced-motion: reduce)")
