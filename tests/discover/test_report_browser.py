"""Pages in a real browser: what no parser of HTML sees."""

import shutil

import pytest

from discover.cli import main
from discover.report.gap import gap_figures, gap_report
from discover.report.study import study_figures, study_report
from tests.discover.sample_gap import sample_gap_data, sample_gap_document
from tests.discover.sample_study import sample_data, sample_document

PAGES = ("study", "gap", "init", "check", "simulate", "compare", "batch")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
WIDE, NARROW = {"width": 1400, "height": 900}, {"width": 500, "height": 900}


@pytest.fixture(scope="module")
def browser():
    api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    if CHROMIUM is None:
        pytest.skip("no chromium is installed")
    with api.sync_playwright() as play:
        # A container's root has no sandbox of Chromium's.
        started = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    study = sample_document(), sample_data()
    gap = sample_gap_document(), sample_gap_data()
    made = {
        "study": study_report(*study, study_figures(*study), command="inerter discover rig"),
        "gap": gap_report(*gap, gap_figures(*gap), command="inerter gap rig --model foim"),
    }
    for name, text in made.items():
        (folder / f"{name}.html").write_text(text, encoding="utf-8")
    for name, out in verbs(folder / "work").items():
        shutil.copy(out / "report.html", folder / f"{name}.html")
    return folder


def verbs(work):
    """Run the verbs whose pages have no sample document; return each one's results."""
    campaign = work / "records"
    options = "--model ioim-laminar --frequencies 0.5,2,8 --amplitudes 5,10 --held-out 1"
    assert main(["synth", str(campaign), "--device", "device-12", *options.split()]) == 0
    commands = {
        "init": ["init", str(campaign), "--replace"],
        "check": ["check", str(campaign)],
        "simulate": ["simulate", "ioim-laminar", "foim", str(campaign)],
        "compare": ["compare", "ioim-laminar", "foim", "--on", str(campaign)],
        "batch": ["batch", str(campaign)],
    }
    found = {name: work / name for name in commands}
    # Drawn up again, the campaign has no device: the others come first.
    for name in sorted(commands, key=lambda n: n == "init"):
        assert main([*commands[name], "-o", str(found[name])]) == 0, name
    return found


@pytest.fixture
def opened(browser, pages):
    """Open a page; whatever it asks for or complains of is kept."""
    contexts = []

    def open_page(name, size, *, script=True):
        context = browser.new_context(viewport=size, java_script_enabled=script)
        contexts.append(context)
        page = context.new_page()
        page.told = []
        page.on("console", lambda message: page.told.append(message.text))
        page.on("pageerror", lambda error: page.told.append(str(error)))
        page.on("request", lambda request: page.told.append(request.url))
        page.goto((pages / f"{name}.html").as_uri())
        assert page.told.pop(0).endswith(f"{name}.html")
        return page

    yield open_page
    for context in contexts:
        context.close()


@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["wide", "narrow"])
@pytest.mark.parametrize("name", PAGES)
def test_nothing_is_asked_for_nothing_complains_and_nothing_is_cut_off(opened, name, size):
    page = opened(name, size)
    page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    assert page.evaluate("document.documentElement.scrollWidth") <= size["width"]
    # What is wider than the page scrolls by itself; pictures and their words end inside it.
    outside = page.evaluate(
        """() => [...document.querySelectorAll('body *')].filter(n => {
            if (n.closest('.scroll') || n.closest('defs') || n.closest('clipPath')) return false;
            if (n.closest('svg') && n.tagName !== 'text' && n.tagName !== 'svg') return false;
            const box = n.getBoundingClientRect();
            return box.width > 0 && (box.right > innerWidth + 1 || box.left < -1);
        }).map(n => n.tagName + ' ' + n.textContent.slice(0, 40))"""
    )
    assert outside == []
    assert page.told == []


def test_a_name_hides_its_curves_in_every_picture_and_shows_them_again(opened):
    page = opened("study", WIDE)
    visible = "[...document.querySelectorAll('[data-series=\"model\"]')].filter(" \
              "n => n.style.display !== 'none').length"
    before = page.evaluate(visible)
    assert before > 5
    chip = page.locator('[data-toggle="model"]').first
    chip.click()
    assert page.evaluate(visible) == 0
    pressed = page.locator('[data-toggle="model"]').evaluate_all(
        "chips => chips.map(c => c.getAttribute('aria-pressed'))"
    )
    assert set(pressed) == {"false"}
    chip.click()
    assert page.evaluate(visible) == before
    assert page.told == []


def test_a_pointer_reads_values_and_a_drag_zooms(opened):
    page = opened("study", WIDE)
    svg = page.locator("svg[data-axes]:has([id='loops-1-figure_1'])")
    svg.scroll_into_view_if_needed()
    box = svg.bounding_box()
    axes = page.evaluate("JSON.parse(document.querySelector("
                         "\"svg:has([id='loops-1-figure_1'])\").dataset.axes)[0]")
    size = page.evaluate("(() => { const b = document.querySelector("
                         "\"svg:has([id='loops-1-figure_1'])\").viewBox.baseVal;"
                         "return [b.width, b.height]; })()")

    def at(x, y):
        """Return the place on the screen of shares of the axes."""
        (a, b), (c, d) = axes["px"], axes["py"]
        return (box["x"] + (a + x * (b - a)) * box["width"] / size[0],
                box["y"] + (c + y * (d - c)) * box["height"] / size[1])

    found = False
    for share in (0.1, 0.3, 0.5, 0.7, 0.9):
        page.mouse.move(*at(0.4, share))
        found = found or page.locator(".tip").is_visible()
        if found:
            break
    assert found
    told = page.locator(".tip").inner_text().splitlines()
    assert told[0] in ("measured", "model")
    assert told[1].startswith("Time (s): ")
    moment = float(told[1].split(": ")[1])
    low, high = axes["x"]
    # The nearest point lies within the pointer's reach of the place that it shows.
    reach = 28.0 / (axes["px"][1] - axes["px"][0])
    assert abs((moment - low) / (high - low) - 0.4) <= reach

    drawn = "document.getElementById('loops-1-axes_1').querySelector('[data-series] path')" \
            ".getAttribute('d')"
    whole = page.evaluate(drawn)
    page.mouse.move(*at(0.2, 0.2))
    page.mouse.down()
    page.mouse.move(*at(0.6, 0.8), steps=3)
    page.mouse.up()
    assert page.evaluate(drawn) != whole
    reset = page.get_by_role("button", name="Whole picture").first
    assert reset.is_visible()
    reset.click()

    def numbers(text):
        return [float(part) for part in text.replace("M", " ").replace("L", " ").split()
                if part.strip("-.e0123456789") == ""]

    assert numbers(page.evaluate(drawn)) == pytest.approx(numbers(whole), abs=0.01)
    assert page.told == []


def test_pictures_are_there_without_script_and_the_page_prints(opened):
    page = opened("gap", NARROW, script=False)
    assert page.locator("svg").count() > 8
    assert page.locator("svg").first.is_visible()
    assert page.locator(".chips").count() == 0
    printed = page.pdf()
    assert printed[:5] == b"%PDF-"
    assert len(printed) > 20_000


def test_what_is_folded_is_printed(opened):
    page = opened("study", WIDE)
    folded = page.locator("details table").first
    assert not folded.is_visible()
    page.emulate_media(media="print")
    assert folded.is_visible()


def test_a_page_is_small_enough_to_send(pages):
    for page in pages.glob("*.html"):
        assert page.stat().st_size < 3_000_000
