#!/usr/bin/env python3
"""Writes the reference pages of the manual from what the program itself says.

    python3 reference.py PROGRAM FOLDER

Writes command-line.md from `--help`, scene.md, sweep.md, study.md, chain.md and motion.md from the JSON Schemas that
`bough schema` prints, python.md from the docstrings of apps/python/bough.py, and headers.md from the first sentences of
the public headers. Two runs with one program write the same bytes. Needs the standard library alone.
"""

import ast
import json
import pathlib
import re
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[3]
MADE = "This page is written by `data/manual/make/reference.py` from what the program prints.\n"
SCHEMAS = [  # page, options of the verb, title, command; of later pages, what the first ones define is not repeated
    ("scene", [], "The format of scenes", "bough schema"),
    ("sweep", ["--sweep"], "The format of sweeps", "bough schema --sweep"),
    ("study", ["--study"], "The format of studies", "bough schema --study"),
    ("chain", ["--chain"], "The format of chains of frames", "bough schema --chain"),
    ("motion", ["--motion"], "The format of a motion", "bough schema --motion"),
]


def output_of(program, *arguments):
    return subprocess.run([program, *arguments], check=True, stdout=subprocess.PIPE, text=True).stdout


def verbs_of(help_text):
    """Names of the sub-commands that a help text lists."""
    listed = re.search(r"^Subcommands:\n((?:  .*\n?)+)", help_text, re.MULTILINE)
    return re.findall(r"^  (\S+)", listed.group(1), re.MULTILINE) if listed else []


def command_line(program):
    """The help of the program, of every verb and of every verb of a verb."""
    text = ["# Command line\n", MADE, "`bough VERB --help` prints the same text.\n"]

    def add(verbs, level):
        printed = output_of(program, *verbs, "--help")
        text.append(f"{'#' * level} {' '.join(['bough', *verbs])}\n")
        text.append("```text\n" + printed.rstrip() + "\n```\n")
        for verb in verbs_of(printed):
            add([*verbs, verb], level + 1 if verbs else 2)

    add([], 2)
    return "\n".join(text)


def cell(text):
    """A text as a cell of a table of Markdown."""
    return re.sub(r"\s+", " ", text).replace("|", "\\|").replace("<", "&lt;").strip()


def reached(schema, definitions):
    """Names of the definitions to which a schema leads, directly or through others."""
    names, open_parts = set(), [schema]
    while open_parts:
        part = open_parts.pop()
        if isinstance(part, dict):
            name = part.get("$ref", "").rsplit("/", 1)[-1]
            if name in definitions and name not in names:
                names.add(name)
                open_parts.append(definitions[name])
            open_parts += part.values()
        elif isinstance(part, list):
            open_parts += part
    return names


def reference_of(schema):
    """Name of the definition that a schema refers to, or None."""
    for part in [schema, *schema.get("allOf", [])]:
        if "$ref" in part:
            return part["$ref"].rsplit("/", 1)[1]
    return None


def type_of(schema, elsewhere=()):
    """What a value may be, in words, with links to definitions; those of `elsewhere` are on the page of scenes."""
    name = reference_of(schema)
    if name is not None:
        return f"[{name}]({'scene.md' if name in elsewhere else ''}#{name})"
    if "enum" in schema:
        return ", ".join(f"`{json.dumps(word)}`" for word in schema["enum"])
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    for key in ("anyOf", "oneOf"):
        if key in schema:
            return " or ".join(dict.fromkeys(type_of(part, elsewhere) for part in schema[key]))
    kind = schema.get("type", "any value")
    if kind == "array":
        low, high = schema.get("minItems"), schema.get("maxItems")
        count = f"{low} x " if low is not None and low == high else ""
        return f"list of {count}{type_of(schema.get('items', {}), elsewhere)}"
    if kind == "object" and isinstance(schema.get("additionalProperties"), dict):
        return f"object of any names, each a {type_of(schema['additionalProperties'], elsewhere)}"
    if kind == "object" and "properties" in schema:
        keys = ", ".join(f"`{key}`" for key in schema["properties"] if key != "comment")
        return f"object with {keys}"
    return kind if isinstance(kind, str) else " or ".join(kind)


def range_of(schema):
    """The limits of a number, as text."""
    for part in [schema, *schema.get("anyOf", [])]:
        limits = [(sign, part[key]) for key, sign in (("minimum", ">="), ("exclusiveMinimum", ">"), ("maximum", "<="),
                                                      ("exclusiveMaximum", "<")) if key in part]
        if limits:
            return ", ".join(f"{sign} {value:g}" for sign, value in limits)
    return ""


def nested_objects(schema):
    """Objects with keys of their own that stand within a schema without a name."""
    if reference_of(schema):
        return
    if schema.get("type") == "object" and "properties" in schema:
        if not isinstance(schema.get("additionalProperties"), dict):
            yield schema
        return
    for part in [*schema.get("oneOf", []), *schema.get("anyOf", []), *([schema["items"]] if "items" in schema else [])]:
        yield from nested_objects(part)


def variant_title(schema, number):
    """What tells a form of an object from the others: its kind, or the key that only it requires."""
    kind = schema.get("properties", {}).get("kind", {}).get("enum", [])
    if len(kind) == 1:
        return f"`\"kind\": \"{kind[0]}\"`"
    required = [key for key in schema.get("required", []) if key != "name"]
    return " and ".join(f"`{key}`" for key in required) if required else f"form {number}"


def object_table(schema, text, path, elsewhere=()):
    """The keys of an object as a table, and then those of the objects within."""
    rows, within = [], []
    required = schema.get("required", [])
    for key, value in schema.get("properties", {}).items():
        if key in ("comment", "$schema"):
            continue
        if "default" in value:
            default = f"`{json.dumps(value['default'])}`"
        else:
            default = "required" if key in required else ""
        limits = range_of(value)
        kinds = cell(type_of(value, elsewhere)) + (f" {limits}" if limits else "")
        rows.append(f"| `{key}` | {kinds} | {default} | {cell(value.get('description', ''))} |")
        for inner in nested_objects(value):
            within.append((f"{path}.{key}", inner))
    text.append("| key | value | default | meaning |\n|---|---|---|---|\n" + "\n".join(rows) + "\n")
    for name, inner in within:
        text.append(f"`{name}`: {inner.get('description', '')}\n")
        object_table(inner, text, name, elsewhere)


def definition(name, schema, text, elsewhere):
    text.append(f"## {name}\n")
    if "description" in schema:
        text.append(schema["description"].replace("<", "&lt;") + "\n")
    if "properties" in schema and not isinstance(schema.get("additionalProperties"), dict):
        object_table(schema, text, name, elsewhere)
        return
    simple = [part for part in schema.get("oneOf", schema.get("anyOf", [])) if "properties" not in part]
    if simple or not schema.get("oneOf"):
        shown = dict(schema, oneOf=simple) if simple else schema
        text.append(f"Value: {cell(type_of(shown, elsewhere))}.\n")
    for number, part in enumerate((p for p in schema.get("oneOf", []) if "properties" in p), 1):
        text.append(f"Form {number}, {variant_title(part, number)}: {part.get('description', '')}\n")
        object_table(part, text, name, elsewhere)


def schema_page(schema, title, command, elsewhere):
    definitions = schema.get("definitions", {})
    names = reached(schema.get("properties", {}), definitions) - set(elsewhere)
    text = [f"# {title}\n", MADE,
            f"`{command}` prints it as a JSON Schema, which editors use to complete and to check.\n"]
    text.append(schema.get("description", "").replace("<", "&lt;") + "\n")
    text.append("Every object may have a `comment`, a text that is not read. Any number may be a "
                "[formula](#formula).\n" if "formula" in names else "")
    text.append("## the file\n")
    object_table(schema, text, "file", elsewhere)
    for name in sorted(names):
        definition(name, definitions[name], text, elsewhere)
    return re.sub(r"\n{3,}", "\n\n", "\n".join(text))


def python_page(path):
    """Functions and classes of a module, with their arguments and docstrings."""
    module = ast.parse(path.read_text(encoding="utf-8"))
    public = next(ast.literal_eval(node.value) for node in module.body
                  if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
    text = ["# The Python module\n", MADE.replace("what the program prints", "docstrings"),
            "```text\n" + ast.get_docstring(module) + "\n```\n"]

    def add(node, level, owner=""):
        called = isinstance(node, ast.FunctionDef) and not node.decorator_list  # not a class, nor a property
        arguments = f"({re.sub(r'^self(, )?', '', ast.unparse(node.args))})" if called else ""
        text.append(f"{'#' * level} `{owner}{node.name}{arguments}`\n")
        text.append((ast.get_docstring(node) or "").replace("<", "&lt;") + "\n")
        for inner in node.body if isinstance(node, ast.ClassDef) else []:
            if isinstance(inner, ast.FunctionDef) and (inner.name == "__getitem__" or inner.name[0] != "_"):
                add(inner, level + 1, node.name + ".")

    for node in module.body:
        if getattr(node, "name", None) in public:
            add(node, 2)
    return "\n".join(text)


def headers_page(folder):
    """The public headers by layer, each with the first sentence of its first comment."""
    text = ["# The headers\n", MADE.replace("what the program prints", "the headers themselves"),
            "Each header states equations, shapes, frames, units and errors of what it declares.\n"]
    for layer in sorted(path for path in folder.iterdir() if path.is_dir()):
        text.append(f"## {layer.name}\n\n| header | about |\n|---|---|")
        for header in sorted(layer.glob("*.hpp")):
            comment = re.search(r"^/// (.*(?:\n/// ?.*)*)", header.read_text(encoding="utf-8"), re.MULTILINE).group(1)
            sentence = re.split(r"(?<=[^.\d])\.(?:\s|$)", re.sub(r"\n/// ?", " ", comment))[0]
            text.append(f"| `bough/{layer.name}/{header.name}` | {cell(sentence)} |")
        text.append("")
    return "\n".join(text)


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "command-line.md").write_text(command_line(program), encoding="utf-8")
    (folder / "python.md").write_text(python_page(SOURCE / "apps" / "python" / "bough.py"), encoding="utf-8")
    (folder / "headers.md").write_text(headers_page(SOURCE / "include" / "bough"), encoding="utf-8")
    scenes = ()
    for name, options, title, command in SCHEMAS:
        schema = json.loads(output_of(program, "schema", *options))
        (folder / f"{name}.md").write_text(schema_page(schema, title, command, scenes), encoding="utf-8")
        scenes = scenes or tuple(schema["definitions"])


if __name__ == "__main__":
    main()
