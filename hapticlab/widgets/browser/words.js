// What a view says: numbers in a row, a hint for what to do now, and the present details for who does not see the picture.

// The present values, each a button that shows or hides its trace.
class Numbers {
  // chosen(names): the traces to show
  constructor(traces, chosen) {
    this.traces = traces
    this.chosen = chosen
    this.open = traces.filter((trace) => trace.open).map((trace) => trace.name)
    this.values = traces.map(() => make("span", { class: "hl-value" }, ["–"]))
    this.buttons = traces.map((trace, k) => {
      const button = make("button", { type: "button", class: "hl-number", title: `show or hide the trace of ${trace.label}` }, [
        ...typeset(trace.label), " = ", this.values[k], trace.unit_shown ? ` ${trace.unit_shown}` : "",
      ])
      button.addEventListener("click", () => this.toggle(trace.name))
      return button
    })
    this.time = make("span", { class: "hl-value" }, ["–"])
    this.row = make("div", { class: "hl-readout", role: "group", "aria-label": "present values; each button shows or hides its trace" }, [
      ...this.buttons, make("span", { class: "hl-time" }, ["t = ", this.time, " s"]),
    ])
    this.mark()
  }

  // Of more than four the oldest goes: each would be too low to read.
  toggle(name) {
    this.open = this.open.includes(name) ? this.open.filter((each) => each !== name) : [...this.open, name].slice(-4)
    this.mark()
    this.chosen(this.open)
  }

  mark() {
    this.buttons.forEach((button, k) => button.setAttribute("aria-pressed", this.open.includes(this.traces[k].name)))
  }

  read(samples) {
    this.traces.forEach((trace, k) => (this.values[k].textContent = shown(samples.last(trace.name) * trace.scale)))
    this.time.textContent = samples.last("t").toFixed(1)
  }
}

// What is so at this moment, in sentences: on a key, for who does not see the picture.
function details(view) {
  const { about, samples } = view
  const known = about.traces.map(({ name, label, unit_shown, scale }) => {
    const value = samples.last(name)
    const more = name === "F" ? pushes(value, about.along) : ""
    return `${label} is ${shown(value * scale)} ${unit_shown}${more}`
  })
  return `${view.status.textContent} ${samples.count ? `${known.join("; ")}.` : "Nothing has moved yet."}`
}

// Whose force F is, and where the motor pushes the handle: against it.
function pushes(force, [x, y]) {
  const way = x ** 2 > 0.5 ? (force * x > 0 ? "left" : "right") : force * y > 0 ? "down" : "up"
  return " on the environment" + (Math.abs(force) < 0.005 || Number.isNaN(force) ? "" : `, so the motor pushes the handle ${way}`)
}

// What a person could do now.
function hint({ about, flags, silent, touched, samples }) {
  if (silent) return ""
  if (flags.replaying) return "A recording is played back. Press Y to end it."
  if (about.kind === "board") return flags.running ? "Move the handle slowly at first." : "Hold the handle, then press Start motor (P)."
  if (!flags.running) return "Press Run (P) to let time pass, or A to start again."
  if (!flags.held) return "The handle is free. Press L, or drag it, to take it again."
  if (flags.vibrates) return "M slows time down, Z enlarges the last 0.2 s, U lets you hear it."
  if (!touched) return "Drag the handle, or use the arrow keys."
  if (samples.last("contact") === 1) return `Come out again: ${samples.complete ? "the shaded loop" : "below the loop"} is the energy of the contact.`
  return about.touches ? "Push until you touch something." : "L releases the handle. A starts again."
}

// A name such as z_1 with its index set below.
function typeset(name) {
  const [, letter, index, words] = name.match(/^([^_ ]*)_?([^ ]*)(.*)$/)
  return [make("i", {}, [letter]), ...(index ? [make("sub", {}, [index])] : []), words]
}

function make(tag, attributes, children = []) {
  const element = document.createElement(tag)
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value)
  element.append(...children)
  return element
}
