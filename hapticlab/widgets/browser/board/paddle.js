// A paddle on a board, as a page has it: what greeting.py, upload.py and serial_paddle.py of hapticlab/device/board are to a
// notebook. Nothing here starts by itself; giveUp() switches the motor off from whatever is under way.

const STARTED_WITHIN = 2 // [s] from a press to START; later the hand may have left the handle
const NO_LIMIT = 3e38 // [N]: of force, below the board's own
const CALIBRATE = "This is never done from a page: on a computer with hapticlab, run `hapticlab calibrate`"
const SHOWN_FLAGS = Object.entries(TABLES.sample_flags)

class PagePaddle {
  // port: a BoardPort; clock: as PAGE_CLOCK; lost(problem): told once that the port is gone
  constructor(port, clock, lost = () => {}) {
    Object.assign(this, { port, clock, lost, board: null, settings: null, run: null, notices: [] })
    this.exchange = new Exchange(port, clock, (frame, known) => this.run?.take(frame, known))
  }

  // Open the port and say hello; what is there is known then: board, settings, notices.
  async open() {
    try {
      await this.port.open((bytes) => this.exchange.hear(bytes), (problem) => this.fail(problem))
      this.board = await this.hello()
      this.settings = await this.readSettings()
      this.notices = [...this.resetWords(), ...(await this.cleared())]
    } catch (problem) {
      this.exchange.fail(problem)
      await this.port.close()
      throw problem
    }
  }

  fail(problem) {
    this.exchange.fail(problem)
    this.run = null
    this.lost(problem)
  }

  async hello() {
    const { exchange } = this
    const tries = Math.round(TABLES.hello_patience / TABLES.hello_again)
    let said
    try {
      said = await exchange.ask("HELLO", [exchange.session], { patience: TABLES.hello_again, tries })
    } catch (problem) {
      if (exchange.broken || problem instanceof Abandoned) throw problem
      throw new LinkProblem(
        `No paddle answered within ${TABLES.hello_patience} s. Either the board has no hapticlab firmware, which \`hapticlab flash\` installs `
        + "from a computer, or this is a different device.",
      )
    }
    const name = String.fromCharCode(...said.board).replace(/\0+$/, "")
    if (said.table !== TABLES.table) {
      const [major, minor] = TABLES.firmware
      const which = TABLES.drives.includes(name) ? ` --board ${name}` : ""
      throw new LinkProblem(
        `The firmware ${said.major}.${said.minor} of the board uses a different version of the messages from firmware ${major}.${minor}, `
        + `which this page needs. On a computer with the hapticlab of this page, run \`hapticlab flash${which}\`.`,
        "VERSION",
      )
    }
    return { ...said, name }
  }

  // The board's settings by name, or null where it was never given any.
  async readSettings() {
    const size = TABLES.settings.reduce((sum, [type]) => sum + SIZES[type], 0)
    let data = []
    while (data.length < size) {
      const { rest } = await this.exchange.ask("READ", [data.length, Math.min(TABLES.piece, size - data.length)])
      if (!rest.length) return null
      data = [...data, ...rest]
    }
    const { values } = unpack(TABLES.settings, Uint8Array.from(data))
    return values.layout === TABLES.settings_layout && values.crc === crc32(data.slice(0, -4)) ? values : null
  }

  // Why the board was reset before, in a list that is empty where a person did it.
  resetWords() {
    const [name, words] = rowOf(TABLES.reset_causes, this.board.reset_cause) ?? []
    return ["BROWN_OUT", "WATCHDOG"].includes(name) ? [`The board was reset by ${words}.`] : []
  }

  // Clear a fault that stands; return the sentence that tells it, in a list that is empty where none stood.
  async cleared() {
    const state = await this.exchange.refresh()
    if (state.state !== TABLES.states.FAULT) return []
    await this.exchange.command("CLEAR")
    return [`A fault was pending: ${faultWords(state, this.exchange.absent)}`]
  }

  // The largest force that the board ever commands [N].
  get forceMax() {
    const { force_max, force_full, checked } = this.settings
    return Math.min(force_max, force_full, checked ? Infinity : TABLES.unchecked_force)
  }

  // What a person should know of the board, [name, value] each.
  get facts() {
    const { board, settings } = this
    const own = [["board", `${board.name} ${hex4(board.ident)}, firmware ${board.major}.${board.minor}`]]
    if (!settings) return own
    const day = String(settings.date)
    return [
      ...own,
      ["calibrated", settings.date ? `${day.slice(0, 4)}-${day.slice(4, 6)}-${day.slice(6)}` : "never: the constants are nominal"],
      ["largest force", `${general(this.forceMax, 4)} N` + (settings.checked ? "" : ", because the sign of the motor was not checked")],
      ["speed limit", `${general(settings.speed_max, 4)} m/s`],
      ["travel", `${general(1e3 * settings.travel_min, 4)} to ${general(1e3 * settings.travel_max, 4)} mm`],
    ]
  }

  // What a record keeps of the board: its name, the time of a step [s], the age of a reading [s], the largest force [N].
  get record() {
    const { board, settings, delay = 0 } = this
    return { paddle: `${board.name} ${hex4(board.ident)}`, delay, sensor_delay: settings.sensor_delay, force_max: this.forceMax }
  }

  // Why the motor of this board stays off, in words; "" where it may be driven.
  get obstacle() {
    const { settings } = this
    if (!settings) return `This board has no calibration, so its motor stays off. ${CALIBRATE}.`
    if (!settings.wired) return `Nobody has confirmed the wiring of this paddle, so its motor stays off. ${CALIBRATE}.`
    return ""
  }

  // Why this board cannot run a program at its period, in words, or "": what upload.check_period and the costs ask of settings.
  refusal(told) {
    const { board, settings } = this
    const T = 1e6 * told.T // [us], as a board says its own
    if (T < board.period_min * (1 - 1e-9) || T > board.period_max * (1 + 1e-9)) {
      return `This scene has T = ${general(told.T)} s; the board needs ${general(board.period_min / 1e6)} to ${general(board.period_max / 1e6)} s.`
    }
    if (settings.sensor === TABLES.sensors.QUADRATURE) {
      const edges = settings.speed_max / Math.abs(settings.metres_per_count)
      return edges <= (told.edges ?? Infinity) ? "" : `At its speed limit the encoder gives ${general(edges, 3)} edges per second; beside this scene the board counts ${general(told.edges, 3)}.`
    }
    if (told.T < settings.sensor_flight * (1 - 1e-6)) {
      // it trusts no reading in flight, and decides with the next one: two of one flight would be taken for a motion
      return `This scene has T = ${general(told.T)} s; the sensor takes ${general(settings.sensor_flight)} s from its last count back to its first.`
    }
    return ""
  }

  // Whether the board knows where its handle is; it forgets with every reset. mismatch: the handle met more travel than there is
  async isHomed() {
    const { flags } = await this.exchange.refresh()
    this.mismatch = Boolean(flags & TABLES.flags.TRAVEL_MISMATCH)
    return Boolean(flags & TABLES.flags.HOMED)
  }

  // Send a program and start it, as the press of ``pressed`` [s] asks. told: of data.programs; values: of its parameters, in their order
  async start(told, values, pressed) {
    const refused = this.obstacle || this.refusal(told)
    if (refused) throw new LinkProblem(`${refused} Nothing was started.`, "REFUSED")
    const { exchange, clock } = this
    const era = exchange.era
    const before = await this.cleared()
    if (!(await this.isHomed())) throw new LinkProblem(`${TABLES.lead}. Then press Start.`, "NOT_HOMED")
    const crc = await this.upload(Uint8Array.from(atob(told.code), (letter) => letter.charCodeAt(0)))
    await this.set(values.map((value, k) => [k, value]))
    if (clock.now() - pressed > STARTED_WITHIN) throw new LinkProblem("The start took too long. Press Start again.", "LATE")
    exchange.require(era)
    const run = new BoardRun(told, () => exchange.absent)
    this.run = run
    this.looked()
    exchange.beating = () => clock.now() < this.lookedAt + TABLES.leash
    try {
      await exchange.command("START", [crc, told.every, 0, NO_LIMIT], { then: () => run.begin() })
    } catch (problem) {
      this.run = null
      if (problem.result) exchange.beating = () => false
      else if (!(problem instanceof Abandoned)) this.giveUp() // whether it runs is not known
      throw problem
    }
    this.heardAt = clock.now()
    return before
  }

  // Send a program, in pieces, whole or not at all; return the CRC-32 that names it.
  async upload(data) {
    const number = TABLES.targets.PROGRAM
    await this.exchange.command("BEGIN", [number, data.length])
    for (let at = 0; at < data.length; at += TABLES.piece) {
      await this.exchange.command("DATA", [at], { rest: data.subarray(at, at + TABLES.piece) })
    }
    const crc = crc32(data.subarray(0, -4))
    await this.exchange.command("COMMIT", [number, data.length, crc])
    return crc
  }

  // Set parameters, [position, value] each; return the tick after which they hold.
  async set(numbers) {
    let tick = 0
    for (let at = 0; at < numbers.length; at += TABLES.set_at_once) {
      const some = numbers.slice(at, at + TABLES.set_at_once)
      const rest = some.flatMap((row) => [...pack([["B", "position"], ["f", "value"]], row)])
      tick = await this.exchange.command("SET", [some.length], { rest })
    }
    return tick
  }

  // Somebody looks at the samples: heartbeats go on for a while. Return why the motor is off, in words, once it is; else "".
  looked() {
    this.lookedAt = this.clock.now()
    return this.run?.fault ? this.run.words : ""
  }

  // Why no sample came for so long that it needs a reason, or null.
  async silence() {
    const { run, clock, exchange } = this
    if (!run || run.fault) return null
    if (run.heard) this.heardAt = clock.now()
    run.heard = false
    if (clock.now() - this.heardAt < TABLES.silence) return null
    this.heardAt = clock.now()
    const state = await exchange.refresh()
    if (state.session !== 0 && state.session !== exchange.session) return "Another program connected to the board while the scene ran, which ended the scene. End that program, then connect again."
    if (state.session === 0) {
      return "The board was reset while the scene ran, and its motor is off. Either its supply voltage fell too low when the motor drew current, or its reset button was pressed. Check the supply, then connect again."
    }
    if (state.state !== TABLES.states.FAULT) return `The board ${state.state === TABLES.states.RUN ? "runs but sends no samples" : "was stopped by another program"}. Connect again.`
    run.fault = state // and the report of it was lost on its way
    return null
  }

  // Switch the motor off at once, whatever is under way. Waits for nothing: a page that is left may call it.
  giveUp() {
    this.run = null
    this.exchange.giveUp()
  }

  // Switch the motor off, and hear from the board that it is; return a fault that ended the run before, in words, or "".
  async stop() {
    const { run } = this
    this.giveUp()
    await this.exchange.command("STOP", [], { tries: 4 })
    const state = await this.exchange.refresh()
    this.delay = state.step_mean / this.board.clock_hz
    if (state.state !== TABLES.states.FAULT) return ""
    await this.exchange.command("CLEAR")
    return faultWords(run?.fault ?? state, this.exchange.absent, run?.told.T)
  }

  // Switch the motor off and close the port.
  async close() {
    if (!this.exchange.broken) this.giveUp()
    this.exchange.fail(new LinkProblem("The port is closed. Connect again."))
    await this.port.close()
  }
}

// One run and what it said since the last look.
class BoardRun {
  // told: of data.programs; absent(): for how long the page did not run [s]
  constructor(told, absent) {
    Object.assign(this, { told, absent, fault: null, begun: false, heard: false, last: -1, taken: -told.every, rows: [] })
    this.size = 5 + 4 * told.types.length
  }

  // Take samples from here on: those that are still under way from an earlier run came before.
  begin() {
    this.begun = true
  }

  take({ message, payload }, known) {
    if (message === "FAULTED") {
      this.fault = known
      return
    }
    if (payload.length !== this.size) return
    this.begun ||= Boolean(known.flags & TABLES.sample_flags.FIRST)
    if (!this.begun || (known.tick <= this.last && this.last >= 0)) return // a repeat on the wire is no new sample
    this.rows.push(payload)
    this.last = known.tick
    this.heard = true
  }

  // The samples since the last look, arrays by name: t [s], x, v, F, what the scene watches, and flags; null where there are none.
  samples() {
    const { told, rows } = this
    if (!rows.length) return null
    const names = ["t", "x", "v", "F", ...told.watched, "gap", ...SHOWN_FLAGS.map(([name]) => name.toLowerCase())]
    const found = Object.fromEntries(names.map((name) => [name, new Float64Array(rows.length)]))
    rows.forEach((payload, row) => {
      const view = new DataView(payload.buffer, payload.byteOffset)
      const tick = view.getUint32(0, true)
      found.t[row] = tick * told.T
      told.types.forEach((type, k) => (found[names[1 + k]][row] = type === "f32" ? view.getFloat32(5 + 4 * k, true) : view.getInt32(5 + 4 * k, true)))
      for (const [name, bit] of SHOWN_FLAGS) found[name.toLowerCase()][row] = Number(Boolean(payload[4] & bit))
      found.gap[row] = Number(tick - this.taken > told.every)
      this.taken = tick
    })
    this.rows = []
    return found
  }

  get words() {
    return faultWords(this.fault, this.absent(), this.told.T)
  }
}

// A fault's name, time, cause and cure in words. absent: for how long the page did not run [s]
function faultWords({ fault, tick }, absent, T) {
  const [name, cause, cure] = rowOf(TABLES.faults, fault) ?? ["UNKNOWN", "", ""]
  const when = `tick ${tick}` + (T ? ` (t = ${general(tick * T)} s)` : "")
  let act = cure
  if (name === "HOST_SILENT") {
    act = absent
      ? `the computer slept, or this page was stopped or too busy, for ${general(absent, 2)} s; start the scene again`
      : "check the cable, and keep this page in view"
  }
  return `${when}: ${name}: ${cause}; the motor is off from then on. ${act.slice(0, 1).toUpperCase()}${act.slice(1)}.`
}

function hex4(number) {
  return number.toString(16).toUpperCase().padStart(4, "0")
}
