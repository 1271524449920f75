// What the page of a real paddle does when it is opened: it shows what can be chosen, and waits.

if (typeof document !== "undefined") {
  const element = (id) => document.getElementById(`hl-${id}`)
  const page = new PaddlePage(JSON.parse(element("data").textContent), element)
  page.choose()
}
