// The moving picture: a display list in metres, drawn on a canvas.

class Picture {
  constructor(canvas, about) {
    this.canvas = canvas
    this.context = canvas.getContext("2d")
    this.along = about.along
    this.ink = new Map()
    this.labels = new Labels(this)
    this.show(about.box)
  }

  show(box) {
    this.box = box // left, right, bottom, top [m]
    if (this.width) this.scaleToFit()
  }

  // Take so much room [px]; without a height, as much as the picture needs of it.
  resize(width, height) {
    const [left, right, bottom, top] = this.box
    this.width = width
    const most = Math.min(Math.max(0.4 * window.innerHeight, 160), 300)
    this.height = height || Math.min(Math.max((width * (top - bottom)) / (right - left), 130), most)
    fit(this.canvas, this.width, this.height)
    this.scaleToFit()
  }

  scaleToFit() {
    const [left, right, bottom, top] = this.box
    this.scale = Math.min(this.width / (right - left), (this.height - AXIS) / (top - bottom))
    this.left = this.width / 2 - (this.scale * (left + right)) / 2
    this.base = (this.height - AXIS) / 2 + (this.scale * (bottom + top)) / 2
    this.size = Math.round(Math.min(Math.max(this.height / 14, 13), 18)) // of letters [px]
  }

  x(metres) {
    return this.left + this.scale * metres
  }

  y(metres) {
    return this.base - this.scale * metres
  }

  // Show items at points [m], where ``state`` is what is known of the moment: F [N], x, intent [m], contact, running.
  draw(shape, points, theme, state = {}) {
    const context = this.context
    this.theme = theme
    this.F = state.F
    this.full = undefined
    this.labels.begin()
    for (let item = 0, at = 0; item < shape.length; at += shape[item++][1]) {
      const [kind, , style] = shape[item]
      if (kind === "frame") this.frame(points.subarray(2 * at))
      if (kind === "force") this.full = style.full
    }
    context.clearRect(0, 0, this.width, this.height)
    context.lineCap = context.lineJoin = "round"
    let at = 0
    for (const [kind, count, style] of shape) {
      const place = points.slice(2 * at, 2 * (at + count))
      for (let i = 0; i < place.length; i += 2) {
        place[i] = this.x(place[i])
        place[i + 1] = this.y(place[i + 1])
      }
      PARTS[kind]?.(this, place, style)
      if (style.name) this.seek(kind, place, style.name)
      at += count
    }
    this.drawScale()
    this.labels.write()
  }

  // What a picture shows may grow: a rod that gets longer stays in it.
  frame([left, bottom, right, top]) {
    const [l, r, b, t] = this.box
    if (Math.abs(l - left) + Math.abs(r - right) + Math.abs(b - bottom) + Math.abs(t - top) > 1e-6) this.show([left, right, bottom, top])
  }

  // Mark at the rim where a body is that left the picture.
  seek(kind, place, name) {
    let [x, y] = place
    if (kind === "area") {
      x = (place[0] + place[4]) / 2
      y = (place[1] + place[5]) / 2
    }
    const floor = this.height - AXIS
    if (x >= 0 && x <= this.width && y >= 0 && y <= floor) return
    const [rx, ry] = [Math.min(Math.max(x, RIM), this.width - RIM), Math.min(Math.max(y, RIM), floor - RIM)]
    const away = Math.hypot(x - rx, y - ry)
    const [ux, uy] = [(x - rx) / away, (y - ry) / away]
    arrow(this, rx - 14 * ux, ry - 14 * uy, rx + (RIM - 2) * ux, ry + (RIM - 2) * uy, WARM)
    const words = `$${TEX[name] || name}$ is ${tidy(Math.round((1000 * away) / this.scale))} mm farther out`
    this.labels.add(words, INK, rx - 14 * ux, ry - 14 * uy, rx - 30 * ux, ry - 30 * uy)
  }

  // How long a length is, and which force a colour tells.
  drawScale() {
    const context = this.context
    const length = niceStep(this.width / this.scale / 12)
    const right = this.width - 10
    const left = right - this.scale * length
    const line = this.height - 10.5
    context.strokeStyle = context.fillStyle = this.theme.quiet
    context.lineWidth = 1
    context.setLineDash([])
    context.font = FONT
    context.textAlign = "right"
    context.textBaseline = "middle"
    context.beginPath()
    context.moveTo(left, line - 4)
    context.lineTo(left, line + 4)
    context.moveTo(left, line)
    context.lineTo(right, line)
    context.moveTo(right, line - 4)
    context.lineTo(right, line + 4)
    context.stroke()
    context.fillText(`${tidy(1000 * length)} mm`, left - 6, line)
    if (!this.full) return
    context.textAlign = "left"
    context.fillText("force 0", 10, line)
    const from = 16 + context.measureText("force 0").width
    for (let k = 0; k < LEVELS; k++) {
      context.fillStyle = this.forceColour((k / (LEVELS - 1)) * this.full)
      context.fillRect(from + 4 * k, line - 4, 4, 8)
    }
    context.fillStyle = this.theme.quiet
    context.fillText(`${tidy(this.full)} N`, from + 4 * LEVELS + 6, line)
  }

  colour(colour) {
    return this.theme.dark ? onDark(this.ink, this.context, colour) : colour
  }

  // From ink at no force to orange at the full one; a small force is seen, too.
  forceColour(force) {
    const level = this.full ? Math.round(Math.sqrt(Math.min(Math.abs(force || 0) / this.full, 1)) * (LEVELS - 1)) : 0
    return this.colour(FORCES[level])
  }
}

const FONT = "12px system-ui, sans-serif"
const AXIS = 20 // [px] below the picture, for its scale
const RIM = 16 // [px] from the rim to the mark of what is beyond it
const LEVELS = 12 // of the colour of a force
const FORCES = Array.from({ length: LEVELS }, (_, k) => "#" + [0xcc, 0x5a, 0x1a].map((part) => Math.round((part * k) / (LEVELS - 1)).toString(16).padStart(2, "0")).join(""))
const TEX = { theta: "\\theta", phi: "\\varphi", psi: "\\psi", alpha: "\\alpha", beta: "\\beta" }

function fit(canvas, width, height) {
  const ratio = window.devicePixelRatio || 1
  canvas.width = Math.round(width * ratio)
  canvas.height = Math.round(height * ratio)
  canvas.style.height = height + "px"
  canvas.getContext("2d").setTransform(ratio, 0, 0, ratio, 0, 0)
}

// The same hue with its lightness turned over, so that black on white becomes white on black; a pale grey stays off the paper.
const DARKEST = 40
function onDark(known, context, colour) {
  if (!known.has(colour)) {
    const [r, g, b, alpha] = components(context, colour)
    const turn = 255 - Math.max(r, g, b) - Math.min(r, g, b)
    const turned = [r, g, b].map((part) => DARKEST + ((255 - DARKEST) * (part + turn)) / 255)
    known.set(colour, `rgba(${turned.map(Math.round).join(", ")}, ${alpha})`)
  }
  return known.get(colour)
}

// Red, green, blue of 0 to 255, and alpha, of any colour that CSS knows.
function components(context, colour) {
  context.save()
  context.fillStyle = "#000"
  context.fillStyle = colour
  const found = context.fillStyle // "#rrggbb", or "rgba(...)" where it is not opaque
  context.restore()
  if (found[0] === "#") return [1, 3, 5].map((i) => parseInt(found.slice(i, i + 2), 16)).concat(1)
  return found.match(/[\d.]+/g).map(Number)
}

function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(least))
  return power * [1, 2, 5, 10].find((factor) => factor * power >= least * 0.999)
}

// A number without the noise of floating point.
function tidy(value) {
  return String(Number(value.toPrecision(6)))
}

// A number for who reads it as it changes.
function shown(value) {
  if (Number.isNaN(value)) return "–"
  const size = Math.abs(value)
  return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2).replace(/^-0.00$/, "0.00")
}
