"""The site is built without a warning, and its pages are whole in a real Chromium."""

import re
from urllib.parse import quote_plus, unquote, urldefrag, urljoin

import pytest

import wsrender as ws
from tests.docs.site import SCRIPTS, all_chosen, build, chosen, serving
from tests.viewer.axe import serious_faults
from tests.viewer.written import launch
from wsrender.analyses.registry import job_classes

PATIENCE_MS = 60_000


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    pytest.importorskip("sphinx_gallery", reason="needs the extra docs")
    return build(tmp_path_factory.mktemp("docs"))


@pytest.fixture(scope="module")
def browser():
    api = pytest.importorskip("playwright.sync_api", reason="needs Playwright for Python and a Chromium")
    with api.sync_playwright() as running:
        browser = launch(running)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def address(folder):
    with serving(folder) as address:
        yield address


@pytest.fixture(scope="module")
def pages(folder):
    """Addresses within the site; of the gallery those that were run, and its list."""
    found = [path.relative_to(folder).as_posix() for path in sorted(folder.rglob("*.html"))]
    kept = [name for name in found if not name.startswith(("_", "views/", "sg_execution_times"))]
    run = set(chosen())
    return [name for name in kept if "/plot_" not in name or name.rpartition("/")[2].removesuffix(".html") in run]


def test_every_script_has_its_page(folder, pages):
    assert len(SCRIPTS) >= 30
    for path in SCRIPTS:
        assert (folder / f"generated/gallery/{path.parent.name}/{path.stem}.html").is_file()
    assert sum("/plot_" in name for name in pages) == len(chosen())


def test_the_reference_has_all_that_there_is(folder):
    shown = {path.stem: path.read_text(encoding="utf-8") for path in folder.glob("generated/reference/*.html")}
    anchors = {name: set(re.findall(r'<section id="([^"]+)"', text)) for name, text in shown.items()}
    for name in job_classes():
        assert {name, name.replace("_", "-")} & anchors["jobs"] and {name, name.replace("_", "-")} & anchors["results"]
    for name in ws.__all__:
        assert isinstance(getattr(ws, name), str) or f"<h3>{name}<" in shown["python"], name
    for name in ("<h3>errors<", "run.merge(", "math.sqrt("):
        assert name in re.sub(r"</?span[^>]*>", "", shown["python"]), name
    assert "highlight-pycon" in shown["python"]
    assert "skeleton(q" in shown["python"]
    for path in ("/v1/jobs", "/v1/jobs/{job_id}/volume/slice", "/v1/models/{sha256}"):
        assert path in shown["http"]
    for command in (
        "wsrender run",
        "wsrender submit",
        "wsrender serve",
        "wsrender database backup",
        "wsrender jobs list",
    ):
        assert f"{command}<" in shown["command_line"], command


def test_every_picture_is_described(folder, pages):
    for name in pages:
        for tag in re.findall(r"<img[^>]*>", (folder / name).read_text(encoding="utf-8")):
            stands_by_its_title = "_thumb." in tag  # in a list of the gallery, within the link that the title names
            assert stands_by_its_title or re.search(r'alt="[^"]+"', tag), (name, tag)
        for tag in re.findall(r"<iframe[^>]*>", (folder / name).read_text(encoding="utf-8")):
            assert re.search(r'title="[^"]+"', tag), (name, tag)


def test_a_click_on_a_picture_opens_it(folder, pages):
    """But for those within links, and those of which each theme shows one; of several planes side by side are wide."""
    link = r'(?:<a class="picture( wide)?" href="([^"]+)">)?<img[^>]*src="([^"]+_images/[^"]+png)"'
    pictures = [each for name in pages for each in re.findall(link, (folder / name).read_text(encoding="utf-8"))]
    for wide, opened, shown in pictures:
        assert opened == shown or re.search(r"_thumb\.|cell_(light|dark)", shown), shown
        assert wide or "two_arms_on_a_table" not in shown, shown
    assert any(wide for wide, *_ in pictures) and not all(wide for wide, *_ in pictures)


def test_no_link_within_the_site_is_broken(folder, pages):
    for name in pages:
        text = (folder / name).read_text(encoding="utf-8")
        for link in re.findall(r'<a [^>]*?href="([^"]+)"', text):
            if re.match(r"[a-z]+:", link):
                continue
            place, part = urldefrag(urljoin(f"/{name}", link))
            target = folder / unquote(place).lstrip("/")
            assert target.is_file(), (name, link)
            if part and target.suffix == ".html":
                assert f'id="{unquote(part)}"' in target.read_text(encoding="utf-8"), (name, link)


def test_names_of_functions_in_formulas_stand_apart(folder):
    page = (folder / "theory" / "parallel.html").read_text(encoding="utf-8")
    assert re.search(r"<mn>338</mn>\s*<mspace[^>]*/><mi>arccos</mi>", page)


# Elements whose content is cut off, or goes beyond their side; on wide screens code must fit, too.
CUT = """wide => {
  const all = document.querySelectorAll(":is(.bd-article, .prev-next-area, .bd-sidebar-secondary) *");
  const fits = wide ? /^(H[1-6]|P|LI|DT|PRE)$/ : /^(H[1-6]|P|LI|DT)$/;
  return [...all].filter(each => {
    const hidden = ["hidden", "clip"].includes(getComputedStyle(each).overflowX);
    const whole = hidden || fits.test(each.tagName) || each.matches(".nav-link");
    return whole && each.clientWidth > 1 && each.scrollWidth > each.clientWidth + 2;
  }).map(each => each.outerHTML.slice(0, 80));
}"""


# Pictures of several planes whose letters, of 8 points in 13 inches, would be too small to be read.
SMALL = """[...document.querySelectorAll(".picture.wide img")]
  .filter(each => each.clientWidth < 800).map(each => `${each.clientWidth} ${each.src}`)"""


@pytest.mark.parametrize("width", [1280, 390])
def test_pages_are_whole(browser, address, pages, width):
    """Nothing is reported, missing, cut off or asked of another host, and no page is wider than the screen."""
    context = browser.new_context(viewport={"width": width, "height": 800})
    context.set_default_timeout(PATIENCE_MS)
    for name in pages:
        page, faults = context.new_page(), []
        page.on("console", lambda said, to=faults: to.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error, to=faults: to.append(str(error)))
        page.on("response", lambda answer, to=faults: to.append(answer.url) if answer.status >= 400 else None)
        page.on("request", lambda asked, to=faults: to.append(asked.url) if _is_foreign(asked.url, address) else None)
        page.goto(address + name)
        missing = page.evaluate("""async () => {
          const all = [...document.images];
          all.forEach(each => each.loading = "eager");
          const found = await Promise.all(all.map(each => each.decode().then(() => null, () => each.src)));
          return found.filter(each => each);
        }""")
        for frame in page.locator("iframe.viewer").all():
            frame.scroll_into_view_if_needed()
            frame.content_frame.locator("canvas").first.wait_for()
        small = page.evaluate(SMALL)
        wider, cut = page.evaluate("document.documentElement.scrollWidth - innerWidth"), page.evaluate(CUT, width > 960)
        assert (faults, missing, small, cut, max(wider, 0)) == ([], [], [], [], 0), name
        page.close()
    context.close()


# Width and theme; of the whole gallery in every look, else in two of them.
LOOKS = [(1280, "light"), (390, "dark"), *([(1280, "dark"), (390, "light")] if all_chosen() else [])]


@pytest.mark.parametrize(("width", "theme"), LOOKS)
def test_axe_finds_no_serious_fault(browser, address, pages, width, theme):
    context = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=theme)
    context.set_default_timeout(PATIENCE_MS)
    page, faults = context.new_page(), {}
    for name in pages:
        page.goto(address + name)
        assert page.evaluate("document.documentElement.dataset.theme") == theme
        if found := serious_faults(page):
            faults[name] = found
    context.close()
    assert faults == {}


def _is_foreign(url: str, address: str) -> bool:
    return not url.startswith((address, "data:", "blob:"))


# Questions of users, in their words, and the page that answers each, or one of several.
ANSWERS = {
    "How accurate is this volume?": "plot_how_accurate_is_the_volume",
    "Which voxel size and how many samples should I take?": "sampling",
    "Why do occupied and refined volume differ?": "results",
    "How does manipulability relate to MATLAB's manipulabilityIndex and Corke's manipulability?": "indices",
    "Which convention do I cite?": "indices",
    "How do I set the tool (TCP)?": "tools",
    "What is the base frame; why is my UR turned by 180°?": "tools",
    "How do I keep the arm from colliding with itself, a table, a second arm?": "worlds",
    "How do I add my own index, constraint, robot, analysis?": "own",
    "How do I lock a joint or narrow its limits?": "robots",
    "How do I load xacro, a ROS package, a Menagerie model?": "robots",
    "Where do I put the base so that all my targets are reached?": "plot_base_for_my_targets",
    "Which of these robots does my task?": "comparing plot_which_robot_does_my_task",
    "Can the arm carry 3 kg everywhere?": "capacity",
    "How do I compare two designs?": "comparing",
    'What does "undecided" mean?': "results",
    "How do I open the files in ParaView, MATLAB, pandas, Blender; what is the axis order?": "files",
    "How do I use it from MATLAB, LabVIEW, ROS 2, Node-RED?": "clients",
    "How do I run it on three GPUs, on Slurm, in a container?": "servers",
    "How do I back up and restore a server; where does the disk go; how long are results kept?": "servers",
    "Who sees my jobs?": "servers",
    "Is the result the same on another machine; what fixes the seed?": "reproducing",
    "How long will this job take and how much memory?": "sampling",
    "How do I make the figure for my paper; may I use the pictures?": "files",
    "How do I cite it?": "reproducing plot_citing",
    "What does it not consider?": "limits",
    "Which parallel mechanisms can I describe, and how?": "parallel",
    "Which platforms and Python versions does it run on?": "install",
}


def test_the_search_finds_what_answers_a_question(browser, address):
    page = browser.new_page()
    lost = {}
    for question, answer in ANSWERS.items():
        page.goto(f"{address}search.html?q={quote_plus(question)}")
        page.locator("#search-results .search-summary, #search-results p").first.wait_for()
        page.wait_for_timeout(1500)
        links = page.locator("#search-results ul.search li > a").evaluate_all("all => all.map(each => each.href)")
        if not any(f"/{each}.html" in link for each in answer.split() for link in links[:3]):
            lost[question] = [link.rpartition("/")[2] for link in links[:3]]
    page.close()
    assert lost == {}
