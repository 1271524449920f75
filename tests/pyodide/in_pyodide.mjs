// A Pyodide that stays: node in_pyodide.mjs ARCHIVE WHEEL; on each line of stdin a request, on each of stdout its answer, in JSON.
// A request: code, values (names it finds), folder (of this computer; its working directory, or null). The answer: printed, error,
// left (the addresses beyond this process that were asked for; each of them is refused).
import net from "node:net";
import { basename, dirname } from "node:path";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const [archive, wheel] = process.argv.slice(2);
const printed = [], left = [];
console.log = console.error; // stdout carries answers alone
net.Socket.prototype.connect = function (...to) {
  const [place] = to.flat();
  left.push(`${place?.host ?? place?.path ?? place}:${place?.port ?? ""}`);
  throw new Error(`no request may leave this process: ${left.at(-1)}`);
};

const { loadPyodide } = await import(pathToFileURL(`${archive}/pyodide.mjs`));
const pyodide = await loadPyodide({ indexURL: archive, env: { HOME: "/home/pyodide", MPLBACKEND: "agg" } });
for (const stream of ["setStdout", "setStderr"]) {
  const decoder = new TextDecoder();
  pyodide[stream]({ write: (bytes) => (printed.push(decoder.decode(bytes, { stream: true })), bytes.length) });
}
await pyodide.loadPackage("micropip", { messageCallback: () => {} });
pyodide.FS.mkdirTree("/wheel");
pyodide.mountNodeFS("/wheel", dirname(wheel));
const names = [`emfs:/wheel/${basename(wheel)}`, "ipython", "ipywidgets", "anywidget", "pytest"];
await pyodide.runPythonAsync(`
import sys, micropip
sys.path.remove("") if "" in sys.path else None  # hapticlab is what is installed, also where a checkout is the working directory
await micropip.install(${JSON.stringify(names)})
`);

// what a run leaves on the event loop, such as a live view, would take its time from the next one
const ENDING = `
import asyncio, sys
left = asyncio.all_tasks() - {asyncio.current_task()}
for task in left:
    task.cancel()
await asyncio.gather(*left, return_exceptions=True)
sys.stdout.flush()
sys.stderr.flush()
`;

async function run({ code, values, folder }) {
  printed.length = left.length = 0;
  let error = null;
  pyodide.FS.mkdirTree("/folder");
  if (folder) pyodide.mountNodeFS("/folder", folder);
  pyodide.FS.chdir("/folder");
  const names = pyodide.toPy({ ...values, __name__: "__main__" });
  try {
    await pyodide.runPythonAsync(code, { globals: names });
  } catch (raised) {
    error = raised.message;
  }
  await pyodide.runPythonAsync(ENDING);
  names.destroy();
  pyodide.FS.chdir("/");
  if (folder) pyodide.FS.unmount("/folder");
  return { printed: printed.join(""), error, left };
}

const answer = (said) => process.stdout.write(JSON.stringify(said) + "\n");
answer({ ready: true });
for await (const line of createInterface({ input: process.stdin })) answer(await run(JSON.parse(line)));
