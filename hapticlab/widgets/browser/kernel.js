// Where a live view comes from in a notebook: a widget's model, behind which a kernel runs. The view knows of no kernel; any
// other source serves it that has ``about`` and these methods, and that calls ``view.receive`` and ``view.fallSilent``.

const KIND = { ready: 0, alive: 1, gone: 2, intend: 3, hold: 4, move: 5, press: 6 }
const HEARTBEAT = 400 // [ms]
const PAGE = Math.floor(Math.random() * 2 ** 48) // differs after the page was loaded anew
const WORDLESS = 1400 // [ms] without a frame: one comes every 250 ms at least

class Kernel {
  constructor(model) {
    this.model = model
    this.about = model.get("about")
    this.number = Math.floor(Math.random() * 2 ** 48)
    this.seen = false
    this.newest = 0 // dispatch of the newest frame [s], by the kernel's clock
  }

  // Begin: what comes goes to the view from now on, once it is seen.
  open(view) {
    this.view = view
    this.hear = (content, buffers) => this.receive(content, buffers)
    this.leave = () => this.say("gone")
    this.back = (event) => event.persisted && this.seen && this.say("ready", PAGE)
    this.model.on("msg:custom", this.hear)
    window.addEventListener("pagehide", this.leave)
    window.addEventListener("pageshow", this.back)
    this.heart = setInterval(() => this.beat(), HEARTBEAT)
  }

  // Nothing moves for a view that nobody sees; a board's motor was switched off before.
  show(seen) {
    if (seen === this.seen) return
    this.seen = seen
    if (this.heard) this.heard = performance.now() // it owed no word meanwhile
    this.say(seen ? "ready" : "gone", seen ? PAGE : 0)
  }

  // Say what a hand does: "intend" x [m], "hold" 1 or 0, "move" the parameter of a number to a value.
  tell(what, ...values) {
    this.say(what, ...values)
  }

  press(name) {
    this.say("press", this.about.presses.indexOf(name), Date.now() / 1000) // one that waited starts no motor
  }

  close() {
    this.say("gone")
    clearInterval(this.heart)
    this.model.off("msg:custom", this.hear)
    window.removeEventListener("pagehide", this.leave)
    window.removeEventListener("pageshow", this.back)
  }

  say(what, value = 0, ...more) {
    try {
      const [clock = 0, ...rest] = more
      this.model.send({}, undefined, [new Float64Array([this.number, KIND[what], value, clock, ...rest]).buffer])
      this.cut = false
    } catch {
      this.cut = true // the kernel that this model spoke to is gone
    }
  }

  beat() {
    if (!this.seen) return
    this.say("alive", PAGE, Date.now() / 1000, this.newest)
    const silence = performance.now() - this.heard
    if (silence > WORDLESS) this.view.fallSilent(this.silence(silence))
  }

  // Why nothing comes, as far as it can be known here.
  silence(milliseconds) {
    const state = this.model.widget_manager?.kernel?.status
    const gone = this.cut || this.model.comm_live === false || ["dead", "terminating", "restarting", "autorestarting"].includes(state)
    if (gone) return "The kernel of this view was stopped or restarted, so nothing moves. Run its cell again."
    const then = this.about.kind === "board" ? "The motor switches off by itself" : "Nothing moves until it answers"
    const busy = state === "busy" ? "It is busy with a cell." : "It may be busy with a cell, or gone."
    return `The kernel has not answered for ${(milliseconds / 1000).toFixed(0)} s. ${busy} ${then}.`
  }

  receive(content, buffers) {
    const [bytes] = buffers
    const frame = bytes && bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength)
    if (frame) {
      this.heard = performance.now()
      this.newest = new Float64Array(frame, 0, 1)[0] // so that a kernel knows how far behind a page is
    }
    this.view.receive(content, frame)
  }
}

function render({ model, el }) {
  const view = new View(new Kernel(model), el)
  return () => view.close()
}

export default { render }
