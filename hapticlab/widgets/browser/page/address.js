// What a visitor changed, in the address of the page: #k=150N/m;x_o=10mm;slow-motion;traces=x,F, values in the words of
// `hapticlab run --set`.
// A link may come from anybody: names are looked up in lists, never as keys, and nothing of it is read as HTML or script.

const LONGEST_ADDRESS = 4000 // letters
const QUOTED = 40 // letters of it that are said again
const QUANTITY = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([^]*)$/
const UNIT_FACTOR = /^([A-Za-z\u00b5\u03bc]+|1)(?:\^(-?\d+(?:\.\d+)?))?$/
const NO_NUMBER = /^\s*([-+]?)(nan|inf|infinity)\s*$/i
const ANGLES = { rad: 1, deg: Math.PI / 180 }

// Return {values, flags, traces, problems} of an address: numbers in SI by name, the flags that it names, traces or null, and
// sentences on what is not understood. parameters: {name, unit} each; units: as hapticlab/widgets/shared/units.py; flags: names
// without a value; traces: those that there are; fixed: why other parameters of the scene cannot be changed, by name.
function readAddress(hash, { parameters, units, flags, traces, fixed = {} }) {
  const found = { values: Object.create(null), flags: [], traces: null, problems: [] }
  const text = decoded(hash.replace(/^#/, ""))
  if (text.length > LONGEST_ADDRESS) {
    found.problems.push(`The address has ${text.length} letters, and this page reads ${LONGEST_ADDRESS}: it shows its own values.`)
    return found
  }
  for (const part of text.split(/[;&]/)) {
    const equals = part.indexOf("=")
    const name = (equals < 0 ? part : part.slice(0, equals)).trim()
    const parameter = parameters.find((each) => each.name === name)
    const written = part.slice(equals + 1)
    if (!part.trim()) continue
    if (equals < 0 && flags.includes(name)) found.flags.push(name)
    else if (equals < 1 || !written) found.problems.push(`${quoted(part)} sets nothing; write NAME=VALUE, such as k=300 or x_o=10mm`)
    else if (!parameter && Object.hasOwn(fixed, name)) found.problems.push(fixed[name])
    else if (!parameter && name === "traces") {
      const names = written.split(",").map((each) => each.trim())
      found.traces = traces.filter((each) => names.includes(each))
      const unknown = names.find((each) => !traces.includes(each))
      if (unknown !== undefined) found.problems.push(`traces = ${quoted(unknown)}: there is no such trace; there are ${traces.join(", ")}`)
    } else if (!parameter) found.problems.push(unknownName(name, written, parameters))
    else {
      const [value, problem] = quantityOf(written, parameter, units)
      if (problem) found.problems.push(problem)
      else found.values[name] = value
    }
  }
  return found
}

// Return the shortest address, with its #, that restores what differs from the page's own values; "" where nothing does.
// on: the flags; traces: those shown, where they are not the page's own.
function writeAddress(values, on, { parameters, units }, traces = null) {
  const changed = parameters.filter(({ name, value }) => name in values && values[name] !== value)
  const parts = changed.map((parameter) => `${parameter.name}=${quantityText(values[parameter.name], parameter, units)}`)
  const all = [...parts, ...on, ...(traces ? [`traces=${traces.join(",")}`] : [])]
  return all.length ? `#${all.join(";")}` : ""
}

function decoded(text) {
  try {
    return decodeURIComponent(text)
  } catch {
    return text // a lone % says nothing else
  }
}

// [number in SI, ""] of a text such as "10 mm" or "300", or [NaN, why not].
function quantityOf(text, { name, unit }, units) {
  const word = text.match(NO_NUMBER)
  if (word) return [/nan/i.test(word[2]) ? NaN : word[1] === "-" ? -Infinity : Infinity, ""]
  const written = text.match(QUANTITY)
  const needs = `${name} = ${quoted(text)}; needs a quantity in ${unit}, like '2 ${unit}'`
  if (!written) return [NaN, `${needs} (it does not begin with a number)`]
  const own = written[2].trim()
  if (!own && !/\s/.test(text.trim())) return [Number(written[1]), ""] // a plain number is in SI
  const [given, wanted] = [sizeOf(own || "1", units), sizeOf(unit, units)]
  if (!given) return [NaN, `${needs} (this page reads metric units, and ${quoted(own)} is none)`]
  if (String(given.exponents) !== String(wanted?.exponents)) return [NaN, `${needs} (${own || "a pure number"} is of another kind)`]
  return [Number(written[1]) * (given.size / wanted.size), ""]
}

// {size in SI, exponents of m, kg, s and A} of a unit such as N*s/m, or null.
function sizeOf(unit, units) {
  let [power, size] = [0, 1]
  const exponents = [0, 0, 0, 0]
  const joined = unit.trim().replaceAll("**", "^").split(/\s*([*/])\s*|\s+/)
  for (let k = 0; k < joined.length; k += 2) {
    const [, name, times] = joined[k].match(UNIT_FACTOR) ?? []
    const known = name && unitNamed(name, units)
    if (!known) return null
    const p = Number(times ?? 1) * (joined[k - 1] === "/" ? -1 : 1)
    power += known.power * p
    size *= known.size ** p
    known.exponents.forEach((e, j) => (exponents[j] += e * p))
  }
  return { size: Number.isInteger(power) ? size * Number(`1e${power}`) : size * 10 ** power, exponents }
}

function unitNamed(name, { units, prefixes }) {
  if (name === "1" || Object.hasOwn(ANGLES, name)) return { power: 0, size: ANGLES[name] ?? 1, exponents: [0, 0, 0, 0] }
  for (const [prefix, power] of Object.entries(prefixes)) {
    const rest = name.slice(prefix.length)
    if (name.startsWith(prefix) && Object.hasOwn(units, rest)) return { power: power + units[rest][0], size: 1, exponents: units[rest][1] }
  }
  return null
}

// The shortest text that is read as this very number: lengths in mm, all else in SI.
function quantityText(value, parameter, units) {
  const { unit } = parameter
  const plain = unit === "1" ? "" : unit
  const texts = unit === "m" ? [`${Number((1000 * value).toPrecision(12))}mm`, `${1000 * value}mm`] : [`${Number(value.toPrecision(12))}${plain}`]
  return texts.find((text) => quantityOf(text, parameter, units)[0] === value) ?? `${value}${plain}`
}

function unknownName(name, written, parameters) {
  const listed = parameters.map((each) => `${each.name} [${each.unit}]`).join(", ") || "none"
  const near = parameters.find((each) => each.name.toLowerCase() === name.toLowerCase())
  const number = Number(written)
  const value = written.trim() && !Number.isNaN(number) ? `${written.trim()}` : quoted(written)
  return `${shortened(name)} = ${value}: the scene has no parameter ${shortened(name)}; it has ${listed}` + (near ? `. Did you mean ${near.name}?` : "")
}

// A text between quotation marks, as Python writes it.
function quoted(text) {
  const mark = text.includes("'") && !text.includes('"') ? '"' : "'"
  return mark + shortened(text).replaceAll("\\", "\\\\") + mark
}

function shortened(text) {
  return text.length > QUOTED ? `${text.slice(0, QUOTED)}…` : text
}
