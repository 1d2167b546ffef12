#!/usr/bin/env python3
"""Makes the manual: a folder of pages by mkdocs, and one page that needs neither network nor folder.

    python3 render.py PROGRAM OUT

OUT/pages gets the Markdown with the reference that PROGRAM writes, OUT/site the pages of mkdocs, OUT/manual.html the
one page. Needs Debian's mkdocs, which brings the Markdown of Python; uses no network. The order of the pages is that in
which index.md links them. Exit status 1: a link or anchor that leads nowhere, a page that index.md does not link; 77:
no mkdocs.
"""

import base64
import html
import importlib.util
import mimetypes
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
DEBIAN_PYTHON = "/usr/bin/python3"
REFERENCE = ["command-line", "scene", "sweep", "study", "chain", "motion", "python", "headers"]
EXTENSIONS = ["tables", "fenced_code", "toc", "sane_lists"]
CONFIGURATION = """site_name: bough
docs_dir: pages
site_dir: site
use_directory_urls: false
theme:
  name: readthedocs
  highlightjs: false
  navigation_depth: 3
plugins: [search]
markdown_extensions: [tables, fenced_code, toc, sane_lists]
nav:
"""
STYLE = """
body { font: 16px/1.5 sans-serif; margin: 0; color: #1c1c1c; background: #fff; }
nav { position: fixed; top: 0; bottom: 0; width: 17em; overflow: auto; padding: 1em; font-size: 85%;
  background: #f3f3f3; }
nav ul { list-style: none; padding-left: 1em; } nav a { color: inherit; text-decoration: none; }
main { margin-left: 20em; max-width: 56em; padding: 1em 2em; overflow-wrap: break-word; }
code { overflow-wrap: anywhere; } pre code { overflow-wrap: normal; }
article { border-top: 1px solid #999; padding-top: 1em; }
table { border-collapse: collapse; display: block; overflow-x: auto; }
th, td { border: 1px solid #ccc; padding: .2em .5em; text-align: left; vertical-align: top; }
pre { background: #f3f3f3; padding: .7em; overflow-x: auto; } code { font-size: 90%; } img { max-width: 100%; }
@media (max-width: 60em), print { nav { position: static; width: auto; } main { margin: 0; } }
@media (prefers-color-scheme: dark) { body { color: #ddd; background: #181818; } nav, pre { background: #262626; }
  th, td { border-color: #444; } a { color: #8ab4f8; } }
"""


def pages_in_order(index):
    """Pages that index.md links, in its order, with the group of its row: [(group, path)]."""
    pages = [("Begin", "index.md")]
    for line in index.splitlines():
        row = re.match(r"\| ([^|]+?) \|", line)
        for target in re.findall(r"\]\(([^)#]+\.md)\)", line):
            if row and target not in [path for _, path in pages]:
                pages.append((row.group(1), target))
        if row and "reference/index.md" in line:
            pages += [(row.group(1), f"reference/{name}.md") for name in REFERENCE]
    return pages


def title_of(path):
    return re.search(r"^# (.+)$", path.read_text(encoding="utf-8"), re.MULTILINE).group(1)


def configuration_of(pages, folder):
    text, last = CONFIGURATION, None
    for group, path in pages:
        if group != last:
            text += f"  - '{group}':\n"
            last = group
        text += f"    - '{title_of(folder / path).replace(chr(39), chr(39) * 2)}': {path}\n"
    return text


def anchor_of(path, anchor=""):
    name = re.sub(r"\W+", "-", path.removesuffix(".md"))
    return f"{name}--{anchor}" if anchor else name


def one_page(pages, folder):
    """All pages in one, with links that lead within it and pictures as data."""
    import markdown

    contents, articles, last = [], [], None
    known = {path for _, path in pages}
    for group, path in pages:
        body = markdown.markdown((folder / path).read_text(encoding="utf-8"), extensions=EXTENSIONS)
        body = re.sub(r'(<h\d) id="([^"]+)"', lambda m: f'{m[1]} id="{anchor_of(path, m[2])}"', body)

        def link(match):
            name, _, anchor = html.unescape(match[1]).partition("#")
            if re.match(r"[a-z]+:", name):
                return match[0]
            goal = os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path
            if goal not in known:
                raise SystemExit(f"{path}: a link to {goal}, which is no page of the manual")
            return f'href="#{anchor_of(goal, anchor)}"'

        def picture(match):
            file = folder / os.path.dirname(path) / match[1]
            kind = mimetypes.guess_type(file.name)[0]
            return f'src="data:{kind};base64,{base64.b64encode(file.read_bytes()).decode()}"'

        body = re.sub(r'href="([^"]+)"', link, body)
        body = re.sub(r'src="([^":]+)"', picture, body)
        if group != last:
            contents.append(f"</ul><p><b>{html.escape(group)}</b></p><ul>")
            last = group
        contents.append(f'<li><a href="#{anchor_of(path)}">{html.escape(title_of(folder / path))}</a></li>')
        articles.append(f'<article id="{anchor_of(path)}">\n{body}\n</article>')
    text = "\n".join(articles)
    nowhere = set(re.findall(r'href="#([^"]+)"', text)) - set(re.findall(r' id="([^"]+)"', text))
    if nowhere:
        raise SystemExit(f"there is no heading for {', '.join(sorted(nowhere))}")
    listed = "\n".join(contents).removeprefix("</ul>") + "</ul>"
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>bough, the manual</title>'
            f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head>\n<body><nav>\n{listed}\n'
            "</nav><main>\n" + text + "\n</main></body></html>\n")


def main():
    if shutil.which("mkdocs") is None or importlib.util.find_spec("markdown") is None:
        print("mkdocs is missing (Debian: apt-get install mkdocs)")
        return 77
    program, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    out.mkdir(parents=True, exist_ok=True)
    folder = out / "pages"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(HERE.parent, folder, ignore=shutil.ignore_patterns("make", "__pycache__"))
    subprocess.run([sys.executable, HERE / "reference.py", program, folder / "reference"], check=True)
    pages = pages_in_order((folder / "index.md").read_text(encoding="utf-8"))
    unlisted = {str(path.relative_to(folder)) for path in folder.rglob("*.md")} - {path for _, path in pages}
    if unlisted:
        raise SystemExit(f"index.md does not link {', '.join(sorted(unlisted))}")
    (out / "mkdocs.yml").write_text(configuration_of(pages, folder), encoding="utf-8")
    words = ["mkdocs", "build", "--quiet", "--strict", "--clean", "--config-file", out / "mkdocs.yml"]
    subprocess.run(words, check=True)
    (out / "manual.html").write_text(one_page(pages, folder), encoding="utf-8")
    print(f"{out / 'site' / 'index.html'}\n{out / 'manual.html'}")
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    lacks = importlib.util.find_spec("markdown") is None
    if lacks and os.path.exists(DEBIAN_PYTHON) and sys.executable != DEBIAN_PYTHON:
        os.execv(DEBIAN_PYTHON, [DEBIAN_PYTHON, *sys.argv])
    sys.exit(main())
