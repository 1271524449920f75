// What a shared file does when it is opened: it takes the data out of the page, and shows the view where they run.

const NO_WEBASSEMBLY = "This browser does not run WebAssembly, which the scene needs. Open the page in a current browser. An iPhone or iPad "
  + "runs it from a web address, not from a file."

async function openShared(told) {
  if (typeof WebAssembly === "undefined") throw new Error(NO_WEBASSEMBLY)
  const loops = Object.entries(told.programs)
  const programs = await Promise.all(loops.map(([, each]) => Program.open(each)))
  const [picture, touching] = [new Drawing(told.picture), touchingOf(told.touching)]
  const save = (log) => keepRecord(log, told)
  return new PageSource(told, Object.fromEntries(loops.map(([name], k) => [name, programs[k]])), { picture, touching, save })
}

// Show the scene in its place, and what stands around it; where it cannot run, the words that are there say what to do.
async function begin(told, place) {
  const waiting = [...place.children]
  try {
    const source = await openShared(told)
    for (const each of waiting) each.remove()
    new Page(source, new View(source, place), told)
  } catch (problem) {
    place.append(make("p", { role: "alert" }, [problem.message]))
  }
}

// A page that shows this one in a frame says whether it is light or dark; what else it says is not heard.
function followTheme({ source, data }) {
  if (source === parent && ["light", "dark"].includes(data?.theme)) document.documentElement.style.colorScheme = data.theme
}

if (typeof document !== "undefined") {
  window.addEventListener("message", followTheme)
  begin(JSON.parse(document.getElementById("hl-data").textContent), document.getElementById("hl-view"))
}
