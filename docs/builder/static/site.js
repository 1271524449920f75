// Whatever scrolls in itself can be reached by the keyboard.
"use strict"
const reachable = () => {
  for (const each of document.querySelectorAll(".bd-article mjx-container, .bd-article pre, .bd-article .pst-scrollable-table-container")) {
    if (each.scrollWidth > each.clientWidth) each.tabIndex = 0
    else if (each.tagName !== "PRE") each.removeAttribute("tabindex")
  }
}
addEventListener("load", () => {
  const typeset = window.MathJax?.startup?.promise ?? Promise.resolve()
  typeset.then(reachable)
})
addEventListener("resize", reachable)
