// Runs modules of the engine wasm as a page, or Emscripten's dlopen, would: cases from stdin, results to stdout, as JSON.
// A case: code and arrays (base64 of little-endian bytes), ticks, every, lanes, rows of results, resumed, rounds to time.
import { readFileSync } from "node:fs";

const bytes = (text) => Uint8Array.from(Buffer.from(text, "base64"));
const text = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength).toString("base64");

/** The fields of the first section, which must be dylink.0 and say what a library brings: sizes and alignments. */
function needs(code) {
  const length = code[9], name = Buffer.from(code.slice(11, 11 + code[10])).toString();
  if (code[8] !== 0 || name !== "dylink.0") throw new Error("the first section is not dylink.0");
  const [kind, size, ...fields] = code.slice(11 + code[10], 10 + length);
  if (kind !== 1 || size !== fields.length) throw new Error("dylink.0 says not what it needs");
  return fields;
}

function run({ code, ticks, every, lanes, size, resumed, rounds = 0, ...arrays }) {
  const module_bytes = bytes(code), names = ["inputs", "parameters", "states"];
  const began = performance.now();
  const module = new WebAssembly.Module(module_bytes);
  let ready = performance.now() - began;
  const parts = names.map((name) => bytes(arrays[name]));
  parts.push(new Uint8Array(8 * size));
  const total = parts.reduce((sum, part) => sum + part.length, 64);  // not from 0 on, as in a library's host
  const memory = new WebAssembly.Memory({ initial: Math.ceil(total / 65536) });
  const places = [];
  let end = 64;
  for (const part of parts) {
    places.push(end);
    new Uint8Array(memory.buffer, end, part.length).set(part);
    end += part.length;
  }
  const start = performance.now();
  const { run } = new WebAssembly.Instance(module, { env: { memory } }).exports;
  if (rounds) run(1, 2, 8 * lanes, 0, ...places);  // compiled when first called
  ready += performance.now() - start;
  const go = () => run(ticks, every, 8 * lanes, resumed ? 1 : 0, ...places);
  go();
  const results = {
    needs: needs(module_bytes),
    states: text(new Uint8Array(memory.buffer, places[2], parts[2].length)),
    outputs: text(new Uint8Array(memory.buffer, places[3], parts[3].length)),
    ready,
  };
  let best = Infinity;
  for (let k = 0; k < rounds; k++) {
    const start = performance.now();
    go();
    best = Math.min(best, performance.now() - start);
  }
  return rounds ? { ...results, best } : results;
}

process.stdout.write(JSON.stringify(JSON.parse(readFileSync(0)).map(run)));
