// The page of a real paddle: choose a scene, connect in a press, look at what the board is, then start in a press with the hand
// on the handle. It reads nothing of its address and hears no other page: what opens a port or starts a motor is a press alone.

const HIDDEN_WORDS = "The page was hidden, so the motor was switched off. Press Start again"
const KEYLESS_WORDS = "A list, a menu or the print dialog opened, which takes Space and Esc, so the motor was switched off. Press Start again"
const UNHEARD_WORDS = "The keyboard is elsewhere, so Space and Esc do not stop the motor. Click into this page to have them again"
const SPACE_WORDS = "Space only stops: press P or Enter to start"

class PaddlePage {
  // data: of the page; element(id): what the page consists of
  constructor(data, element, clock = PAGE_CLOCK) {
    Object.assign(this, { data, element, clock, paddle: null, source: null, view: null, failed: false })
    for (const { name, title } of data.scenes) element("scene").append(new Option(title, name))
    for (const kind of ["pointerdown", "keydown"]) element("scene").addEventListener(kind, (event) => event.key !== "Tab" && this.yieldKeys())
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
    window.addEventListener("pointerdown", (event) => this.stopByPointer(event), true)
    window.addEventListener("click", (event) => this.stopped && event.detail && event.stopImmediatePropagation(), true)
    for (const kind of ["contextmenu", "beforeprint"]) window.addEventListener(kind, () => this.yieldKeys())
    window.addEventListener("blur", () => this.source?.running && this.source.say(UNHEARD_WORDS))
    document.addEventListener("visibilitychange", () => document.hidden && this.stop(HIDDEN_WORDS))
    document.addEventListener("freeze", () => this.stop(HIDDEN_WORDS))
    window.addEventListener("pagehide", () => this.leave())
    window.addEventListener("error", (event) => this.fail(event.message))
    window.addEventListener("unhandledrejection", (event) => this.fail(event.reason?.message ?? event.reason))
  }

  // Space and Esc stop a motor wherever the focus is. Space starts none: pressed twice, or held, it would undo its own stop.
  stopByKey(event) {
    const { source } = this
    const starts = event.key === " " && event.target.closest?.(".hl-run")
    if (![" ", "Escape"].includes(event.key) || !(source?.driving || starts)) return
    event.preventDefault()
    event.stopImmediatePropagation()
    if (source.driving) this.stop()
    else if (!event.repeat) source.say(SPACE_WORDS)
  }

  // A pointer stops a motor as it goes down on Stop, wherever it is lifted; the click that may follow is no second press.
  stopByPointer({ target }) {
    this.stopped = Boolean(target.closest?.(this.source?.running ? "#hl-stop, .hl-run" : "#hl-stop"))
    if (this.stopped) this.stop()
  }

  // An open list or menu keeps every key for itself, so that none could stop a motor: it stops now.
  yieldKeys() {
    if (this.source?.driving) this.stop(KEYLESS_WORDS)
  }

  // Switch the motor off.
  stop(words) {
    if (!this.paddle || this.paddle.exchange.broken) return
    const { source } = this
    if (!source) return this.paddle.giveUp() // whatever is under way
    if (words && source.driving) source.say(words)
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
    this.failed = true
    paddle?.giveUp()
    paddle?.close()
    this.say(`This page has an error, so the motor was switched off: ${words}. Load the page again.`)
    this.element("connect").disabled = true
    source?.fallSilent(this.element("words").textContent)
  }

  // --- the board

  async connect() {
    if (this.clock.now() - pressedAt() > TIMELY) return this.say("That press came late, or a script made it, so no port was opened. Press Connect again.")
    const button = this.element("connect")
    button.disabled = true
    this.say("Choose the port of the board.")
    try {
      await this.closing // the same port may be chosen again
      const port = await BoardPort.request(this.clock)
      const paddle = new PagePaddle(port, this.clock, (problem) => this.lost(problem))
      this.say("Waiting for the board. Opening a port resets many boards, which takes up to 2 s.")
      await paddle.open()
      if (this.failed) return await paddle.close()
      this.paddle = paddle
      this.introduce()
    } catch (problem) {
      if (!this.failed) this.say(problem.message)
    }
    button.disabled = this.failed
    return undefined
  }

  // Say what the board is, and what must be done on a computer first.
  introduce() {
    const { paddle, element } = this
    element("facts").replaceChildren(...paddle.facts.map(([name, value]) => make("div", {}, [make("dt", {}, [name]), make("dd", {}, [value])])))
    element("connect").textContent = "Disconnect"
    element("stop").hidden = false
    this.say("")
    this.choose()
    this.say([element("words").textContent, ...paddle.notices].filter(Boolean).join(" "))
  }

  disconnect() {
    const { paddle } = this
    this.closeView()
    this.forget("Disconnected.")
    this.closing = paddle.close()
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
    const { board, obstacle } = this.paddle
    if (obstacle) return this.say(obstacle)
    const told = Object.hasOwn(scene.boards, board.name) && scene.boards[board.name]
    if (!told) return this.say(`This scene does not fit the board ${board.name}. Choose another one.`)
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
