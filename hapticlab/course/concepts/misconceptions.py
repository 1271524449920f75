"""The misconceptions that wrong options stand for: a name, what a person who has it believes, and the labs that treat it."""

from typing import NamedTuple


class Misconception(NamedTuple):
    """What a wrong option shows.

    Parameters
    ----------
    title : str
    belief : str
        One sentence.
    labs : tuple of str
        Numbers of the labs that treat it.
    """

    title: str
    belief: str
    labs: tuple[str, ...]


#: name -> misconception; several options may show the same one
MISCONCEPTIONS = {
    # signs and units
    "force_on_wrong_body": Misconception(
        "Force on the wrong body",
        "The force of the hand on the environment is taken for the force of the motor on the handle, or the reverse.",
        ("00", "01"),
    ),
    "millimetres_as_metres": Misconception(
        "Millimetres as metres", "A number in millimetres is inserted where the formula needs metres.", ("00", "01")
    ),
    "half_in_the_force": Misconception(
        "Half of the force", "The factor one half of a spring's energy is thought to belong to its force as well.", ("01", "02")
    ),
    "units_by_themselves": Misconception(
        "Units take care of themselves", "A program is thought to convert units even if it only contains numbers.", ("01",)
    ),
    "unit_inverted": Misconception(
        "Conversion in the wrong direction",
        "A number is divided by the factor between two units where it must be multiplied.",
        ("01",),
    ),
    "unit_twice": Misconception(
        "Conversion made twice", "The factor between two units is applied to the stiffness and to the position.", ("01",)
    ),
    "larger_drum_more_force": Misconception(
        "A larger drum pushes harder",
        "A larger drum on the motor is thought to increase the force, as a longer arm increases a torque.",
        ("00", "09"),
    ),
    "force_is_torque": Misconception(
        "Torque taken for force",
        "The same torque of the motor is thought to give the same force at the handle, whatever the transmission.",
        ("00", "09"),
    ),
    "sensor_apart": Misconception(
        "A sensor apart from the transmission",
        "The counts per metre are thought to belong to the encoder alone, without the transmission between it and the handle.",
        ("00",),
    ),
    # energy of a held spring
    "spring_conserves": Misconception(
        "A programmed spring conserves energy",
        "A programmed spring is thought to return exactly the energy that it absorbed, as a real spring does.",
        ("02", "05"),
    ),
    "stiffer_on_exit": Misconception(
        "The spring changes",
        "The stiffness of a programmed spring is thought to differ between the way in and the way out.",
        ("02",),
    ),
    "friction_supplies": Misconception(
        "Friction supplies energy",
        "Friction or damping of the handle is thought to return energy that it took before.",
        ("02", "05"),
    ),
    "encoder_makes_leak": Misconception(
        "The encoder is the source",
        "The energy that the hold generates is attributed to the rounding of the encoder.",
        ("02", "03"),
    ),
    "stored_for_leaked": Misconception(
        "Stored energy for generated energy",
        "The energy that a spring stores is taken for the energy that the hold generates.",
        ("02",),
    ),
    "full_rectangle": Misconception(
        "The last error for the whole period",
        "The error of the held force at the end of a period is counted for the whole period, though it grows from zero.",
        ("02",),
    ),
    "one_period_for_all": Misconception(
        "One period for the whole contact",
        "The change of the leak in one period is taken for that of the whole contact.",
        ("02",),
    ),
    "each_sample_leaks_alike": Misconception(
        "More samples, more leak",
        "Each sample is thought to generate the same energy, so that faster sampling generates more.",
        ("02",),
    ),
    # passivity and stability
    "stable_is_passive": Misconception(
        "Stable means passive",
        "A wall that was stable in some hands is thought to be passive, so stable in every hand.",
        ("03", "05"),
    ),
    "firm_hand_worst": Misconception(
        "A firm hand is the hardest case",
        "A wall that is stable in a firm hand is thought to be stable in every other hand.",
        ("03", "05"),
    ),
    "program_never_passive": Misconception(
        "A program is never passive",
        "A programmed wall is thought never to be passive, although a device may dissipate more than the hold generates.",
        ("02", "05"),
    ),
    "critical_damping": Misconception(
        "Critical damping",
        "The damping that passivity requires is confused with the critical damping of an oscillator.",
        ("02", "05"),
    ),
    "whole_period_delay": Misconception(
        "The hold as a whole period",
        "The hold is counted as a delay of one period, though on average it is half a period.",
        ("02", "05", "11"),
    ),
    "virtual_damping_as_real": Misconception(
        "Virtual damping as real damping",
        "Virtual damping is thought to help passivity as the damping of the device does.",
        ("04", "05"),
    ),
    "virtual_damping_free": Misconception(
        "Virtual damping is free",
        "A virtual damper, positive or negative, is thought to have no influence on the passive stiffness.",
        ("04", "05"),
    ),
    "compensation_buys_stiffness": Misconception(
        "Compensation buys stiffness", "Damping compensation that acts everywhere is thought to allow a stiffer wall.", ("04",)
    ),
    "negative_never_passive": Misconception(
        "Negative damping is never passive",
        (
            "A negative virtual damper is thought to rule out passivity, although the device may dissipate more than the "
            "damper generates."
        ),
        ("04", "05"),
    ),
    # delay and prediction
    "delay_free": Misconception(
        "A delay costs nothing",
        "A late force is thought to be the same force a little later, without an influence on energy.",
        ("03", "11", "15"),
    ),
    "hold_free": Misconception(
        "The hold is forgotten",
        "Only the delay is counted, and not the half period by which the hold is late in addition.",
        ("03", "11"),
    ),
    "prediction_free": Misconception(
        "Prediction is free", "A law that extrapolates the position is thought not to amplify the counts of the encoder.", ("11",)
    ),
    "prediction_smooths": Misconception(
        "Prediction smooths", "Extrapolation is confused with averaging, which would make the counts smaller.", ("11",)
    ),
    # encoder and friction
    "faster_is_finer": Misconception(
        "Faster sampling is finer",
        "The velocity from two samples is thought to become finer when the samples are closer.",
        ("04", "14"),
    ),
    "encoder_alone": Misconception(
        "The encoder alone sets the velocity",
        "The smallest step of the velocity is thought not to depend on the period.",
        ("04", "14"),
    ),
    "noise_averages": Misconception(
        "More samples average",
        "A difference of two samples is thought to profit from the average over many samples.",
        ("04", "14"),
    ),
    "friction_lowers_leak": Misconception(
        "Friction lowers the leak",
        "Dry friction is thought to change the energy that the hold generates in a given motion.",
        ("03",),
    ),
    "dry_is_viscous": Misconception(
        "Dry friction as damping",
        "Dry friction is thought to act on large oscillations as it does on small ones.",
        ("03", "04"),
    ),
    "more_is_lighter": Misconception(
        "More compensation is only lighter",
        "Too much compensation is thought to make the handle lighter and nothing else.",
        ("04",),
    ),
    "friction_stays_positive": Misconception(
        "Friction cannot become negative",
        "A program is thought to be able to cancel friction at most, but not to exceed it.",
        ("04",),
    ),
    "instability_grows": Misconception(
        "Every instability grows without end", "An oscillation that begins by itself is thought to grow for ever.", ("03", "04")
    ),
    # simulated bodies
    "small_step_conserves": Misconception(
        "A small step conserves energy", "Below some step, every method is thought to conserve energy exactly.", ("07",)
    ),
    "every_method_damps": Misconception(
        "Every method damps", "The error of an integrator is thought always to remove energy.", ("07",)
    ),
    "error_is_rounding": Misconception(
        "Errors are rounding", "The error of an integrator is attributed to the digits of the numbers, not to the step.", ("07",)
    ),
    "error_follows_step": Misconception(
        "The error follows the step", "The error of every method is thought to be proportional to its step.", ("07",)
    ),
    "local_for_global": Misconception(
        "The error of one step",
        "The order of the error of a single step is taken for that of the error after a given time.",
        ("07",),
    ),
    "order_multiplies": Misconception(
        "The order as a factor", "The order of a method is thought to be a factor of the error, and not an exponent.", ("07",)
    ),
    "limit_follows_stiffness": Misconception(
        "The step limit follows the stiffness",
        "The longest stable step is thought to be inversely proportional to the stiffness.",
        ("07", "08", "17"),
    ),
    "limit_is_the_methods": Misconception(
        "The step limit belongs to the method",
        "The longest stable step is thought to depend on the method and not on the scene.",
        ("07", "08"),
    ),
    "stiffer_is_steadier": Misconception(
        "Stiffer is steadier", "A stiffer spring is thought to be easier to integrate, because it moves less.", ("07", "08")
    ),
    "series_as_parallel": Misconception(
        "Springs in series as in parallel", "The stiffnesses of two springs in series are added.", ("06", "15")
    ),
    "coupler_invisible": Misconception(
        "The coupler is not felt", "A hand is thought to feel the virtual wall itself, and not the coupler before it.", ("06",)
    ),
    "coupler_alone": Misconception(
        "Only the coupler is felt", "A hand is thought to feel the coupler alone, whatever is behind it.", ("06",)
    ),
    # measurement and load
    "interval_of_samples": Misconception(
        "The interval contains the samples", "A confidence interval is thought to contain 95 % of the recorded samples.", ("09",)
    ),
    "interval_of_devices": Misconception(
        "The interval contains the devices",
        "A confidence interval is thought to contain 95 % of all paddles of this type.",
        ("09",),
    ),
    "interval_of_estimates": Misconception(
        "The interval contains the estimates",
        "A confidence interval is thought to contain 95 % of the estimates of further experiments.",
        ("09",),
    ),
    "estimate_is_truth": Misconception(
        "The estimate is the truth", "A guarantee is computed from the estimate, as if it had no interval.", ("04", "09")
    ),
    "upper_end_is_safe": Misconception(
        "The upper end is safe",
        "The larger value is thought to be the cautious one, though a guarantee needs the least damping.",
        ("04", "09"),
    ),
    "more_samples_suffice": Misconception(
        "More samples always help", "A longer recording is thought to show every constant, whatever motion it contains.", ("09",)
    ),
    "one_speed_separates": Misconception(
        "One speed separates frictions",
        "Dry and viscous friction are thought to be separable in a motion at one speed.",
        ("04", "09"),
    ),
    "force_shows_mass": Misconception(
        "A force shows the mass", "A force on a moving handle is thought to show its mass, even if nothing accelerates.", ("09",)
    ),
    "load_is_rate": Misconception(
        "The rate alone is the load",
        "The load of a board is thought to follow the sampling rate alone, whatever the method computes in each step.",
        ("07", "12"),
    ),
    "load_is_method": Misconception(
        "The method alone is the load",
        "The load of a board is thought to follow the work in one step alone, whatever the number of steps per second.",
        ("07", "12"),
    ),
    "load_of_the_scene": Misconception(
        "The load belongs to the scene",
        "The load of a board is thought to depend on the scene alone, and neither on the method nor on the rate.",
        ("07", "12"),
    ),
    # what a hand notices
    "threshold_constant": Misconception(
        "The same difference everywhere",
        "The smallest difference that a person notices is thought to be the same at every level.",
        ("10",),
    ),
    "threshold_square_root": Misconception(
        "The root instead of the fraction",
        "The noticed difference is thought to grow with the square root of the level.",
        ("10",),
    ),
    "stiffer_is_easier": Misconception(
        "Stiffer is easier to tell apart", "Smaller differences are thought to be noticed between stiffer walls.", ("10",)
    ),
    "threshold_is_a_step": Misconception(
        "Below the threshold nothing",
        "Below the threshold a person is thought to guess, and above it to be always right.",
        ("10",),
    ),
    "below_is_wrong": Misconception(
        "Below the threshold wrong", "Below the threshold a person is thought to be wrong more often than right.", ("10",)
    ),
    "threshold_is_attention": Misconception(
        "Attention removes the threshold", "A careful person is thought to notice every difference.", ("10",)
    ),
    "cost_decides": Misconception(
        "The cost decides alone", "The part that needs most cycles is left out, whether a hand notices it or not.", ("12", "13")
    ),
    "model_everything": Misconception(
        "A model must be complete", "A part that exists in reality is thought to belong in every model of it.", ("13",)
    ),
    "only_the_whole": Misconception(
        "A hand feels only the whole", "A single part of a scene is thought not to be noticed by a hand at all.", ("13",)
    ),
    "one_by_one": Misconception(
        "Thresholds one by one", "Several parts are left out because each of them alone is below the threshold.", ("13",)
    ),
    "errors_cancel": Misconception("Errors cancel", "Several small changes are thought to cancel each other.", ("13",)),
}
