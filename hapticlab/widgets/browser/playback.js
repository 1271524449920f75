// When each frame is shown. Frames carry the kernel's clock; a network that holds packets back delivers them in bunches.
// Where they arrive evenly the newest is shown at once. Where they do not, they are played back as evenly as they were
// made, a little late, and the picture between two of them is interpolated.

const EVEN = 0.025 // [s] lateness of three frames in four up to which the newest is shown at once
const LATEST = 0.15 // [s] the playback is never further behind
const REMEMBERED = 64 // frames whose lateness counts
const HELD = 5 // [s] of frames wait at most to be shown: a tab that nobody sees shows none

class Playback {
  constructor() {
    this.queue = [] // frames not yet passed, oldest first
    this.current = null
    this.offsets = [] // [s] arrival minus dispatch; two clocks, so only differences mean anything
    this.gaps = []
  }

  push(frame, now) {
    frame.arrived = now
    const offset = now - frame.sent
    if (this.last !== undefined) remember(this.gaps, Math.min(frame.sent - this.last, 0.1))
    remember(this.offsets, offset)
    this.last = frame.sent
    this.queue.push(frame)
    while (frame.sent - this.queue[0].sent > HELD) this.queue.shift()
  }

  // How far behind the fastest packet the picture has to be [s]; 0 where frames arrive evenly.
  delay() {
    const fastest = Math.min(...this.offsets)
    if (quantile(this.offsets, 0.75) - fastest <= EVEN) return 0 // a busy computer is late now and then, a network often
    return Math.min(quantile(this.offsets, 0.9) - fastest + quantile(this.gaps, 0.5), LATEST)
  }

  // Return {frame, next, part, passed}: what to show now, and the frames whose rows have come due.
  at(now) {
    const delay = this.delay()
    const moment = delay ? now - Math.min(...this.offsets) - delay : Infinity
    const passed = []
    while (this.queue.length && this.queue[0].sent <= moment) passed.push(this.queue.shift())
    if (passed.length) this.current = passed[passed.length - 1]
    const next = this.queue[0]
    const part = this.current && next ? (moment - this.current.sent) / (next.sent - this.current.sent) : 0
    return { frame: this.current, next, part: Math.min(Math.max(part, 0), 1), passed }
  }

  get waiting() {
    return this.queue.length > 0
  }
}

function remember(values, value) {
  values.push(value)
  if (values.length > REMEMBERED) values.shift()
}

function quantile(values, part) {
  const sorted = [...values].sort((a, b) => a - b)
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))] : 0
}
