// What is said aloud to who listens: a state when it is another one, a contact when it is reached, and details when asked for.

const SPOKEN = 2000 // [ms] between two sentences on what goes on
const ASKED = 8000 // [ms] that details which were asked for are not talked over

class Spoken {
  constructor() {
    this.element = make("p", { class: "hl-unseen hl-spoken", role: "status", "aria-live": "polite" })
    this.until = -Infinity // [ms] when the next sentence on what goes on may come
    this.leftAt = -Infinity // [ms] when a contact ended
  }

  // Say what goes on, when it is another kind of sentence, whatever its numbers are.
  status(words) {
    const kind = words.replace(/-?[\d.]+(e[+-]?\d+)?/g, "#")
    if (kind === this.kind || performance.now() < this.until) return
    this.kind = kind
    this.say(words)
  }

  // Say at once that something was reached, unless it comes and goes.
  follow(samples) {
    const contact = samples.last("contact")
    const apart = performance.now() - this.leftAt > SPOKEN / 4
    if (contact === 1 && this.contact === 0 && apart) this.say(`Contact reached at x = ${(1000 * samples.last("x")).toFixed(1)} mm.`)
    if (contact === 0 && this.contact === 1) this.leftAt = performance.now()
    this.contact = contact
  }

  // Say what was asked for.
  answer(words) {
    this.say(words)
    this.until = performance.now() + ASKED
  }

  say(words) {
    this.element.textContent = words
    this.until = performance.now() + SPOKEN
  }
}
