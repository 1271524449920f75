"""The scripts of a shared page in node, one process for all that is asked of it."""

import base64
import json
import shutil
import subprocess
from pathlib import Path

import numpy as np

from hapticlab.widgets.browser_view import BROWSER
from hapticlab.widgets.shared.page import PAGE_SCRIPTS

NODE = shutil.which("node")


def in_node(cases):
    """Return the answers to cases, each (what, given) as page_in_node.mjs takes them."""
    scripts = [str(BROWSER / name) for name in PAGE_SCRIPTS]
    asked = json.dumps({"scripts": scripts, "cases": cases})
    done = subprocess.run([NODE, Path(__file__).with_suffix(".mjs")], input=asked, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def evaluated(scripts, expression, **given):
    """Return, by JSON, what an expression of JavaScript is after some scripts of the page, with ``given`` as its names."""
    source = "\n".join((BROWSER / "page" / script).read_text("utf-8") for script in scripts)
    code = f"""
    const given = JSON.parse(require("fs").readFileSync(0, "utf-8"))
    const work = new Function(...Object.keys(given), {json.dumps(source)} + ";return " + {json.dumps(expression)})
    console.log(JSON.stringify(work(...Object.values(given))))
    """
    done = subprocess.run([NODE, "-e", code], input=json.dumps(given), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def text(numbers):
    """Return numbers as text that keeps every bit."""
    return base64.b64encode(np.ascontiguousarray(numbers, "<f8").tobytes()).decode()


def array(text, type="<f8"):
    return np.frombuffer(base64.b64decode(text), type)
