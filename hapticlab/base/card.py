"""How a record of facts prints: a line that says what it is, and a row for each fact."""

from __future__ import annotations

from collections.abc import Mapping


def card(head: str, rows: Mapping[str, str]) -> str:
    """The text of a record; facts that are empty are left out.

    Examples
    --------
    >>> print(card("wall: a spring", {"order": "1", "cost": "", "source": "Eq. (23.1)"}))
    wall: a spring
      order   1
      source  Eq. (23.1)
    """
    told = {name: text for name, text in rows.items() if text}
    width = max(map(len, told), default=0)
    return "\n".join([head, *(f"  {name:<{width}}  {text}" for name, text in told.items())])
