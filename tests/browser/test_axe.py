"""axe-core sees in a page what it is asked to see."""

import pytest
from axe import findings

PAGE = '<html lang="en"><title>t</title><main><h1>a</h1>{}</main></html>'

pytestmark = pytest.mark.wide


@pytest.mark.parametrize(
    ("element", "rule"),
    [
        ('<img src="x">', "image-alt"),
        ('<p style="color: #999; background: #fff">pale</p>', "color-contrast"),
        ('<input type="checkbox">', "label"),
        ('<div style="height: 20px; overflow: auto"><p style="height: 90px">far</p></div>', "scrollable-region-focusable"),
        ('<img src="x" alt="a wall"><p>dark on white</p>', None),
    ],
)
def test_what_cannot_be_used_is_found(browser, element, rule):
    page = browser.new_page()
    page.set_content(PAGE.format(element))
    assert [one["rule"] for one in findings(page)] == ([rule] if rule else [])
    page.close()
