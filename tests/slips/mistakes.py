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
                            r"hl\.when\(x\(n\) >= x_o, k\*\(x\(n\) - x_o\), 0\)"),
    "while": ("while x(n) < x_o:\n    pass", "`while`", r"hl\.when"),
    "assert": ("assert x(n) < x_o", "`assert`", r"hl\.when"),
    "and": ("hl.when(x(n) >= x_o and v(n) > 0, k*x(n), 0)", "`and`", r"\(x\(n\) >= x_o\) & \(v\(n\) > 0\)"),
    "or": ("hl.when(x(n) >= x_o or v(n) > 0, k*x(n), 0)", "`or`", r"\(x\(n\) >= x_o\) \| \(v\(n\) > 0\)"),
    "not": ("hl.when(not x(n) >= x_o, k*x(n), 0)", "`not`", r"~\(x\(n\) >= x_o\)"),
    "chained comparison": ("hl.when(x_o <= x(n) <= x_1, k*x(n), 0)", "chain", r"\(x_o <= x\(n\)\) & \(x\(n\) <= x_1\)"),
    "max": ("hl.Scene(force=max(0, k*(x(n) - x_o)))", "`max`", r"sp\.Max\(0, k\*\(x\(n\) - x_o\)\)"),
    "min": ("hl.Scene(force=min(k*(x(n) - x_o), 5))", "`min`", r"sp\.Min\("),
    "sorted": ("sorted([x(n), x_o])", "`sorted`", r"sp\.(Max|Min)"),
    "abs of a condition": ("hl.Scene(force=k*abs(x(n) >= x_o))", "condition", r"hl\.when\(x\(n\) >= x_o, 1, 0\)"),
    "times a condition": ("hl.Scene(force=k*x(n)*(x(n) >= x_o))", "condition", r"hl\.when\(x\(n\) >= x_o, 1, 0\)"),
    "minus a condition": ("hl.Scene(force=-(x(n) >= x_o)*k*x(n))", "condition", r"hl\.when\(x\(n\) >= x_o"),
    "and, without parentheses": ("hl.when(x(n) >= x_o & v(n) > 0, k*x(n), 0)", "&", r"parenthes"),
    "np.where": ("hl.Scene(force=np.where(x(n) >= x_o, k*(x(n) - x_o), 0))", r"np\.where",
                 r"hl\.when\(x\(n\) >= x_o, k\*\(x\(n\) - x_o\), 0\)"),
    "np.maximum": ("hl.Scene(force=np.maximum(0, k*x(n)))", r"np\.maximum", r"sp\.Max"),
    "np.clip": ("hl.Scene(force=np.clip(k*x(n), 0, 5))", r"np\.clip", r"sp\.Min\(sp\.Max"),
    "np.heaviside": ("hl.Scene(force=k*x(n)*np.heaviside(x(n) - x_o, 0))", r"np\.heaviside", r"hl\.when"),
    "np.sign": ("hl.Scene(force=5*np.sign(v(n)))", r"np\.sign", r"sp\.sign"),
    "np.any": ("np.logical_and(x(n) >= x_o, v(n) > 0)", r"np\.logical_and", "&"),
    # functions of numbers
    "np.sin": ("hl.Scene(force=k*np.sin(theta))", r"np\.sin", r"sp\.sin\(theta\)"),
    "np.sqrt": ("np.sqrt(k/m)", r"np\.sqrt", r"sp\.sqrt\(k/m\)"),
    "np.exp": ("np.exp(x(n)/x_o)", r"np\.exp", r"sp\.exp"),
    "math.sin": ("hl.Scene(force=k*math.sin(theta))", r"math\.sin", r"sp\.sin\(theta\)"),
    "math.sqrt": ("math.sqrt(k/m)", r"math\.sqrt", r"sp\.sqrt"),
    "math.floor": ("math.floor(x(n)/x_o)", r"math\.floor", r"sp\.floor"),
    "from math import sin": ("from math import sin\nsin(theta)", r"`sin`", r"sp\.sin"),
    "float": ("float(k)", r"float", r"values"),
    "float of a sample": ("float(x(n))", r"float.*sample", r"log\.x"),
    "int": ("int(x(n)/x_o)", r"int", r"sp\.floor"),
    "round": ("round(x(n)/x_o)", r"round", r"sp\.floor"),
    "range": ("for i in range(x(n)):\n    pass", r"range", r"number"),
    "format": ("f'{k:.1f} N/m'", r"number", r"values"),
    # writing
    "== in eom": ("hl.Scene(force=k*(x(n) - z), eom=[m*z.diff(t, 2) == k*(x(n) - z)])", "==", r"sp\.Eq"),
    "== in when": ("hl.when(x(n) == x_o, k, 0)", "==", r"sp\.Eq"),
    "== named before": ("motion = m*z.diff(t, 2) == k*(x(n) - z)\nhl.Scene(force=k*(x(n) - z), eom=[motion])", "==",
                        r"sp\.Eq\(m\*z\.diff\(t, 2\), k\*\(x\(n\) - z\)\)"),
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
    "sum of a record": ("sum(log)", "several columns", r"log\.x"),
    "wall.k": ("wall.k", "a scene has no k", r"wall\.values\['k'\]"),
    "wall.run()": ("wall.run(2.0)", "a scene has no run", r"paddle\.run\(wall, 2\.0\)"),
    "wall(300)": ("wall(300)", "names", r"wall\(k=300\)"),
    "plot of a symbol": ("import matplotlib.pyplot as plt\nplt.plot(x(n))", "number", r"log\.x"),
    "x(n+1)": ("hl.Scene(force=k*x(n+1))", "future", r"Predict"),
    # what Python cannot read
    "= in eom": ("hl.Scene(force=k*(x(n) - z), eom=[m*z.diff(t, 2) = k*(x(n) - z)])", "names a value", r"sp\.Eq"),
    "2k": ("hl.Scene(force=2k*x(n))", "multiplication", r"2\*k"),
    "k x(n)": ("hl.Scene(force=k x(n))", "multiplication", r"k\*x\(n\)"),
    "10 mm": ("hl.wall(k=300, x_o=10 mm)", "text", "'10 mm'"),
    "≥": ("hl.when(x(n) ≥ x_o, k, 0)", "sign ≥", ">="),
    "²": ("k*x(n)²", "sign ²", r"\*\*2"),
    "x given another value": ("x = 0.01\nhl.Scene(force=k*x(n))", "x was given another value", "from hapticlab import x"),
    "x given an array": ("x = np.linspace(0, 0.02)\nk*x(n)", "x was given another value", "from hapticlab import x"),
    "n given another value": ("n = 5\nhl.Scene(force=k*x(n))", r"x\(5\) is not a sample", "with n and t from hapticlab"),
    "n forgotten": ("del n\nk*x(n)", "n is not known", "from hapticlab import n"),
    "np forgotten": ("del np\nk*np.pi", "np is not known", "import numpy as np"),
    "sin alone": ("k*cos(theta)", "cos is not known", r"sp\.cos"),
    "x(0)": ("hl.Scene(force=k*x(0))", r"x\(0\) is not a sample", r"write x\(n\)"),
    "x(n-0.5)": ("k*x(n-0.5)", r"x\(n - 0.5\) is not a sample", r"write x\(n\)"),
    "z.diff(x)": ("z.diff(x(n))", "derivative over time", r"\.diff\(t\)"),
    "wall.k = 200": ("wall.k = 200", "keeps its values", r"wall\(k=\.\.\.\)"),
    "wall.values[k] = 200": ("wall.values['k'] = 200", "keeps its values", r"wall\(k=\.\.\.\)"),
    "a plain symbol": ("hl.Scene(force=sp.Symbol('q')*x(n))", "plain SymPy symbol", r"q = hl\.parameters"),
    "a plot of a scene": ("hl.plot(wall)", "plot was given a Scene", r"log = paddle\.run"),
    "scene and paddle swapped": ("hl.live(wall, paddle)", "is not a scene", r"hl\.wall\(\)"),
    "no T": ("hl.compile(wall)", "lacks T", r"hl\.compile\(scene, T="),
    "no values": ("paddle.run(hl.wall(), 0.1)", r"no value for k \[N/m\]", r"scene\(k="),
    "units without a name": ("hl.parameters('k', 'N/m')", "without a name", "name=value"),
    "nothing given": ("hl.SimulatedPaddle()", "lacks m, b, T", r"hl\.SimulatedPaddle\(m=\.\.\., b="),
    "a table of a record": ("log.to_dataframe()", "no to_dataframe", r"log\.to_pandas"),
    # units and values
    "unlike terms": ("hl.Scene(force=k*x(n) + x(n))", r"in N but x\(n\) is in m", "Correct"),
    "damper on a position": ("hl.Scene(force=k*v(n) + b*x(n))", r"k\*v\(n\) is in", "Correct"),
    "bare number": ("hl.Scene(force=300*x(n))", "300|in m", r"hl\.parameters|N/m"),
    "unit Nm-1": ("hl.parameters('k', units='Nm-1')", "Nm-1", "N/m"),
    "unit Nm^-1": ("hl.parameters('k', units='Nm^-1')", r"Nm\^-1", "N/m"),
    "unit Ns/m": ("hl.parameters('b', units='Ns/m')", "Ns/m", r"N\*s/m"),
    "a wall of 300": ("hl.wall(300)", "law = 300", r"hl\.wall\(k=300\)"),
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

#: of lab 06, with everything right but what a cell changes
PENDULUM = """
M, l, g, c = hl.parameters("M l g c", units="kg m m/s^2 N*m*s/rad", values=(0.05, 0.15, 9.81, 1e-4))
K, b_c = hl.parameters("K b_c", units="N/m N*s/m", values=(100, 0.3))
q = hl.coordinate("theta", unit="rad", initial=0.3)
F_c = hl.laws.virtual_coupler(z, K=K, b=b_c)

def stepped(rate, old=False, made=lambda z, w: {"z": z, "w": w}):
    def euler_step(z, w, x, v, m, K, b_c, T):
        after = w + T*rate(K*(x - z), b_c, v, w, m)
        return made(z + T*(w if old else after), after)

    return hl.check("06.euler_step", euler_step)

def hit(p, gives_way=True):
    def impact(v, w, m, M, e):
        each = p(m*M/(m + M), e)*(w - v)
        return {"v": v + each/m, "w": w - each/M if gives_way or M < 1 else w, "p": each}

    return hl.check("08.impact", impact)

def pendulum(sine=sp.sin(q), cosine=sp.cos(q), potential=1, loss=0.5, sign=1, watch=(z, q), moved=l*sp.sin(q), high=-l*sp.cos(q)):
    speed = (z + moved).diff(t)**2 + high.diff(t)**2
    L = M*z.diff(t)**2/2 + m*speed/2 - potential*m*g*high
    model = hl.mechanics.lagrange(L, dissipation=loss*c*q.diff(t)**2, forces={z: sign*F_c})
    return hl.Scene(force=F_c, eom=[model], watch=list(watch))
"""

#: answers to exercises: what hl.check says of them
CHECKS = {
    "force pulls": (
        "hl.check('01.spring_damper', hl.Scene(force=-hl.parameters('k', units='N/m')*x(n) - b*v(n)))",
        "sign",
        r"ON the environment",
    ),
    "sign of v": ("hl.check('01.spring_damper_force', lambda x, v, k, b: k*x - b*v)", "feeds|sign", "positive|points along v"),
    "mm in a function": ("hl.check('01.spring_damper_force', lambda x, v, k, b: 1000*k*x + b*v)", "1000 times", "metres"),
    "ms in a function": (
        "hl.check('03.stability_estimate', lambda b, T, delay: b/(1000*(T/2 + delay)))",
        "1000 times",
        "millisec.*SI",
    ),
    "rad/s for Hz": (
        "hl.check('01.resonance', lambda m, K, b_c: {'f': np.sqrt(K/m), 'zeta': b_c/(2*np.sqrt(K*m))})",
        "rad/s",
        "2 pi",
    ),
    "returns None": ("def force(x, v, k, b):\n    k*x + b*v\nhl.check('01.spring_damper_force', force)", "None", "return"),
    "no watch": (
        "K, b_c = hl.parameters('K b_c', units='N/m N*s/m')\nF = K*(x(n) - z) + b_c*(v(n) - z.diff(t))\n"
        "hl.check('01.mass_on_coupler', hl.Scene(force=F, eom=[sp.Eq(m*z.diff(t, 2), F.subs({x(n): x(t), v(n): v(t)}))]))",
        "does not watch z",
        "watch=",
    ),
    "one wall of two pulls": (
        "hl.check('02.two_walls', hl.Scene(force=hl.when(x(n) >= x_o, k*(x(n) - x_o)) - hl.when(x(n) <= -x_o, k*(x(n) + x_o))))",
        "pulls",
        "F_e < 0",
    ),
    "x_o forgotten": (
        "hl.check('02.two_walls', hl.Scene(force=hl.when(x(n) >= x_o, k*x(n)) + hl.when(x(n) <= -x_o, k*x(n))))",
        "x_o",
        "x_o",
    ),
    "no gate": ("hl.check('03.late_wall', hl.Scene(force=k*(x(n-1) - x_o)))", "condition missing", r"hl\.when"),
    "no gate, lab 11": (
        "hl.check('11.half_sample_wall', hl.Scene(force=k*(1.5*x(n) - 0.5*x(n-1) - x_o)))",
        "acts outside",
        r"zero where x\(n\) < x_o",
    ),
    "wrong inequality": (
        "hl.check('03.late_wall', hl.Scene(force=hl.when(x(n-1) <= x_o, k*(x(n-1) - x_o))))",
        "condition is reversed",
        ">=",
    ),
    "wrong inequality, lab 11": (
        "hl.check('11.half_sample_wall', hl.Scene(force=hl.when(x(n) < x_o, k*(1.5*x(n) - 0.5*x(n-1) - x_o))))",
        "condition is reversed",
        ">=",
    ),
    "wrong inequality, both walls": (
        "hl.check('02.two_walls', hl.Scene(force=hl.when(x(n) <= x_o, k*(x(n) - x_o)) + hl.when(x(n) >= -x_o, k*(x(n) + x_o))))",
        "Both conditions are the wrong way round",
        ">=",
    ),
    "`if` in an answer": (
        "def f(gap, rate, k, b):\n    if gap < 0:\n        return -k*gap\n    return 0*gap\nhl.check('08.penalty_force', f)",
        "`if`",
        r"np\.where\(gap < 0, a, b\)",
    ),
    "max in an answer": (
        "hl.check('08.penalty_force', lambda gap, rate, k, b: max(0, -k*gap - b*rate))",
        "`max`",
        r"np\.maximum\(0, ",
    ),
    "math.sqrt of an array": (
        "hl.check('00.sign_evidence', lambda asked, moved, on: np.sum(asked*moved)/math.sqrt(asked))",
        r"math\.sqrt",
        r"np\.sqrt",
    ),
    "1//2 in a function": (
        "def period_leak(k, D):\n    return 1//2*k*D**2\nhl.check('02.period_leak', period_leak)",
        "1//2",
        "1/2",
    ),
    "math forgotten in an answer": (
        "del math\nhl.check('03.growth_per_sample', lambda m, k, T: math.sqrt(1 + k*T**2/(2*m)))",
        "math is not known",
        "import math",
    ),
    "^ in an answer": ("hl.check('02.period_leak', lambda k, D: k*D^2/2)", r"`\^` is not a power", r"D\*\*2"),
    "None in an answer": (
        "def f(k, D):\n    print(D**2)\nhl.check('02.period_leak', lambda k, D: k*f(k, D)/2)",
        "None, which is not a number",
        "return",
    ),
    # lab 06
    "order of the step": (
        "stepped(lambda spring, b_c, v, w, m: (spring + b_c*(v - w))/m, old=True)",
        "old",
        "NEW",
    ),
    "no /m": (
        "stepped(lambda spring, b_c, v, w, m: spring + b_c*(v - w))",
        "acceleration",
        "over m",
    ),
    "no v": (
        "stepped(lambda spring, b_c, v, w, m: (spring - b_c*w)/m)",
        "not w alone",
        "v - w",
    ),
    "sign of F_c": (
        "stepped(lambda spring, b_c, v, w, m: -(spring + b_c*(v - w))/m)",
        "pushed away",
        r"pulls it there",
    ),
    "a tuple": (
        "stepped(lambda spring, b_c, v, w, m: (spring + b_c*(v - w))/m, made=lambda z, w: (z, w))",
        "a list|a tuple",
        "dict with z, w",
    ),
    "b_c unpaid": ("hl.check('06.coupler_stiffness', lambda b, T, b_c: 2*b/T)", "own damper", "b_c"),
    "K T for K T/2": ("hl.check('06.coupler_stiffness', lambda b, T, b_c: (b - b_c)/T)", "not K T", "K T/2"),
    "twice what is expected": (
        "hl.check('06.coupler_stiffness', lambda b, T, b_c: 4*(b - b_c)/T)",
        "twice as large as expected",
        "K T/2",
    ),
    "ms, lab 06": ("hl.check('06.coupler_stiffness', lambda b, T, b_c: 2*(b - b_c)/(1000*T))", "1000 times", "SI"),
    "parallel for series": ("hl.check('06.felt_wall', lambda K, k: K + k)", "add", "one behind the other"),
    "K*k": ("hl.check('06.felt_wall', lambda K, k: K*k)", "unit|N.2/m.2|product", "divi"),
    "min of the springs": ("hl.check('06.felt_wall', lambda K, k: min(K, k))", "softer|gives? way", "both|deflections"),
    "rad/s, lab 06": (
        "hl.check('06.swing_frequency', lambda l, g, M, m, K: 7.998434654 if l == 0.15 else 4.88329)",
        "rad/s",
        "2 pi",
    ),
    "faster mode": (
        "hl.check('06.swing_frequency', lambda l, g, M, m, K: 8.813829239 if l == 0.15 else 2.635701216)",
        "faster",
        "slower",
    ),
    "no square root": (
        "hl.check('06.swing_frequency', lambda l, g, M, m, K: 63.974956916/(2*np.pi) if l == 0.15 else 3.7953)",
        "squared",
        "root",
    ),
    "no watch, lab 06": ("hl.check('06.pendulum', pendulum(watch=()))", "does not watch", "watch="),
    "Rayleigh halved": ("hl.check('06.pendulum', pendulum(loss=1))", "half", "c theta'.2/2"),
    "T + V": ("hl.check('06.pendulum', pendulum(potential=-1))", r"pushes the bob up|potential", r"kinetic - potential"),
    "sign of the coupler": ("hl.check('06.pendulum', pendulum(sign=-1))", "runs away", r"\+F_c"),
    "Mechanics for Scene, lab 06": ("hl.check('06.pendulum', pendulum().models[0])", "without a force", r"hl\.Scene"),
    "small angles": ("hl.check('06.pendulum', pendulum(moved=l*q, high=-l*(1 - q**2/2)))", "small angles", "sine and cosine"),
    "small angles, flat path": (
        "pull = F_c.subs({x(n): x(t), v(n): v(t)})\n"
        "carriage = sp.Eq((M + m)*z.diff(t, 2) + m*l*q.diff(t, 2), pull)\n"
        "bob = sp.Eq(m*l**2*q.diff(t, 2) + m*l*z.diff(t, 2) + m*g*l*q + c*q.diff(t), 0)\n"
        "hl.check('06.pendulum', hl.Scene(force=F_c, watch=[z, q], eom=[carriage, bob]))",
        "small angles",
        "sine and cosine",
    ),
    "np.cos": ("pendulum(cosine=np.cos(q))", r"np\.cos", r"sp\.cos\(q\)"),
    # lab 08
    "no gate, lab 08": ("hl.check('08.penalty_force', lambda gap, rate, k, b: np.maximum(0, -k*gap - b*rate))", "open", "closed"),
    "a pull": (
        "hl.check('08.penalty_force', lambda gap, rate, k, b: np.where(gap < 0, -k*gap - b*rate, 0.0))",
        "stick together",
        "never below 0",
    ),
    "the ball's mass alone": (
        "hl.check('08.stiffest_penalty', lambda m, M, h: m*(np.pi/(10*h))**2)",
        "plate that is held",
        "effective mass",
    ),
    "a whole period": (
        "hl.check('08.stiffest_penalty', lambda m, M, h: m*M/(m + M)*(2*np.pi/(10*h))**2)",
        "whole cycle",
        "half a cycle",
    ),
    "no square": ("hl.check('08.stiffest_penalty', lambda m, M, h: m*M/(m + M)*np.pi/(10*h))", "square", "pi/"),
    "relative velocity": (
        "hl.check('08.impact', lambda v, w, m, M, e: {'v': -e*v, 'w': w + (1 + e)*m*v/M, 'p': -(1 + e)*m*v})",
        "held|relative",
        "momentum|relative",
    ),
    "e forgotten": (
        "hit(lambda mass, e: mass)",
        "equal",
        r"1 \+ e",
    ),
    "a held plate": (
        "hit(lambda mass, e: (1 + e)*mass, gives_way=False)",
        "one percent|plate",
        "small term|momentum",
    ),
    "Euler's e": ("hl.check('08.pulse_time', lambda p, F_max: p/F_max)", "p/.e tau", "Euler"),
    "sign of a": (
        "hl.check('08.reaction', lambda a, m, g: {'N': max(0, m*(g - a)), 'gap_acceleration': max(0, a - g)})",
        "upwards",
        "lighter|a < 0",
    ),
    "no g": (
        "hl.check('08.reaction', lambda a, m, g: {'N': max(0, m*a), 'gap_acceleration': max(0, -a)})",
        r"weight|\bg\b",
        r"m \(g \+ a\)",
    ),
    "determinant": ("hl.check('08.largest_multiplier', lambda a, e, g: e**2)", "determinant", "larger"),
    "trace": ("hl.check('08.largest_multiplier', lambda a, e, g: 1 + (1 + e)**2*a/g + e**2)", "trace|sum", "larger|eigvals"),
}

#: whose sentence names the mistake, and of the cure only where to look
WEAKER = ("a held plate",)
