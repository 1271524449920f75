// A parameter's slider, with a field beside it that takes any number the scene allows.

const BUSY = 500 // [ms] after a hand moved a slider

class Slider {
  // parameter: as a session describes it; id: of its elements; moved(value): tells what a hand asks for
  constructor(parameter, id, moved) {
    const { name, value, low, high, limit_words } = parameter
    this.name = name
    this.unit = unitWords(parameter.unit)
    this.low = low
    this.high = high
    this.moved = moved
    this.busy = 0
    this.step = niceStep((high - low) / 200)
    this.words = `slider ${tidy(low)} to ${this.withUnit(high)}` + (limit_words ? `; ${limit_words}` : "")
    this.range = make("input", { type: "range", id, min: low, max: high, step: "any", "aria-describedby": id + "-limits" })
    this.entry = make("input", {
      type: "text", inputmode: "decimal", role: "spinbutton", class: "hl-entry", autocomplete: "off", "aria-describedby": id + "-limits",
      "aria-label": this.unit ? `${name} in ${this.unit}` : name,
    })
    this.limits = make("span", { class: "hl-limits", id: id + "-limits", "aria-live": "polite" }, [this.words])
    const unit = this.unit ? [" ", make("span", { class: "hl-unit" }, [`[${this.unit}]`])] : []
    this.row = make("div", { class: "hl-slider" }, [make("label", { for: id }, [name, ...unit]), this.range, this.entry, this.limits])
    this.listen()
    this.show(value)
  }

  listen() {
    this.range.addEventListener("input", () => this.move(Number(this.range.value)))
    this.range.addEventListener("keydown", (event) => this.stepped(event, Number(this.range.value), this.low, this.high))
    this.entry.addEventListener("input", () => this.typing())
    this.entry.addEventListener("change", () => this.commit())
    this.entry.addEventListener("keydown", (event) => {
      if (event.key === "Enter") return this.commit() // a notebook may keep "change" back
      this.stepped(event, number(this.entry.value), -Infinity, Infinity)
    })
    this.entry.addEventListener("blur", () => this.left())
  }

  typing() {
    this.edited = true
    this.explain()
  }

  // Ask for the number that was typed; what is none is said, and asks for nothing.
  commit() {
    if (!this.edited) return
    const value = number(this.entry.value)
    if (Number.isNaN(value)) return this.say(`“${this.entry.value}” is no number: ${this.name} stays ${this.withUnit(this.shown)}`, true)
    this.move(value)
  }

  left() {
    this.edited = false
    this.entry.value = tidy(this.shown) // what was said of a wrong one stays to be read
  }

  // Arrow keys move by a step that reads well; "any" alone would leave the step to the browser.
  stepped(event, from, low, high) {
    const steps = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key]
    const sideways = event.key === "ArrowLeft" || event.key === "ArrowRight" // in the field they move the cursor
    if (!steps || Number.isNaN(from) || (sideways && event.target === this.entry)) return
    event.preventDefault()
    const to = Number(((Math.round(from / this.step) + steps) * this.step).toPrecision(12))
    this.move(Math.min(Math.max(to, low), high))
    this.entry.value = tidy(this.shown)
  }

  move(value) {
    this.edited = false
    this.busy = performance.now() + BUSY
    this.show(value)
    this.moved(value)
  }

  // Go where the parameter is, but not while a hand moves it: what the kernel says then is older.
  follow(value) {
    if (value !== undefined && value !== this.shown && performance.now() > this.busy) this.show(value)
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
    this.limits.classList.toggle("hl-wrong", wrong)
    this.entry.setAttribute("aria-invalid", wrong)
  }

  withUnit(value) {
    return this.unit ? `${tidy(value)} ${this.unit}` : tidy(value)
  }
}

// What a person typed as a number, with a decimal point or comma; NaN where it is none, or could be two: "1,000".
function number(typed) {
  const text = typed.trim()
  if (!/^[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?$/i.test(text) || /^[+-]?[1-9]\d{0,2},\d{3}$/.test(text)) return NaN
  return Number(text.replace(",", "."))
}

// A unit as a person writes it: "N*s/m" is N s/m, and a number has none.
function unitWords(unit) {
  return unit === "1" ? "" : unit.replaceAll("*", " ")
}
