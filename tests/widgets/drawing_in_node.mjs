// Evaluate recordings as a page does. In: {name: [recording, [values, ...]]}; what is no number is in a word. Out: {name: results}.

import { readFileSync } from "node:fs"
import { text } from "node:stream/consumers"
import { argv, stdin } from "node:process"
import { runInThisContext } from "node:vm"

const { Drawing, Recorded, FUNCTIONS } = runInThisContext(`${readFileSync(argv[2], "utf8")}\n;({ Drawing, Recorded, FUNCTIONS })`)
const numbers = (values) => Object.fromEntries(Object.entries(values).map(([name, value]) => [name, Number(value)]))
const words = (found) => Array.from(found.length === undefined ? [found] : found, (one) => (Number.isFinite(one) ? one : String(one)))
const answers = { functions: Object.keys(FUNCTIONS) }
for (const [name, [recording, moments]] of Object.entries(JSON.parse(await text(stdin)))) {
  const recorded = recording.items ? new Drawing(recording) : new Recorded(recording)
  answers[name] = moments.map((values) => {
    const found = recorded.at(numbers(values))
    return recording.items ? [found[0], words(found[1])] : words(found)
  })
}
console.log(JSON.stringify(answers))
