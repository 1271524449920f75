// What the page's host makes of tests/vectors/link_frames.json, as JSON on stdout; test_link_frames.py compares.
import { readFileSync } from "node:fs"

const board = new URL("../../hapticlab/widgets/browser/board/", import.meta.url)
const scripts = ["../page/npz.js", "messages.js", "link.js"].map((name) => readFileSync(new URL(name, board), "utf-8")).join("\n")
const names = "Decoder, Exchange, encodeFrame, decodeFrame, fieldsOf"
const link = new Function(`${scripts}; return { ${names} }`)()
const { session, requests, streams, guards, asks } = JSON.parse(readFileSync(new URL("link_frames.json", import.meta.url), "utf-8"))
const bytes = (hex) => Uint8Array.from(Buffer.from(hex, "hex"))
const hex = (data) => Buffer.from(data).toString("hex")
const shown = (fields) => fields && Object.fromEntries(Object.entries(fields).map(([k, v]) => [k, v instanceof Uint8Array ? hex(v) : v]))
const row = (frame) => frame && [frame.message, frame.sequence, hex(frame.payload)]

function decoded({ chunks }) {
  const decoder = new link.Decoder()
  const frames = chunks.flatMap((chunk) => decoder.feed(bytes(chunk)))
  return { frames: frames.map((frame) => [...row(frame), shown(link.fieldsOf(frame))]), damaged: decoder.damaged }
}

// One try each; time stands still but for what is waited for.
async function asked({ message, came }) {
  const timers = []
  const clock = { now: () => 0, wall: () => 0, after: (seconds, work) => (timers.push(work), () => timers.splice(timers.indexOf(work), 1)) }
  const exchange = new link.Exchange({ write: () => {} }, clock, () => {})
  const taken = (known) => (message === "STATUS" ? known.tick : [known.result, known.tick])
  const answer = exchange.ask(message, message === "STATUS" ? [1] : [], { tries: 1 }).then(taken, () => null)
  const settle = () => new Promise(setImmediate)
  await settle()
  for (const chunk of came) {
    exchange.hear(bytes(chunk))
    await settle()
  }
  for (const work of [...timers]) work() // whoever still waits has waited long enough
  return answer
}

const answer = {
  requests: requests.map(({ message, sequence, values, rest }) => hex(link.encodeFrame(message, sequence, values, { rest: bytes(rest), session }))),
  streams: Object.fromEntries(Object.entries(streams).map(([name, stream]) => [name, decoded(stream)])),
  guards: guards.map(([data, begun]) => row(link.decodeFrame(bytes(data), begun))),
  asks: Object.fromEntries(await Promise.all(Object.entries(asks).map(async ([name, ask]) => [name, await asked(ask)]))),
}
console.log(JSON.stringify(answer))
