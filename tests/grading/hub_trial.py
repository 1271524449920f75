"""Runs docs/teaching/server.md in a machine of its own: users, JupyterHub, proxy and exchange; writes what happened as JSON.

It is started by test_hub.py as the first process of new mount, process and network namespaces, where root may make users and
folders that nobody else sees, and where 127.0.0.1 is its own.

    unshare --mount --net --pid --fork --mount-proc --kill-child python hub_trial.py SCRATCH
"""

import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from hand_in import LABS, ROOT, WRONG, handed_in
from hub_client import Person, wait_for

PAGE = (ROOT / "docs" / "teaching" / "server.md").read_text("utf-8")
LAB = LABS["02"]
HUB = "http://127.0.0.1:8000"
PASSWORD = "a paddle and a wall"
ENVIRONMENT = Path("/opt/haptics")
NOTEBOOK = f"{LAB.name}/{LAB.notebook.name}"
#: what nobody but the instructor may read, and what only root may change
SECRET = ("/home/prof/answers/02_virtual_wall/solution.py", "/home/prof/haptics/gradebook.db", "/home/bob", "/srv/jupyterhub",
          "/srv/nbgrader/exchange/haptics/inbound")  # fmt: skip


def blocks(page=PAGE):
    """Return the page's commands in order: (who, heading, lines)."""
    found = []
    for heading, text in re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", page, re.M | re.S):
        for who, lines in re.findall(r"^```sh\n# as (\w+)[^\n]*\n(.*?)^```", text, re.M | re.S):
            found.append((who, heading, lines.strip()))
    return found


def files(page=PAGE):
    """Return the files of the page, path to content."""
    return dict(re.findall(r"`(/[^`\s]*)`[^`]*?:?\n[^`]*?\n?```(?:py|sh)\n(?!# as)(.*?)^```", page, re.M | re.S))


def private_machine(scratch):
    """Put empty folders of this machine's own over those that the page writes to, and its environment where the page has it."""
    subprocess.run(["mount", "--make-rprivate", "/"], check=True)
    for place in ("/etc", "/home", "/srv", "/opt"):
        own = scratch / place[1:]
        if place == "/etc":
            shutil.copytree(place, own, symlinks=True)
        else:
            own.mkdir()
    (scratch / "opt" / ENVIRONMENT.name).mkdir()
    subprocess.run(["mount", "--bind", sys.prefix, scratch / "opt" / ENVIRONMENT.name], check=True)
    for place in ("/etc", "/home", "/srv", "/opt"):
        subprocess.run(["mount", "--rbind", scratch / place[1:], place], check=True)
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)


def as_root(lines, **given):
    return subprocess.run(["bash", "-ec", lines], cwd=ROOT, check=True, text=True, capture_output=True, **given).stdout


class Trial:
    """The course of the page, step by step; ``facts`` is what the test judges."""

    def __init__(self):
        self.facts, self.left = {}, blocks()

    def next(self, who, heading):
        """Return the next commands of the page, which must be these."""
        said, under, lines = self.left.pop(0)
        assert (said, under) == (who, heading), f"the page goes on with {said} under {under}, not with {who} under {heading}"
        return lines

    def set_up(self):
        self.next("root", "Install")  # who runs this test has done it
        as_root(self.next("root", "Install"))
        as_root("chpasswd", input="".join(f"{name}:{PASSWORD}\n" for name in ("prof", "ada", "bob")))
        as_root(self.next("root", "The exchange"))
        for path, content in files().items():
            Path(path).parent.mkdir(parents=True, exist_ok=True)
            Path(path).write_text(content, "utf-8")
        with open("/srv/hub.log", "w") as log:
            self.hub = subprocess.Popen(["bash", "-ec", self.next("root", "JupyterHub")], stdout=log, stderr=log)
        wait_for(f"{HUB}/hub/login")
        as_root(self.next("root", "Make the course and release a lab"))

    def type(self, person, lines):
        """Type commands into this person's terminal; each must succeed."""
        shown, well = person.type(*lines.splitlines())
        assert well, f"{person.name}: {lines}\n{shown}"
        return shown

    def release(self):
        self.prof = Person(HUB, "prof", PASSWORD)
        self.facts["released"] = self.type(self.prof, self.next("prof", "Make the course and release a lab"))

    def students(self):
        ada, bob = (Person(HUB, name, PASSWORD) for name in ("ada", "bob"))
        about = {"course_id": "haptics", "assignment_id": LAB.name}
        ada.press("fetch", **about)
        self.type(bob, self.next("bob", "What a student does"))
        self.facts["checked"] = self.work(ada)
        self.facts["bob_checked"] = self.work(bob, WRONG["02"], "open('/home/prof/answers/02_virtual_wall/solution.py')")
        self.facts["open_to_ada"] = self.look_around(ada)
        self.facts["servers_of_others"] = [ada.at_another("bob"), ada.at_another("prof"), ada.at_another("ada")]
        ada.press("submit", **about)
        self.type(bob, self.next("bob", "What a student does"))
        self.ada, self.bob = ada, bob

    def work(self, person, wrong=None, first=""):
        """Fill a student's notebook, run it from top to bottom in their kernel, save it; return what its checks said."""
        notebook = handed_in(person.notebook(NOTEBOOK), LAB, wrong)
        if first:
            notebook["cells"].insert(0, {**notebook["cells"][0], "cell_type": "code", "source": first, "id": "looks-around"})
            notebook["cells"][0] |= {"outputs": [], "execution_count": None}
        cells = [cell["source"] for cell in notebook["cells"] if cell["cell_type"] == "code"]
        said = person.run(NOTEBOOK, cells)
        person.save(NOTEBOOK, notebook)
        return [one for one in said if one.startswith("02.") or "Error" in one]

    def look_around(self, person):
        """Return what this person's kernel can do that it must not."""
        reads = [f"import os; print(os.listdir({p!r}) if os.path.isdir({p!r}) else open({p!r}).read())" for p in SECRET]
        writes = [
            f"open({str(ENVIRONMENT / 'lib' / 'x.py')!r}, 'w')",
            "os.rename('/srv/nbgrader/exchange/haptics', '/srv/nbgrader/exchange/mine')",
        ]
        said = person.run(NOTEBOOK, [*reads, *writes])
        return [code for code, one in zip([*reads, *writes], said, strict=True) if not one.startswith("PermissionError")]

    def forge(self):
        """Let ada hand in a link to the solved notebook, and under bob's name, in the form that nbgrader gives submissions."""
        inbound, late = "/srv/nbgrader/exchange/haptics/inbound", f"{LAB.name}+2099-01-01 00:00:00.000000 UTC+x"
        linked, forged = f"{inbound}/ada+{late}", f"{inbound}/bob+{late}"
        collect = ["cd ~/haptics", f"nbgrader collect {LAB.name}"]
        self.type(self.ada, f"mkdir '{linked}'\nln -s ~prof/haptics/source/{NOTEBOOK} '{linked}'")
        self.facts["linked"] = self.prof.type(*collect)
        self.facts["through_the_link"] = [str(path) for path in Path("/home/prof/haptics/submitted").glob(f"ada/{NOTEBOOK}")]
        as_root(f"rm -r '{linked}'")
        self.type(self.ada, f"cp -r {LAB.name} '{forged}'")
        self.type(self.prof, "rm -r ~/haptics/submitted")
        self.facts["forged"] = self.prof.type(*collect)
        as_root(f"rm -r '{forged}'")
        self.type(self.prof, "rm -r ~/haptics/submitted/bob")

    def grade(self):
        self.facts["graded"] = self.type(self.prof, self.next("prof", "Collect and grade"))
        course = Path("/home/prof/haptics")
        self.facts["forbidden"] = self.without_user_namespaces()
        self.facts["marks"] = (course / "marks.csv").read_text("utf-8")
        self.facts["bobs_page"] = (course / "pages" / "students" / "bob.html").read_text("utf-8")

    def without_user_namespaces(self):
        """Return what the page's ways of grading say where no user may make namespaces."""
        line = next(one for one in blocks()[8][2].splitlines() if one.startswith("hapticlab grade"))
        command = f"cd /home/prof/haptics; PATH={ENVIRONMENT}/bin:$PATH {line}"
        with subprocess.Popen(["unshare", "--user", "cat"], stdin=subprocess.PIPE) as inside:
            while os.readlink(f"/proc/{inside.pid}/ns/user") == os.readlink("/proc/self/ns/user"):
                time.sleep(0.01)
            for ids in ("uid_map", "gid_map"):
                Path(f"/proc/{inside.pid}/{ids}").write_text("0 0 65536")
            enter = ["nsenter", "--user", f"--target={inside.pid}", "--setuid=0", "--setgid=0"]
            subprocess.run([*enter, "sh", "-c", "echo 0 > /proc/sys/user/max_user_namespaces"], check=True)
            ways = {"prof": ["su", "prof", "-c", command], "root": ["bash", "-c", command]}
            ways["landlock"] = ["su", "prof", "-c", command.replace("namespaces", "landlock").replace("--pages pages", "")]
            found = {who: subprocess.run([*enter, *way], text=True, capture_output=True) for who, way in ways.items()}
            inside.stdin.close()
        return {who: [one.returncode, one.stdout + one.stderr] for who, one in found.items()}

    def feedback(self):
        self.type(self.prof, self.next("prof", "Feedback"))
        self.type(self.bob, self.next("bob", "Feedback"))
        self.ada.press("fetch_feedback", course_id="haptics", assignment_id=LAB.name)
        for name in ("ada", "bob"):
            (page,) = Path(f"/home/{name}/{LAB.name}/feedback").rglob("*.html")
            self.facts[f"{name}_feedback"] = page.read_text("utf-8")
        assert self.left == []


def main(scratch):
    began = time.monotonic()
    private_machine(Path(scratch))
    trial = Trial()
    trial.set_up()
    for step in (trial.release, trial.students, trial.forge, trial.grade, trial.feedback):
        step()
        print(f"{step.__name__}: done after {time.monotonic() - began:.0f} s", flush=True)
    listening = as_root("cat /proc/net/tcp /proc/net/tcp6")
    trial.facts["listening"] = sorted({line.split()[1] for line in listening.splitlines() if " 0A " in line})
    (Path(scratch) / "facts.json").write_text(json.dumps(trial.facts), "utf-8")


if __name__ == "__main__":
    os.umask(0o022)
    main(sys.argv[1])
