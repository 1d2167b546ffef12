#!/usr/bin/env python3
"""Writes what a shell knows of the program: manual pages of section 1, and completion for bash.

    python3 shell.py PROGRAM FOLDER VERSION

Writes man1/bough.1, man1/bough-VERB.1 for every verb, and completions/bough, all from `--help`: what the program does
not print is not in them. Two runs with one program write the same bytes. Needs the standard library alone.
"""

import pathlib
import re
import sys

from reference import output_of, verbs_of

COMPLETION = """# Completion of bough for bash, written by data/manual/make/shell.py from `bough --help`.
_bough() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} verb=${{COMP_WORDS[1]}} words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "{verbs} --help --version" -- "$current")
    return
  fi
  case $before in
    new) words=$("${{COMP_WORDS[0]}}" new 2>/dev/null | awk '{{ print $1 }}') ;;
    help | explain) words="{verbs}" ;;
  esac
  if [ -n "$words" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
    return
  fi
  case $verb in
{options}
  esac
  case $current in
    -*) mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current") ;;
    *) mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
  esac
}}
complete -o filenames -F _bough bough
"""


def escaped(text):
    """A text as roff takes it."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in text.split("\n"))


def sections_of(help_text):
    """The help as [(title, lines)]: what stands before the first title has the title ""."""
    sections = [("", [])]
    for line in help_text.rstrip().split("\n"):
        title = re.match(r"^([A-Z][A-Za-z ]+):(.*)$", line)
        if title and title.group(1) in ("Usage", "Positionals", "Options", "Subcommands", "Examples"):
            sections.append((title.group(1), [title.group(2).strip()] if title.group(2).strip() else []))
        else:
            sections[-1][1].append(line)
    return [(title, lines) for title, lines in sections if any(line.strip() for line in lines)]


def options_of(help_text):
    """The long options that a help text lists."""
    return sorted(set(re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", help_text, re.MULTILINE)))


def page(name, about, help_text, version, others):
    """A manual page: the sections of the help under the titles of manual pages, in lines as they are printed."""
    titles = {"": "DESCRIPTION", "Usage": "SYNOPSIS", "Positionals": "ARGUMENTS", "Options": "OPTIONS",
              "Subcommands": "VERBS", "Examples": "EXAMPLES"}
    order = ["Usage", "", "Positionals", "Options", "Subcommands", "Examples"]
    text = [f'.TH {name.upper()} 1 "" "bough {version}" "bough"', ".SH NAME", f"{escaped(name)} \\- {escaped(about)}"]
    parts = sorted(sections_of(help_text), key=lambda part: order.index(part[0]))
    for title, lines in parts:
        text += [f".SH {titles[title]}", ".nf", escaped("\n".join(lines).strip("\n")), ".fi"]
    listed = [f".BR {escaped(other)} (1)" + ("," if other != others[-1] else ".") for other in others]
    text += [".SH SEE ALSO", *listed, ".PP", "\\fBbough explain\\fR looks words up in the manual."]
    return "\n".join(text) + "\n"


def main():
    program, folder, version = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
    (folder / "man1").mkdir(parents=True, exist_ok=True)
    (folder / "completions").mkdir(parents=True, exist_ok=True)
    main_help = output_of(program, "--help")
    verbs = verbs_of(main_help)
    pages = [f"bough-{verb}" for verb in verbs]
    about = main_help.split("\n", 1)[0].rstrip(".")
    (folder / "man1" / "bough.1").write_text(page("bough", about, main_help, version, pages), encoding="utf-8")
    options = []
    for verb in verbs:
        printed = output_of(program, verb, "--help")
        listed = options_of(printed)
        for inner in verbs_of(printed):
            inner_help = output_of(program, verb, inner, "--help")
            printed += f"\n\n{verb} {inner}\n{inner_help}"
            listed = sorted({*listed, *options_of(inner_help), inner})
        first = printed.split("\n", 1)[0].rstrip(".")
        text = page(f"bough-{verb}", first, printed, version, ["bough"])
        (folder / "man1" / f"bough-{verb}.1").write_text(text, encoding="utf-8")
        options.append(f'    {verb}) words="{" ".join(listed)}" ;;')
    text = COMPLETION.format(verbs=" ".join(verbs), options="\n".join(options))
    (folder / "completions" / "bough").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main()
