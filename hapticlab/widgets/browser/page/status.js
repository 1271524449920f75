// What goes on, in words that change only when it does: hapticlab/widgets/status_words.py.

const SLOWEST = 8.0 // [Hz]: a hand moves slower, chatter is faster
const SMALLEST = 2e-5 // [m]: what vibrates moves farther
const MEAN = 0.1 // [s] of a moving mean that takes a hand's own motion away
const SUSTAINED = 0.5 // of the strongest quarter that every other one has: a bounce has less
const SWINGS_LED = 4.0 // a handle that is led further than so many amplitudes meanwhile may feel a grating of the scene
const LATE = 0.02 // [s] of the last second that were dropped and are told
const MUCH = 0.3 // [s] from here on with what to do
const CHANGES = 3 // a contact that begins or ends so often within the recent quarter of a second comes and goes
const SHORTEST = 32 // samples
const REVERSALS = 2 // turns of an oscillation at least
const LAGS = 40 // a sensor's noise has at no lag up to so many samples
const CORRELATED = 0.2 // as large a correlation
const AT_LIMIT = "The motor is at its limit"
const MISSED = "An event was left unlocated: bodies may be inside each other, and a shorter T helps"

// Return what goes on, one or two sentences. vibration, lost, note: in words, or ""
function statusWords(motion, now, { vibration, lost, note }) {
  let said = ["Paused", motion.stepping.fault ? `Stopped: ${motion.stepping.fault}` : "", lost]
  if (motion.replaying) said = ["Replaying a record"]
  else if (motion.running) {
    const runs = motion.speed === 1 ? "Running" : `Running at ${general(motion.speed)} times real time`
    const [, , contact] = motion.rows.last()
    const touched = contactWords(contact.slice(contact.length - Math.ceil(contact.length / 4)))
    const free = motion.held ? "" : "The handle is let go"
    said = [runs + touched, vibration, motion.atLimit ? AT_LIMIT : "", lateWords(motion.pace.behind(now), motion.speed > motion.told.about.slow), free]
  }
  const records = motion.running && !motion.replaying ? "Recording" : "Recording waits"
  said.push(motion.missed ? MISSED : "", motion.recording ? records : "", note)
  return said.filter(Boolean).map((sentence) => `${sentence.replace(/\.+$/, "")}.`).join(" ")
}

// Say whether something is touched, from recent samples of 1 or 0; nothing in a scene where nothing can be.
function contactWords(contact) {
  if (!contact.length || Number.isNaN(contact.at(-1))) return ""
  const changes = contact.filter((now, k) => k && now !== contact[k - 1]).length
  if (changes >= CHANGES) return ", in and out of contact"
  return contact.at(-1) ? ", in contact" : ", not in contact"
}

// Say that the computer did not keep up, from so many seconds that were dropped; or nothing. slower: it could run slower
function lateWords(behind, slower = true) {
  if (behind < LATE) return ""
  const said = `The computer fell behind by ${10 * Math.round(100 * Math.min(behind, TOLD))} ms in the last second`
  return behind < MUCH ? said : `${said}: too slow for this scene; ${slower ? "press M for slow motion" : "close other pages and programs"}`
}

// Say how a handle vibrates where the scene runs, or nothing.
function vibrationWords(motion) {
  const [x, F] = motion.rows.last()
  return motion.running && !motion.replaying ? chatterWords(x, F, motion.stepping.T) : ""
}

// Say how a handle vibrates in its recent second, or nothing; x [m] and F [N], a sample every T [s]. It is called chatter
// where the environment gives energy to a handle that is not led on.
function chatterWords(x, F, T) {
  const width = Math.max(1, Math.round(MEAN / T))
  if (x.length < Math.max(SHORTEST + width - 1, 4 * width) || !(extent(x) > SMALLEST) || !F.some(Boolean)) return ""
  const total = [0]
  for (const place of x) total.push(total.at(-1) + place)
  const mean = Float64Array.from({ length: x.length - width + 1 }, (_, k) => (total[k + width] - total[k]) / width)
  const fast = mean.map((slow, k) => x[k + (width >> 1)] - slow)
  const strengths = split(fast.subarray(fast.length >> 1), 4).map(deviation)
  if (!(Math.min(...strengths) >= SUSTAINED * Math.max(...strengths))) return ""
  const { frequency, amplitude } = oscillation(fast, T) ?? {}
  if (!(frequency >= SLOWEST && amplitude >= SMALLEST)) return ""
  const level = sum(F) / F.length
  let drawn = 0
  for (let k = 0; k < F.length - 1; k++) drawn -= (F[k] - level) * (x[k + 1] - x[k])
  const chatters = drawn > 0 && extent(mean.subarray(fast.length >> 1)) < SWINGS_LED * amplitude
  return `${chatters ? "Chatter" : "The handle vibrates"}: ${Number((1e3 * amplitude).toPrecision(1))} mm at ${frequency.toFixed(0)} Hz`
}

// The frequency [Hz] and amplitude [m] of the last half of a motion, or null where it does not oscillate: of
// hapticlab.chatter what the words above need.
function oscillation(x, T) {
  const quarter = x.subarray(x.length - (x.length >> 2))
  const half = x.subarray(x.length - (x.length >> 1))
  const largest = x.reduce((most, place) => Math.max(most, Math.abs(place)), 0)
  const least = Math.max(1e-9, 1e-6 * extent(x), 4 * 2 ** -23 * largest)
  const [y, window] = aroundTrend(quarter)
  const strength = Math.sqrt(2 * sum(y.map((each, k) => window[k] * each ** 2)))
  if (reversals(half) < REVERSALS || strength < least) return null
  const [swing] = aroundTrend(half)
  const rises = upwardCrossings(swing)
  if (isScatter(swing) || rises.length < 2) return null
  return { frequency: (rises.length - 1) / ((rises.at(-1) - rises[0]) * T), amplitude: extent(swing) / 2 }
}

// A motion less its straight line, fitted under a Hann window, and the window.
function aroundTrend(x) {
  const size = x.length
  const hann = Float64Array.from({ length: size }, (_, k) => 0.5 - 0.5 * Math.cos((2 * Math.PI * (k + 1)) / (size + 1)))
  const whole = sum(hann)
  const window = hann.map((weight) => weight / whole)
  const n = window.map((_, k) => (2 * k) / (size - 1) - 1)
  const level = sum(x.map((place, k) => window[k] * place))
  const slope = sum(x.map((place, k) => window[k] * n[k] * (place - level))) / sum(n.map((at, k) => window[k] * at ** 2))
  return [x.map((place, k) => place - level - slope * n[k]), window]
}

function reversals(x) {
  let [turns, before] = [0, 0]
  for (let k = 1; k < x.length; k++) {
    const way = Math.sign(x[k] - x[k - 1])
    if (way && before && way !== before) turns++
    before = way || before
  }
  return turns
}

// Where y rises through zero, in samples; swings below a quarter of its rms do not count.
function upwardCrossings(y) {
  const level = 0.25 * Math.sqrt(sum(y.map((each) => each ** 2)) / y.length)
  const found = []
  let before = null
  y.forEach((value, k) => {
    if (!(Math.abs(value) > level)) return
    if (before !== null && y[before] < 0 && value > 0) found.push(before + ((k - before) * y[before]) / (y[before] - value))
    before = k
  })
  return found
}

// Whether it is white noise of a sensor: a handle has mass and cannot jump about so.
function isScatter(y) {
  const power = sum(y.map((each) => each ** 2))
  for (let lag = 1; lag <= Math.min(LAGS, y.length >> 2); lag++) {
    let alike = 0
    for (let k = lag; k < y.length; k++) alike += y[k] * y[k - lag]
    if (!(Math.abs(alike) < CORRELATED * power)) return false
  }
  return power > 0
}

function sum(values) {
  return values.reduce((total, value) => total + value, 0)
}

function extent(values) {
  let [low, high] = [Infinity, -Infinity]
  for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)]
  return high - low
}

function deviation(values) {
  const mean = sum(values) / values.length
  return Math.sqrt(sum(values.map((value) => (value - mean) ** 2)) / values.length)
}

// So many parts, the first ones longer by one where they cannot be alike.
function split(values, parts) {
  const size = Math.floor(values.length / parts)
  const more = values.length % parts
  const end = (k) => k * size + Math.min(k, more)
  return Array.from({ length: parts }, (_, k) => values.subarray(end(k), end(k + 1)))
}
