"""What the command line says of the wheels for a lab room: its steps, its size, what a system lacks, and how to install them."""

from ..site.room_readme import README
from ..site.wheel_folder import collect_wheels


def wheels(parser, options):
    """Collect the wheels, and say what is missing and how to install them; 1 if a system is not served."""
    made = collect_wheels(
        options.folder, systems=options.systems, pythons=options.pythons, extras=options.extras, wheel=options.wheel,
        say=lambda step: print(f"  {step}", flush=True),
    )  # fmt: skip
    print(f"wheels in {made.folder.resolve()}: {len(made.files)} files, {sum(made.files.values()) / 1e6:.0f} MB")
    for line in made.missing:
        print(f"missing: {line}")
    print(f"\nto install: copy the folder to the room; its {README} has the line of each system")
    return 1 if any("not collected" in line for line in made.missing) else 0
