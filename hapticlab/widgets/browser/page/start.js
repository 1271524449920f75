// What a shared file does when it is opened: it takes the data out of the page, and shows the view where they run.

async function openShared(told) {
  const loops = Object.entries(told.programs)
  const programs = await Promise.all(loops.map(([, each]) => Program.open(each)))
  const picture = new PlainPicture(told.about, told.full)
  const touching = (samples) => new Float64Array(samples.x.length).fill(NaN)
  const save = () => "Nothing here keeps a record"
  return new PageSource(told, Object.fromEntries(loops.map(([name], k) => [name, programs[k]])), { picture, touching, save })
}

if (typeof document !== "undefined") {
  const place = document.getElementById("hl-view")
  openShared(JSON.parse(document.getElementById("hl-data").textContent)).then(
    (source) => new View(source, place),
    (problem) => place.append(`This browser cannot run the scene: ${problem.message}`),
  )
}
