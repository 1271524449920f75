// The handle, the hand that leads it and the motor's force: a picture of any scene.

const THICK = 0.0014 // [m] of the handle, times the picture's width over 0.1 m
const KNOB = 0.0083 // [m] from the handle's middle to its knob

class PlainPicture {
  // about: of the view; full: the force that is shown in full [N]
  constructor({ along, box }, full) {
    const [left, right, bottom, top] = box
    const u = Math.max((right - left) / 0.1, (top - bottom) / 0.026)
    Object.assign(this, { along, u, full, frame: [left, bottom, right, top] })
  }

  // The items of one moment and their points.
  at({ x, intent }) {
    const { u, along: [a, b] } = this
    const at = (way, across) => [a * way - b * across, b * way + a * across]
    const knob = at(x - (THICK * u) / 2, KNOB * u)
    const handle = [...at(x, 0), ...at(x - THICK * u, 0), ...knob]
    const force = [...at(x - THICK * u, -0.0039 * u), ...at(x - 0.0194 * u, -0.0039 * u)]
    const hand = Number.isFinite(intent) ? [...knob, knob[0] + a * (intent - x), knob[1] + b * (intent - x)] : []
    const round = 0.0022 * u
    const shape = [["handle", 3, { high: 0.0055 * u, round }], ["force", 2, { full: this.full }]]
    if (hand.length) shape.push(["hand", 2, { round }])
    return { shape: [...shape, ["frame", 2, {}]], points: [...handle, ...force, ...hand, ...this.frame] }
  }
}
