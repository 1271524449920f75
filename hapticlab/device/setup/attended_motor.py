"""A motor that runs while a person is asked: off whatever happens, an interrupt by the keyboard included."""

from contextlib import contextmanager


@contextmanager
def attended(paddle):
    """Start, ask and stop inside; what raises here leaves no motor running."""
    try:
        yield
    except BaseException:
        paddle._abandon()
        raise
