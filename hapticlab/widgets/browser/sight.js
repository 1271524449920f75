// Whether something can be seen: it is on the screen, in a tab that is not hidden.

// Call changed(seen) at first and when that changes; return what ends this.
function watchSight(element, changed) {
  let [on, before] = [false, undefined]
  const look = () => {
    const seen = on && !document.hidden
    if (seen !== before) changed(seen)
    before = seen
  }
  const observer = new IntersectionObserver((entries) => {
    on = entries[entries.length - 1].isIntersecting
    look()
  })
  observer.observe(element)
  document.addEventListener("visibilitychange", look)
  return () => {
    observer.disconnect()
    document.removeEventListener("visibilitychange", look)
  }
}
