// The live view: what it shows, and what a pointer, a key, a slider or a button says to the kernel.

const KIND = { ready: 0, alive: 1, gone: 2, intend: 3, hold: 4, move: 5, press: 6 }
const HEARTBEAT = 400 // [ms]
const PAGE = Math.floor(Math.random() * 2 ** 48) // differs after the page was loaded anew
const STEP = 0.0005 // [m] of an arrow key
const SOONEST = 15 // [ms] between two words on where the hand means to be
const BUSY = 500 // [ms] after a hand moved a slider
const TRACED = 25 // [ms] between two pictures of the traces: they scroll, and wait for nobody
const READOUT = 250 // [ms] between two readouts in text

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
    this.shape = []
    this.x = this.intent = 0 // [m] of the handle as last shown, and of the hand that holds it
    this.cleanups = []
    this.build(el)
    this.picture = new Picture(this.stage, this.about.box)
    this.traces = new Traces(this.graph, this.about.traces, this.about.seconds)
    if (this.about.kind === "simulated") this.traces.hand = "(dashed: where the hand means to be)"
    this.listen(model, "msg:custom", (content, buffers) => this.receive(content, buffers))
    this.listenToPage()
    const observer = new ResizeObserver(() => this.resize())
    observer.observe(this.root)
    this.cleanups.push(() => observer.disconnect())
    this.resize()
    this.tell("ready", PAGE)
    const heart = setInterval(() => this.tell("alive", PAGE), HEARTBEAT)
    this.cleanups.push(() => clearInterval(heart))
  }

  // --- what it consists of

  build(el) {
    const about = this.about
    this.root = make("section", { class: "hl-live", "aria-label": about.title })
    this.stage = make("canvas", { class: "hl-stage", ...this.stageRole() })
    this.graph = make("canvas", { class: "hl-graph", role: "img", "aria-label": this.graphWords() })
    this.readout = make("p", { class: "hl-readout", "aria-label": "present values" })
    this.status = make("p", { class: "hl-status", role: "status", "aria-live": "polite" })
    this.buttons = this.makeButtons()
    this.sliders = about.parameters.map((parameter, number) => this.makeSlider(parameter, number))
    const bar = make("div", { class: "hl-buttons", role: "toolbar", "aria-label": "controls" }, Object.values(this.buttons))
    const sliders = make("div", { class: "hl-sliders", role: "group", "aria-label": "parameters" }, this.sliders.map((s) => s.row))
    const help = make("p", { class: "hl-help" }, [about.help])
    this.root.append(bar, this.stage, this.readout, this.status, sliders, this.graph, help)
    el.append(this.root)
    // JupyterLab takes keys for its own, d d to delete a cell, unless the very element that has the focus says no.
    for (const each of this.root.querySelectorAll("[tabindex], input, button")) each.dataset.lmSuppressShortcuts = "true"
    if (about.kind === "simulated") this.followHand()
  }

  stageRole() {
    const about = this.about
    if (about.kind !== "simulated") return { role: "img", "aria-label": `${about.title}: moving picture` }
    const [low, high] = about.x_range
    return {
      role: "slider", tabindex: 0, "aria-label": "hand on the handle", "aria-orientation": "horizontal",
      "aria-valuemin": tidy(1000 * low), "aria-valuemax": tidy(1000 * high), "aria-valuenow": 0, "aria-valuetext": "hand at 0.0 mm",
    }
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

  makeSlider(parameter, number) {
    const { name, unit, value, low, high, limit_words } = parameter
    const id = `hl-${this.number}-${number}`
    const step = niceStep((high - low) / 200)
    const limits = { min: low, max: high, "aria-describedby": id + "-limits" }
    const range = make("input", { type: "range", id, ...limits, step: "any" })
    const entry = make("input", { type: "number", ...limits, step: "any", "aria-label": `${name} in ${unit}` })
    const words = limit_words || `${tidy(low)} to ${tidy(high)}`
    const row = make("div", { class: "hl-slider" }, [
      make("label", { for: id }, [name, " ", make("span", { class: "hl-unit" }, [`[${unit}]`])]),
      range, entry, make("span", { class: "hl-limits", id: id + "-limits" }, [words]),
    ])
    const slider = { row, range, entry, name, unit, number, busy: 0 }
    range.addEventListener("input", () => this.move(slider, Number(range.value)))
    range.addEventListener("keydown", (event) => stepRange(event, range, step))
    const commit = () => {
      if (entry.value !== "" && Number(entry.value) !== slider.shown) this.move(slider, Number(entry.value))
    }
    entry.addEventListener("change", commit)
    entry.addEventListener("keydown", (event) => event.key === "Enter" && commit()) // a notebook may keep "change" back
    entry.addEventListener("blur", () => showValue(slider, slider.shown))
    showValue(slider, value)
    return slider
  }

  // --- what a hand says

  followHand() {
    const stage = this.stage
    stage.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return
      stage.setPointerCapture(event.pointerId)
      this.grab = { pointer: event.pointerId, from: this.along(event), intent: this.flags.held ? this.intent : this.x }
      this.take(this.grab.intent)
    })
    const follow = (event) => {
      if (this.grab?.pointer !== event.pointerId) return
      const way = this.along(event) - this.grab.from
      if (way !== this.grab.way) this.take(this.grab.intent + way)
      this.grab.way = way
    }
    stage.addEventListener("pointermove", follow) // as often as pictures are shown
    stage.addEventListener("pointerrawupdate", follow) // at once, where a browser has it
    for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, () => (this.grab = null))
    stage.addEventListener("keydown", (event) => this.key(event))
  }

  // How far along the handle's way a pointer is [m].
  along(event) {
    const [x, y] = this.about.along
    return (x * event.clientX - y * event.clientY) / this.picture.scale
  }

  key(event) {
    const [low, high] = this.about.x_range
    const from = this.flags.held ? this.intent : this.x
    const step = (event.shiftKey ? 10 : 1) * STEP
    const moves = {
      ArrowRight: from + step, ArrowUp: from + step, ArrowLeft: from - step, ArrowDown: from - step,
      PageUp: from + 10 * STEP, PageDown: from - 10 * STEP, Home: low, End: high,
    }
    if (!(event.key in moves) || event.ctrlKey || event.altKey || event.metaKey) return
    event.preventDefault()
    this.take(moves[event.key])
  }

  // The hand takes the handle, if it does not hold it, and means to be at x [m].
  take(x) {
    const [low, high] = this.about.x_range
    this.intent = Math.min(Math.max(x, low), high)
    if (!this.flags.held) this.tell("hold", 1)
    this.intend()
  }

  // Say where the hand means to be, at once but not too often; the last word is always said.
  intend() {
    if (this.intending) return
    const say = () => {
      this.intending = null
      this.intended = performance.now()
      this.tell("intend", this.intent)
      this.stage.setAttribute("aria-valuenow", (1000 * this.intent).toFixed(1))
      this.stage.setAttribute("aria-valuetext", `hand at ${(1000 * this.intent).toFixed(1)} mm`)
    }
    const wait = SOONEST - (performance.now() - this.intended)
    if (wait > 0) this.intending = setTimeout(say, wait)
    else say()
  }

  move(slider, value) {
    slider.busy = performance.now() + BUSY
    showValue(slider, value)
    this.tell("move", slider.number, value)
  }

  press(name) {
    const flags = this.flags
    if (name === "hold") return this.tell("hold", flags.held ? 0 : 1)
    const words = { run: flags.running ? "pause" : this.about.kind === "board" ? "start" : "resume", record: flags.recording ? "stop" : "record" }
    this.tell("press", this.about.presses.indexOf(words[name] || name))
  }

  shortcut(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.type === "number") return
    const name = { p: "run", l: "hold", Escape: "hold", r: "record", s: "save", y: "replay" }[event.key]
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
    window.addEventListener("pagehide", leave)
    window.addEventListener("pageshow", back)
    this.root.addEventListener("keydown", (event) => this.shortcut(event))
    this.cleanups.push(() => {
      window.removeEventListener("pagehide", leave)
      window.removeEventListener("pageshow", back)
    })
  }

  listen(model, event, act) {
    model.on(event, act)
    this.cleanups.push(() => model.off(event, act))
  }

  close() {
    clearTimeout(this.intending)
    this.tell("gone")
    this.closed = true
    for (const clean of this.cleanups) clean()
  }

  // --- what the kernel says

  receive(content, buffers) {
    if (content.shape) this.shape = content.shape
    if (content.flags) this.showFlags(content.flags)
    if (content.values) this.follow(content.values)
    if (content.status) this.status.textContent = content.status
    if (!buffers.length) return
    const bytes = buffers[0]
    const frame = decode(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), this.shape)
    this.playback.push(frame, performance.now() / 1000)
    this.ask()
  }

  // A slider goes where its parameter is, but not while a hand moves it: what the kernel says then is older.
  follow(values) {
    for (const slider of this.sliders) {
      const value = values[slider.name]
      if (value !== undefined && value !== slider.shown && performance.now() > slider.busy) showValue(slider, value)
    }
  }

  showFlags(flags) {
    this.flags = flags
    const board = this.about.kind === "board"
    const words = {
      run: flags.running ? (board ? "■ Stop motor" : "❚❚ Pause") : board ? "▶ Start motor" : "▶ Run",
      hold: flags.held ? "Let go" : "Take the handle",
      record: flags.recording ? "■ Stop recording" : "● Record", save: "Save", replay: flags.replaying ? "■ Stop replay" : "Replay",
    }
    for (const [name, button] of Object.entries(this.buttons)) {
      const key = button.getAttribute("aria-keyshortcuts")
      button.replaceChildren(words[name], " ", make("kbd", { "aria-hidden": "true" }, [key]))
    }
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
      if (each.rows.length) this.x = each.rows[each.rows.length - COLUMNS + 1]
    }
    if (!frame || this.closed) return
    const theme = this.theme(now)
    this.picture.draw(frame.shape, between(frame, next, part), theme)
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
      .map((trace, k) => `${trace.label} = ${shown(last[1 + k] * trace.scale)} ${trace.unit_shown}`)
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
    this.known = { at: now, dark, ink: style.color, quiet: colour(dark ? "--hl-quiet-dark" : "--hl-quiet"), grid: colour(dark ? "--hl-grid-dark" : "--hl-grid") }
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

function showValue(slider, value) {
  slider.shown = value
  slider.range.value = value
  slider.range.setAttribute("aria-valuetext", `${tidy(value)} ${slider.unit}`)
  if (document.activeElement !== slider.entry) slider.entry.value = Number(value.toPrecision(4))
}

// Arrow keys move by a step that reads well; "any" alone would leave the step to the browser.
function stepRange(event, range, step) {
  const steps = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key]
  if (!steps) return
  event.preventDefault()
  range.value = Math.round(Number(range.value) / step + steps) * step
  range.dispatchEvent(new Event("input"))
}

function shown(value) {
  const size = Math.abs(value)
  return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2).replace(/^-0.00$/, "0.00")
}

export default { render }
