"""Each right answer is what the package computes or simulates, and each wrong number what its misconception computes.

The formulas of the questions stand in ``hapticlab/course/concepts``; here each is derived in another way, for many drawn numbers.
"""

import re

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import x
from hapticlab.course.concepts.inventory import form

#: README's line tries the numbers of one seed, .ci/run those of forty
pytestmark = [pytest.mark.parametrize("draws", [range(1), range(40)], ids=["few", "many"]), pytest.mark.always("few")]
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def asked(name, draws):
    """Yield (numbers, misconception -> first number of the option, misconception -> text) of a question, "" for the right one."""
    for seed in draws:
        (one,) = [one for one in form(seed, "ada", "before") if one.question.name == name]
        texts = {option.misconception: option.text for option in one.options}
        found = {key: NUMBER.search(text) for key, text in texts.items()}
        yield one.numbers, {key: float(match[0]) for key, match in found.items() if match}, texts


def near(value):
    """The numbers of options have three or four digits."""
    return pytest.approx(value, rel=6e-3)


def check(name, right, wrong, draws):
    """Compare the numbers of the options with functions of the drawn numbers."""
    for numbers, options, _ in asked(name, draws):
        assert options[""] == near(right(numbers)), (name, numbers)
        for misconception, function in wrong.items():
            assert options[misconception] == near(function(numbers)), (name, misconception, numbers)


def heavy(x, v, T=1e-3):
    """A handle that nothing brakes, so that its motion is prescribed."""
    return hl.SimulatedPaddle(m=1e9, b=0, T=T), {"x": x, "v": v}


# ---------------------------------------------------------------- signs and units


def test_the_motor_pushes_out_of_the_wall(draws):
    for numbers, options, texts in asked("motor_force", draws[:6]):
        log = hl.SimulatedPaddle(m=0.05, b=0, T=1e-3).run(hl.wall()(k=numbers["K"], x_o=0), duration=3e-3, x=numbers["d"] / 1000)
        assert log.v[1] < 0  # to the left
        assert "left" in texts[""] and "right" in texts["force_on_wrong_body"]
        assert options[""] == options["force_on_wrong_body"] == near(log.F[0])
        assert options["millimetres_as_metres"] == near(1000 * log.F[0])
        assert options["half_in_the_force"] == near(log.F[0] / 2)


def test_a_stiffness_in_newtons_per_millimetre(draws):
    def right(given):
        return hl.wall()(k=f"{given['k']} N/mm").values["k"]

    wrong = {
        "units_by_themselves": lambda given: given["k"],
        "unit_inverted": lambda given: given["k"] ** 2 / right(given),
        "unit_twice": lambda given: right(given) ** 2 / given["k"],
    }
    check("number_for_newtons_per_metre", right, wrong, draws)


def test_a_larger_drum_by_virtual_work(draws):
    theta, r_p, r_s, r_h, torque, counts = sp.symbols("theta r_p r_s r_h torque counts", positive=True)
    travel = theta * r_p / r_s * r_h  # of the handle, for an angle of the motor
    force = torque / sp.diff(travel, theta)
    per_metre = counts / (2 * sp.pi) / sp.diff(travel, theta)
    for numbers, _, texts in asked("larger_drum", draws[:8]):
        ratios = [sp.simplify(one.subs(r_p, numbers["r"] * r_p) / one) for one in (force, per_metre)]
        assert ratios == [pytest.approx(1 / numbers["r"])] * 2
        assert texts[""] == f"The force and the counts per metre are both divided by {numbers['r']:g}."


# ---------------------------------------------------------------- energy of a held spring


def test_the_leak_of_one_period(draws):
    for numbers, options, _ in asked("leak_of_one_period", draws[:8]):
        K, depth, moved = numbers["K"], numbers["d"] / 1000, numbers["D"] / 1000
        paddle, start = heavy(depth, moved / 1e-3)
        log = paddle.run(hl.wall()(k=K, x_o=0), duration=3e-3, **start)
        work = log.F[0] * (log.x[1] - log.x[0])
        stored = K * (log.x[1] ** 2 - log.x[0] ** 2) / 2
        assert options[""] == near(1e6 * (stored - work))
        assert options["full_rectangle"] == near(1e6 * (log.F[1] - log.F[0]) * moved)
        assert options["stored_for_leaked"] == near(1e6 * K * depth**2 / 2)


def leaked(T, depth=0.01, v=0.1, K=500.0):
    """Energy that a wall generates where a machine moves the handle in and out at one speed."""
    total = 0.0
    for start, speed in ((0.0, v), (depth, -v)):
        paddle, given = heavy(start, speed, T)
        log = paddle.run(hl.wall()(k=K, x_o=0), duration=depth / v, **given)
        moved = speed * T
        total -= float(np.sum(log.F) * moved)  # work of the handle, of each held force
    return total


def test_faster_sampling_generates_less(draws):
    def ratio(given):
        return leaked(1e-3 / given["r"]) / leaked(1e-3)

    wrong = {
        "one_period_for_all": lambda given: given["E"] * ratio(given) ** 2,
        "each_sample_leaks_alike": lambda given: given["E"] / ratio(given),
        "encoder_makes_leak": lambda given: given["E"],
    }
    check("leak_with_faster_sampling", lambda given: given["E"] * ratio(given), wrong, draws[:4])


def test_the_held_force_is_too_small_inwards_and_too_large_outwards(draws):
    for speed in (0.1, -0.1):
        paddle, given = heavy(0.01, speed)
        log = paddle.run(hl.wall()(k=500, x_o=0), duration=5e-3, **given)
        mean = 500 * (log.x[:-1] + log.x[1:]) / 2  # of an ideal spring
        assert np.all((mean - log.F[:-1]) * speed > 0)


# ---------------------------------------------------------------- passivity


def test_the_damping_that_is_required(draws):
    for numbers, options, _ in asked("damping_required", draws):
        T = numbers["T"] / 1000
        assert hl.passivity_limit(hl.Device(b=numbers["right"], T=T)).K == near(numbers["K"])
        assert options[""] == near(hl.passivity.wall_damping(hl.Device(T=T), K=numbers["K"]))
        assert options["whole_period_delay"] == near(2 * options[""])
        ratio = options["critical_damping"] / (2 * np.sqrt(numbers["K"] * numbers["m"] / 1000))
        assert ratio == near(1.0)


def test_a_firm_hand_says_nothing_about_a_light_one(draws):
    firm, light = hl.Hand("grip"), hl.Hand(m=0.005, b=0.02, k=60)
    for numbers, _, _ in asked("stable_in_many_hands", draws[:8]):
        b = 0.8 * numbers["K"] * 1e-3 / 2  # not passive
        limits = [hl.stability_limit(hl.SimulatedPaddle(m=0.05, b=b, T=1e-3, hand=hand)).K for hand in (firm, light)]
        assert limits[0] > numbers["K"] > limits[1]


def test_a_virtual_damper_of_either_sign_costs_stiffness(draws):
    for numbers, options, _ in asked("virtual_damper_in_the_wall", draws):
        device = hl.Device(b=numbers["b"], T=numbers["T"] / 1000)
        limit = hl.passivity_limit(device, B=numbers["B"]).K
        free = hl.passivity_limit(device).K
        expected = {
            "": limit,
            "virtual_damping_free": free,
            "virtual_damping_as_real": 2 * free - limit,
            "whole_period_delay": limit / 2,
        }
        assert options == {key: near(value) for key, value in expected.items()}
    for numbers, options, _ in asked("compensation_everywhere", draws):
        device = hl.Device(b=numbers["K"] * 1e-3 / 2, T=1e-3)
        limit = hl.passivity_limit(device, B=-numbers["p"] / 100 * device.b).K
        assert options[""] == near(limit) and limit > 0  # negative damping can be passive
        assert options["virtual_damping_free"] == near(hl.passivity_limit(device).K)
        assert options["compensation_buys_stiffness"] == near(2 * numbers["K"] - limit)


# ---------------------------------------------------------------- delay and prediction


def test_the_damping_of_a_late_wall(draws):
    for numbers, options, _ in asked("damping_for_a_late_wall", draws[:8]):
        law = hl.laws.LinearLaw.of("zoh", K=float(numbers["K"]), T=1e-3)
        late = hl.Device(T=1e-3, delay=numbers["tau"] / 1000)
        at = {
            name: -float(hl.passivity.equivalent_damper(one, law, 1e-3))
            for name, one in (("hold", hl.Device(T=1e-3)), ("late", late))
        }
        expected = {
            "": at["late"],
            "delay_free": at["hold"],
            "hold_free": at["late"] - at["hold"],
            "whole_period_delay": at["late"] + at["hold"],
        }
        assert options == {key: near(value) for key, value in expected.items()}


def test_how_far_a_late_law_must_look_ahead(draws):
    """At constant speed, of a force that each sample holds later."""

    def generated(late, ahead, depth=40, K=1.0):
        held = np.arange(late, depth + late)  # the position where each force acts first, one unit a period
        return np.sum(K * ((held + 0.5) - (held - late + ahead)))

    for numbers, options, _ in asked("how_far_ahead", draws[:8]):
        late = int(numbers["j"])
        assert generated(late, options[""]) == pytest.approx(0)
        assert all(abs(generated(late, options[one])) > 1 for one in options if one)
        assert options["hold_free"] == late and options["whole_period_delay"] == late + 1 and options["delay_free"] == 0.5


def test_the_price_of_a_prediction(draws):
    first = hl.laws.BackwardDifferenceSpring.taps[0]
    smoothed = 0.5  # the mean of two samples
    wrong = {
        "prediction_free": lambda given: given["K"] * given["q"] * 1e-3,
        "prediction_smooths": lambda given: smoothed * given["K"] * given["q"] * 1e-3,
        "whole_period_delay": lambda given: (1 + 2 * (first - 1)) * given["K"] * given["q"] * 1e-3,
    }
    check("price_of_prediction", lambda given: first * given["K"] * given["q"] * 1e-3, wrong, draws)


# ---------------------------------------------------------------- encoder and friction


def test_the_smallest_step_of_a_velocity(draws):
    def step(q, kHz):
        read = np.floor(np.linspace(0, 3, 400) + 1e-9) * q  # um, of a slow motion
        return np.diff(read).max() * kHz  # um/ms = mm/s

    wrong = {
        "faster_is_finer": lambda given: given["q"] ** 2 / step(given["q"], given["kHz"]),
        "encoder_alone": lambda given: step(given["q"], 1),
        "noise_averages": lambda given: given["q"] / np.sqrt(given["kHz"]),
    }
    check("step_of_the_velocity", lambda given: step(given["q"], given["kHz"]), wrong, draws)


def test_friction_stops_small_oscillations_and_not_large_ones(draws):
    (question,) = [one.question for one in form(0, "", "before") if one.question.name == "friction_hides_chatter"]
    names = {"hl": hl}
    exec(question.picture.partition("hl.show(")[0], names)  # what the picture shows
    frictionless, rubbing = (position for _, position in names["curves"].values())
    assert np.ptp(frictionless[-60:]) > 2 * np.ptp(frictionless[:60]) and np.ptp(rubbing[-60:]) < 1e-6
    paddle, wall = names["handle"], hl.wall()(k=1000, x_o=0)
    assert paddle.coulomb == 0.02 and 1000 > hl.passivity_limit(paddle).K
    knocked = paddle.run(wall, duration=3.0, x=1.887e-3, v=0.3).x
    assert np.ptp(knocked[2000:]) > 0.95 * np.ptp(knocked[1000:2000]) > 1e-3  # it does not stop


def test_too_much_compensation_ends_in_a_limit_cycle(draws):
    law = hl.laws.damping_compensation(b=0.05, coulomb=0.05, speed="2 mm/s")
    paddle = hl.SimulatedPaddle(m=0.03, b=0.05, T=1e-3, coulomb=0.05, hand=hl.Hand(m=0.005, b=0.02, k=20))
    for numbers, _, _ in asked("too_much_compensation", draws[:3]):
        for start in (0.01, 0.03):
            log = paddle.run(law(viscous=0, dry=numbers["p"] / 100), duration=8.0, x=start)
            third, last = (np.ptp(part) for part in np.array_split(log.x, 8)[-2:])
            assert last == pytest.approx(third, rel=0.02) and last > 1e-3
    assert np.ptp(paddle.run(law(viscous=0, dry=1.0), duration=8.0, x=0.02).x[-1000:]) < 1e-3


# ---------------------------------------------------------------- simulated bodies


def test_forward_euler_gains_energy_at_every_step(draws):
    for numbers, _, _ in asked("forward_euler", draws[:8]):
        w = np.sqrt(numbers["K"] / (numbers["m"] / 1000))
        grown = [abs(1 + 1j * w * h) ** 2 - 1 for h in (1e-2, 1e-3, 1e-5)]
        assert np.all(np.diff(grown) < 0) and min(grown) > 0
    assert hl.methods.table()["euler"].imaginary == 0


def rk(order, h):
    """Error of a Runge-Kutta method of an order after one second of x'' = -9 x."""
    A = h * np.array([[0.0, 1.0], [-9.0, 0.0]])
    step = sum(np.linalg.matrix_power(A, k) / float(sp.factorial(k)) for k in range(order + 1))
    end = np.linalg.matrix_power(step, round(1 / h)) @ [1.0, 0.0]
    return np.hypot(end[0] - np.cos(3), (end[1] + 3 * np.sin(3)) / 3)


def test_what_the_order_says(draws):
    for numbers, options, _ in asked("order_of_a_method", draws):
        p, r, e = numbers["p"], numbers["r"], numbers["e"]
        assert options[""] == pytest.approx(e * rk(p, 0.01 / r) / rk(p, 0.01), rel=0.05)
        assert options["error_follows_step"] == near(e / r) and options["order_multiplies"] == near(e / (p * r))
        assert options["local_for_global"] == near(options[""] / r)


def test_the_longest_step_of_a_stiffer_contact(draws):
    k, m = hl.parameters("k m", units="N/m kg", values=(500, 0.05))
    z = hl.coordinate("z", unit="m")
    pull = k * (x(hl.t) - z)
    scene = hl.Scene(force=pull, eom=[sp.Eq(m * z.diff(hl.t, 2), pull)])

    def longest(stiffer):
        return hl.stability.step_limit(scene(k=500 * stiffer), "semi_implicit_euler", T=1e-3).margin

    for numbers, options, _ in asked("stiffer_contact", draws[:12]):
        ratio = longest(numbers["s"]) / longest(1)
        assert options[""] == near(numbers["h"] * ratio)
        assert options["limit_follows_stiffness"] == near(numbers["h"] * ratio**2)
        assert options["limit_is_the_methods"] == numbers["h"] and options["stiffer_is_steadier"] == near(numbers["h"] / ratio)


def test_a_wall_through_a_coupler(draws):
    z = hl.coordinate("z", unit="m")
    m, K_c, K, b = hl.parameters("m K_c K b", units="kg N/m N/m N*s/m", values=(0.05, 300, 600, 3))
    coupler = hl.laws.virtual_coupler(z, K=K_c, b=b)
    scene = hl.Scene(force=coupler, eom=[sp.Eq(m * z.diff(hl.t, 2), coupler - hl.when(z >= 0, K * z))])
    for numbers, options, _ in asked("wall_behind_a_coupler", draws[:8]):
        paddle, start = heavy(0.01, 0)
        log = paddle.run(scene(K=numbers["K"], K_c=numbers["K_c"]), duration=1.0, **start)
        assert options[""] == near(log.F[-1] / 0.01)
        assert options["series_as_parallel"] == numbers["K"] + numbers["K_c"]
        assert (options["coupler_invisible"], options["coupler_alone"]) == (numbers["K"], numbers["K_c"])


# ---------------------------------------------------------------- measurement and load


def test_what_an_interval_contains(draws):
    random = np.random.default_rng(3)
    for numbers, _, _ in asked("what_an_interval_states", draws[:3]):
        true, half = (numbers["low"] + numbers["high"]) / 2, (numbers["high"] - numbers["low"]) / 2
        estimates = true + half / 1.96 * random.standard_normal(20_000)
        assert np.mean(abs(estimates - true) < half) == pytest.approx(0.95, abs=0.01)  # their intervals contain the truth
        others = np.mean(abs(estimates - random.permutation(estimates)) < half)
        assert others < 0.9  # further estimates in an interval
        samples = true + 5 * half * random.standard_normal(20_000)
        assert np.mean(abs(samples - true) < half) < 0.5  # the mean of many samples is known better than one


def test_the_lower_end_guarantees(draws):
    for numbers, options, _ in asked("value_for_a_guarantee", draws):
        ends = {"": "low", "estimate_is_truth": "b", "upper_end_is_safe": "high"}
        expected = {key: hl.passivity_limit(hl.Device(b=numbers[name], T=1e-3)).K for key, name in ends.items()}
        assert options == {key: near(value) for key, value in (expected | {"whole_period_delay": expected[""] / 2}).items()}


def test_one_speed_determines_one_sum(draws):
    for numbers, _, texts in asked("one_constant_speed", draws[:4]):
        v, samples = numbers["v"] / 1000, int(numbers["n"])
        columns = np.column_stack([np.zeros(samples), np.full(samples, v), np.ones(samples)])  # of m, b and f_c
        assert np.linalg.matrix_rank(columns) == 1 and columns[0].tolist() == [0, v, 1]
        assert texts[""] == "only the sum $f_c + b\\,v$"


def test_the_load_is_what_one_step_costs_times_the_rate(draws):
    k, m, d = hl.parameters("k m d", units="N/m kg m", values=(500, 0.05, 0.01))
    z = hl.coordinate("z", unit="m")
    pull = k * d * sp.sin((x(hl.t) - z) / d)
    scene = hl.Scene(force=pull, eom=[sp.Eq(m * z.diff(hl.t, 2), pull)])  # the force is what the first evaluation computes
    methods = "rk4", "semi_implicit_euler"
    steps = {name: str(hl.compile(scene, T=1e-3, method=name)).count("sin") for name in methods}
    cheaper = steps["semi_implicit_euler"] / steps["rk4"]
    wrong = {
        "load_is_rate": lambda given: given["L"] * given["r"],
        "load_is_method": lambda given: given["L"] * cheaper,
        "load_of_the_scene": lambda given: given["L"],
    }
    check("load_of_a_cheaper_method", lambda given: given["L"] * cheaper * given["r"], wrong, draws)


# ---------------------------------------------------------------- what a hand notices


def test_webers_law_and_answers_below_the_threshold(draws):
    for numbers, options, _ in asked("weber_fraction", draws[:12]):
        curve = hl.people.SimulatedObserver(weber=numbers["d"] / numbers["K"]).curve()
        ways = {key: float(curve(np.log1p(difference / (4 * numbers["K"])))) for key, difference in options.items()}
        here = float(curve(np.log1p(numbers["d"] / numbers["K"])))
        assert ways[""] == pytest.approx(here, rel=1e-9)
        assert all(abs(value - here) > 0.02 for key, value in ways.items() if key)
    for numbers, _, _ in asked("below_the_threshold", draws):
        curve = hl.people.SimulatedObserver(weber=numbers["w"] / 100).curve()
        assert 0.55 < float(curve(np.log1p(numbers["half"] / 100))) < 0.75 < float(curve(np.log1p(numbers["w"] / 100)))


def test_what_may_be_left_out(draws):
    for numbers, _, _ in asked("what_to_leave_out", draws):
        assert numbers["a"] < numbers["threshold"] < numbers["b"] and numbers["a_cost"] < numbers["b_cost"]
    for numbers, _, texts in asked("several_small_changes", draws):
        force = np.full(100, 1.0)
        less = force - 3 * [numbers["a"] / 100 * force][0]  # all three parts pull in the same direction
        assert numbers["a"] < numbers["threshold"] < 100 * abs(less - force).max()
        assert f"by {100 * abs(less - force).max():.0f} %" in texts[""]
