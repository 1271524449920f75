"""A person in a browser: logs in to a JupyterHub, and has a JupyterLab with notebooks, a terminal and nbgrader's buttons."""

import json
import re
import time
import uuid
from contextlib import closing

import requests
from websocket import create_connection

#: seconds that a server, a cell or a command may take
LIMIT = 300


class Person:
    """A user of the hub at ``address``, logged in by a password, with a server of their own behind the hub's proxy."""

    def __init__(self, address, name, password):
        self.name, self._hub = name, f"{address}/hub"
        self._session = requests.Session()
        page = self._session.get(f"{self._hub}/login", timeout=LIMIT)
        given = {"username": name, "password": password, "_xsrf": self._session.cookies["_xsrf"]}
        page = self._session.post(f"{self._hub}/login", data=given, timeout=LIMIT)
        assert page.ok and "/hub/login" not in page.url, f"{name} cannot log in: {page.status_code} {page.url}"
        made = self._at_hub("POST", f"users/{name}/tokens", json={})
        self._token = made.json()["token"]
        if not self._at_hub("GET", f"users/{name}").json()["server"]:
            self._at_hub("POST", f"users/{name}/server")
        self._wait_for_server()
        self._server = f"{address}/user/{name}"

    def _at_hub(self, method, path, **given):
        crumb = next(one.value for one in self._session.cookies if one.name == "_xsrf" and one.path.endswith("/hub/"))
        answer = self._session.request(method, f"{self._hub}/api/{path}", headers={"X-XSRFToken": crumb}, timeout=LIMIT, **given)
        assert answer.ok, f"{method} {path}: {answer.status_code} {answer.text[:500]}"
        return answer

    def _wait_for_server(self):
        events = f"{self._hub}/api/users/{self.name}/server/progress"
        with requests.get(events, headers=self._key, stream=True, timeout=LIMIT) as stream:
            for line in stream.iter_lines():
                told = json.loads(line.removeprefix(b"data:")) if line.startswith(b"data:") else {}
                assert not told.get("failed"), told
                if told.get("ready"):
                    return

    @property
    def _key(self):
        return {"Authorization": f"token {self._token}"}

    def ask(self, method, path, key=None, **given):
        """Return the answer of this person's server, or of another's."""
        return requests.request(method, f"{self._server}/{path}", headers=self._key, timeout=LIMIT, **given)

    def at_another(self, name):
        """Return the status with which somebody else's server answers this person."""
        return requests.get(self._server.replace(self.name, name) + "/api/contents", headers=self._key, timeout=LIMIT).status_code

    def notebook(self, path):
        """Return a notebook as JupyterLab opens it."""
        answer = self.ask("GET", f"api/contents/{path}")
        assert answer.ok, answer.text
        return answer.json()["content"]

    def save(self, path, content):
        """Save a notebook as JupyterLab does."""
        answer = self.ask("PUT", f"api/contents/{path}", json={"type": "notebook", "format": "json", "content": content})
        assert answer.ok, answer.text

    def press(self, button, **about):
        """Press a button of nbgrader's Assignment List: fetch, submit or fetch_feedback; return the list."""
        answer = self.ask("POST", f"assignments/{button}", json=about).json()
        assert answer["success"], answer
        return answer["value"]

    def run(self, path, cells):
        """Run cells in the kernel of a notebook; return what each printed or raised."""
        about = {"path": path, "name": "", "type": "notebook", "kernel": {"name": "python3"}}
        session = self.ask("POST", "api/sessions", json=about).json()
        with self._socket(f"api/kernels/{session['kernel']['id']}/channels") as socket:
            said = [_executed(socket, cell) for cell in cells]
        self.ask("DELETE", f"api/sessions/{session['id']}")
        return said

    def type(self, *lines):
        """Type lines into a new terminal; return what it showed, and whether every command succeeded."""
        name = self.ask("POST", "api/terminals").json()["name"]
        end, shown = uuid.uuid4().hex, ""
        before_each_prompt = "well=yes; PROMPT_COMMAND='[ $? = 0 ] || well=no'"
        with self._socket(f"terminals/websocket/{name}") as socket:
            for line in [before_each_prompt, *lines, f'echo "$well:"{end}']:
                socket.send(json.dumps(["stdin", line + "\r"]))
            while not (found := re.search(rf"(yes|no):{end}", shown)):
                kind, *data = json.loads(socket.recv())
                shown += data[0] if kind == "stdout" else ""
        self.ask("DELETE", f"api/terminals/{name}")
        return shown, found[1] == "yes"

    def _socket(self, path):
        address = f"{self._server}/{path}".replace("http", "ws", 1)
        return closing(create_connection(address, header=self._key, timeout=LIMIT))


def _executed(socket, code):
    """Return what a cell printed, or the name and the text of its error."""
    key = uuid.uuid4().hex
    header = {"msg_id": key, "msg_type": "execute_request", "username": "", "session": key, "version": "5.3", "date": ""}
    content = {"code": code, "silent": False, "store_history": True, "allow_stdin": False, "stop_on_error": False}
    whole = {"header": header, "parent_header": {}, "metadata": {}, "content": content, "channel": "shell", "buffers": []}
    socket.send(json.dumps(whole))
    said = ""
    while True:
        message = json.loads(socket.recv())
        content = message["content"]
        if message["parent_header"].get("msg_id") != key:
            continue
        if message["msg_type"] == "stream":
            said += content["text"]
        elif message["msg_type"] == "error":
            said += f"{content['ename']}: {content['evalue']}"
        elif message["msg_type"] == "status" and content["execution_state"] == "idle":
            return said


def wait_for(address, seconds=60):
    """Wait until an address answers well; the proxy answers before the hub is there."""
    last = time.monotonic() + seconds
    while True:
        try:
            if requests.get(address, timeout=5).ok:
                return
        except requests.ConnectionError:
            pass
        assert time.monotonic() < last, f"nothing at {address} after {seconds} s"
        time.sleep(0.2)
