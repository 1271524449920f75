// The page's host in node, in virtual time, against the firmware's core behind a fake port. From stdin {data, stores, scenarios};
// to stdout what became of each. Between two milliseconds all that was promised is kept.
import { readFileSync } from "node:fs"

const here = new URL("../../../", import.meta.url)
const text = (path) => readFileSync(new URL(path, here), "utf-8")
const browser = "hapticlab/widgets/browser/"
const scripts = ["page/rows.js", "page/limits.js", "page/records.js", "page/status.js", "page/npz.js", "page/drawing.js"]
  .concat(["messages", "link", "port", "paddle", "source", "core"].map((name) => `board/${name}.js`))
const source = [...scripts.map((name) => text(browser + name)), text("tests/widgets/board/fake_serial.js")].join("\n")
const names = "TABLES, Board, BoardPort, PagePaddle, BoardSource, Drawing, touchingOf, FakeBoard, FakePort, FakeSerial, Decoder, decodeFrame, fieldsOf, encodeFrame, recordFile"
const asked = JSON.parse(readFileSync(0, "utf-8"))
const wasm = readFileSync(new URL("firmware/prebuilt/web.wasm", here))
const settle = () => new Promise(setImmediate)

// A bench of its own for each scenario: clock, board, port, and a page's paddle and source.
async function bench({ store = asked.stores.usual, scene = "wall" } = {}) {
  const bytes = Uint8Array.from(Buffer.from(store, "hex"))
  let [time, slept] = [0, 0]
  const timers = new Set()
  const clock = {
    now: () => time,
    wall: () => time + slept,
    after: (seconds, work) => {
      const timer = { at: time + seconds, work }
      timers.add(timer)
      return () => timers.delete(timer)
    },
  }
  const frames = (work) => clock.after(1 / 60, work)
  const world = { navigator: {}, requestAnimationFrame: frames, cancelAnimationFrame: (cancel) => cancel?.() }
  const page = new Function(...Object.keys(world), `"use strict"; ${source}; return { ${names} }`)(...Object.values(world))
  const cores = await Promise.all([0, 1].map(() => page.Board.open(wasm, bytes)))
  const board = new page.FakeBoard(cores, asked.known)
  const port = new page.FakePort(board)
  world.navigator.serial = new page.FakeSerial(port)
  const b = { page, navigator: world.navigator, clock, board, port, serial: world.navigator.serial, frames: [], words: [], lost: [], pressed: () => clock.now() }
  b.pass = async (seconds, { asleep = false } = {}) => {
    for (const until = time + seconds; time < until - 1e-9; ) {
      time += 0.001
      board.run(time)
      if (asleep) continue
      for (const timer of [...timers]) if (timer.at <= time && timers.delete(timer)) timer.work()
      await settle()
    }
  }
  // Wait for a promise while time passes; what it is refused with comes back.
  b.wait = async (promise) => {
    let over = null
    promise.then((value) => (over = { value }), (problem) => (over = { problem }))
    for (let k = 0; !over && k < 8000; k++) await b.pass(0.001)
    return over
  }
  b.view = { receive: (news, bytes) => b.frames.push(news), fallSilent: (words) => b.lost.push(words) }
  b.connect = async () => {
    const opened = await b.wait(page.BoardPort.request(clock).then((found) => {
      b.paddle = new page.PagePaddle(found, clock, (problem) => { b.lost.push(problem.message); b.source?.fallSilent(problem.message) })
      return b.paddle.open()
    }))
    if (opened?.problem) return opened.problem.message
    const { boards, picture, touching } = asked.data.scenes.find(({ name }) => name === scene)
    const told = boards.host
    const options = { picture: new page.Drawing(picture), touching: page.touchingOf(touching), save: () => "kept", clock }
    b.source = new page.BoardSource(told, asked.data.words, b.paddle, { ...options, gesture: () => b.pressed() })
    b.source.open(b.view)
    b.source.show(true)
    return ""
  }
  // Lead the handle to both stops and back, as slowly as a hand does.
  b.home = async () => {
    for (const x of [-0.055, 0.055, 0]) await b.lead(x)
    await b.pass(0.3)
  }
  b.lead = async (x) => {
    while (Math.abs(x - board.hand) > 1e-9) {
      board.hand += Math.max(-4e-4, Math.min(4e-4, x - board.hand))
      await b.pass(0.001)
    }
  }
  b.press = async (name, seconds = 0.3) => {
    b.source.press(name)
    await b.pass(seconds)
  }
  b.said = () => port.sent.flatMap((bytes) => new page.Decoder().feed(bytes)).map(({ message }) => message)
  b.status = () => b.frames.map((news) => news.status).filter(Boolean).at(-1)
  // What another host said before: the handle is at 0.
  b.homed = () => {
    board.run((time += 0.002))
    for (const [name, values] of [["HELLO", [9]], ["HOME", [0]]]) board.core.receive(page.encodeFrame(name, 1, values, { session: 9 }))
    board.core.transmit()
    return b
  }
  // Connected and started, with the hand in the wall.
  b.running = async (x = 0.02) => {
    const problem = await b.homed().connect()
    if (problem) throw new Error(problem)
    await b.lead(x)
    await b.press("start", 0.2)
    if (!board.core.duty) throw new Error(`the motor is off: ${b.status()}`)
    return b
  }
  // The computer sleeps: its clock stands still, the board's does not.
  b.sleep = (seconds, ticks = 300) => {
    slept += seconds
    for (let k = 0; k < ticks; k++) board.tick()
  }
  // What became of the motor after something was done.
  b.after = async (work, seconds = 0.4, options) => {
    const tick = board.ticks
    await work()
    await b.pass(seconds, options)
    if (options?.asleep) await b.pass(0.2)
    return { off: board.offAfter(tick), status: b.status(), lost: b.lost, motor: b.source?.running ?? false }
  }
  return b
}

const noise = (bytes) => bytes.map((byte, k) => (byte * 37 + k * 11 + 5) & 255)
const push = (b) => (b.board.v = 4)
const fail = (b, name) => b.board.core.core.hl_host_fault(b.board.core.board, b.page.TABLES.faults[name][0])

const scenarios = {
  async "a wall is felt"() {
    const b = await bench()
    await b.running()
    const { rows, numbers, told } = b.source
    const forces = []
    const take = b.paddle.run.samples.bind(b.paddle.run)
    b.paddle.run.samples = () => {
      const found = take()
      if (found) for (let k = 0; k < found.t.length; k++) forces.push([found.t[k], found.x[k], found.F[k]])
      return found
    }
    for (const x of [0.015, 0.02, 0.0, 0.018]) {
      b.board.hand = x
      await b.pass(0.1)
    }
    const before = { k: numbers[told.parameters.findIndex(({ name }) => name === "k")], duty: b.board.core.duty, x: b.board.x }
    b.source.press("record")
    b.source.tell("move", told.about.parameters.findIndex(({ name }) => name === "k"), 150)
    await b.pass(0.3)
    const after = { duty: b.board.core.duty, x: b.board.x }
    await b.press("stop")
    const record = b.page.recordFile(b.source.recorded(), { ...told.record, ...b.paddle.record })
    const off = await b.after(() => b.press("pause", 0))
    await b.pass(0.3)
    return { forces, before, after, off, status: b.status(), facts: b.paddle.facts, options: b.port.options, signals: b.port.signals, asked: b.serial.asked, gotten: b.serial.gotten, said: [...new Set(b.said())], frames: b.frames.length, record: Buffer.from(record).toString("base64") }
  },
  async "nothing starts without a press"() {
    const b = await bench()
    await b.connect()
    await b.pass(0.5)
    const unknown = b.status()
    await b.press("start")
    const refused = b.status()
    await b.home()
    b.board.hand = 0.02
    await b.pass(0.5)
    const homed = b.status()
    b.pressed = () => b.clock.now() - 0.6
    await b.press("start")
    const late = b.status()
    b.pressed = () => -Infinity
    await b.press("resume")
    await b.press("restart")
    return { unknown, refused, homed, late, said: b.said(), duty: Math.max(...b.board.duties.map(Math.abs)) }
  },
  async "stop while it starts"() {
    const b = await bench()
    await b.homed().connect()
    await b.lead(0.02)
    const found = []
    for (let k = 1; k < 30; k += 3) {
      b.source.press("start")
      await b.pass(0.001 * k)
      b.source.press("pause")
      const tick = b.board.ticks
      await b.pass(0.15)
      found.push([b.board.offAfter(tick), b.source.running, b.said().at(-1)])
    }
    return { found }
  },
  async "stop while it starts again"() {
    const b = await (await bench()).running()
    const found = []
    for (let k = 0; k < 12; k += 2) {
      b.source.press("restart")
      await b.pass(0.001 * k)
      b.source.press("pause")
      const tick = b.board.ticks
      await b.pass(0.1)
      found.push([b.board.offAfter(tick), b.source.running, b.said().at(-1)])
      await b.press("start", 0.1)
    }
    return { found }
  },
  async "press Stop"() {
    const b = await (await bench()).running()
    return b.after(() => b.source.press("pause"))
  },
  async "page closed"() {
    const b = await (await bench()).running()
    return b.after(() => {
      b.source.close()
      b.paddle.close()
    })
  },
  async "page blocked"() {
    const b = await (await bench()).running()
    return b.after(() => {}, 0.4, { asleep: true })
  },
  async "laptop asleep"() {
    const b = await (await bench()).running()
    return b.after(() => b.sleep(10), 0.8)
  },
  async "nobody looks"() {
    const b = await (await bench()).running()
    return b.after(() => (b.source.turn = () => {}), 1.25)
  },
  async "port closed"() {
    const b = await (await bench()).running()
    return b.after(() => (b.port.onWay = () => new Uint8Array(0)), 2)
  },
  async "unplugged"() {
    const b = await (await bench()).running()
    return b.after(() => b.port.unplug())
  },
  async "power lost with the cable"() {
    const b = await (await bench()).running()
    return b.after(() => {
      b.board.powered = false
      b.port.unplug()
    })
  },
  async "device accepts no data"() {
    const b = await (await bench()).running()
    return b.after(() => (b.port.stuck = true), 1)
  },
  async "garbage"() {
    const b = await (await bench()).running()
    return b.after(() => {
      b.port.onWay = noise
      b.port.onWire = noise
    }, 2.6)
  },
  async "board reset"() {
    const b = await (await bench()).running()
    return b.after(() => b.board.reset(), 1.3)
  },
  async "another program"() {
    const b = await (await bench()).running()
    return b.after(() => b.board.core.receive(b.page.encodeFrame("HELLO", 1, [77])), 1.3)
  },
  async "over-speed"() {
    const b = await (await bench()).running()
    return b.after(() => push(b))
  },
  async "over-travel"() {
    const b = await (await bench()).running()
    return b.after(() => Object.assign(b.board, { beyond: true, x: 0.056, hand: 0.056 }))
  },
  async "sensor's wire"() {
    const b = await (await bench()).running()
    return b.after(() => fail(b, "SENSOR")) // what a board finds of itself
  },
  async "stack overflow"() {
    const b = await (await bench()).running()
    return b.after(() => fail(b, "MEMORY"))
  },
  async "sensor frozen"() {
    const b = await (await bench()).running()
    return b.after(() => {
      const counts = Math.round(b.board.x / b.board.known.metres_per_count)
      b.board.sensor = () => counts
    }, 1.3)
  },
  async "heat"() {
    const b = await bench({ store: asked.stores.hot })
    b.board.hand = 0
    await b.running(0.025)
    return b.after(() => {}, 1.2)
  },
  async "division by zero"() {
    const b = await bench({ scene: "quotient" })
    await b.running()
    return b.after(() => b.source.tell("move", b.source.about.parameters.findIndex(({ name }) => name === "y"), 0))
  },
  async "program damaged in memory"() {
    const b = await (await bench()).running()
    return b.after(() => b.board.core.damageProgram(40, 1))
  },
  async "a fault, and Start again"() {
    const b = await (await bench()).running()
    const fault = await b.after(() => push(b))
    b.board.hand = 0.0
    await b.press("start", 0.4) // it was meant for Stop
    const soon = b.said().filter((name) => name === "START").length
    await b.pass(0.4)
    await b.press("start", 0.4)
    b.board.hand = 0.02
    await b.pass(0.3)
    return { ...fault, soon, again: b.board.core.duty, said: b.status() }
  },
  async "a slider moved in a start"() {
    const b = await bench()
    await b.homed().connect()
    await b.lead(0.02)
    const slider = b.source.about.parameters.findIndex(({ name }) => name === "k")
    const take = b.port.take.bind(b.port)
    b.port.take = (bytes) => {
      if (b.page.decodeFrame(bytes.slice(0, -1))?.message === "START") b.source.tell("move", slider, 150)
      return take(bytes)
    }
    await b.press("start", 0.5)
    return { k: b.source.values.k, force: -b.board.core.duty * b.board.known.force_full, x: b.board.x, status: b.status() }
  },
  async "pressed just after Stop"() {
    const b = await (await bench()).running()
    const starts = () => b.said().filter((name) => name === "START").length
    await b.press("pause", 0)
    const stopped = b.clock.now()
    const refused = []
    for (const name of ["start", "resume", "restart", "start"]) {
      await b.press(name)
      refused.push([starts(), b.status()])
    }
    b.pressed = () => stopped - 0.1 // made before, heard after
    await b.press("start", 0)
    b.pressed = () => b.clock.now()
    const early = starts()
    await b.press("start")
    await b.press("restart") // a motor that is on begins again at once
    return { refused, early, then: starts(), duty: b.board.core.duty }
  },
  async "stop whose STOP is lost"() {
    const b = await bench()
    await b.homed().connect()
    await b.lead(0.02)
    b.port.onWire = (bytes) => (b.said().includes("START") ? new Uint8Array(0) : bytes) // so that it still starts
    b.source.press("start")
    while (!b.board.core.duty) await b.pass(0.001)
    let lost = 0
    b.port.onWay = (bytes) => {
      const own = b.page.decodeFrame(bytes.slice(0, -1))?.message === "STOP" && lost++ < 1
      return own ? new Uint8Array(0) : bytes
    }
    return { ...(await b.after(() => b.source.press("pause"))), lost }
  },
  async "error as it begins"() {
    const b = await bench()
    await b.homed().connect()
    await b.lead(0.02)
    b.source.begin = () => {
      throw new Error("a mistake")
    }
    await b.press("start")
    return { said: b.said(), status: b.status(), duty: b.board.core.duty }
  },
  async "a start that takes long"() {
    const b = await bench()
    await b.homed().connect()
    await b.lead(0.02)
    const upload = b.paddle.upload.bind(b.paddle)
    b.paddle.upload = async (data) => {
      const crc = await upload(data)
      await new Promise((goOn) => b.clock.after(2.1, goOn)) // as a page does that is busy
      return crc
    }
    await b.press("start", 2.5)
    return { said: b.said(), status: b.status(), duty: Math.max(...b.board.duties.map(Math.abs)) }
  },
  async "a period that the board does not have"() {
    const b = await bench()
    await b.homed().connect()
    b.source.told = { ...b.source.told, T: 0.5 }
    await b.press("start")
    return { said: b.said(), words: b.status() }
  },
  async "a damaged byte, then everything twice"() {
    const b = await (await bench()).running()
    const before = b.port.out
    b.port.readable = new ReadableStream({ start: (out) => void (b.port.out = out) })
    before.error(new DOMException("A byte was damaged.", "FramingError"))
    b.port.onWire = (bytes) => Uint8Array.of(...bytes, ...bytes)
    await b.pass(0.05)
    const times = []
    const take = b.paddle.run.samples.bind(b.paddle.run)
    b.paddle.run.samples = () => {
      const found = take()
      times.push(...(found?.t ?? []))
      return found
    }
    await b.pass(0.3)
    return { times, duty: b.board.core.duty, status: b.status() }
  },
  async "a board that is silent for a while"() {
    const b = await bench()
    await b.connect()
    b.port.onWire = () => new Uint8Array(0)
    await b.pass(6)
    b.port.onWire = (bytes) => bytes
    const before = b.said().length
    await b.pass(0.2)
    return { asked: b.said().length - before }
  },
  async "further than its travel"() {
    const b = await bench()
    await b.connect()
    b.board.beyond = true
    for (const x of [-0.06, 0.06, 0]) await b.lead(x)
    await b.pass(0.5)
    return { status: b.status() }
  },
  async "reset by a supply that fell"() {
    const b = await bench()
    b.port.onWire = (bytes) => {
      const frame = b.page.decodeFrame(bytes.slice(0, bytes.indexOf(0)))
      if (frame?.message !== "WELCOME") return bytes
      const fields = { ...b.page.fieldsOf(frame), reset_cause: b.page.TABLES.reset_causes.BROWN_OUT[0] }
      return b.page.encodeFrame("WELCOME", frame.sequence, Object.values(fields))
    }
    await b.connect()
    const { notices } = b.paddle
    await b.wait(b.paddle.close())
    return { notices, forgotten: b.port.forgotten }
  },
  async "another version"() {
    const b = await bench()
    b.port.onWire = (bytes) => {
      const frame = b.page.decodeFrame(bytes.slice(0, bytes.indexOf(0)))
      if (frame?.message !== "WELCOME") return bytes
      const { table, board, ...rest } = b.page.fieldsOf(frame)
      return b.page.encodeFrame("WELCOME", frame.sequence, [table ^ 1, Buffer.from("pico\0\0\0\0"), ...Object.values(rest)])
    }
    return { words: await b.connect(), said: [...new Set(b.said())], closed: b.port.closed }
  },
  async "port taken"() {
    const b = await bench()
    b.port.taken = true
    return { words: await b.connect(), said: b.said() }
  },
  async "no port chosen"() {
    const b = await bench()
    b.serial.port = null
    return { words: await b.connect() }
  },
  async "no API"() {
    const b = await bench()
    b.navigator.serial = undefined
    return { words: await b.connect() }
  },
  async "nothing answers"() {
    const b = await bench()
    b.board.powered = false
    return { words: await b.connect(), seconds: b.clock.now(), closed: b.port.closed }
  },
  async "noise answers"() {
    const b = await bench()
    b.port.onWire = (bytes) => noise(Uint8Array.from({ length: 5000 }, (_, k) => bytes[k % bytes.length]))
    return { words: await b.connect(), said: [...new Set(b.said())], closed: b.port.closed }
  },
  async "resets as it opens"() {
    const b = await bench()
    b.board.powered = false
    b.clock.after(1.5, () => (b.board.powered = true)) // its bootloader listens first
    return { words: await b.connect(), facts: b.paddle.facts }
  },
  async "not calibrated"() {
    const b = await bench({ store: "" })
    await b.connect()
    await b.press("start")
    return { words: b.status(), obstacle: b.paddle.obstacle, said: [...new Set(b.said())] }
  },
  async "not wired"() {
    const b = await bench({ store: asked.stores.unwired })
    await b.homed().connect()
    await b.press("start")
    return { words: b.status(), obstacle: b.paddle.obstacle, said: [...new Set(b.said())] }
  },
  async "an encoder that is too fast"() {
    const b = await bench()
    await b.homed().connect()
    b.source.told = { ...b.source.told, edges: 1e5 } // at 2 m/s and 10 um per count there are twice as many
    await b.press("start")
    return { words: b.status(), said: [...new Set(b.said())] }
  },
  async "a sensor that is too slow"() {
    const b = await bench({ store: asked.stores.slow })
    await b.homed().connect()
    await b.press("start")
    return { words: b.status(), said: [...new Set(b.said())] }
  },
  async "sign not checked"() {
    const b = await bench({ store: asked.stores.unchecked })
    await b.running(0.025)
    return { facts: b.paddle.facts, duty: Math.max(...b.board.duties.map(Math.abs)) * b.board.known.force_full }
  },
  async "a fault that stood"() {
    const b = await (await bench()).running()
    push(b)
    await b.pass(0.01, { asleep: true })
    b.board.port = b.navigator.serial.port = new b.page.FakePort(b.board) // another page, at the same board
    b.source.closed = true
    return { words: await b.connect(), notices: b.paddle.notices, state: (await b.wait(b.paddle.exchange.refresh())).value.state }
  },
}

const answer = {}
for (const name of asked.scenarios ?? Object.keys(scenarios)) {
  const began = performance.now()
  answer[name] = await scenarios[name]()
  answer[name].ms = performance.now() - began
}
process.stdout.write(JSON.stringify(answer), () => process.exit(0)) // of a port that is stuck something always waits
