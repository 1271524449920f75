// The scripts of a shared page, without a page: cases from stdin, {scripts, cases: [[what, given], ...]}, answers to stdout.
import { readFileSync } from "node:fs"

const PARTS = ["Program", "Stepping", "Pace", "Rows", "PageSource", "touchingOf", "refusal", "general", "chatterWords", "contactWords", "lateWords", "linspace", "normal"]
const { scripts, cases } = JSON.parse(readFileSync(0, "utf8"))
const source = scripts.map((path) => readFileSync(path, "utf8")).join("\n")
const { Program, Stepping, Pace, Rows, PageSource, touchingOf, ...parts } = new Function(`"use strict"; ${source}\n return { ${PARTS} }`)()

const text = (numbers) => Buffer.from(Float64Array.from(numbers).buffer).toString("base64")
const numbers = (array) => [...new Float64Array(Uint8Array.from(Buffer.from(array, "base64")).buffer)]
const texts = (columns) => Object.fromEntries(Object.entries(columns).map(([name, column]) => [name, text(column)]))
const arrays = (columns) => Object.fromEntries(Object.entries(columns).map(([name, column]) => [name, Float64Array.from(numbers(column))]))

async function programsOf(told) {
  const names = Object.keys(told.programs)
  const opened = await Promise.all(names.map((name) => Program.open(told.programs[name])))
  return Object.fromEntries(names.map((name, k) => [name, opened[k]]))
}

const ANSWERS = {
  // A scene, and what is done to it in turn: {intent}, {set}, {hold}, {start}; the fault is that before the last start.
  async steps({ told, plan }) {
    const stepping = new Stepping(told, await programsOf(told))
    const found = []
    let fault = null
    for (const { intent, set, hold, start } of plan) {
      if (set) stepping.set(set)
      if (hold !== undefined) stepping.hold(hold)
      if (start) {
        fault = stepping.fault
        stepping.start()
      }
      if (intent) found.push(texts(stepping.advance(Float64Array.from(numbers(intent)))))
    }
    return { found, fault, place: stepping.place }
  },

  pace({ T, speed, moments, costs, speeds }) {
    const pace = new Pace(T, speed)
    pace.start(moments[0])
    return moments.map((now, k) => {
      if (speeds[k]) pace.passAt(speeds[k])
      const due = pace.due(now)
      pace.spent(due, costs[k] * due)
      return [due, pace.behind(now)]
    })
  },

  rows({ T, columns, watched, parts: some }) {
    const rows = new Rows(T, columns, watched)
    const found = some.map(([samples, contact]) => text(rows.add(arrays(samples), Float64Array.from(numbers(contact)))))
    return { found, recent: rows.last().map(text) }
  },

  words({ name, given }) {
    return parts[name](...given.map((each) => (typeof each === "string" ? Float64Array.from(numbers(each)) : each)))
  },

  noise({ seed, count }) {
    const draw = parts.normal(seed, 0)
    return text(Array.from({ length: count }, draw))
  },

  // A whole view: at each moment of the clock what is said, then what a frame of the screen shows.
  async view({ told, script }) {
    let [now, screen] = [0, null]
    globalThis.requestAnimationFrame = (work) => ((screen = work), 1)
    globalThis.cancelAnimationFrame = () => (screen = null)
    const seen = []
    const receive = (news, bytes) => seen.push({ ...news, bytes: text(new Float64Array(bytes.slice(0, 24))), rows: Buffer.from(bytes.slice(24)).toString("base64") })
    const saved = []
    const source = new PageSource(told, await programsOf(told), {
      picture: { at: () => [[], []] },
      touching: touchingOf(told.touching),
      save: (record) => (saved.push({ ...record, columns: texts(record.columns) }), "Saved"),
      clock: () => now,
    })
    source.open({ receive })
    for (const [moment, said] of script) {
      now = moment
      for (const [name, ...given] of said) source[name](...given)
      const work = screen
      screen = null
      work?.()
    }
    return { seen, saved, values: source.values }
  },
}

const answers = []
for (const [what, given] of cases) answers.push(await ANSWERS[what](given))
process.stdout.write(JSON.stringify(answers))
