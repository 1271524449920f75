"""Scripts of a shared file's page, run by node without a page."""

import json
import shutil
import subprocess

import pytest

from hapticlab.widgets.browser_view import BROWSER

needs_node = pytest.mark.skipif(not shutil.which("node"), reason="scripts of a page are run by node 18 or newer")


def in_node(scripts, expression, **given):
    """Return, by JSON, what an expression of JavaScript is after these scripts, with ``given`` as its names."""
    source = "\n".join((BROWSER / script).read_text("utf-8") for script in scripts)
    code = f"""
    const given = JSON.parse(require("fs").readFileSync(0, "utf-8"))
    const work = new Function(...Object.keys(given), {json.dumps(source)} + ";return " + {json.dumps(expression)})
    console.log(JSON.stringify(work(...Object.values(given))))
    """
    done = subprocess.run(["node", "-e", code], input=json.dumps(given), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
