"""Draw the picture of README.md from its own example: `python tests/benchmarks/readme_picture.py`."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PICTURE = ROOT / "docs" / "images" / "chatter.png"


def draw(to=PICTURE):
    """Run the first example of README.md and write its figure."""
    (example,) = re.findall(r"^```python\n(.*?)^```", (ROOT / "README.md").read_text("utf-8"), re.M | re.S)
    names = {}
    exec(compile(example, "README.md", "exec"), names)
    names["figure"].savefig(to, dpi=80)


if __name__ == "__main__":
    draw()
