// What leads through a blind comparison: it uncovers the picture for each presentation, and takes the answer.

const SAYS = { show: 0, hide: 1, answer: 2, alive: 3 }
const HEARTBEAT = 400 // [ms]

function render({ model, el }) {
  const head = new BlindHead(model, el)
  return () => head.close()
}

class BlindHead {
  constructor(model, el) {
    this.model = model
    this.about = model.get("about")
    this.el = el
    this.counter = node("strong")
    this.words = node("p", { role: "status", "aria-live": "polite" })
    this.buttons = ["Feel the first", "The first", "The second"].map((word, k) => node("button", { type: "button" }, [word, " ", node("kbd", {}, [["Space", "1", "2"][k]])]))
    this.buttons[0].addEventListener("click", () => this.feel())
    for (const which of [0, 1]) this.buttons[1 + which].addEventListener("click", () => this.answer(which))
    for (const button of this.buttons) button.dataset.lmSuppressShortcuts = "true"
    el.append(node("section", { class: "hl-blind-head", "aria-label": "blind comparison" }, [node("div", {}, [this.counter, ...this.buttons]), this.words]))
    this.key = (event) => this.press(event)
    this.trial = this.state.trial
    this.missed = this.state.missed
    model.on("change:state", () => this.told())
    this.heart = setInterval(() => this.beat(), HEARTBEAT)
    this.next = 0 // the presentation that comes next: 0, 1, or 2 where both were felt
    this.cover("")
  }

  get state() {
    return this.model.get("state")
  }

  // The box that holds this and the live view, once the page has put them there.
  get box() {
    return this.el.closest(".hl-blind")
  }

  get stage() {
    return this.box?.querySelector("canvas.hl-stage")
  }

  beat() {
    if (this.box && this.box !== this.listened) {
      this.listened?.removeEventListener("keydown", this.key, true)
      this.listened = this.box
      this.listened.addEventListener("keydown", this.key, true)
      this.mark()
    }
    this.say("alive")
  }

  press(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.repeat) return
    const act = { " ": () => this.feel(), 1: () => this.answer(0), 2: () => this.answer(1) }[event.key]
    if (!act || (event.key === " " && event.target.localName === "button")) return // Space presses a button by itself
    event.preventDefault()
    event.stopPropagation()
    act()
  }

  // Uncover the next presentation; where it waits for a press, this is it.
  feel() {
    if (this.state.done || this.shown || this.waiting || this.next > 1) return
    const which = this.next
    this.next = which + 1
    this.shown = true
    this.say("show", which)
    this.words.textContent = `${which ? "Second" : "First"}: move the handle into it.`
    this.mark()
    clearTimeout(this.timer)
    this.timer = setTimeout(() => this.end(which), 1000 * this.about.duration)
    this.stage?.focus({ preventScroll: true })
  }

  // A presentation is over: cover it, and pause before the second one.
  end(which) {
    this.say("hide")
    if (which === 1) return this.cover(`${this.about.question} Press 1 for the first, 2 for the second.`)
    this.waiting = true
    this.cover("The second one follows.")
    this.timer = setTimeout(() => {
      this.waiting = false
      if (this.about.board) this.cover("Hold the handle, and press Space to feel the second one.")
      else this.feel()
    }, 1000 * this.about.pause)
  }

  answer(which) {
    if (this.state.done || this.next < 2 || this.sent) return
    clearTimeout(this.timer)
    this.sent = true
    this.say("answer", which)
    this.cover("")
    this.stage?.focus({ preventScroll: true }) // a button that cannot be pressed gets no keys
  }

  // The kernel has an answer: say so, and go on to the next pair; or the motor is at its limit.
  told() {
    if (this.state.limited && this.shown) this.words.textContent = "The motor is at its limit, and that hides the difference. Move less far."
    if (this.state.missed !== this.missed) return this.again()
    if (this.state.trial === this.trial) return
    this.trial = this.state.trial
    this.next = 0
    this.sent = false
    this.cover("")
  }

  // A presentation that the kernel did not begin is felt again.
  again() {
    clearTimeout(this.timer)
    this.missed = this.state.missed
    this.next = this.state.felt
    this.waiting = this.sent = false
    this.cover(`The ${this.next ? "second" : "first"} one did not start. ${this.about.board ? "Hold the handle, and press" : "Press"} Space to feel it.`)
  }

  cover(words) {
    this.shown = false
    const { trial, answered, done } = this.state
    const saved = answered ? `Saved: you answered "the ${answered}". ` : ""
    const begin = `${this.about.board ? "Hold the handle, and press" : "Press"} Space to feel the first one.`
    this.words.textContent = words || (this.sent ? "Saving ..." : done ? `${saved}All trials are done. Run the next cell.` : saved + begin)
    this.counter.textContent = done ? `${trial - 1} trials` : `Trial ${trial}`
    this.stage?.dispatchEvent(new PointerEvent("pointercancel")) // the hand starts from the middle again
    this.mark()
  }

  // Show what can be pressed, and whether the picture is covered.
  mark() {
    const { done } = this.state
    this.box?.classList.toggle("hl-covered", !this.shown)
    this.buttons[0].firstChild.textContent = this.next === 0 ? "Feel the first" : "Feel the second"
    this.buttons[0].disabled = Boolean(done || this.shown || this.waiting || this.next > 1)
    for (const button of this.buttons.slice(1)) button.disabled = Boolean(done || this.next < 2 || this.sent)
  }

  say(what, value = 0) {
    this.model.send({}, undefined, [new Float64Array([SAYS[what], value, Date.now() / 1000]).buffer])
  }

  close() {
    clearTimeout(this.timer)
    clearInterval(this.heart)
    this.listened?.removeEventListener("keydown", this.key, true)
    this.say("hide")
  }
}

function node(tag, attributes = {}, children = []) {
  const element = document.createElement(tag)
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value)
  element.append(...children)
  return element
}

export default { render }
