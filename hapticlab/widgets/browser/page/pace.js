// Ticks that are due by the clock, counted from where it began so that nothing drifts: Pace of hapticlab/widgets/pace.py.

const LONGEST_MADE_UP = 0.05 // [s] of the clock that are made up for at once; what is more is dropped, and told
const WORK = 0.02 // [s] that one turn may compute, so that inputs and pictures go on where the computer is slow
const TOLD = 1.0 // [s] that what was dropped is told

class Pace {
  // T: period [s]; speed: scene time over the clock's
  constructor(T, speed) {
    Object.assign(this, { T, speed, dropped: [], cost: 0 })
    this.start(0)
  }

  // Count from here on [s].
  start(now) {
    Object.assign(this, { begun: now, done: 0 })
  }

  // Go on at another speed from the last tick that was due.
  passAt(speed) {
    this.begun += (this.done * this.T) / this.speed
    Object.assign(this, { done: 0, speed })
  }

  // Return the ticks to do now.
  due(now) {
    let wanted = Math.trunc(((now - this.begun) * this.speed) / this.T + 1e-6) - this.done
    let most = (LONGEST_MADE_UP * this.speed) / this.T
    if (this.cost) most = Math.min(most, WORK / this.cost)
    most = Math.max(1, Math.trunc(most + 1e-6))
    if (wanted > most) {
      const late = ((wanted - most) * this.T) / this.speed
      this.begun += late
      this.dropped.push([now, late])
      wanted = most
    }
    this.done += Math.max(wanted, 0)
    return Math.max(wanted, 0)
  }

  // Note how long ticks took to compute [s].
  spent(ticks, seconds) {
    if (ticks) this.cost += 0.2 * (seconds / ticks - this.cost)
  }

  // Time of the clock that was dropped within the last second [s].
  behind(now) {
    while (this.dropped.length && this.dropped[0][0] < now - TOLD) this.dropped.shift()
    return this.dropped.reduce((sum, [, late]) => sum + late, 0)
  }
}
