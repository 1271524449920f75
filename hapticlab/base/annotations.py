"""The types that public signatures share; only a type checker opens this module."""

from os import PathLike
from typing import Literal

import numpy as np
import sympy as sp
from numpy.typing import NDArray

#: a number in SI, or a text with its unit, such as "10 mm"
Number = float | str
#: a sympy expression, a number in SI, or a text with its unit
Term = sp.Expr | float | str
Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
File = str | PathLike[str]
#: what runs a program, and what runs one with a simulated paddle, float64 inside: names of hapticlab.compiler.engines.table
Engine = Literal["auto", "llvm", "wasm", "interpreter", "vm"]
PlantEngine = Literal["auto", "llvm", "wasm", "interpreter"]
