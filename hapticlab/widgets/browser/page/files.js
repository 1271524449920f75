// Files that the browser keeps for a person, among their downloads.

const FRAMED = "if the page around this frame allows downloads. Otherwise open the frame in a tab of its own"

// Keep a record as a file that hapticlab reads, or as a table; return words on it.
function keepRecord(log, told) {
  const name = keepFile(recordFile(log, told), told.scene, "npz", "application/zip")
  return keptWords(name, ": hl.records.Telemetry.load reads it")
}

function keepTable(log, told) {
  return keptWords(keepFile(new TextEncoder().encode(recordTable(log, told)), told.scene, "csv", "text/csv"))
}

// A frame is not told that it may not keep files.
function keptWords(name, more = "") {
  return `Saved ${name}, ${window.parent === window ? `see your downloads${more}` : FRAMED}`
}

function keepFile(bytes, scene, ending, type) {
  const stem = scene.replace(/[^\p{L}\p{N}]+/gu, "_").replace(/^_+|_+$/g, "") || "scene"
  keepFile.count = (keepFile.count ?? 0) + 1
  const name = `${stem}-${keepFile.count}.${ending}`
  const address = URL.createObjectURL(new Blob([bytes], { type }))
  make("a", { href: address, download: name }).click()
  setTimeout(() => URL.revokeObjectURL(address), 60_000)
  return name
}
