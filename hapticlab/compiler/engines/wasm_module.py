"""One WebAssembly module around the code of one function, ``run``, whose memory its host gives.

The memory is imported as ``env.memory``, and a custom section ``dylink.0`` says that the module is a library that brings
neither data nor a table. So Emscripten's dlopen (ctypes.CDLL in Pyodide) loads the same bytes that other hosts instantiate.
Sections: WebAssembly Core Specification 2.0, 5.5, https://www.w3.org/TR/wasm-core-2/; dylink.0:
https://github.com/WebAssembly/tool-conventions/blob/main/DynamicLinking.md.
"""

from itertools import groupby

from .wasm_words import VALUE_TYPES, unsigned

MAGIC_AND_VERSION = b"\0asm\x01\0\0\0"
CUSTOM, TYPE, IMPORT, FUNCTION, EXPORT, CODE = 0, 1, 2, 3, 7, 10
FUNCTION_TYPE, KIND_FUNCTION, KIND_MEMORY = b"\x60", b"\0", b"\x02"
#: subsection 1, of 4 bytes: size and alignment of the data, of the table
NEITHER_DATA_NOR_TABLE = b"\x01\x04\0\0\0\0"


def module(arguments, local_types, code):
    """Return the bytes of a module.

    Parameters
    ----------
    arguments : int
        Of ``run``, all i32; it returns nothing.
    local_types : list of str
        Value types of its other locals.
    code : bytes
        Of its body, up to the last ``end``.
    """
    runs = [(type, len([*alike])) for type, alike in groupby(local_types)]
    body = _vector([unsigned(count) + _type(type) for type, count in runs]) + code
    return MAGIC_AND_VERSION + b"".join(
        (
            _section(CUSTOM, _name("dylink.0") + NEITHER_DATA_NOR_TABLE),
            _section(TYPE, _vector([FUNCTION_TYPE + _vector([_type("i32")] * arguments) + _vector([])])),
            _section(IMPORT, _vector([_name("env") + _name("memory") + KIND_MEMORY + b"\0" + unsigned(0)])),  # of any size
            _section(FUNCTION, _vector([unsigned(0)])),
            _section(EXPORT, _vector([_name("run") + KIND_FUNCTION + unsigned(0)])),
            _section(CODE, _vector([_sized(body)])),
        )
    )


def _sized(content):
    return unsigned(len(content)) + content


def _section(number, content):
    return bytes((number,)) + _sized(content)


def _vector(items):
    return unsigned(len(items)) + b"".join(items)


def _name(text):
    return _sized(text.encode())


def _type(name):
    return bytes((VALUE_TYPES[name],))
