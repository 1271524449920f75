"""A mapping that stays as it was made."""

from collections.abc import Mapping


class Frozen(Mapping):
    """Read-only, hashable dictionary; it equals a dict of the same items.

    Examples
    --------
    >>> from hapticlab.scene.frozen import Frozen
    >>> Frozen({"k": 150.0}) == {"k": 150.0}
    True
    """

    __slots__ = ("_items",)

    def __init__(self, items=()):
        self._items = dict(items)

    def __getitem__(self, name):
        return self._items[name]

    def __iter__(self):
        return iter(self._items)

    def __len__(self):
        return len(self._items)

    def __hash__(self):
        return hash(frozenset(self._items.items()))

    def __repr__(self):
        return repr(self._items)
