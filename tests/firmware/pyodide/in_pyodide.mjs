// Run a file of Python in Pyodide, without packages: node in_pyodide.mjs FILE FOLDER; the folder is there as /folder.
import { readFileSync } from "node:fs"
import { loadPyodide } from "pyodide"

const [file, folder] = process.argv.slice(2)
const pyodide = await loadPyodide()
pyodide.mountNodeFS("/folder", folder)
try {
  pyodide.runPython(readFileSync(file, "utf-8"))
} catch (error) {
  console.error(error.message)
  process.exitCode = 1
}
