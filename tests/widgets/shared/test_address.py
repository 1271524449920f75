import random

import pytest
from page_in_node import NODE, evaluated

import hapticlab as hl
from hapticlab import n, x
from hapticlab.cli.options import parser
from hapticlab.device.simulated.stepping import Stepping
from hapticlab.errors import HapticlabError
from hapticlab.widgets.shared.around import fixed
from hapticlab.widgets.shared.units import units

pytestmark = pytest.mark.skipif(NODE is None, reason="the scripts of a page are run by node 18 or newer")
k, x_o, B, m, a, ratio, tau, g = hl.parameters("k x_o B m a ratio tau g", units="N/m m N*s/m kg rad 1 s m/s^2")
SCENE = hl.Scene(force=k * ratio * (x(n) - x_o) + m * g, watch={"B": B, "a": a, "tau": tau}, name="all units")
OWN = SCENE(k=300, x_o=0.01, B=0.5, m=0.02, a=0.1, ratio=0.7, tau=1e-3, g=9.81)
VALUES = dict(OWN.values)
PARAMETERS = [{"name": name, "unit": one.unit, "value": VALUES[name]} for name, one in OWN.parameters.items()]
PARSER = parser()
TOLD = {"parameters": PARAMETERS, "units": units(), "flags": ["slow-motion"], "traces": ["x", "F", "E"]}
ADDRESS = ["address.js"]

#: as they may stand after --set
READ = (
    """k=150 k=150N/m k=.15N/mm k=0.15kN/m k=1.5e2N/m k=150000mN/m k=1N/cm k=150kg/s^2 k=150kg*s**-2 x_o=10mm x_o=1cm
x_o=-2.5e-3m x_o=12um x_o=12µm x_o=3e4nm B=500mN*s/m B=0.5N*s/m B=5e-4N*s/mm B=0.5kg/s m=20g m=0.02kg a=5.7deg a=0.1rad a=0.1
ratio=0.25 tau=2ms tau=500us g=9.8m/s^2 g=981cm/s^2 g=1e4mm/s**2 k=0 x_o=0mm""".split()
    + ["k = 150 N / m", "B=0.5 N s/m"]
)
#: that nothing can be set to, and why
REFUSED = ["k=150N", "x_o=2s", "x_o=mm", "k=", "k", "=3", "y=3", "K=3", "ratio=2mm", "k=3N/m/", "k=3N/m;4", "x_o=2mm5", "k=--3"]
HOSTILE = [
    "__proto__=1", "constructor=1", "toString=3", "hasOwnProperty", "k=__proto__", "k=3constructor", "k=3 toString/__proto__",
    "<script>alert(1)</script>=3", "k=<img src=x onerror=alert(1)>", "%", "%E0%A4%A", "k=%00", "k=3%3Bm=1", "k=1" + "0" * 3000,
    ";" * 3000, "k=3" * 1000, "k=" + "9" * 3000 + "N/m",
]  # fmt: skip


def python_reads(text):
    """What ``hapticlab run --set`` gives a scene, or None where it is refused."""
    try:
        settings = PARSER.parse_args(["run", "scene.py", "--set", text]).set
        return dict(OWN(**dict(settings)).values)
    except (HapticlabError, SystemExit):
        return None


def read(texts):
    return evaluated(ADDRESS, "texts.map((text) => readAddress('#' + text, told))", texts=texts, told=TOLD)


def test_an_address_is_read_as_set_reads_it(capsys):
    for text, found in zip(READ, read(READ), strict=True):
        assert not found["problems"], found
        assert VALUES | found["values"] == python_reads(text), text
    for text, found in zip(REFUSED, read([text.split(";")[-1] for text in REFUSED]), strict=True):
        assert found["problems"] and not found["values"]
        assert python_reads(text) is None or ";" in text, text
    capsys.readouterr()


def test_a_unit_that_only_pint_knows_is_refused_in_words():
    assert python_reads("k=1lbf/inch")
    (found,) = read(["k=1lbf/inch"])
    assert found["problems"] == [
        "k = '1lbf/inch'; needs a quantity in N/m, like '2 N/m' (this page reads metric units, and 'lbf/inch' is none)"
    ]


def test_an_unknown_name_gets_the_sentence_of_python():
    texts = ["y=3", "y=3mm", "K=3", "x_O=2mm"]
    for text, found in zip(texts, read(texts), strict=True):
        name, _, value = text.partition("=")
        with pytest.raises(HapticlabError) as refused:
            OWN(**{name: value})
        assert found["problems"][0].replace(f" = {value}:", f" = '{value}':") == str(refused.value)


def test_a_parameter_that_is_not_live_says_why():
    gears = hl.library.gears()
    told = TOLD | {"fixed": fixed(gears, Stepping(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), gears))}
    (found,) = evaluated(ADDRESS, "[readAddress('#N_1=12;constructor=1', told)]", told=told)
    with pytest.raises(HapticlabError) as refused:
        Stepping(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), gears).set(N_1=12)
    assert found["problems"][0] == str(refused.value) and "no parameter constructor" in found["problems"][1]


def test_what_was_changed_is_written_and_read_again():
    draw = random.Random(23)
    factors = [1, 2, 0.5, -2.7, *(10 ** draw.uniform(-9, 9) for _ in range(4))]
    changed = [{one["name"]: one["value"] * draw.choice(factors) for one in PARAMETERS} for _ in range(15)]
    write = "all.map((values) => writeAddress(values, [], told)).map((text) => [text, readAddress(text, told)])"
    for values, (text, found) in zip(changed, evaluated(ADDRESS, write, all=changed, told=TOLD), strict=True):
        assert not found["problems"]
        assert VALUES | found["values"] == values
        parts = [part for part in text.removeprefix("#").split(";") if part]
        assert len(parts) == sum(values[name] != VALUES[name] for name in values)
        for part in parts:
            name = part.partition("=")[0]
            assert python_reads(part) in (None, VALUES | {name: values[name]})  # None: a negative mass


def test_an_address_is_short_and_readable():
    long = VALUES | {"B": 0.1 + 0.2, "ratio": 0.5}
    states = [[{"k": 150.0, "x_o": 0.0123}, []], [{"k": 300.0}, ["slow-motion"]], [long, []], [{}, []]]
    texts = evaluated(ADDRESS, "all.map(([values, on]) => writeAddress(values, on, told))", told=TOLD, all=states)
    assert texts == ["#k=150N/m;x_o=12.3mm", "#slow-motion", "#B=0.30000000000000004N*s/m;ratio=0.5", ""]


def test_traces_are_named_in_the_address():
    write = "readAddress(writeAddress({}, ['slow-motion'], told, ['x', 'E']), told)"
    found = evaluated(ADDRESS, write, told=TOLD)
    assert (found["flags"], found["traces"], found["problems"]) == (["slow-motion"], ["x", "E"], [])
    (found,) = read(["traces=F,q"])
    assert found["traces"] == ["F"] and found["problems"] == ["traces = 'q': there is no such trace; there are x, F, E"]


def test_a_hostile_address_sets_nothing_and_is_told_in_few_words():
    for found in read(HOSTILE):
        assert set(found["values"]) <= {"k", "m"}
        assert all(len(problem) < 300 for problem in found["problems"])
    (long,) = read(["k=1;" * 500_000])
    assert not long["values"] and len(long["problems"]) == 1
