// The hand that a pointer, a finger or the keys lead: where it means to be, and what that tells the kernel.

const STEP = 0.0005 // [m] of an arrow key
const SOONEST = 20 // [ms] between two words on where the hand means to be
const LED = 500 // [ms] after it was led here: until then the kernel's word on it is older

class Hand {
  constructor(view) {
    this.view = view
    this.stage = view.stage
    this.range = view.about.x_range
    this.intent = this.x = 0 // [m] where it means to be, and where the handle was shown last
    this.stage.addEventListener("pointerdown", (event) => this.grasp(event))
    this.stage.addEventListener("pointermove", (event) => this.follow(event)) // as often as pictures are shown
    this.stage.addEventListener("pointerrawupdate", (event) => this.follow(event)) // at once, where a browser has it
    this.stage.addEventListener("pointerup", (event) => this.release(event))
    this.stage.addEventListener("pointercancel", () => (this.grab = null))
    this.stage.addEventListener("keydown", (event) => this.key(event))
  }

  static role(about) {
    const [low, high] = about.x_range
    return {
      role: "slider", tabindex: 0, "aria-label": "hand on the handle", "aria-orientation": about.along[1] ** 2 > 0.5 ? "vertical" : "horizontal",
      "aria-valuemin": tidy(1000 * low), "aria-valuemax": tidy(1000 * high), "aria-valuenow": 0, "aria-valuetext": "hand at 0.0 mm",
    }
  }

  // Nothing can be moved while nobody would hear it; the stage stays where the keyboard finds it.
  switchOff(off) {
    this.off = off
    this.stage.setAttribute("aria-disabled", off)
  }

  // Where a movement begins [m].
  get place() {
    return this.view.flags.held ? this.intent : this.x
  }

  grasp(event) {
    if (event.button !== 0 || this.off) return
    this.stage.setPointerCapture(event.pointerId)
    this.grab = { pointer: event.pointerId, from: this.along(event), intent: this.place }
    this.take(this.grab.intent)
  }

  follow(event) {
    if (this.grab?.pointer !== event.pointerId || this.off) return
    const way = this.along(event) - this.grab.from
    if (way !== this.grab.way) this.take(this.grab.intent + way)
    this.grab.way = way
  }

  // The end of a drag: where the handle can be thrown, the hand lets go of it as it moves.
  release(event) {
    if (this.grab?.pointer === event.pointerId && this.view.about.let_go) {
      if (this.intending) this.say()
      this.view.tell("hold", 0)
    }
    this.grab = null
  }

  // How far along the handle's way a pointer is [m].
  along(event) {
    const [x, y] = this.view.about.along
    return (x * event.clientX - y * event.clientY) / this.view.picture.scale
  }

  key(event) {
    const [low, high] = this.range
    const from = this.place
    const step = (event.shiftKey ? 10 : 1) * STEP
    const moves = {
      ArrowRight: from + step, ArrowUp: from + step, ArrowLeft: from - step, ArrowDown: from - step,
      PageUp: from + 10 * STEP, PageDown: from - 10 * STEP, Home: low, End: high,
    }
    if (!(event.key in moves) || event.ctrlKey || event.altKey || event.metaKey) return
    event.preventDefault()
    if (!this.off) this.take(moves[event.key])
  }

  // Take the handle, if it is not held, and mean to be at x [m].
  take(x) {
    const [low, high] = this.range
    this.intent = Math.min(Math.max(x, low), high)
    if (!this.view.flags.held) this.view.tell("hold", 1)
    this.intend()
    this.show()
  }

  // Say where the hand means to be, at once but not too often; the last word is always said.
  intend() {
    if (this.intending) return
    const wait = SOONEST - (performance.now() - this.intended)
    if (wait > 0) this.intending = setTimeout(() => this.say(), wait)
    else this.say()
  }

  say() {
    clearTimeout(this.intending)
    this.intending = null
    this.intended = performance.now()
    this.view.tell("intend", this.intent)
  }

  // Another view, a program, or a page that was here before led it: begin where that left it.
  led(x) {
    if (!this.view.flags.held) this.x = x
    if (x === this.intent || this.grab || this.intending || performance.now() < this.intended + LED) return
    this.intent = x
    this.show()
  }

  show() {
    const shown = (1000 * this.intent).toFixed(1)
    this.stage.setAttribute("aria-valuenow", shown)
    this.stage.setAttribute("aria-valuetext", `hand at ${shown} mm`)
  }
}
