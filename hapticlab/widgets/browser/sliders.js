// A parameter's slider, with a field beside it that takes any number the scene allows. Lengths are in mm, as everywhere.

const BUSY = 500 // [ms] after a hand moved a slider
const ABSURD = 100 // times the larger end of the slider: more is a slip of the hand
const READ = 6000 // [ms] that words on a wrong entry stay after the field was left

class Slider {
  // parameter: as a session describes it; id: of its elements; moved(value): tells what a hand asks for, in SI
  constructor(parameter, id, moved) {
    const { name, value, low, high, limit_words, scale } = parameter
    this.name = name
    this.unit = parameter.unit_shown
    this.scale = scale // what is shown = scale * what is told
    this.low = scale * low
    this.high = scale * high
    this.moved = moved
    this.busy = 0
    this.off = false
    this.step = niceStep((this.high - this.low) / 200)
    this.words = `slider ${tidy(this.low)} to ${this.withUnit(this.high)}` + (limit_words ? `; ${limit_words}` : "")
    this.range = make("input", { type: "range", id, min: this.low, max: this.high, step: "any", "aria-describedby": id + "-limits" })
    this.entry = make("input", {
      type: "text", inputmode: "decimal", role: "spinbutton", class: "hl-entry", autocomplete: "off", "aria-describedby": id + "-limits",
      "aria-label": this.unit ? `${name} in ${this.unit}` : name,
    })
    this.limits = make("span", { class: "hl-limits", id: id + "-limits", "aria-live": "polite" }, [this.words])
    const unit = this.unit ? [" ", make("span", { class: "hl-unit" }, [`[${this.unit}]`])] : []
    const late = parameter.at_start ? [make("span", { class: "hl-late" }, ["acts at the next start"])] : []
    this.row = make("div", { class: "hl-slider" }, [make("label", { for: id }, [...typeset(name), ...unit, ...late]), this.range, this.entry, this.limits])
    this.listen()
    this.show(scale * value)
  }

  listen() {
    this.range.addEventListener("input", () => (this.off ? this.show(this.shown) : this.move(Number(this.range.value))))
    this.range.addEventListener("keydown", (event) => this.stepped(event, Number(this.range.value), this.low, this.high))
    this.entry.addEventListener("input", () => this.typing())
    this.entry.addEventListener("change", () => this.commit())
    this.entry.addEventListener("keydown", (event) => {
      if (event.key === "Enter") return this.commit() // a notebook may keep "change" back
      this.stepped(event, number(this.entry.value), -Infinity, Infinity)
    })
    this.entry.addEventListener("blur", () => this.left())
  }

  // Nothing can be moved while nobody would hear it; it stays where the keyboard finds it.
  switchOff(off) {
    this.off = off
    for (const each of [this.range, this.entry]) each.setAttribute("aria-disabled", off)
    this.entry.readOnly = off
    this.row.classList.toggle("hl-off", off)
  }

  typing() {
    this.edited = true
    this.explain()
  }

  // Ask for the number that was typed; what is not one is said, and asks for nothing.
  commit() {
    if (!this.edited || this.off) return
    const value = number(this.entry.value)
    const stays = `${this.name} stays at ${this.withUnit(this.shown)}`
    const read = meanings(this.entry.value)
    if (read) return this.say(`“${this.entry.value}” could be ${read.join(" or ")}: type one of these; ${stays}`, true)
    if (Number.isNaN(value)) return this.say(`“${this.entry.value}” is not a number; ${stays}`, true)
    const most = ABSURD * Math.max(Math.abs(this.low), Math.abs(this.high))
    if (Math.abs(value) > most) return this.say(`${this.withUnit(value)} is more than ${ABSURD} times the end of the slider; ${stays}`, true)
    this.move(value)
  }

  // What was typed and not taken goes; the words on it stay a while.
  left() {
    this.edited = false
    this.entry.value = tidy(this.shown)
    clearTimeout(this.reading)
    this.reading = setTimeout(() => this.explain(), READ)
  }

  // Arrow keys move by a step that reads well; "any" alone would leave the step to the browser.
  stepped(event, from, low, high) {
    const steps = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key]
    const sideways = event.key === "ArrowLeft" || event.key === "ArrowRight" // in the field they move the cursor
    if (!steps || Number.isNaN(from) || (sideways && event.target === this.entry)) return
    event.preventDefault()
    if (this.off) return
    const to = Number(((Math.round(from / this.step) + steps) * this.step).toPrecision(12))
    this.move(Math.min(Math.max(to, low), high))
    this.entry.value = tidy(this.shown)
  }

  move(value) {
    this.edited = false
    this.busy = performance.now() + BUSY
    this.show(value)
    this.moved(value / this.scale)
  }

  // Go where the parameter is [SI], but not while a hand moves it: what is said of it then is older.
  follow(value) {
    if (value === undefined || performance.now() <= this.busy) return
    const shown = Number((value * this.scale).toPrecision(12))
    if (shown !== this.shown) this.show(shown)
  }

  show(value) {
    this.shown = value
    this.range.value = value
    this.entry.setAttribute("aria-valuenow", value)
    this.range.setAttribute("aria-valuetext", this.withUnit(value) + (this.beyond() ? ", beyond the slider" : ""))
    this.explain()
    if (!this.edited && document.activeElement !== this.entry) this.entry.value = tidy(value)
  }

  beyond() {
    return this.shown < this.low || this.shown > this.high
  }

  // Say how far the slider goes, and how far the parameter may.
  explain() {
    this.say((this.beyond() ? `${this.withUnit(this.shown)} is beyond the ` : "") + this.words, false)
  }

  say(words, wrong) {
    if (this.limits.textContent !== words) this.limits.textContent = words
    this.row.classList.toggle("hl-wrong", wrong)
    this.entry.setAttribute("aria-invalid", wrong)
  }

  withUnit(value) {
    return this.unit ? `${tidy(value)} ${this.unit}` : tidy(value)
  }
}

// What a person typed as a number, with a decimal point or comma; NaN where it is none, or could be two.
function number(typed) {
  const text = typed.trim()
  if (!/^[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?$/i.test(text) || meanings(text)) return NaN
  return Number(text.replace(",", "."))
}

// The two numbers that "1,000" could be, 1 and 1000; null where what was typed has one meaning at most.
function meanings(typed) {
  const text = typed.trim()
  return /^[+-]?[1-9]\d{0,2},\d{3}$/.test(text) ? [".", ""].map((mark) => Number(text.replace(",", mark))) : null
}
