// The moving picture: a display list in metres, drawn on a canvas.

// A frame's bytes: dispatch [s], scene time [s], number of rows as float64; the rows; then every point of the picture.
const COLUMNS = 5 // t, x, F, E, intent

function decode(buffer, shape) {
  const [sent, time, count] = new Float64Array(buffer.slice(0, 24))
  const numbers = new Float32Array(buffer.slice(24))
  const rows = numbers.subarray(0, count * COLUMNS)
  return { sent, time, rows, points: numbers.subarray(count * COLUMNS), shape }
}

// A point of what is shown: between this frame and the next, if both have the same items.
function between(frame, next, part) {
  if (!next || !part || next.points.length !== frame.points.length) return frame.points
  const a = frame.points
  const b = next.points
  return a.map((value, i) => value + part * (b[i] - value))
}

class Picture {
  constructor(canvas, about) {
    this.canvas = canvas
    this.context = canvas.getContext("2d")
    this.box = about.box // left, right, bottom, top [m]
    this.ink = new Map()
  }

  // Take so much room [px]; without a height, as much as the picture needs of it.
  resize(width, height) {
    const [left, right, bottom, top] = this.box
    this.width = width
    const most = Math.min(Math.max(0.4 * window.innerHeight, 160), 300)
    this.height = height || Math.min(Math.max((width * (top - bottom)) / (right - left), 130), most)
    this.font = `${Math.round(Math.min(Math.max(width / 60, 12), 16))}px system-ui, sans-serif`
    fit(this.canvas, this.width, this.height)
    this.scale = Math.min(width / (right - left), (this.height - AXIS) / (top - bottom))
    this.left = width / 2 - (this.scale * (left + right)) / 2
    this.base = (this.height - AXIS) / 2 + (this.scale * (bottom + top)) / 2
  }

  x(metres) {
    return this.left + this.scale * metres
  }

  y(metres) {
    return this.base - this.scale * metres
  }

  // Show items at points [m], where ``state`` is what is known of the moment: F [N], x, intent [m], contact, running.
  draw(shape, points, theme, state = {}) {
    this.state = state
    const context = this.context
    context.clearRect(0, 0, this.width, this.height)
    this.theme = theme
    this.drawScale()
    let at = 0
    for (const item of shape) {
      const count = item[1]
      DRAWN[item[0]](this, context, points.subarray(2 * at, 2 * (at + count)), item)
      at += count
    }
  }

  // How long a length is: heights and widths are to the same scale.
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
  }

  colour(colour) {
    return this.theme.dark ? onDark(this.ink, this.context, colour) : colour
  }
}

const FONT = "12px system-ui, sans-serif"
const AXIS = 20 // [px] below the picture, for its scale

function trace(picture, context, points) {
  context.beginPath()
  for (let i = 0; i < points.length; i += 2) context.lineTo(picture.x(points[i]), picture.y(points[i + 1]))
}

const DRAWN = {
  line(picture, context, points, [, , width, colour, dash]) {
    trace(picture, context, points)
    context.lineWidth = width
    context.setLineDash(dash || [])
    context.strokeStyle = picture.colour(colour)
    context.stroke()
  },

  area(picture, context, points, [, , fill, edge]) {
    trace(picture, context, points)
    context.closePath()
    if (fill && fill !== "none") {
      context.fillStyle = picture.colour(fill)
      context.fill()
    }
    if (!edge || edge === "none") return
    context.lineWidth = 1.5
    context.setLineDash([])
    context.strokeStyle = picture.colour(edge)
    context.stroke()
  },

  text(picture, context, points, [, , string, colour]) {
    context.font = picture.font
    context.textAlign = "center"
    context.textBaseline = "middle"
    const half = context.measureText(string).width / 2
    const x = Math.min(Math.max(picture.x(points[0]), half + 2), picture.width - half - 2)
    write(picture, string, x, Math.min(Math.max(picture.y(points[1]), 10), picture.height - 10), colour)
  },

  arrow(picture, context, points, [, , colour, label]) {
    const [x0, y0, x1, y1] = [picture.x(points[0]), picture.y(points[1]), picture.x(points[2]), picture.y(points[3])]
    const length = Math.hypot(x1 - x0, y1 - y0)
    context.fillStyle = context.strokeStyle = picture.colour(colour)
    if (length > 1) {
      const head = Math.min(12, length)
      const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length]
      const [bx, by] = [x1 - head * ux, y1 - head * uy]
      context.lineWidth = 4
      context.setLineDash([])
      context.beginPath()
      context.moveTo(x0, y0)
      context.lineTo(bx, by)
      context.stroke()
      context.beginPath()
      context.moveTo(x1, y1)
      context.lineTo(bx - 0.5 * head * uy, by + 0.5 * head * ux)
      context.lineTo(bx + 0.5 * head * uy, by - 0.5 * head * ux)
      context.fill()
    }
    if (!label) return
    context.font = "bold " + picture.font
    context.textAlign = x1 < x0 ? "right" : "left"
    context.textBaseline = "bottom"
    write(picture, label, Math.min(Math.max(x1, 60), picture.width - 60), y1 - 8, colour)
  },
}

// Write a text on a rim of paper, so that lines under it do not strike it through.
function write(picture, string, x, y, colour) {
  const context = picture.context
  context.setLineDash([])
  context.lineWidth = 4
  context.lineJoin = "round"
  context.strokeStyle = picture.theme.paper
  context.strokeText(string, x, y)
  context.fillStyle = picture.colour(colour)
  context.fillText(string, x, y)
}

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

function shown(value) {
  const size = Math.abs(value)
  return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2).replace(/^-0.00$/, "0.00")
}
