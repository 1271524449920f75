"""Jupyter's server sends what a kernel says at once, not 40 ms later.

A kernel answers a message from the browser with a small "busy" first. Nagle's algorithm then holds the next packet until
the browser has acknowledged that one, which an operating system delays by some 40 ms: a hand on a live view would feel
the paddle through syrup. Jupyter loads this module through ``etc/jupyter/jupyter_server_config.d/hapticlab.json``.
"""


def _jupyter_server_extension_points():
    return [{"module": "hapticlab._jupyter"}]


def _load_jupyter_server_extension(app):
    base = app.kernel_websocket_connection_class

    class PromptConnection(base):
        async def connect(self):
            try:
                self.websocket_handler.set_nodelay(True)
            except Exception:  # a server that cannot is slower, no more
                app.log.debug("hapticlab: this server holds small packets back", exc_info=True)
            return await super().connect()

    app.web_app.settings["kernel_websocket_connection_class"] = PromptConnection
