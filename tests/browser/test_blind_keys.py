"""The keys of a blind comparison, in a page of its own: no notebook, no kernel."""

import pytest

from hapticlab.widgets.browser_view import BROWSER

# Notes what is said but that the page is there, as [what, value].
OPEN = """(board) => {
  window.said = []
  const state = { trial: 1, answered: "", done: false, limited: false, felt: 0, missed: 0 }
  const about = { question: "Which?", board: false, duration: 0.3, pause: 0.2 }
  const model = {
    get: (name) => ({ about, state })[name],
    on: (name, told) => (window.tell = (news) => { Object.assign(state, news); told() }),
    send: (content, callbacks, [data]) => {
      const [what, value] = new Float64Array(data)
      if (what !== SAYS.alive) said.push([what, value])
    },
  }
  about.board = board
  render({ model, el: document.querySelector(".hl-blind div") })
}"""


def opened(browser, board=False):
    page = browser.new_page()
    page.clock.install(time=0)
    page.set_content('<div class="hl-blind"><div></div><canvas class="hl-stage" tabindex="0"></canvas></div>')
    source = (BROWSER / "blind.js").read_text("utf-8")
    page.add_script_tag(content=source.replace("export default { render }", ""))
    page.evaluate(OPEN, board)
    page.clock.run_for(500)  # until it listens
    page.evaluate("document.querySelector('canvas').focus()")
    return page


@pytest.mark.wide
def test_space_leads_through_a_trial_and_presses_the_button_that_has_the_focus(browser):
    page = opened(browser)
    page.keyboard.press("Space")
    page.clock.run_for(1000)
    assert page.evaluate("said") == [[0, 0], [1, 0], [0, 1], [1, 0]]  # both were shown and hidden
    page.get_by_role("button", name="The second 2").focus()
    page.keyboard.press("Space")
    assert page.evaluate("said.at(-1)") == [2, 1]
    page.close()


@pytest.mark.wide
def test_a_presentation_that_did_not_start_comes_again(browser):
    page = opened(browser, board=True)

    def feel():
        page.keyboard.press("Space")
        page.clock.run_for(1000)
        return page.evaluate("said.findLast(([what]) => what === SAYS.show)[1]")

    assert feel() == 0
    page.evaluate("tell({ missed: 1 })")
    assert "The first one did not start" in page.get_by_role("status").text_content()
    assert feel() == 0
    page.evaluate("tell({ felt: 1 })")
    page.keyboard.press("Space")
    page.keyboard.press("2")  # answered before the kernel says that it did not start
    assert page.get_by_role("status").text_content() == "Saving ..."
    page.evaluate("tell({ missed: 2 })")
    assert "The second one did not start" in page.get_by_role("status").text_content()
    assert feel() == 1
    page.keyboard.press("2")
    page.evaluate("tell({ trial: 2, felt: 0, answered: 'second' })")
    assert "Saved" in page.get_by_role("status").text_content() and feel() == 0
    page.close()
