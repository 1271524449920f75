// A record as a file that hl.records.Telemetry.load reads: what Telemetry.save writes, a zip of NumPy arrays, not compressed.

const FLAG_COLUMNS = ["saturated", "gap", "overrun"]
const OWN_COLUMNS = ["t", "x", "v", "F"]

// Return the bytes of a log, {columns, parameters, changes, T, fault}. told: {units, scene, paddle, delay, sensor_delay,
// force_max} of the scene on its paddle.
function recordFile({ columns, parameters, changes, T, fault }, told) {
  const order = Object.keys(columns).filter((name) => ![...OWN_COLUMNS, ...FLAG_COLUMNS].includes(name))
  const { units, scene, paddle, delay, sensor_delay } = told
  const about = { order, units, parameters, changes, scene, paddle, T, delay, sensor_delay, every: 1, fault: fault ?? null }
  const limited = columns.F.map((force) => Number(told.force_max !== null && Math.abs(force) >= told.force_max))
  const raised = { saturated: limited, gap: limited.map(() => 0), overrun: limited.map(() => 0), ...columns } // a board says them itself
  const flags = FLAG_COLUMNS.map((name) => [name, npy("|b1", Uint8Array.from(raised[name]))])
  const numbers = [...OWN_COLUMNS.map((name) => [name, name]), ...order.map((name) => [`channel.${name}`, name])]
  return zipped([
    ["about", npyText(JSON.stringify(about))], ...numbers.map(([entry, name]) => [entry, npy("<f8", Float64Array.from(columns[name]))]), ...flags,
  ].map(([name, bytes]) => [`${name}.npy`, bytes])) // prettier-ignore
}

// An array of one dimension as NumPy writes it (numpy.lib.format, version 1.0).
function npy(type, array, shape = `(${array.length},)`) {
  const words = `{'descr': '${type}', 'fortran_order': False, 'shape': ${shape}, }`
  const head = words.padEnd(Math.ceil((words.length + 11) / 64) * 64 - 11) + "\n"
  const prefix = Uint8Array.from([0x93, ...[..."NUMPY"].map((letter) => letter.charCodeAt(0)), 1, 0, head.length & 255, head.length >> 8])
  return joined([prefix, new TextEncoder().encode(head), new Uint8Array(array.buffer)], Uint8Array)
}

function npyText(text) {
  const letters = Uint32Array.from(text, (letter) => letter.codePointAt(0))
  return npy(`<U${letters.length}`, letters, "()")
}

// A zip of entries [name, bytes] that are stored as they are (PKWARE APPNOTE 6.3, sections 4.3.7, 4.3.12 and 4.3.16).
function zipped(entries) {
  const [parts, index] = [[], []]
  let at = 0
  for (const [name, bytes] of entries) {
    const letters = new TextEncoder().encode(name)
    const sizes = [[crc32(bytes), 4], [bytes.length, 4], [bytes.length, 4], [letters.length, 2]]
    const file = [[20, 2], [0x800, 2], [0, 2], [0, 2], [0x21, 2], ...sizes, [0, 2]] // names in UTF-8, stored, 1 January 1980
    const local = joined([little([[0x04034b50, 4], ...file]), letters, bytes], Uint8Array)
    index.push(little([[0x02014b50, 4], [20, 2], ...file, [0, 2], [0, 2], [0, 2], [0, 4], [at, 4]]), letters)
    parts.push(local)
    at += local.length
  }
  const directory = joined(index, Uint8Array)
  const count = entries.length
  const end = little([[0x06054b50, 4], [0, 2], [0, 2], [count, 2], [count, 2], [directory.length, 4], [at, 4], [0, 2]])
  return joined([...parts, directory, end], Uint8Array)
}

// Whole numbers, each in so many bytes, the lowest first.
function little(numbers) {
  return Uint8Array.from(numbers.flatMap(([number, bytes]) => Array.from({ length: bytes }, (_, k) => (number / 2 ** (8 * k)) & 255)))
}

// Begun from the CRC-32 of what stands before the bytes, or from any other number.
function crc32(bytes, start = 0) {
  const table = Uint32Array.from({ length: 256 }, (_, k) => {
    for (let bit = 0; bit < 8; bit++) k = k & 1 ? (k >>> 1) ^ 0xedb88320 : k >>> 1
    return k
  })
  let crc = ~start
  for (const byte of bytes) crc = table[(crc ^ byte) & 255] ^ (crc >>> 8)
  return ~crc >>> 0
}

// The same as a table in text, with units in its head: what Telemetry.to_csv writes.
function recordTable({ columns }, { units, force_max }) {
  const names = [...OWN_COLUMNS, ...Object.keys(columns).filter((name) => !OWN_COLUMNS.includes(name))]
  const limited = force_max !== null && columns.F.some((force) => Math.abs(force) >= force_max)
  const head = [...names.map((name) => `${name} [${units[name] ?? "1"}]`), ...(limited ? ["saturated"] : [])]
  const row = (_, k) => [...names.map((name) => columns[name][k]), ...(limited ? [Number(Math.abs(columns.F[k]) >= force_max)] : [])].join(",")
  return [head.join(","), ...Array.from(columns.t, row)].join("\n").replaceAll("NaN", "nan") + "\n"
}
