// The live view: what it shows, and what a pointer, a key, a slider or a button says to the kernel.

const KIND = { ready: 0, alive: 1, gone: 2, intend: 3, hold: 4, move: 5, press: 6 }
const HEARTBEAT = 400 // [ms]
const PAGE = Math.floor(Math.random() * 2 ** 48) // differs after the page was loaded anew
const TRACED = 25 // [ms] between two pictures of the traces: they scroll, and wait for nobody
const READOUT = 250 // [ms] between two readouts in text
const SPOKEN = 2000 // [ms] between two sentences for who listens
const WORDLESS = 1500 // [ms] without a frame: one comes every 250 ms at least
const HIDDEN = 3000 // [ms] until a tab that nobody sees switches a board's motor off
const WAITING = "Waiting for the kernel: this moves in a running notebook only."

function render({ model, el }) {
  const view = new View(model, el)
  return () => view.close()
}

class View {
  constructor(model, el) {
    this.model = model
    this.number = Math.floor(Math.random() * 2 ** 48)
    this.about = model.get("about")
    this.playback = new Playback()
    this.flags = {}
    this.words = "" // of the kernel, on what goes on
    this.silent = true // no word from the kernel, now
    this.shape = []
    this.cleanups = []
    this.build(el)
    this.picture = new Picture(this.stage, this.about)
    this.traces = new Traces(this.graph, this.about.traces, this.about.seconds)
    this.traces.notes.F = "(on the environment; the motor applies -F)"
    if (this.about.kind === "simulated") this.traces.notes.x = "(dashed: where the hand means to be)"
    this.listen(model, "msg:custom", (content, buffers) => this.receive(content, buffers))
    this.listenToPage()
    const observer = new ResizeObserver(() => this.resize())
    observer.observe(this.root)
    this.cleanups.push(() => observer.disconnect())
    this.resize()
    this.tell("ready", PAGE)
    const heart = setInterval(() => this.beat(), HEARTBEAT)
    this.cleanups.push(() => clearInterval(heart))
  }

  // --- what it consists of

  build(el) {
    const about = this.about
    this.root = make("section", { class: "hl-live", "aria-label": about.title })
    this.stage = make("canvas", { class: "hl-stage", ...this.stageRole() })
    this.graph = make("canvas", { class: "hl-graph", role: "img", "aria-label": this.graphWords() })
    this.readout = make("p", { class: "hl-readout", id: `hl-${this.number}-readout` })
    this.stage.setAttribute("aria-describedby", this.readout.id)
    this.status = make("p", { class: "hl-status" })
    this.spoken = make("p", { class: "hl-spoken", role: "status", "aria-live": "polite" })
    this.buttons = this.makeButtons()
    this.sliders = about.parameters.map(
      (parameter, k) => new Slider(parameter, `hl-${this.number}-${k}`, (value) => this.tell("move", k, value)),
    )
    const bar = make("div", { class: "hl-buttons", role: "group", "aria-label": "controls" }, Object.values(this.buttons))
    const sliders = make("div", { class: "hl-sliders", role: "group", "aria-label": "parameters" }, this.sliders.map((s) => s.row))
    const help = make("p", { class: "hl-help" }, [about.help])
    this.root.append(bar, this.stage, this.readout, this.status, this.spoken, sliders, this.graph, help)
    el.append(this.root)
    // JupyterLab takes keys for its own, d d to delete a cell, unless the very element that has the focus says no.
    for (const each of this.root.querySelectorAll("[tabindex], input, button")) each.dataset.lmSuppressShortcuts = "true"
    if (about.kind === "simulated") this.hand = new Hand(this)
    this.status.textContent = WAITING
    this.showFlags({})
  }

  stageRole() {
    const about = this.about
    return about.kind === "simulated" ? Hand.role(about) : { role: "img", "aria-label": `${about.title}: moving picture` }
  }

  graphWords() {
    return "traces over time: " + this.about.traces.map((t) => `${t.label} in ${t.unit_shown}`).join(", ") + "; the text above gives the present values"
  }

  makeButtons() {
    const buttons = {}
    for (const [name, key] of [["run", "P"], ["hold", "L"], ["record", "R"], ["save", "S"], ["replay", "Y"]]) {
      if (name === "hold" && this.about.kind !== "simulated") continue
      buttons[name] = make("button", { type: "button", class: "hl-" + name, "aria-keyshortcuts": key })
      buttons[name].addEventListener("click", () => this.press(name))
    }
    return buttons
  }

  // --- what a hand says

  press(name) {
    const flags = this.flags
    if (this.buttons[name].disabled) return
    if (name === "hold") return flags.held ? this.tell("hold", 0) : this.hand.take(this.hand.x)
    const words = { run: flags.running && !flags.replaying ? "pause" : this.about.kind === "board" ? "start" : "resume", record: flags.recording ? "stop" : "record" }
    this.tell("press", this.about.presses.indexOf(words[name] || name), Date.now() / 1000) // one that waited starts no motor
  }

  shortcut(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.type === "text") return
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key // Caps Lock or not
    const name = { p: "run", l: "hold", Escape: "hold", r: "record", s: "save", y: "replay" }[key]
    if (!this.buttons[name] || this.buttons[name].disabled) return
    if (event.key === "Escape" && !this.flags.held) return
    event.preventDefault()
    this.press(name)
  }

  tell(kind, value = 0, more = 0) {
    this.model.send({}, undefined, [new Float64Array([this.number, KIND[kind], value, more]).buffer])
  }

  listenToPage() {
    const leave = () => this.tell("gone")
    const back = (event) => event.persisted && this.tell("ready", PAGE)
    const hide = () => {
      clearTimeout(this.hiding)
      if (document.hidden && this.about.kind === "board") this.hiding = setTimeout(() => this.pause(), HIDDEN)
    }
    document.addEventListener("visibilitychange", hide)
    window.addEventListener("pagehide", leave)
    window.addEventListener("pageshow", back)
    this.root.addEventListener("keydown", (event) => this.shortcut(event))
    this.cleanups.push(() => {
      clearTimeout(this.hiding)
      document.removeEventListener("visibilitychange", hide)
      window.removeEventListener("pagehide", leave)
      window.removeEventListener("pageshow", back)
    })
  }

  listen(model, event, act) {
    model.on(event, act)
    this.cleanups.push(() => model.off(event, act))
  }

  close() {
    clearTimeout(this.hand?.intending)
    this.tell("gone")
    this.closed = true
    for (const clean of this.cleanups) clean()
  }

  pause() {
    this.tell("press", this.about.presses.indexOf("pause"), Date.now() / 1000)
  }

  // --- what the kernel says

  beat() {
    this.tell("alive", PAGE, Date.now() / 1000)
    const silence = performance.now() - this.heard
    if (!(silence > WORDLESS)) return
    this.silent = true
    const then = this.about.kind === "board" ? "the motor goes off by itself" : "nothing moves until it answers"
    this.status.textContent = `No word from the kernel for ${(silence / 1000).toFixed(0)} s: ${then}.`
    this.speak()
    this.showFlags(this.flags)
  }

  // A frame came: what it says is true.
  hear() {
    this.heard = performance.now()
    if (this.status.textContent !== this.words) this.status.textContent = this.words
    this.speak()
    if (!this.silent) return
    this.silent = false
    this.showFlags(this.flags)
  }

  receive(content, buffers) {
    if (content.shape) this.shape = content.shape
    if (content.flags) this.showFlags(content.flags)
    if (content.values) for (const slider of this.sliders) slider.follow(content.values[slider.name])
    if (content.wanted !== undefined) this.hand?.led(content.wanted)
    if (content.status) this.words = content.status
    if (!buffers.length) return
    this.hear()
    const bytes = buffers[0]
    const frame = decode(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), this.shape)
    this.playback.push(frame, performance.now() / 1000)
    this.ask()
  }

  // Say the status to who listens, when another kind of sentence is there, and not too often.
  speak() {
    const words = this.status.textContent
    const kind = words.replace(/-?[\d.]+(e[+-]?\d+)?/g, "#")
    if (kind === this.saidKind || performance.now() < this.spokenAt + SPOKEN) return
    this.saidKind = kind
    this.spokenAt = performance.now()
    this.spoken.textContent = words
  }

  showFlags(flags) {
    this.flags = flags
    const board = this.about.kind === "board"
    const words = {
      run: flags.running && !flags.replaying ? (board ? ["■", "Stop motor"] : ["❚❚", "Pause"]) : ["▶", board ? "Start motor" : "Run"],
      hold: ["", flags.held ? "Let go" : "Take the handle"],
      record: flags.recording ? ["■", "Stop recording"] : ["●", "Record"],
      save: ["", "Save"],
      replay: flags.replaying ? ["■", "Stop replay"] : ["", "Replay"],
    }
    const stops = board && flags.running // may always be pressed
    const off = { run: this.silent && !stops, record: flags.replaying, hold: flags.replaying, save: !flags.recorded, replay: !flags.recorded && !flags.replaying }
    for (const [name, button] of Object.entries(this.buttons)) {
      const key = button.getAttribute("aria-keyshortcuts")
      const [glyph, word] = words[name]
      button.replaceChildren(make("span", { "aria-hidden": "true" }, [glyph && glyph + " "]), word, " ", make("kbd", { "aria-hidden": "true" }, [key]))
      button.disabled = Boolean(off[name] || (this.silent && name !== "run"))
    }
    for (const slider of this.sliders) slider.range.disabled = slider.entry.disabled = this.silent
    this.root.classList.toggle("hl-recording", Boolean(flags.recording))
  }

  // --- drawing

  ask() {
    if (this.asked || this.closed) return
    this.asked = true
    requestAnimationFrame(() => {
      this.asked = false
      this.paint(performance.now() / 1000)
      if (this.playback.waiting) this.ask()
    })
  }

  paint(now) {
    const { frame, next, part, passed } = this.playback.at(now)
    for (const each of passed) {
      if (each.time < this.time - 1e-6) this.traces.clear() // a replay began
      this.time = each.time
      this.traces.add(each.rows)
      if (this.hand && each.rows.length) this.hand.x = each.rows[each.rows.length - COLUMNS + 1]
    }
    if (!frame || this.closed) return
    const theme = this.theme(now)
    const [, x, F, , intent] = frame.rows.subarray(frame.rows.length - COLUMNS)
    if (frame.rows.length) this.state = { x, F, intent }
    this.picture.draw(frame.shape, between(frame, next, part), theme, { ...this.state, running: this.flags.running })
    if (!(now - this.tracedAt < TRACED / 1000) || !frame.rows.length) {
      this.tracedAt = now
      this.traces.draw(part && next ? frame.time + part * (next.time - frame.time) : frame.time, theme)
    }
    if (!(now - this.readAt < READOUT / 1000)) this.read(frame, now)
    this.root.dispatchEvent(new CustomEvent("painted", { detail: frame }))
  }

  // The present values in words, a few times a second.
  read(frame, now) {
    const last = frame.rows.subarray(frame.rows.length - COLUMNS)
    if (!last.length) return
    this.readAt = now
    this.readout.textContent = this.about.traces
      .map((trace, k) => `${trace.label} = ${shown(last[1 + k] * trace.scale)} ${trace.unit_shown}${trace.name === "F" ? pushes(last[2], this.about.along) : ""}`)
      .concat(`t = ${last[0].toFixed(1)} s`)
      .join("   ")
  }

  // Ink and paper as the notebook's theme has them, looked up twice a second.
  theme(now) {
    if (this.known && now - this.known.at < 0.5) return this.known
    const style = getComputedStyle(this.root)
    const colour = (name) => style.getPropertyValue(name).trim()
    const paper = components(this.picture.context, style.backgroundColor)
    const dark = paper[0] + paper[1] + paper[2] < 384
    this.known = { at: now, dark, ink: style.color, paper: style.backgroundColor, quiet: colour(dark ? "--hl-quiet-dark" : "--hl-quiet"), grid: colour(dark ? "--hl-grid-dark" : "--hl-grid") }
    this.root.classList.toggle("hl-dark", dark)
    return this.known
  }

  resize() {
    const width = Math.floor(this.root.clientWidth) - 2
    if (width < 100 || width === this.width) return
    this.width = width
    this.picture.resize(width)
    this.traces.resize(width)
    this.ask()
  }
}

function make(tag, attributes, children = []) {
  const element = document.createElement(tag)
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value)
  element.append(...children)
  return element
}

// Whose force F is, and where the motor pushes the handle: against it.
function pushes(force, [x, y]) {
  const way = x ** 2 > 0.5 ? (force * x > 0 ? "left" : "right") : force * y > 0 ? "down" : "up"
  return " on the environment" + (Math.abs(force) < 0.005 ? "" : `, the motor pushes ${way}`)
}

export default { render }
