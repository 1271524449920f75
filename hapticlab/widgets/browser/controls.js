// The buttons of a live view, each with its key. One that can do nothing now is grey and stays where the keyboard finds it.

const KEYS = { run: "P", again: "A", hold: "L", slow: "M", zoom: "Z", sound: "U", record: "R", save: "S", replay: "Y" }
const TITLES = {
  again: "the scene starts again from its first state", zoom: "the last 0.2 s",
  sound: "hear the force, at the pitch of scene time",
}
const SIMULATED = ["hold", "slow"] // what a board has not

class Controls {
  // pressed(name): what a hand presses and can be pressed
  constructor(about, pressed) {
    this.board = about.kind === "board"
    this.slow = about.slow // scene time over the clock's in slow motion
    this.pressed = pressed
    this.buttons = {}
    for (const [name, key] of Object.entries(KEYS)) {
      if (this.board && SIMULATED.includes(name)) continue
      const words = name === "slow" ? `scene time at ${this.slow} times real time` : TITLES[name]
      const title = words ? { title: words } : {}
      this.buttons[name] = make("button", { type: "button", class: "hl-" + name, "aria-keyshortcuts": key, ...title })
      this.buttons[name].addEventListener("click", () => this.press(name))
    }
    this.row = make("div", { class: "hl-buttons", role: "group", "aria-label": "controls" }, Object.values(this.buttons))
  }

  press(name) {
    if (this.buttons[name] && !this.isOff(name)) this.pressed(name)
  }

  isOff(name) {
    return this.buttons[name].getAttribute("aria-disabled") === "true"
  }

  // Press the button whose key that is; return whether there is one.
  key(event, held) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.type === "text") return false
    const key = event.key.length === 1 ? event.key.toUpperCase() : event.key // Caps Lock or not
    const name = key === "Escape" ? held && "hold" : Object.keys(KEYS).find((each) => KEYS[each] === key)
    if (event.repeat && (name || key === "Enter")) return true // a key that is held is one press
    if (!name || !this.buttons[name] || this.isOff(name)) return false
    this.pressed(name)
    return true
  }

  // Say what each button does now. flags: as frames have them; silent: nobody would hear; zoomed, sounds: of the view
  show(flags, { silent, zoomed, sounds }) {
    const board = this.board
    const runs = flags.running && !flags.replaying
    const words = {
      run: runs ? (board ? ["■", "Stop motor"] : ["❚❚", "Pause"]) : ["▶", board ? "Start motor" : "Run"],
      again: ["", "Start again"],
      hold: ["", flags.held ? "Let go" : "Take hold"],
      slow: ["", "Slow"],
      zoom: ["", "Zoom"],
      sound: ["", "Sound"],
      record: flags.recording ? ["■", "Stop recording"] : ["●", "Record"],
      save: ["", "Save"],
      replay: flags.replaying ? ["■", "Stop"] : ["", "Replay"],
    }
    const pressed = { slow: flags.speed === this.slow, zoom: zoomed, sound: sounds }
    const stops = board && flags.running // may always be pressed
    const off = {
      run: silent && !stops, again: silent || (board && !flags.motor), record: silent || flags.replaying,
      hold: silent || flags.replaying, slow: silent, save: silent || !flags.recorded,
      replay: silent || (!flags.recorded && !flags.replaying),
    }
    for (const [name, button] of Object.entries(this.buttons)) {
      const [glyph, word] = words[name]
      const text = `${glyph} ${word}`
      if (button.dataset.words !== text) {
        button.dataset.words = text
        const key = make("kbd", { "aria-hidden": "true" }, [KEYS[name]])
        button.replaceChildren(...(glyph ? [make("span", { "aria-hidden": "true" }, [glyph + " "])] : []), word, " ", key)
      }
      button.setAttribute("aria-disabled", Boolean(off[name]))
      if (name in pressed) button.setAttribute("aria-pressed", Boolean(pressed[name]))
    }
  }
}
