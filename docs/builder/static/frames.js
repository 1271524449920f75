// Tell each live frame whether the page around it is light or dark: at once when it is loaded, and when the reader changes it.

const themeOfPage = () => (document.documentElement.dataset.theme === "dark" ? "dark" : "light")
const tellTheme = (frame) => frame.contentWindow.postMessage({ theme: themeOfPage() }, "*")
const liveFrames = () => document.querySelectorAll(".hl-frame iframe")

document.addEventListener("load", ({ target }) => target.matches?.(".hl-frame iframe") && tellTheme(target), true)
document.addEventListener("DOMContentLoaded", () => liveFrames().forEach(tellTheme)) // one may have been loaded before this script
new MutationObserver(() => liveFrames().forEach(tellTheme)).observe(document.documentElement, { attributeFilter: ["data-theme"] })
