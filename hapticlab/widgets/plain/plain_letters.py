"""Mathematics in letters that need no typesetting, for the view of plain widgets."""

import re
from functools import lru_cache

GREEK = {
    "theta": "θ", "varphi": "φ", "phi": "φ", "psi": "ψ", "beta": "β", "alpha": "α", "rho": "ρ", "Omega": "Ω", "sin": "sin ",
    "omega": "ω", "mu": "µ", "gamma": "γ", "delta": "δ", "epsilon": "ε", "lambda": "λ", "eta": "η", "xi": "ξ",
}  # fmt: skip


@lru_cache(1000)
def plain(words):
    """Return a text in letters that need no typesetting: names as Python writes them, Greek letters as such.

    Examples
    --------
    >>> plain(r"$K,\\ b_c$"), plain(r"$\\varphi_2$"), plain("$P\\\\,P_{cr}$")
    ('K, b_c', 'φ_2', 'P P_cr')
    """
    if "$" not in words:
        return words
    words = re.sub(r"\\[ ,]", " ", words.replace("$", ""))
    words = re.sub(r"\\(\w+?)(?=_|\W|$)", lambda word: GREEK.get(word[1], word[1]), words)
    return re.sub(r"  +", " ", re.sub(r"[{}]", "", words))
