// Whatever scrolls in itself can be reached by the keyboard.
"use strict"
const reachable = () => {
  for (const each of document.querySelectorAll(".bd-article mjx-container, .bd-article pre, .bd-article .pst-scrollable-table-container")) {
    if (each.scrollWidth > each.clientWidth) each.tabIndex = 0
    else if (each.tagName.startsWith("MJX") && each.getBoundingClientRect().right > innerWidth) each.classList.add("scrolls")
    else if (each.tagName !== "PRE") each.removeAttribute("tabindex")
  }
}
// Folding a branch of the side bar is named after the page that it is of.
for (const summary of document.querySelectorAll("nav li > details > summary")) {
  const link = summary.closest("li").querySelector("a")
  if (link) summary.setAttribute("aria-label", `Pages of ${link.textContent.trim()}`)
}
addEventListener("load", () => {
  const typeset = window.MathJax?.startup?.promise ?? Promise.resolve()
  typeset.then(reachable)
})
addEventListener("resize", reachable)
