// The page of a real paddle: choose a scene, connect in a press, look at what the board is, then start in a press with the hand
// on the handle. It reads nothing of its address and hears no other page: what opens a port or starts a motor is a press alone.

const HIDDEN_WORDS = "The page was hidden, so the motor was switched off. Press Start again"

class PaddlePage {
  // data: of the page; element(id): what the page consists of
  constructor(data, element, clock = PAGE_CLOCK) {
    Object.assign(this, { data, element, clock, paddle: null, source: null, view: null })
    for (const { name, title } of data.scenes) element("scene").append(new Option(title, name))
    element("scene").addEventListener("change", () => {
      this.say("")
      this.choose()
    })
    element("connect").addEventListener("click", () => (this.paddle ? this.disconnect() : this.connect()))
    element("stop").addEventListener("click", () => this.stop())
    if (!navigator.serial) this.say(NO_SERIAL)
    this.listen()
  }

  // --- what a person presses, and what switches the motor off

  listen() {
    window.addEventListener("keydown", (event) => this.stopByKey(event), true)
    document.addEventListener("visibilitychange", () => document.hidden && this.stop(HIDDEN_WORDS))
    document.addEventListener("freeze", () => this.stop(HIDDEN_WORDS))
    window.addEventListener("pagehide", () => this.leave())
    window.addEventListener("error", (event) => this.fail(event.message))
    window.addEventListener("unhandledrejection", (event) => this.fail(event.reason?.message ?? event.reason))
  }

  // Space and Esc stop a motor wherever the focus is.
  stopByKey(event) {
    if (!(this.source?.running || this.source?.busy) || ![" ", "Escape"].includes(event.key)) return
    event.preventDefault()
    event.stopImmediatePropagation()
    this.stop()
  }

  // Switch the motor off.
  stop(words) {
    if (!this.paddle || this.paddle.exchange.broken) return
    const { source } = this
    if (!source) return this.paddle.giveUp() // whatever is under way
    if (words && source.running) source.say(words)
    source.press("pause")
    return undefined
  }

  // The page is left: STOP goes out if anything still does; a board that hears nothing stops by itself.
  leave() {
    if (this.paddle && !this.paddle.exchange.broken) this.disconnect()
  }

  // An error of the page's own: the motor goes off first, and nothing here is relied on any more.
  fail(words = "unknown") {
    if (String(words).startsWith("ResizeObserver loop")) return // the browser's word for a picture that comes a frame later
    const { paddle, source } = this
    this.paddle = this.source = null
    paddle?.giveUp()
    paddle?.close()
    this.say(`This page has an error, so the motor was switched off: ${words}. Load the page again.`)
    this.element("connect").disabled = true
    source?.fallSilent(this.element("words").textContent)
  }

  // --- the board

  async connect() {
    if (this.clock.now() - pressedAt() > TIMELY) return this.say("Press Connect yourself: a script opens no port.")
    const button = this.element("connect")
    button.disabled = true
    this.say("Choose the port of the board.")
    try {
      const port = await BoardPort.request(this.clock)
      const paddle = new PagePaddle(port, this.clock, (problem) => this.lost(problem))
      this.say("Waiting for the board. Opening a port resets many boards, which takes up to 2 s.")
      await paddle.open()
      this.paddle = paddle
      this.introduce()
    } catch (problem) {
      this.say(problem.message)
    }
    button.disabled = false
    return undefined
  }

  // Say what the board is, and what must be done on a computer first.
  introduce() {
    const { paddle, element } = this
    element("facts").replaceChildren(...paddle.facts.flatMap(([name, value]) => [make("dt", {}, [name]), make("dd", {}, [value])]))
    element("connect").textContent = "Disconnect"
    element("stop").hidden = false
    this.say([paddle.obstacle, ...paddle.notices].filter(Boolean).join(" "))
    this.choose()
  }

  disconnect() {
    const { paddle } = this
    this.closeView()
    this.forget("Disconnected.")
    return paddle.close()
  }

  // The port is gone: the view stays to be read, and shows no motor.
  lost(problem) {
    if (!this.paddle) return
    this.source?.fallSilent(problem.message)
    this.source = null
    this.forget(problem.message)
  }

  forget(words) {
    this.paddle = null
    this.element("connect").textContent = "Connect a paddle"
    this.element("stop").hidden = true
    this.element("facts").replaceChildren()
    this.say(words)
  }

  // --- the scene

  // Show the chosen scene, its motor off; another's motor goes off first.
  choose() {
    const scene = this.data.scenes.find(({ name }) => name === this.element("scene").value)
    this.element("about").textContent = scene.about
    if (!this.paddle) return undefined
    this.closeView()
    const told = scene.boards[this.paddle.board.name]
    if (this.paddle.obstacle) return undefined
    if (!told) return this.say(`This scene does not fit the board ${this.paddle.board.name}. Choose another one.`)
    this.source = new BoardSource(told, this.data.words, this.paddle, {
      picture: new Drawing(scene.picture),
      touching: touchingOf(scene.touching),
      save: (log) => keepRecord(log, { ...told.record, ...this.paddle.record }),
      gesture: pressedAt,
      clock: this.clock,
    })
    this.view = new View(this.source, this.element("view"))
    return undefined
  }

  closeView() {
    this.view?.close()
    this.view = this.source = null
    this.element("view").replaceChildren()
  }

  say(words) {
    this.element("words").textContent = words
  }
}

// When the person pressed what is being handled now [s]; what a script pressed was never pressed. A press that waited keeps its time.
function pressedAt() {
  const { event } = window
  return event?.isTrusted && ["click", "keydown"].includes(event.type) ? event.timeStamp / 1000 : -Infinity
}
