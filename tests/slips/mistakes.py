"""Mistakes as students make them, as data: the cell, what its message must say of the mistake, and of the cure.

A message scores 2 where it says both, 1 where it says one of them, 0 where it says neither.
"""

#: what every cell may use
BEFORE = """
import math
import numpy as np
import sympy as sp
import hapticlab as hl
from hapticlab import T, n, t, v, x
k, x_o, x_1, b, m, phi = hl.parameters("k x_o x_1 b m phi", units="N/m m m N*s/m kg rad")
z, theta = hl.coordinate("z", unit="m", initial=x(n)), hl.coordinate("theta", unit="rad")
wall = hl.wall(k=300, x_o="10 mm")
paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2))
log = paddle.run(wall, 0.02)
"""

#: (cell, of the mistake, of the cure): regular expressions. First those that were met in labs 00 to 04, then others.
CELLS = {
    # conditions that Python decides at once
    "if": ("def force():\n    if x(n) >= x_o:\n        return k*(x(n) - x_o)\n    return 0\n\nhl.Scene(force=force())",
           "`if`", r"hl\.when\(x\(n\) >= x_o"),
    "if in an expression": ("hl.Scene(force=k*(x(n) - x_o) if x(n) >= x_o else 0)", "`if`",
                            r"hl\.when\(x\(n\) >= x_o, k \* \(x\(n\) - x_o\), 0\)"),
    "while": ("while x(n) < x_o:\n    pass", "`while`", r"hl\.when"),
    "assert": ("assert x(n) < x_o", "`assert`", r"hl\.when"),
    "and": ("hl.when(x(n) >= x_o and v(n) > 0, k*x(n), 0)", "`and`", r"\(x\(n\) >= x_o\) & \(v\(n\) > 0\)"),
    "or": ("hl.when(x(n) >= x_o or v(n) > 0, k*x(n), 0)", "`or`", r"\(x\(n\) >= x_o\) \| \(v\(n\) > 0\)"),
    "not": ("hl.when(not x(n) >= x_o, k*x(n), 0)", "`not`", r"~\(x\(n\) >= x_o\)"),
    "chained comparison": ("hl.when(x_o <= x(n) <= x_1, k*x(n), 0)", "chain", r"\(x_o <= x\(n\)\) & \(x\(n\) <= x_1\)"),
    "max": ("hl.Scene(force=max(0, k*(x(n) - x_o)))", "`max`", r"sp\.Max\(0, k \* \(x\(n\) - x_o\)\)"),
    "min": ("hl.Scene(force=min(k*(x(n) - x_o), 5))", "`min`", r"sp\.Min\("),
    "sorted": ("sorted([x(n), x_o])", "`sorted`", r"sp\.(Max|Min)"),
    "abs of a condition": ("hl.Scene(force=k*abs(x(n) >= x_o))", "condition", r"hl\.when\(x\(n\) >= x_o, 1, 0\)"),
    "times a condition": ("hl.Scene(force=k*x(n)*(x(n) >= x_o))", "condition", r"hl\.when\(x\(n\) >= x_o, 1, 0\)"),
    "minus a condition": ("hl.Scene(force=-(x(n) >= x_o)*k*x(n))", "condition", r"hl\.when\(x\(n\) >= x_o"),
    "and, without parentheses": ("hl.when(x(n) >= x_o & v(n) > 0, k*x(n), 0)", "&", r"parenthes"),
    "np.where": ("hl.Scene(force=np.where(x(n) >= x_o, k*(x(n) - x_o), 0))", r"np\.where",
                 r"hl\.when\(x\(n\) >= x_o, k \* \(x\(n\) - x_o\), 0\)"),
    "np.maximum": ("hl.Scene(force=np.maximum(0, k*x(n)))", r"np\.maximum", r"sp\.Max"),
    "np.clip": ("hl.Scene(force=np.clip(k*x(n), 0, 5))", r"np\.clip", r"sp\.Min\(sp\.Max"),
    "np.heaviside": ("hl.Scene(force=k*x(n)*np.heaviside(x(n) - x_o, 0))", r"np\.heaviside", r"hl\.when"),
    "np.sign": ("hl.Scene(force=5*np.sign(v(n)))", r"np\.sign", r"sp\.sign"),
    "np.any": ("np.logical_and(x(n) >= x_o, v(n) > 0)", r"np\.logical_and", "&"),
    # functions of numbers
    "np.sin": ("hl.Scene(force=k*np.sin(theta))", r"np\.sin", r"sp\.sin\(theta\)"),
    "np.sqrt": ("np.sqrt(k/m)", r"np\.sqrt", r"sp\.sqrt\(k / m\)"),
    "np.exp": ("np.exp(x(n)/x_o)", r"np\.exp", r"sp\.exp"),
    "math.sin": ("hl.Scene(force=k*math.sin(theta))", r"math\.sin", r"sp\.sin\(theta\)"),
    "math.sqrt": ("math.sqrt(k/m)", r"math\.sqrt", r"sp\.sqrt"),
    "math.floor": ("math.floor(x(n)/x_o)", r"math\.floor", r"sp\.floor"),
    "from math import sin": ("from math import sin\nsin(theta)", r"`sin`", r"sp\.sin"),
    "float": ("float(k)", r"float", r"values"),
    "int": ("int(x(n)/x_o)", r"int", r"sp\.floor"),
    "round": ("round(x(n)/x_o)", r"round", r"sp\.floor"),
    "range": ("for i in range(x(n)):\n    pass", r"range", r"number"),
    "format": ("f'{k:.1f} N/m'", r"number", r"values"),
    # writing
    "== in eom": ("hl.Scene(force=k*(x(n) - z), eom=[m*z.diff(t, 2) == k*(x(n) - z)])", "==", r"sp\.Eq"),
    "== in when": ("hl.when(x(n) == x_o, k, 0)", "==", r"sp\.Eq"),
    "== named before": ("motion = m*z.diff(t, 2) == k*(x(n) - z)\nhl.Scene(force=k*(x(n) - z), eom=[motion])", "==",
                        r"sp\.Eq\(m \* z\.diff\(t, 2\), k \* \(x\(n\) - z\)\)"),
    "!= in when": ("hl.when(x(n) != x_o, k*x(n), 0)", "!=", r"sp\.Ne"),
    "^": ("hl.Scene(force=k*x(n)^2)", r"\^", r"\*\*"),
    "^ of a parameter": ("k^2", r"\^", r"k ?\*\* ?2"),
    "^ of a symbol by a symbol": ("hl.Scene(force=k^m)", r"\^", r"\*\*"),
    "1//2": ("hl.Scene(force=1//2*k*x(n))", r"1 ?// ?2", r"1 ?/ ?2"),
    "1//2 named before": ("energy = 1//2*k*x(n)**2\nhl.Scene(force=k*x(n), watch={'E': energy})", r"1 ?// ?2", r"1 ?/ ?2"),
    "1//2 of an energy": ("L = 1//2*m*z.diff(t)**2 - k*z**2/2\n"
                          "motion = hl.mechanics.lagrange(L, forces={z: k*(x(n) - z)})\n"
                          "paddle.run(hl.Scene(force=k*(x(n) - z), eom=[motion])(k=100, m=0.1), 0.01)", r"1 ?// ?2", r"1 ?/ ?2"),
    "x//2": ("hl.Scene(force=k*(x(n)//2))", "//", "/"),
    "x[n]": ("hl.Scene(force=k*x[n])", r"x\[n\]", r"x\(n\)"),
    "x[n-1]": ("x(n) - x[n-1]", r"x\[n ?- ?1\]", r"x\(n ?- ?1\)"),
    "x(n)[1]": ("x(n)[1]", r"\[1\]", r"x\(n ?- ?1\)"),
    "x.n": ("hl.Scene(force=k*x.n)", r"x\.n", r"x\(n\)"),
    "z.dot": ("b*z.dot", r"z\.dot", r"z\.diff\(t\)"),
    "theta.sin()": ("theta.sin()", r"\.sin", r"sp\.sin\(theta\)"),
    "x not called": ("hl.Scene(force=k*x)", "function of time", r"x\(n\)"),
    "x not called, compared": ("hl.when(x >= x_o, k, 0)", "x is a function", r"x\(n\)"),
    "z(n)": ("z(n)", r"z\(n\)|call", r"\bz\b"),
    "multiplication left out": ("hl.Scene(force=k(x(n) - x_o))", "multipl|called", r"k ?\*"),
    "text for a number": ("k*(x(n) - '10 mm')", "text", r"hl\.parameters"),
    "sum of a list": ("x(n) + [1, 2]", "list", r"number|one by one"),
    "len": ("len(x(n))", "len", r"log"),
    "an array of samples": ("np.array([1.0, 2.0]) > x(n)", "array", r"one|number"),
    "loop over x": ("for one in x(n):\n    pass", "loop|iterat|for", r"log\.x"),
    "plot of a symbol": ("import matplotlib.pyplot as plt\nplt.plot(x(n))", "number", r"log\.x"),
    "x(n+1)": ("hl.Scene(force=k*x(n+1))", "future", r"Predict"),
    # units and values
    "unlike terms": ("hl.Scene(force=k*x(n) + x(n))", r"in N but x\(n\) is in m", "Correct"),
    "damper on a position": ("hl.Scene(force=k*v(n) + b*x(n))", r"k\*v\(n\) is in", "Correct"),
    "bare number": ("hl.Scene(force=300*x(n))", "300|in m", r"hl\.parameters|N/m"),
    "unit Nm-1": ("hl.parameters('k', units='Nm-1')", "Nm-1", "N/m"),
    "unit deg": ("hl.parameters('phi', units='deg')", "deg", "rad"),
    "unit mm": ("hl.parameters('x_o', units='mm')", "mm", "declare m"),
    "mm for m": ("hl.wall()(k=300, x_o=10)", "x_o = 10 m", "'10 mm'"),
    "g for kg": ("hl.SimulatedPaddle(m=50, b=0.1, T=1e-3)", "50 kg", "'50 g'"),
    "ms for s": ("hl.SimulatedPaddle(m=0.05, b=0.1, T=1)", "T = 1 s", "'1 ms'"),
    "degrees for a parameter": ("hl.Scene(force=k*x_o*sp.sin(phi))(k=1, x_o=1e-3, phi=30)", "30 rad", "'30 deg'"),
    "degrees in sin": ("hl.Scene(force=k*x_o*sp.sin(30))", r"sin\(30\)", "rad|pi"),
    "degrees of an angle": ("hl.Scene(force=k*x_o*sp.sin(180*theta/sp.pi), eom=[sp.Eq(theta.diff(t), 0/T)])", "degrees",
                            r"sin\(theta\(t\)\)"),
    "wrong kind of unit": ("hl.wall()(k='300 kg', x_o=0.01)", "300 kg", "N/m"),
    "negative stiffness": ("hl.wall()(k=-300, x_o=0.01)", "-300", ">= 0"),
    "unknown parameter": ("hl.wall()(K=300)", "no parameter K", "mean k"),
    "wall(K=)": ("hl.wall(K=300)", "K", r"\bk\b"),
    "no eom": ("paddle.run(hl.Scene(force=k*(x(n) - z))(k=100), 0.01)", "z", "eom|equation"),
    "expression in eom": ("hl.Scene(force=k*(x(n) - z), eom=[m*z.diff(t, 2) - k*(x(n) - z)])", "equation", r"sp\.Eq"),
    "Mechanics for Scene": ("paddle.run(hl.mechanics.lagrange(m*z.diff(t)**2/2, forces={z: k*(x(n) - z)}), 0.1)",
                            "without a force", r"hl\.Scene"),
    "F= for force=": ("hl.Scene(F=k*x(n))", r"\bF\b", "force"),
    "misspelt name": ("hl.Sceen(force=0)", "Sceen", r"hl\.Scene"),
    "run(w, T=1)": ("paddle.run(wall, T=1)", "T", "duration"),
    "run without a scene": ("paddle.run(2.0)", r"scene = 2\.0", "duration="),
    "log[x]": ("log['y']", "y", r"\bx\b"),
    "log.position": ("log.position", "position", r"\bx\b"),
    "an array in if": ("if log.x > 0.001:\n    print('inside')", "array", r"np\.where|\.any\(\)"),
    "max of arrays": ("max(log.F, 0)", "`max`", r"np\.maximum"),
    "math of an array": ("math.sin(log.x)", r"math\.sin", r"np\.sin"),
    "and of arrays": ("(log.x > 0) and (log.F > 0)", "`and`", "&"),
    "chain of arrays": ("log.F[0 < log.x < 0.01]", "chain", r"\(0 < log\.x\) & \(log\.x < 0\.01\)"),
}  # fmt: skip
