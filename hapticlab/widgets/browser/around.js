// Beside plain widgets in one box: gives them names, and keeps a notebook from taking their keys for its own.

const OFTEN = 300 // [ms]: the widgets beside it appear when they like

function render({ model, el }) {
  const tend = () => {
    const box = el.closest(".widget-vbox")
    if (!box) return
    for (const each of box.querySelectorAll("button, input, [tabindex]")) each.dataset.lmSuppressShortcuts = "true"
    for (const row of box.querySelectorAll(".widget-slider")) {
      row.querySelector("[role=slider]")?.setAttribute("aria-label", row.querySelector("label")?.textContent ?? "")
    }
    for (const image of box.querySelectorAll("img")) image.alt = model.get("words")
  }
  const heart = setInterval(tend, OFTEN)
  return () => clearInterval(heart)
}

export default { render }
