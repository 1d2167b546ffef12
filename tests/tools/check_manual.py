#!/usr/bin/env python3
"""Holds the manual against the program: every example, every command, every link.

    python3 check_manual.py PROGRAM SOURCE_DIR [PAGE...]      examples and commands of data/manual and README.md
    python3 check_manual.py --links SOURCE_DIR                links and anchors of every Markdown file of the tree

A page is worked through from its top to its end in one empty folder, in which `data` leads to the data of the tree.
A comment of Markdown on the line above a block says what the block is:

    <!-- file: NAME -->      JSON, a table or a program that is saved under this name; JSON is checked by the program
    <!-- into: NAME -->      members of JSON that are put into NAME (items of lists by their names), which is checked
    <!-- status: N -->       the commands end with this status, not with 0
    <!-- not run: REASON -->  a block that is only read
    <!-- picture: NAME -->   the picture on the next line is the file NAME that the commands of the page have made

`sh` blocks are run, `python` blocks too where NumPy is there. A `text` block below them has lines of what they print,
in this order; `...` stands for anything. A block of which nothing of that can be done is a fault. Blocks of C++ are
compiled by tests/run.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SOURCES = ("", "data", "benchmarks", "src", "tests")
LIMIT = 120  # seconds that one block may take


class Block:
    def __init__(self, line, language, marks):
        self.line, self.language, self.marks, self.lines = line, language, marks, []

    @property
    def text(self):
        return "".join(line + "\n" for line in self.lines)


def blocks_of(text):
    """Fenced blocks of a page, each with the comments above it."""
    marks, block, fence, indent = {}, None, "", 0
    for number, line in enumerate(text.splitlines(), 1):
        if block is not None:
            if line.strip() == fence:
                yield block
                block, marks = None, {}
            else:
                block.lines.append(line[indent:])
            continue
        mark = re.fullmatch(r"\s*<!-- (file|into|status|not run): (.+?) -->", line)
        begin = re.fullmatch(r"(\s*)(```+)(\w*)", line)
        if mark:
            marks[mark.group(1)] = mark.group(2)
        elif begin:
            block, fence, indent = Block(number, begin.group(3), marks), begin.group(2), len(begin.group(1))
        elif line.strip():
            marks = {}


def merged(scene, members):
    """A scene with further members: items of lists join those of other names, an empty list removes them, objects are
    joined, all else is replaced."""
    for key, value in members.items():
        old = scene.get(key)
        named = value and isinstance(value, list) and all(isinstance(item, dict) for item in value)
        if named and isinstance(old, list):
            names = {item.get("name") for item in value} - {None}
            scene[key] = [item for item in old if item.get("name") not in names] + value
        elif isinstance(value, dict) and isinstance(old, dict) and "kind" not in value:
            scene[key] = {**old, **value}
        else:
            scene[key] = value
    return scene


def found_in(lines, printed):
    """The first of these lines that is not printed after those before it, or None."""
    rest = [" ".join(line.split()) for line in printed.splitlines()]
    for line in lines:
        words = " ".join(line.split())
        if words in ("", "..."):
            continue
        pattern = re.compile(".*".join(re.escape(part.strip()) for part in words.split("...")))
        while rest and not pattern.search(rest[0]):
            rest.pop(0)
        if not rest:
            return line
        rest.pop(0)
    return None


class Page:
    """One page and the folder in which it is worked through."""

    def __init__(self, path, source, program, folder):
        self.path, self.source, self.program, self.folder = path, source, program, pathlib.Path(folder)
        self.faults, self.counts = [], {}
        self.printed = None  # by the last commands; None after other blocks, "" where they could not run
        (self.folder / "data").symlink_to(source / "data")
        (self.folder / "bin").mkdir()
        (self.folder / "bin" / "bough").symlink_to(program)
        self.environment = {**os.environ, "BOUGH": str(program), "PYTHONPATH": str(source / "apps" / "python"),
                            "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}"}

    def fault(self, block, text):
        self.faults.append(f"{self.path.relative_to(self.source)}:{block.line}: {text}")

    def count(self, what):
        self.counts[what] = self.counts.get(what, 0) + 1

    def run(self, arguments, text=None):
        try:
            done = subprocess.run(arguments, cwd=self.folder, env=self.environment, timeout=LIMIT, input=text,
                                  text=True, errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        except subprocess.TimeoutExpired:
            return None, f"not done within {LIMIT} s"
        return done.returncode, done.stdout

    def work(self):
        for block in blocks_of(self.path.read_text(encoding="utf-8")):
            if "not run" in block.marks:
                self.count("only read")
            elif block.language == "json":
                self.json(block)
            elif "file" in block.marks:
                self.write(block.marks["file"], block.text)
            elif block.language in ("sh", "python"):
                self.commands(block)
            elif block.language == "text" and self.printed is not None:
                self.output(block)
            elif block.language != "cpp":
                self.fault(block, "a block of which nothing can be checked")
        self.pictures()
        return self.faults

    def pictures(self):
        text = self.path.read_text(encoding="utf-8")
        for name, shown in re.findall(r"<!-- picture: (\S+) -->\n!\[[^]]*\]\((\S+)\)", text):
            self.count("pictures")
            made, kept = self.folder / name, self.path.parent / shown
            if not made.exists() or not kept.exists() or made.read_bytes() != kept.read_bytes():
                where = self.path.relative_to(self.source)
                self.faults.append(f"{where}: {shown} is not the {name} that the commands make")

    def write(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text, encoding="utf-8")

    def json(self, block):
        self.count("JSON")
        name = block.marks.get("file") or block.marks.get("into")
        if name is None:
            return self.fault(block, "a block of JSON that does not say which file it is, or belongs to")
        try:
            if "file" in block.marks:
                self.write(name, block.text)
                content = json.loads(block.text)
            else:
                content = json.loads((self.folder / name).read_text(encoding="utf-8"))
                content = merged(content, json.loads("{" + block.text + "}"))
                name = pathlib.Path(name).name
                self.write(name, json.dumps(content, indent=1))
        except (OSError, ValueError) as error:
            return self.fault(block, str(error))
        if not isinstance(content, dict) or "schema_version" not in content:
            return None
        if "designs" in content:
            arguments = ["bough", "sweep", name, "--dry-run"]
        elif "analysis" in content:
            arguments = ["bough", "check", name]
        else:
            return None  # files of other verbs are checked by the commands that read them
        status, printed = self.run(arguments)
        if status != int(block.marks.get("status", 0)):
            self.fault(block, f"{' '.join(arguments)}:\n{printed}")
        self.printed = None
        return None

    def commands(self, block):
        if block.language == "python":
            status, _ = self.run([sys.executable, "-c", "import numpy"])
            if status != 0:
                self.printed = ""
                return self.count("without NumPy")
            status, self.printed = self.run([sys.executable, "-"], block.text)
        else:
            status, self.printed = self.run(["sh", "-eu", "-c", block.text])
        self.count(block.language)
        if status != int(block.marks.get("status", 0)):
            self.fault(block, f"status {status}:\n{self.printed}")
        return None

    def output(self, block):
        if self.printed == "":
            return
        self.count("output")
        missing = found_in(block.lines, self.printed)
        if missing is not None:
            self.fault(block, f"is not printed: {missing}\nbut:\n{self.printed}")


def slugs_of(text):
    """Anchors of the headings of a page as git hosts make them, and those that Python-Markdown makes as well."""
    hosts, rendered, seen = set(), set(), {}
    fenced = False
    for line in text.splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
        heading = None if fenced else re.match(r"#+ +(.*?) *#*$", line)
        if not heading:
            continue
        words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading.group(1)).replace("`", "")
        kept = re.sub(r"[^\w\s-]", "", words).strip().lower()
        host = kept.replace(" ", "-")
        number = seen.get(host, 0)
        seen[host] = number + 1
        hosts.add(f"{host}-{number}" if number else host)
        rendered.add(re.sub(r"[-\s]+", "-", kept) + (f"_{number}" if number else ""))
    return hosts, hosts & rendered


def links_of(text):
    """Targets of links and pictures outside of code, with their lines."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        if fenced:
            continue
        for target in re.findall(r"\]\(([^()\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            yield number, target


def faults_of_links(source):
    """Links of all Markdown files that lead nowhere, and their number."""
    faults, count, manual = [], 0, source / "data" / "manual"
    files = [path for top in SOURCES for path in (source / top).glob("**/*.md" if top else "*.md")]
    for path in sorted(set(files)):
        for line, target in links_of(path.read_text(encoding="utf-8")):
            if re.match(r"[a-z]+:", target):
                continue
            count += 1
            name, _, anchor = target.partition("#")
            goal = (path.parent / name).resolve() if name else path
            where = f"{path.relative_to(source)}:{line}: {target}"
            if not goal.exists():
                faults.append(f"{where}: there is no such file")
            elif manual in path.parents and manual not in goal.parents:
                faults.append(f"{where}: leads out of the manual, which is installed without the rest of the tree")
            elif anchor and goal.suffix == ".md" and goal.exists():
                hosts, both = slugs_of(goal.read_text(encoding="utf-8"))
                if anchor not in (both if manual in goal.parents else hosts):
                    faults.append(f"{where}: that page has no such heading")
    return faults, count


def main(arguments):
    if arguments[0] == "--links":
        faults, count = faults_of_links(pathlib.Path(arguments[1]).resolve())
        print("\n".join(faults + [f"{count} links, {len(faults)} lead nowhere"]))
        return bool(faults) or count == 0
    program, source = pathlib.Path(arguments[0]).resolve(), pathlib.Path(arguments[1]).resolve()
    pages = [pathlib.Path(page).resolve() for page in arguments[2:]]
    pages = pages or [source / "README.md", *sorted((source / "data" / "manual").rglob("*.md"))]
    faults, counts = [], {}
    for path in pages:
        folder = tempfile.mkdtemp(prefix="bough-manual-")
        try:
            page = Page(path, source, program, folder)
            faults += page.work()
            for what, number in page.counts.items():
                counts[what] = counts.get(what, 0) + number
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    print("\n".join(faults))
    listed = ", ".join(f"{number} {what}" for what, number in counts.items())
    print(f"{len(pages)} pages: {listed}; {len(faults)} faults")
    return bool(faults) or not counts


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
