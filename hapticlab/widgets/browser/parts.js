// The parts of a moving picture on a canvas: each draws itself at places in pixels, and tells labels where its lines are.

const INK = "#000000"
const SOFT = "#8a8a8a"
const HANDLE = "#3f5563"
const HAND = "#1a4b84"
const WARM = "#cc5a1a"
const PAPER = "#ffffff"
const MEDIUM = "#e9ebee"
const MOST = 1.5 // times the full force, up to which an arrow grows

const PARTS = {
  line(picture, place, { width, colour, dash }) {
    path(picture, place)
    stroke(picture, picture.colour(colour), width, dash)
  },

  area(picture, place, { fill, edge }) {
    path(picture, place, true)
    const box = [Infinity, Infinity, -Infinity, -Infinity]
    for (let i = 0; i < place.length; i++) {
      box[i % 2] = Math.min(box[i % 2], place[i])
      box[2 + (i % 2)] = Math.max(box[2 + (i % 2)], place[i])
    }
    picture.labels.solid(...box)
    paint(picture, fill, edge)
  },

  disc(picture, [x, y, rx, ry], { fill, edge, mark }) {
    circle(picture, x, y, Math.hypot(rx - x, ry - y))
    paint(picture, fill, edge)
    if (!mark) return
    path(picture, [x, y, rx, ry])
    stroke(picture, picture.colour(SOFT), 1)
  },

  gear(picture, [x, y, tx, ty], { teeth, deep, fill }) {
    const tooth = deep * picture.scale
    const radius = Math.hypot(tx - x, ty - y) - tooth
    const turn = Math.atan2(ty - y, tx - x)
    const context = picture.context
    context.beginPath()
    for (let k = 0; k < 4 * teeth; k++) { // a tooth is a foot, a flank, a head, a flank
      const at = turn + ((k - 1.5 + (k % 2 ? -0.2 : 0.2)) * Math.PI) / (2 * teeth)
      const reach = radius + (k % 4 === 1 || k % 4 === 2 ? tooth : -tooth)
      context.lineTo(x + reach * Math.cos(at), y + reach * Math.sin(at))
    }
    context.closePath()
    paint(picture, fill, INK)
    octagon(picture, x, y, radius)
  },

  arrow(picture, [x0, y0, x1, y1], { colour }) {
    arrow(picture, x0, y0, x1, y1, colour)
  },

  label(picture, place, { words, colour }) {
    picture.labels.add(words, colour, ...place)
  },

  spring(picture, ends, style) {
    const [at, length] = along(ends)
    const high = style.high * picture.scale
    const lead = Math.min(0.2, (1.5 * high) / length)
    const turns = 2 * style.coils
    const coil = [...at(0), ...at(lead)]
    for (let k = 0; k < turns; k++) coil.push(...at(lead + ((1 - 2 * lead) * (k + 0.5)) / turns, k % 2 ? -high : high))
    path(picture, coil.concat(at(1 - lead), at(1)), false, false)
    stroke(picture, carried(picture, style, length), 1.6)
    sides(picture, at, high)
  },

  damper(picture, ends, style) {
    const [at, length] = along(ends)
    const high = style.high * picture.scale
    const cup = Math.min(4.5 * high, 0.6 * length) / length // keeps its size while the piston's rod gets longer
    const [begin, end, piston] = [0.5 - cup / 2, 0.5 + cup / 2, 0.5 - 0.2 * cup]
    const colour = carried(picture, style, length)
    path(picture, [...at(0), ...at(begin)], false, false)
    stroke(picture, colour, 1.4)
    path(picture, [...at(end, high), ...at(begin, high), ...at(begin, -high), ...at(end, -high)], false, false)
    stroke(picture, colour, 1.4)
    path(picture, [...at(piston, 0.75 * high), ...at(piston, -0.75 * high)], false, false)
    stroke(picture, colour, 2.4)
    path(picture, [...at(piston), ...at(1)], false, false)
    stroke(picture, colour, 1.4)
    sides(picture, at, high)
  },

  ground(picture, ends, { deep }) {
    const [at, length] = along(ends)
    const far = deep * picture.scale
    const step = Math.max(Math.abs(far), 4)
    path(picture, ends)
    stroke(picture, picture.colour(INK), 1.6)
    const context = picture.context
    context.beginPath()
    for (let way = step; way < length; way += step) {
      context.moveTo(...at(way / length))
      context.lineTo(...at((way - step) / length, far))
    }
    stroke(picture, picture.colour(INK), 0.8)
    picture.labels.line(...at(0, far), ...at(1, far))
  },

  // A wall gives where a face is beyond its boundary: the rim is at the face there.
  wall(picture, place, style) {
    const [at, length] = along([place[0], place[1], place[4], place[5]])
    const depth = ((place[2] - place[0]) * (place[4] - place[0]) + (place[3] - place[1]) * (place[5] - place[1])) / length
    const { scale } = picture
    const far = 2 * (picture.width + picture.height)
    const flat = (inside, across) => at(inside / length, across)
    const rim = dent(depth, style.face * scale, style.high * scale).flatMap(([inside, across]) => flat(inside, across))
    const outline = [...flat(0, -far), ...rim, ...flat(0, far)]
    path(picture, [...outline, ...flat(far, far), ...flat(far, -far)], true, false)
    paint(picture, MEDIUM, "")
    for (let layer = 1; layer < 5; layer++) { // pressed together where the face is
      const [deeper, left] = [layer * 22, 0.55 ** layer]
      const pressed = dent(depth * left, style.face * scale, style.high * scale).flatMap(([inside, across]) => flat(deeper + inside, across))
      path(picture, [...flat(deeper, -far), ...pressed, ...flat(deeper, far)], false, false)
      stroke(picture, picture.theme.grid, 1.5)
    }
    path(picture, outline)
    stroke(picture, picture.forceColour(depth > 0 ? picture.F : 0), 2.5)
  },

  track(picture, [left, level, right], { heights }) {
    const rim = heights.flatMap((height, k) => [left + ((right - left) * k) / (heights.length - 1), level - height * picture.scale])
    const beyond = picture.height
    path(picture, [...rim, right, beyond, left, beyond], true, false)
    paint(picture, MEDIUM, "")
    path(picture, rim)
    stroke(picture, picture.colour(INK), 1.8)
  },

  // Its face is exactly at the first place, whatever stands behind it.
  handle(picture, [fx, fy, bx, by, kx, ky], style) {
    const { context, scale } = picture
    const [mx, my] = [(fx + bx) / 2, (fy + by) / 2]
    const way = Math.hypot(kx - mx, ky - my)
    const [ux, uy] = [((kx - mx) / way) * style.high * scale, ((ky - my) / way) * style.high * scale]
    const blade = Math.hypot(fx - bx, fy - by) <= 1 && style.high
    context.lineCap = "butt"
    path(picture, [blade ? mx + ux : mx, blade ? my + uy : my, kx, ky])
    stroke(picture, picture.colour(HANDLE), 6)
    if (!blade && style.high) {
      path(picture, [fx + ux, fy + uy, fx - ux, fy - uy, bx - ux, by - uy, bx + ux, by + uy], true)
      paint(picture, HANDLE, "")
    } else if (blade) {
      path(picture, [mx - ux, my - uy, mx + ux, my + uy])
      stroke(picture, picture.colour(HANDLE), 2)
    }
    context.lineCap = "round"
    circle(picture, kx, ky, style.round * scale)
    paint(picture, HANDLE, "")
  },

  // A hand pulls the knob by a spring to where it aims.
  hand(picture, ends, style) {
    const round = style.round * picture.scale
    const [at, length] = along(ends)
    const pulled = picture.colour(HAND)
    if (length > 3) {
      const turns = [...at(0)]
      for (let k = 0; k < 16; k++) turns.push(...at((k + 0.5) / 16, (k % 2 ? -0.45 : 0.45) * round))
      path(picture, turns.concat(at(1)), false, false)
      stroke(picture, picture.theme.paper, 4)
      path(picture, turns.concat(at(1)), false, false)
      stroke(picture, pulled, 1.8)
      sides(picture, at, 0.45 * round)
    }
    circle(picture, ends[2], ends[3], 0.62 * round)
    paint(picture, PAPER, HAND, 2.5)
  },

  // The motor acts on the handle, against the force on the environment.
  force(picture, [x, y, tx, ty], { full }) {
    if (!Number.isFinite(picture.F)) return
    const level = Math.min(Math.abs(picture.F) / full, MOST)
    const [ex, ey] = [x + level * (tx - x), y + level * (ty - y)]
    const pulls = -picture.F * (picture.along[0] * (tx - x) - picture.along[1] * (ty - y)) > 0
    const [ax, ay, bx, by] = pulls ? [x, y, ex, ey] : [ex, ey, x, y]
    if (level > 0.02) arrow(picture, ax, ay, bx, by, null, picture.forceColour(picture.F))
    const away = Math.hypot(tx - x, ty - y)
    const [ux, uy] = [(tx - x) / away, (ty - y) / away]
    picture.labels.add(`motor ${Math.abs(picture.F).toFixed(1)} N`, INK, ex, ey, ex + 3.9 * picture.size * ux, ey + 1.1 * picture.size * uy)
  },
}

// A function from (part of the way between two places, pixels to the right of it) to a place, and the way's length.
function along([x0, y0, x1, y1]) {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1e-6
  const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length]
  return [(part, right = 0) => [x0 + part * length * ux - right * uy, y0 + part * length * uy + right * ux], length]
}

// The rim of a wall that gives: pairs (how far in, how far across).
function dent(depth, face, high) {
  if (depth <= 0) return [[0, -high], [0, high]]
  const slope = Math.max(Math.min(Math.max(1.2 * depth, 0.25 * face), high - face), 0)
  const half = Array.from({ length: 9 }, (_, k) => [depth * (0.5 + 0.5 * Math.cos((Math.PI * k) / 8)), face + (slope * k) / 8])
  return [...half.map(([inside, across]) => [inside, -across]).reverse(), ...half]
}

function carried(picture, style, length) {
  if (style.carries) return picture.forceColour(picture.F)
  return style.k === undefined || style.k === null ? picture.colour(INK) : picture.forceColour(style.k * (length / picture.scale - style.rest))
}

function path(picture, place, closed = false, told = true) {
  const context = picture.context
  context.beginPath()
  for (let i = 0; i < place.length; i += 2) context.lineTo(place[i], place[i + 1])
  if (closed) context.closePath()
  if (told) picture.labels.lines(place, closed)
}

function circle(picture, x, y, radius) {
  picture.context.beginPath()
  picture.context.arc(x, y, radius, 0, 2 * Math.PI)
  octagon(picture, x, y, radius)
}

function octagon(picture, x, y, radius) {
  picture.labels.lines(OCTAGON.map((part, i) => (i % 2 ? y : x) + radius * part), true)
  picture.labels.solid(x - radius, y - radius, x + radius, y + radius)
}

const OCTAGON = Array.from({ length: 16 }, (_, i) => (i % 2 ? Math.sin : Math.cos)((Math.PI / 4) * (i >> 1)))

function sides(picture, at, high) {
  picture.labels.line(...at(0, high), ...at(1, high))
  picture.labels.line(...at(0, -high), ...at(1, -high))
}

function stroke(picture, colour, width, dash = NONE) {
  const context = picture.context
  context.setLineDash(dash)
  context.lineWidth = width
  context.strokeStyle = colour
  context.stroke()
}

const NONE = []

function paint(picture, fill, edge, width = 1.5) {
  if (fill && fill !== "none") {
    picture.context.fillStyle = picture.colour(fill)
    picture.context.fill()
  }
  if (edge && edge !== "none") stroke(picture, picture.colour(edge), width)
}

function arrow(picture, x0, y0, x1, y1, colour, shown = picture.colour(colour)) {
  const length = Math.hypot(x1 - x0, y1 - y0)
  if (length < 1) return
  const context = picture.context
  const head = Math.min(10, length)
  const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length]
  const [bx, by] = [x1 - head * ux, y1 - head * uy]
  path(picture, [x0, y0, bx, by])
  stroke(picture, shown, colour ? 1.6 : 4)
  const wide = colour ? 0.38 : 0.6
  context.beginPath()
  context.moveTo(x1, y1)
  context.lineTo(bx - wide * head * uy, by + wide * head * ux)
  context.lineTo(bx + wide * head * uy, by - wide * head * ux)
  context.fillStyle = shown
  context.fill()
}
