// What hapticlab/analysis/pictures/recording.py recorded, evaluated without Python: a function of numbers, or a moving picture.

// Number by number, by the names that NumPy has for them; a truth is 1 or 0.
const FUNCTIONS = {
  add: (a, b) => a + b,
  subtract: (a, b) => a - b,
  multiply: (a, b) => a * b,
  divide: (a, b) => a / b,
  floor_divide: (a, b) => { // exact where a / b is rounded up
    const left = a % b
    return b ? Math.round((a - left) / b) - (left && left < 0 !== b < 0 ? 1 : 0) : a / b
  },
  remainder: (a, b) => { // has the sign of b
    const left = a % b
    return left && left < 0 !== b < 0 ? left + b : left
  },
  fmod: (a, b) => a % b,
  power: (a, b) => (a === 1 ? 1 : a ** b),
  negative: (a) => -a,
  absolute: Math.abs,
  sign: Math.sign,
  copysign: (a, b) => (b < 0 || Object.is(b, -0) ? -Math.abs(a) : Math.abs(a)),
  heaviside: (a, b) => (a === 0 ? b : (Math.sign(a) + 1) / 2),
  sqrt: Math.sqrt,
  cbrt: Math.cbrt,
  hypot: (a, b) => Math.hypot(a, b),
  sin: Math.sin,
  cos: Math.cos,
  tan: Math.tan,
  arcsin: Math.asin,
  arccos: Math.acos,
  arctan: Math.atan,
  arctan2: Math.atan2,
  sinh: Math.sinh,
  cosh: Math.cosh,
  tanh: Math.tanh,
  arcsinh: Math.asinh,
  arccosh: Math.acosh,
  arctanh: Math.atanh,
  exp: Math.exp,
  exp2: (a) => 2 ** a,
  expm1: Math.expm1,
  log: Math.log,
  log2: Math.log2,
  log10: Math.log10,
  log1p: Math.log1p,
  floor: Math.floor,
  ceil: Math.ceil,
  trunc: Math.trunc,
  rint: (a) => { // a half goes to the even number
    const near = Math.round(a)
    return Math.abs(a % 1) === 0.5 && near % 2 ? near - 1 : near
  },
  maximum: (a, b) => Math.max(a, b),
  minimum: (a, b) => Math.min(a, b),
  fmax: (a, b) => (a >= b || Number.isNaN(b) ? a : b),
  fmin: (a, b) => (a <= b || Number.isNaN(b) ? a : b),
  less: (a, b) => a < b,
  less_equal: (a, b) => a <= b,
  greater: (a, b) => a > b,
  greater_equal: (a, b) => a >= b,
  equal: (a, b) => a === b,
  not_equal: (a, b) => a !== b,
  logical_and: (a, b) => a !== 0 && b !== 0,
  logical_or: (a, b) => a !== 0 || b !== 0,
  logical_xor: (a, b) => (a !== 0) !== (b !== 0),
  logical_not: (a) => a === 0,
  isfinite: Number.isFinite,
  isnan: Number.isNaN,
  where: (a, b, c) => (a !== 0 ? b : c),
}

// Steps that are more: from its arguments and the sizes of all nodes before, the nodes it needs, how many numbers it has, and
// what fills them from the numbers of those nodes.
const STEPS = {
  join: (_, ...from) => [from, from.length, (out, given) => out.forEach((_, n) => (out[n] = given[n][0]))],

  slice: (sizes, from, first, step, count) => STEPS.take(sizes, from, Array.from({ length: count }, (_, n) => first + step * n)),

  take(sizes, from, index) {
    const places = from.flatMap((node, k) => Array.from({ length: sizes[node] }, (_, at) => [k, at]))
    const picks = index.map((at) => places[at])
    return [from, picks.length, (out, given) => picks.forEach(([k, at], n) => (out[n] = given[k][at]))]
  },

  reduce(sizes, name, count, from) {
    const fill = (out, [all]) => out.forEach((_, row) => (out[row] = all.subarray(row * count, (row + 1) * count).reduce((a, b) => FUNCTIONS[name](a, b))))
    return [[from], sizes[from] / count, fill]
  },

  accumulate(sizes, name, count, from) {
    const fill = (out, [all]) => out.forEach((_, n) => (out[n] = n % count ? FUNCTIONS[name](out[n - 1], all[n]) : all[n]))
    return [[from], sizes[from], fill]
  },

  interp: (sizes, ...from) => [from, sizes[from[0]], (out, [x, xs, ys]) => out.forEach((_, n) => (out[n] = interpolate(x[n], xs, ys)))],
}

function interpolate(x, xs, ys) {
  const last = xs.length - 1
  if (!(x < xs[last])) return x >= xs[last] ? ys[last] : NaN
  if (x <= xs[0]) return ys[0]
  let [low, high] = [0, last]
  while (high - low > 1) {
    const middle = (low + high) >> 1
    if (xs[middle] <= x) low = middle
    else high = middle
  }
  return ys[low] + ((ys[high] - ys[low]) / (xs[high] - xs[low])) * (x - xs[low])
}

// A function that is applied number by number; a single number goes with all.
function elementwise(name, sizes, from) {
  const f = FUNCTIONS[name]
  const fill = (out, [a, b = a, c = a]) => {
    const [i, j, k] = [a, b, c].map((one) => (one.length > 1 ? 1 : 0))
    for (let n = 0; n < out.length; n++) out[n] = f(a[i * n], b[j * n], c[k * n])
  }
  return [from, Math.max(...from.map((node) => sizes[node])), fill]
}

// The numbers of a node that stays, or nothing.
function constant(node) {
  if (!Array.isArray(node)) return Float64Array.of(Number(node)) // also of "NaN" and "Infinity"
  if (node[0] === "numbers") return Float64Array.from(node[1], Number)
  if (node[0] !== "linspace") return undefined
  const [, first, last, count] = node
  return Float64Array.from({ length: count }, (_, n) => (n === count - 1 ? last : n * ((last - first) / (count - 1)) + first))
}

class Recorded {
  constructor({ inputs, nodes, gives }) {
    this.inputs = inputs.map(([name, start]) => [name, Number(start)])
    this.gives = gives
    this.numbers = inputs.map(() => new Float64Array(1)) // of each node
    this.steps = []
    for (const node of nodes) {
      const kept = constant(node)
      if (!kept) this.addStep(node)
      this.numbers.push(kept || this.steps.at(-1).out)
    }
  }

  addStep([name, ...rest]) {
    const sizes = this.numbers.map((one) => one.length)
    const [from, size, fill] = STEPS[name] ? STEPS[name](sizes, ...rest) : elementwise(name, sizes, rest)
    const given = from.map((node) => this.numbers[node])
    this.steps.push({ node: this.numbers.length, from, given, fill, out: new Float64Array(size) })
  }

  // Take values by name, and return what the function gives; what has not moved is not computed again.
  way(values) {
    const first = !this.moved
    this.moved ??= this.numbers.map(() => false)
    this.inputs.forEach(([name, start], k) => {
      const value = values[name] ?? start
      this.moved[k] = first || !Object.is(value, this.numbers[k][0])
      this.numbers[k][0] = value
    })
    for (const { node, from, given, fill, out } of this.steps) {
      this.moved[node] = first || from.some((one) => this.moved[one])
      if (this.moved[node]) fill(out, given)
    }
    let found = this.gives
    while (found.if !== undefined) found = this.numbers[found.if][0] !== 0 ? found.then : found.else
    return found
  }

  at(values) {
    const found = this.numbers[this.way(values)]
    return found.length === 1 ? found[0] : found
  }
}

// A moving picture: items, each with its number of points, and all points, as browser_view.take_apart has them.
class Drawing extends Recorded {
  constructor(recording) {
    super(recording)
    this.items = recording.items
  }

  // values: x, F [N], intent, coordinates and parameters by name, in SI, as for MovingPicture.draw.
  at(values) {
    const shape = []
    const points = []
    for (const item of this.way(values)) {
      const [kind, node, stays, moves] = this.items[item]
      const places = this.numbers[node]
      if (!places.every(Number.isFinite)) continue // it lies nowhere
      const style = { ...stays }
      for (const [key, from] of Object.entries(moves)) style[key] = from.length ? Array.from(this.numbers[from[0]]) : this.numbers[from][0]
      shape.push([kind, places.length / 2, style])
      points.push(...places)
    }
    return [shape, Float64Array.from(points)]
  }
}

// A function of samples and parameters: the contact of each sample, 1 or 0; NaN where the scene has nothing to touch.
function touchingOf(recording) {
  if (!recording) return ({ x }) => new Float64Array(x.length).fill(NaN)
  const touched = new Recorded(recording)
  const names = recording.inputs.map(([name]) => name)
  return (samples, values) => Float64Array.from(samples.x, (_, k) => {
    const known = names.map((name) => [name, Object.hasOwn(samples, name) ? samples[name][k] : values[name]])
    return touched.at(Object.fromEntries(known))
  })
}
