"""The pages of a paddle and of a class of forty as a browser shows them: narrow and wide, light and dark, for everybody."""

from dataclasses import replace

import numpy as np
import pytest
from axe import findings

import hapticlab as hl
from hapticlab.measurement.quality.record import PaddleQuality, Rendered, Velocity, Width

NAME = '<script>document.title = "run"</script> $x^2 & bench'
f = tuple(np.geomspace(2, 200, 12).tolist())


def made(name, profile, K):
    """A record without a measurement, of a spring whose force is 1 ms late."""
    s = 2j * np.pi * np.array(f)
    Z = 100 / s * np.exp(-1e-3 * s)
    widths = tuple(
        Width(v, (0.0, 2.0, 5.0), (K, 2 * K, K / 3), (K, 3 * K, 5 * K), (K, 2 * K, K / 3))
        for v in ("backward difference", "filter")
    )
    rendered = Rendered(100.0, 0.0, f, tuple(Z.real.tolist()), tuple(Z.imag.tolist()), (0.01,) * len(f))
    rows = (Velocity("backward difference", 5e-4, 5e-3, 933, True),)
    return PaddleQuality(name, "2026-11-20", "simulated paddle", "a pinch", hl.devices.profile(profile), widths, rendered, rows)


@pytest.mark.parametrize("scheme", [pytest.param("light", marks=pytest.mark.slow), pytest.param("dark", marks=pytest.mark.wide)])
def test_pages_fit_load_nothing_and_axe_finds_nothing_serious(browser, tmp_path, scheme):
    one = made(NAME, "hapkit_rough", 800.0)
    for k in range(40):
        replace(made(f"bench {k}", "hapkit", 300.0 + 20 * k), name=NAME if k == 7 else f"bench {k}").save(tmp_path / f"{k}.json")
    paths = [one.page(tmp_path / "one.html"), hl.measure.compare_qualities(tmp_path).page(tmp_path / "class.html")]
    page, asked = browser.new_page(color_scheme=scheme), []
    page.on("request", lambda request: asked.append(request.url))
    for width in (390, 1280):
        page.set_viewport_size({"width": width, "height": 800})
        for path in paths:
            page.goto(path.as_uri())
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            assert page.evaluate("[...document.images].every((one) => one.complete && one.naturalWidth > 300)")
            assert page.title() != "run" and page.evaluate("document.body.textContent").count(NAME) == 1
            assert findings(page) == []
    assert {url for url in asked if not url.startswith("data:")} == {path.as_uri() for path in paths}
    page.close()
