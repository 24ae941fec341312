"""The files around the package agree with one another: one address, one version, one pair of
commands.
"""

import itertools
import re
import tomllib
from pathlib import Path

import pytest
import yaml

import collisions

ROOT = Path(__file__).resolve().parents[2]
HOSTED = ROOT / ".github"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not HOSTED.is_dir(), reason="this copy has no files of a hosted project"),
]


def project():
    """The metadata."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def read(name):
    """A file of YAML."""
    return yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))


def files():
    """The files that may name the address of the project."""
    named = [path for path in ROOT.iterdir() if path.suffix in (".md", ".toml", ".cff", ".yaml")]
    folders = (HOSTED, ROOT / "docs", ROOT / "vectors")
    found = [
        path
        for folder in folders
        for path in folder.rglob("*")
        if path.suffix in (".md", ".yml", ".yaml", ".json")
    ]
    return [path for path in named + found if path.is_file() and "_build" not in path.parts]


def test_every_address_of_the_project_begins_with_one_base():
    """That of the repository, which a line in CONTRIBUTING.md changes everywhere."""
    urls = project()["project"]["urls"]
    base = urls["Repository"]
    assert set(urls) == {"Repository", "Documentation", "Issues", "Changelog"}
    assert all(url == base or url.startswith(f"{base}/") for url in urls.values())
    host, _, place = base.removeprefix("https://").partition("/")
    assert place
    seen = set()
    for path in files():
        text = path.read_text(encoding="utf-8")
        for url in re.findall(rf"{re.escape(host)}/[^\s'\"`)>|#]*", text):
            assert url.startswith(f"{host}/{place}"), f"{path.name}: {url}"
            seen.add(path.name)
    assert {
        "pyproject.toml",
        "CITATION.cff",
        "SECURITY.md",
        "config.yml",
        "CONTRIBUTING.md",
    } <= seen


def test_the_citation_has_the_version_and_what_a_reader_of_it_asks_for():
    """As the format 1.2.0 requires; the address is that of the metadata."""
    cited = read("CITATION.cff")
    assert {"cff-version", "message", "title", "authors", "type", "license", "version"} <= set(
        cited
    )
    assert cited["cff-version"] == "1.2.0"
    assert cited["version"] == collisions.__version__
    metadata = project()["project"]
    assert cited["license"] == metadata["license"]
    assert cited["repository-code"] == metadata["urls"]["Repository"]
    assert [author["name"] for author in cited["authors"]] == [
        author["name"] for author in metadata["authors"]
    ]


def test_the_workflow_runs_the_commands_of_the_readme_on_three_systems():
    """On every Python that the metadata name, and the gate on Linux."""
    jobs = read(".github/workflows/tests.yml")["jobs"]
    lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    commands = [step["run"] for step in jobs["readme"]["steps"] if "run" in step]
    assert len(commands) == 2
    assert set(commands) <= set(lines)
    matrix = jobs["readme"]["strategy"]["matrix"]
    assert {name.partition("-")[0] for name in matrix["os"]} == {"ubuntu", "macos", "windows"}
    claimed = [
        name.rpartition(" ")[2]
        for name in project()["project"]["classifiers"]
        if re.search(r"Python :: 3\.\d+$", name)
    ]
    assert set(claimed) <= set(matrix["python"])
    assert project()["project"]["requires-python"] == f">={claimed[0]}"
    assert [step["run"] for step in jobs["gate"]["steps"] if "run" in step] == ["bash .ci/run"]
    (built,) = [step["run"] for step in jobs["pages"]["steps"] if "run" in step]
    assert '".[docs]"' in built


def test_every_form_of_an_issue_asks_for_what_it_needs():
    """Each has a name, a description and a body; its fields have names of their own."""
    forms = {
        path.stem: yaml.safe_load(path.read_text(encoding="utf-8"))
        for path in (HOSTED / "ISSUE_TEMPLATE").glob("*.yml")
    }
    assert not forms.pop("config")["blank_issues_enabled"]
    assert set(forms) == {"bug", "wrong_number", "feature"}
    for form in forms.values():
        assert {"name", "description", "body"} <= set(form)
        fields = [field for field in form["body"] if field["type"] != "markdown"]
        names = [field["id"] for field in fields]
        assert len(names) == len(set(names))
        assert all(field["attributes"]["label"] for field in fields)
    for option in itertools.chain.from_iterable(
        field["attributes"].get("options", ()) for field in forms["wrong_number"]["body"]
    ):
        assert isinstance(option, str)  # "No" without quotes is a falsehood in YAML


def test_the_other_settings_name_what_is_there():
    """The pages' configuration and extra, and local hooks that need nothing fetched."""
    hosting = read(".readthedocs.yaml")
    assert (ROOT / hosting["sphinx"]["configuration"]).is_file()
    (install,) = hosting["python"]["install"]
    assert set(install["extra_requirements"]) <= set(project()["project"]["optional-dependencies"])
    hooks = read(".pre-commit-config.yaml")["repos"]
    assert [repository["repo"] for repository in hooks] == ["local"]
    assert {hook["entry"].split()[0] for hook in hooks[0]["hooks"]} == {"ruff", "mypy"}
    assert {
        update["package-ecosystem"] for update in read(".github/dependabot.yml")["updates"]
    } == {"github-actions", "pip"}


def test_the_sdist_names_every_file_of_the_project():
    """So that what is built from it is tested and documented without the repository."""
    listed = [
        place.removeprefix("/")
        for place in project()["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]
    ]
    unnamed = {
        ".git",
        ".gitignore",
        "pyproject.toml",
        "build",
        "dist",
        ".venv",
        ".coverage",
        "htmlcov",
        ".hypothesis",
    }
    for path in ROOT.iterdir():
        if path.name in unnamed or path.name.endswith(("_cache", "__pycache__")):
            continue
        assert any(path.match(place) for place in listed), f"{path.name} is not in the sdist"


def test_the_readme_needs_no_file_beside_it():
    """On the page of a package index nothing else of the project is there."""
    assert (
        re.findall(r"\]\((?!https://)[^)]*\)", (ROOT / "README.md").read_text(encoding="utf-8"))
        == []
    )
