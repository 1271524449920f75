// Which values a slider may set: what hapticlab.device.live_parameters.checked says of a program without its steps. Each
// parameter takes a part of the way from the value it came with to its own limit, and the parts may add up to 1.

const HOW = "compile with these values bound, or with more substeps"
const NEARLY = 1e-9

// Return why values cannot be set beside those that are, in words; "" where they can. told: {name, unit, low, high, value,
// limits, range, positive, why} of each parameter; changed, values: by name, SI.
function refusal(told, values, changed) {
  for (const each of told) {
    if (Object.hasOwn(changed, each.name)) {
      const words = outside(each, changed[each.name])
      if (words) return words
    }
  }
  return unstable(told, { ...values, ...changed }, changed)
}

function outside({ name, unit, low, high, range, positive, why }, value) {
  if (!Number.isFinite(value)) return `${name} = ${general(value)}; needs a finite number in ${unit}${why}`
  if (positive && value <= 0) return `${name} = ${general(value)} ${unit}; ${positive}${why}`
  if (value < (low ?? -Infinity) || value > (high ?? Infinity)) return `${name} = ${general(value)} ${unit}; ${range}${why}`
  if (!Number.isFinite(Math.fround(value))) return `${name} = ${general(value)}; a board needs a finite float32, |${name}| < 3.4e38.`
  return ""
}

function unstable(told, values, changed) {
  const limited = told.filter((each) => each.limits)
  const taken = limited.map((each) => [each, Math.max(...each.limits.filter(Number.isFinite).map((end) => partOfTheWay(values[each.name], each.value, end)))])
  const some = taken.filter(([, part]) => part > NEARLY)
  const total = some.reduce((sum, [, part]) => sum + part, 0)
  const moved = some.filter(([each]) => Object.hasOwn(changed, each.name))
  if (total <= 1 + NEARLY || !moved.length) return ""
  for (const [each] of moved) {
    const words = past(each, values[each.name])
    if (words) return `${words}; ${HOW}`
  }
  const shown = some.map(([{ name }, part]) => `${name} = ${general(values[name], 4)} (${(100 * part).toFixed(0)} %)`).join(", ")
  return `${shown}: a step may be unstable. Each value uses a fraction of the distance to its own limit, and the fractions add up to `
    + `${(100 * total).toFixed(0)} %; needs at most 100 %. Move one back, ${HOW}`
}

// That a value is past its own limit, in words, or "".
function past({ name, value: bound, limits }, value) {
  const [low, high] = [limits[0] ?? -Infinity, limits[1] ?? Infinity]
  if (low * (1 - NEARLY * Math.sign(low)) <= value && value <= high * (1 + NEARLY * Math.sign(high))) return ""
  return `${name} = ${general(value)}: a step is stable for ${name} ${value > bound ? `<= ${general(high, 4)}` : `>= ${general(low, 4)}`}`
}

// How far a parameter is on the way to its limit: 0 at the value it came with, 1 at the limit, negative away from it.
function partOfTheWay(now, value, end) {
  const start = value * end > 0 ? value : end / 1e3
  if (now * end <= 0) return -Infinity
  return end === start ? (now === start ? NaN : Infinity) : Math.log(now / start) / Math.log(end / start)
}

// A number as Python writes it by "g".
function general(value, digits = 6) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf"
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e").map(Number)
  if (exponent >= -4 && exponent < digits) return String(Number(value.toPrecision(digits)))
  return `${mantissa}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`
}
