"""A progress bar for whatever lasts longer than two seconds; the only place where tqdm opens."""

from .turns import has_threads


def progress_bar(ticks, shown=True, unit="tick"):
    """Return a bar on stderr that appears after two seconds; use it in a ``with``, and ``update`` it by ticks done."""
    from tqdm import tqdm

    if not has_threads():
        tqdm.monitor_interval = 0  # its monitor is a thread
    return tqdm(total=ticks, delay=2, disable=not shown, unit=unit, unit_scale=ticks > 1000, leave=False)
