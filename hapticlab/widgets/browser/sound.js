// What the scene sounds like: the force at the pitch of scene time, and a soft tap where a contact begins. Nothing here
// plays before a hand asks for it. Plain nodes alone: a worklet needs a secure page.

const LEVEL = 0.2 // of full scale, at most
const AHEAD = 0.06 // [s] that sound is behind the picture, so that it does not break off where a frame is late
const PILED = 0.3 // [s] of sound that wait at most
const RAMP = 0.03 // [s] in which it grows loud or silent: a step would click
const DEEPEST = 80 // [Hz]: a hand's own motion is not heard, a chatter is by its overtones
const APART = 0.12 // [s] between two taps
const HARD = 0.3 // [m/s] of a handle whose tap is as loud as taps are

// A voice in any audio context, so that a test can render it without a loudspeaker.
class Voice {
  constructor(context, full = 3) {
    this.context = context
    this.full = full // [N] that sounds as loud as it gets
    this.next = 0 // when the next piece begins
    this.tapped = -Infinity
    this.before = 0 // the last force, from which the next piece goes on
    this.input = context.createBiquadFilter()
    this.input.type = "highpass"
    this.input.frequency.value = DEEPEST
    const shaper = context.createWaveShaper() // bends what is louder, and never passes 1
    shaper.curve = Float32Array.from({ length: 1025 }, (_, k) => Math.tanh((k - 512) / 256))
    this.volume = context.createGain()
    this.volume.gain.value = 0
    this.input.connect(shaper).connect(this.volume).connect(context.destination)
  }

  // Grow loud or silent.
  open(on) {
    const now = this.context.currentTime
    this.volume.gain.cancelScheduledValues(now)
    this.volume.gain.setTargetAtTime(on ? LEVEL : 0, now, RAMP / 3)
  }

  // Play forces [N], so far apart in scene time [s], at a speed of scene time over the clock's.
  feed(forces, apart, speed) {
    const { context } = this
    const now = context.currentTime
    const rate = context.sampleRate
    const length = Math.round((forces.length * apart * rate) / speed)
    if (length < 1 || !forces.every(Number.isFinite)) return
    if (this.next < now + 0.005 || this.next > now + PILED) this.next = Math.ceil((now + AHEAD) * rate) / rate
    const piece = context.createBuffer(1, length, rate)
    const values = piece.getChannelData(0)
    for (let k = 0; k < length; k++) {
      const place = ((k + 1) * forces.length) / length - 1
      const left = Math.floor(place)
      const from = left < 0 ? this.before : forces[left]
      values[k] = (from + (place - left) * (forces[Math.min(left + 1, forces.length - 1)] - from)) / this.full
    }
    this.before = forces[forces.length - 1]
    this.play(piece, this.next)
    this.next += length / rate
  }

  // A tap for a contact that began at a speed [m/s].
  tap(speed) {
    const { context } = this
    const now = context.currentTime
    if (now < this.tapped + APART) return
    this.tapped = now
    const rate = context.sampleRate
    const piece = context.createBuffer(1, Math.round(0.06 * rate), rate)
    const loud = 0.6 * Math.min(Math.max(Math.abs(speed) / HARD, 0.15), 1)
    piece.getChannelData(0).forEach((_, k, values) => {
      const t = k / rate
      values[k] = loud * Math.min(t / 0.003, 1) * Math.exp(-t / 0.012) * Math.sin(2 * Math.PI * 220 * t)
    })
    this.play(piece, now + AHEAD)
  }

  play(piece, when) {
    const source = this.context.createBufferSource()
    source.buffer = piece
    source.connect(this.input)
    source.start(when)
  }
}

// The voice of a live view: silent unless it is asked for, and while nothing moves or nobody sees it.
class Sound {
  constructor(samples) {
    this.samples = samples
    this.on = false
    this.heard = false
  }

  // A hand asks for sound, or for silence: a gesture, without which a browser plays nothing.
  toggle() {
    this.on = !this.on
    if (this.on && !this.voice) this.voice = new Voice(new AudioContext())
    this.follow(this.moves)
  }

  // Be heard while the scene moves and is seen.
  follow(moves) {
    this.moves = moves
    const heard = Boolean(this.on && moves)
    if (this.on && heard) this.voice.context.resume() // also after a telephone interrupted it
    if (heard === this.heard) return
    this.heard = heard
    this.voice.open(heard)
    clearTimeout(this.ending)
    if (!heard) this.ending = setTimeout(() => this.voice.context.suspend(), 5000 * RAMP)
  }

  // Play the rows that came last.
  play(count, speed) {
    const { samples } = this
    const { apart } = samples
    if (!this.heard || !count || this.voice.context.state !== "running") return
    const from = samples.count - count
    this.voice.feed(Array.from({ length: count }, (_, k) => samples.at(from + k, "F_applied")), apart, speed)
    for (let row = from; row < samples.count; row++) {
      if (row === samples.oldest || samples.at(row, "contact") !== 1 || samples.at(row - 1, "contact") !== 0) continue
      this.voice.tap((samples.at(row, "x_true") - samples.at(row - 1, "x_true")) / apart)
      return
    }
  }

  close() {
    clearTimeout(this.ending)
    this.voice?.context.close()
  }
}
