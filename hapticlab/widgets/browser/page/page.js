// What stands around the view in a shared file: values in the address, buttons for the whole page, the code to copy, and files
// that a visitor keeps.

const WRITTEN_AFTER = 200 // [ms] after a change: a slider that is dragged writes once
const MOST_TOLD = 3 // sentences on an address
const MOST_TRACES = 4 // more would be too low to read
const PACES = ["real-time", "slow-motion"]
const PAGE_BUTTONS = {
  step: { key: "N", after: "run", word: "Next tick", title: "pause, and advance by one sampling period" },
  reset: { key: "X", after: "again", word: "Reset all", title: "values, motion and address as in the file" },
  table: { key: "C", after: "save", word: "CSV", title: "save the recording as a table" },
}
const PAGE_KEYS = "Of this page: N next tick, C save as CSV, X reset all. Keys act while the view has the focus."

class Page {
  // source: of the view; told: the data of the page
  constructor(source, view, told) {
    Object.assign(this, { source, view, told })
    const { traces } = told.about
    this.pace = told.about.speed === told.about.slow ? "real-time" : "slow-motion" // what M changes it to
    const named = { flags: PACES, traces: traces.map((each) => each.name) }
    this.words = { parameters: told.parameters, fixed: told.fixed, units: told.metric, ...named }
    this.own = traces.filter((each) => each.open).map((each) => each.name)
    this.said = document.getElementById("hl-told")
    this.code = document.getElementById("hl-code")
    source.changed = () => this.changed()
    const show = view.numbers.chosen
    view.numbers.chosen = (open) => {
      show(open)
      this.changed()
    }
    this.buildButtons()
    this.buildCopy()
    this.readAddress()
    window.addEventListener("hashchange", () => this.readAddress())
    view.root.addEventListener("painted", () => this.showButtons())
  }

  // --- the address

  // Set what the address names, and nothing else; say what cannot be set.
  readAddress() {
    const { values, flags, traces, problems } = readAddress(location.hash, this.words)
    const own = Object.fromEntries(this.told.parameters.map(({ name, value }) => [name, value]))
    for (const parameter of this.told.parameters) {
      const { name } = parameter
      const words = name in values && outside(parameter, values[name])
      if (words) problems.push(words)
      else own[name] = values[name] ?? own[name]
    }
    const refused = this.source.set(own)
    if (flags.includes(this.pace) !== this.hasOtherPace) this.source.press("slow")
    this.showTraces(traces?.length ? traces.slice(0, MOST_TRACES) : this.own)
    this.tell(refused ? [...problems, refused] : problems)
  }

  showTraces(names) {
    const { numbers } = this.view
    numbers.open = [...names]
    numbers.mark()
    numbers.chosen(numbers.open)
  }

  get hasOtherPace() {
    return this.source.motion.speed !== this.told.about.speed
  }

  tell(problems) {
    const more = problems.length - MOST_TOLD
    const last = more > 0 ? [`${more} more part${more > 1 ? "s" : ""} of the address cannot be used.`] : []
    this.said.replaceChildren(...[...problems.slice(0, MOST_TOLD), ...last].map((words) => make("span", {}, [words])))
  }

  changed() {
    clearTimeout(this.writing)
    this.writing = setTimeout(() => this.write(), WRITTEN_AFTER)
  }

  write() {
    const values = this.source.values
    const { open } = this.view.numbers
    const others = [...open].sort().join() !== [...this.own].sort().join() && open.length > 0
    const address = writeAddress(values, this.hasOtherPace ? [this.pace] : [], this.words, others ? open : null)
    if (this.code) this.code.textContent = codeWith(values, this.told)
    try {
      if (address !== location.hash) history.replaceState(null, "", location.href.split("#")[0] + address)
    } catch {
      // a page in a frame of its own, or of a file, may not: it then forgets what was changed
    }
  }

  // --- buttons and their keys

  buildButtons() {
    this.buttons = {}
    const { buttons } = this.view.controls
    for (const [name, { key, after, word, title }] of Object.entries(PAGE_BUTTONS)) {
      const shown = [word, " ", make("kbd", { "aria-hidden": "true" }, [key])]
      this.buttons[name] = make("button", { type: "button", title, "aria-keyshortcuts": key }, shown)
      this.buttons[name].addEventListener("click", () => this.press(name))
      buttons[after].after(this.buttons[name])
    }
    buttons.record.before(make("span", { class: "hl-break" })) // what moves above, what is recorded below
    this.view.root.querySelector(".hl-help").append(make("p", {}, [PAGE_KEYS]))
    this.view.root.addEventListener("keydown", (event) => this.key(event))
    this.showButtons()
  }

  // Only inside the view, and not while something is typed.
  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.type === "text") return
    const name = Object.keys(PAGE_BUTTONS).find((each) => PAGE_BUTTONS[each].key === event.key.toUpperCase())
    if (!name || (event.repeat && name !== "step")) return
    event.preventDefault()
    this.press(name)
  }

  showButtons() {
    const { flags } = this.view
    if (flags === this.shownFlags) return
    this.shownFlags = flags
    const { replaying, recorded } = flags
    const off = { step: replaying, table: !recorded, reset: false }
    for (const [name, button] of Object.entries(this.buttons)) button.setAttribute("aria-disabled", Boolean(off[name]))
  }

  press(name) {
    if (this.buttons[name].getAttribute("aria-disabled") === "true") return
    if (name === "step") this.step()
    else if (name === "table") this.source.say(keepTable(this.source.recorded(), this.told))
    else this.reset()
    this.source.look()
  }

  step() {
    const { stepping } = this.source
    const before = stepping.ticks
    this.source.step()
    if (stepping.ticks === before) return // it stopped, and says why
    const words = `Tick ${stepping.ticks}: t = ${general(1e3 * stepping.ticks * stepping.T)} ms`
    this.source.say(words)
    this.view.spoken.say(`${words}.`) // each time: a status is spoken when its kind changes
  }

  reset() {
    if (this.view.traces.zoomed) this.view.zoom()
    this.source.reset()
    this.showTraces(this.own)
    this.tell([])
    this.write()
  }

  // --- the code to copy

  buildCopy() {
    const button = document.getElementById("hl-copy")
    if (!button) return
    button.hidden = false
    button.addEventListener("click", async () => {
      document.getElementById("hl-copied").textContent = await copied(this.code)
    })
  }
}

// The Python of a page with the values that a visitor chose.
function codeWith(values, { code, parameters }) {
  const [before, after] = code
  const changed = parameters.filter(({ name, value }) => values[name] !== value).map(({ name }) => `${name}=${values[name]}`)
  return before + (changed.length ? `scene = scene(${changed.join(", ")})  # as on this page\n` : "") + after
}

// Copy an element's text, or where that is not allowed select it; return what was done, in words.
async function copied(element) {
  try {
    await navigator.clipboard.writeText(element.textContent)
    return "Copied."
  } catch {
    getSelection().selectAllChildren(element)
    return "Selected. Copy it with Ctrl+C, or Cmd+C on a Mac."
  }
}
