"""What axe-core finds on a page that people cannot use who do not see, do not hear or have no mouse."""

from importlib.resources import files

#: how much a finding counts, by axe's own words; the first two must not be there
IMPACTS = ("critical", "serious", "moderate", "minor")
#: the rules of WCAG 2.2 AA, and axe's best practices
RULES = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice")


def findings(page, selector="body", impacts=IMPACTS[:2]):
    """Return what is wrong inside the element that a selector names: {impact: ..., rule: ..., element: its HTML}, worst first."""
    if not page.evaluate("typeof axe !== 'undefined'"):
        page.evaluate(files("axe_playwright_python").joinpath("axe.min.js").read_text("utf-8"))
    found = page.evaluate(
        "([element, rules]) => axe.run(element, { runOnly: { type: 'tag', values: rules }, resultTypes: ['violations'] })",
        [selector, list(RULES)],
    )
    told = [
        {"impact": rule["impact"], "rule": rule["id"], "element": node["html"][:200]}
        for rule in found["violations"]
        for node in rule["nodes"]
        if rule["impact"] in impacts
    ]
    return sorted(told, key=lambda each: IMPACTS.index(each["impact"]))
