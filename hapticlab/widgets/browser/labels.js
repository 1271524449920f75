// Labels of a moving picture: typeset letters, each where nothing else is.

const AROUND = [0, 45, -45, 90, -90, 135, -135, 180].map((degrees) => (degrees * Math.PI) / 180)
const FARTHER = [1, 1.6, 2.4, 3.4, 4.6, 6.5]
const NEAR = 16 // [px] from what is named, where its name finds no room on it
const SPARE = 2 // [px] between a label and anything else
const GREEK = {
  alpha: "α", beta: "β", gamma: "γ", delta: "δ", epsilon: "ε", zeta: "ζ", eta: "η", theta: "θ", kappa: "κ", lambda: "λ", mu: "μ", nu: "ν", xi: "ξ", pi: "π",
  rho: "ρ", sigma: "σ", tau: "τ", phi: "φ", varphi: "φ", chi: "χ", psi: "ψ", omega: "ω", Gamma: "Γ", Delta: "Δ", Theta: "Θ", Lambda: "Λ", Sigma: "Σ", Phi: "Φ", Psi: "Ψ", Omega: "Ω",
}
const SERIF = "'STIX Two Text', 'Cambria', 'Times New Roman', 'Liberation Serif', serif"

class Labels {
  constructor(picture) {
    this.picture = picture
    this.known = new Map() // words and size -> how they are set
    this.chosen = new Map() // label -> the place it took last
    this.begin()
  }

  // Forget what was drawn.
  begin() {
    this.waiting = []
    this.segments = []
    this.solids = []
    this.placed = []
  }

  // A body from (left, top) to (right, bottom): what has its name elsewhere is not written on it.
  solid(left, top, right, bottom) {
    this.solids.push(left, top, right, bottom)
  }

  line(x0, y0, x1, y1) {
    this.segments.push(x0, y0, x1, y1)
  }

  lines(place, closed) {
    const last = place.length - 2
    for (let i = 0; i < last; i += 2) this.segments.push(place[i], place[i + 1], place[i + 2], place[i + 3])
    if (closed) this.segments.push(place[last], place[last + 1], place[0], place[1])
  }

  // Name what is at (x, y), best at (px, py).
  add(words, colour, x, y, px, py) {
    this.waiting.push({ words, colour, x, y, px, py })
  }

  // Write every label where it covers no other label, and no line if there is such a place.
  write() {
    for (const [number, label] of this.waiting.entries()) {
      const set = this.set(label.words)
      const place = this.choose(label, set, number)
      if (!place) continue
      const [x, y] = place
      this.typeset(set, x - set.width / 2, y, label.colour, this.cost(x, y, set, 1) > 0 || this.covered(x, y) > 0)
      this.placed.push({ words: label.words, left: x - set.width / 2, right: x + set.width / 2, top: y - set.height / 2, bottom: y + set.height / 2 })
    }
  }

  choose(label, set, number) {
    const places = candidates(label, set)
    const before = this.chosen.get(number)
    let best = null
    let least = Infinity
    // what it took last comes first: a label does not jump to and fro between two places
    const order = before ? [before, ...places.keys()] : [...places.keys()]
    for (const k of order) {
      const [x, y] = places[k]
      const cost = this.cost(x, y, set, least) + (k ? this.covered(x, y) : 0)
      if (cost < least) {
        best = k
        least = cost
      }
      if (cost === 0) break
    }
    if (best === null) return null
    // back to its own place as soon as that is free again
    if (best !== 0 && this.cost(...places[0], set, 1) === 0) best = 0
    this.chosen.set(number, best)
    return places[best]
  }

  // How many lines a label would cover; infinite where it covers another label or leaves the picture.
  cost(x, y, { width, height }, most = Infinity) {
    const { picture, placed, segments } = this
    const [w, h] = [width / 2 + SPARE, height / 2 + SPARE]
    if (x - w < 0 || x + w > picture.width || y - h < 0 || y + h > picture.height - AXIS) return Infinity
    for (const other of placed) if (x + w > other.left && x - w < other.right && y + h > other.top && y - h < other.bottom) return Infinity
    let cost = 0
    for (let i = 0; i < segments.length && cost < most; i += 4) cost += crosses(segments[i] - x, segments[i + 1] - y, segments[i + 2] - x, segments[i + 3] - y, w, h)
    return cost
  }

  covered(x, y) {
    let count = 0
    for (let i = 0; i < this.solids.length; i += 4)
      if (x > this.solids[i] && y > this.solids[i + 1] && x < this.solids[i + 2] && y < this.solids[i + 3]) count++
    return count
  }

  // Letters, their fonts and widths, of words with mathematics between dollars.
  set(words) {
    const size = this.picture.size
    const key = `${size} ${words}`
    if (this.known.has(key)) return this.known.get(key)
    if (this.known.size > 500) this.known.clear() // numbers change
    const context = this.picture.context
    let width = 0
    const runs = letters(words).map(({ text, italic, level }) => {
      const font = italic === null ? `${size - 1}px system-ui, sans-serif` : `${italic ? "italic " : ""}${Math.round(size * (level ? 0.8 : 1.12))}px ${SERIF}`
      context.font = font
      const run = { text, font, x: width, y: level * 0.3 * size }
      width += context.measureText(text).width
      return run
    })
    const set = { runs, width: width + 2, height: 1.15 * size }
    this.known.set(key, set)
    return set
  }

  // On a rim of paper where it covers something, so that this does not strike it through.
  typeset({ runs }, x, y, colour, covers) {
    const { context, theme } = this.picture
    context.setLineDash(NONE)
    context.textAlign = "left"
    context.textBaseline = "middle"
    context.lineWidth = 3
    context.strokeStyle = theme.paper
    context.fillStyle = this.picture.colour(colour)
    for (const run of covers ? runs : NONE) {
      context.font = run.font
      context.strokeText(run.text, x + run.x, y + run.y)
    }
    for (const run of runs) {
      context.font = run.font
      context.fillText(run.text, x + run.x, y + run.y)
    }
  }
}

// Where a label may stand, the best first: where it should, then around what it names, ever farther.
function candidates({ x, y, px, py }, { width, height }) {
  const way = Math.hypot(px - x, py - y)
  const found = [[px, py]]
  const from = way ? Math.atan2(py - y, px - x) : -Math.PI / 2
  for (const times of FARTHER)
    for (const turn of AROUND) {
      const [c, s] = [Math.cos(from + turn), Math.sin(from + turn)]
      const reach = Math.max(way, NEAR) * times
      found.push([x + reach * c + 0.3 * (width - height) * c, y + reach * s])
    }
  return found
}

// Whether a line goes through a box of half sizes w, h about the origin: 1 or 0.
function crosses(x0, y0, x1, y1, w, h) {
  if ((x0 < -w && x1 < -w) || (x0 > w && x1 > w) || (y0 < -h && y1 < -h) || (y0 > h && y1 > h)) return 0
  const [dx, dy] = [x1 - x0, y1 - y0]
  const side = (x, y) => dx * (y - y0) - dy * (x - x0)
  const [a, b, c, d] = [side(-w, -h), side(w, -h), side(w, h), side(-w, h)]
  return (a > 0 && b > 0 && c > 0 && d > 0) || (a < 0 && b < 0 && c < 0 && d < 0) ? 0 : 1
}

// Runs of letters: italic is null for plain words, level 1 for a subscript, -1 for a superscript.
function letters(words) {
  return words.split("$").flatMap((part, k) => (k % 2 ? mathematics(part) : part ? [{ text: part, italic: null, level: 0 }] : []))
}

function mathematics(tex, level = 0) {
  const runs = []
  const put = (text, italic) => {
    const last = runs[runs.length - 1]
    if (last && last.italic === italic && last.level === level) last.text += text
    else runs.push({ text, italic, level })
  }
  tex = tex.replace(/\\frac\{(\w+)\}\{(\w+)\}/g, "$1/$2").replace(/\\(left|right|mathrm|operatorname)\b/g, "")
  for (let i = 0; i < tex.length; ) {
    const rest = tex.slice(i)
    const command = rest.match(/^\\([A-Za-z]+|.)/)
    const shifted = rest.match(/^([_^])(\{([^}]*)\}|\\[A-Za-z]+|.)/)
    if (shifted) runs.push(...mathematics(shifted[3] ?? shifted[2], shifted[1] === "_" ? 1 : -1))
    else if (command) {
      if (GREEK[command[1]]) put(GREEK[command[1]], true)
      else put(/^[A-Za-z]/.test(command[1]) ? command[1] + " " : " ", false)
    } else if (!/[{}]/.test(rest[0])) put(rest[0] === "-" ? "−" : rest[0], /[A-Za-z]/.test(rest[0]))
    i += (shifted || command || [rest[0]])[0].length
  }
  return runs
}
