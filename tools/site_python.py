# SPDX-License-Identifier: BSD-3-Clause
"""The pages of the Python interface, from the package's sources and stubs. Nothing is imported or built."""
import ast
import re
import textwrap

import griffe

# Parameters at the start of a sentence, such as "near, far: nothing is nearer".
BEGINS = re.compile(r"(?:^|(?<=[.:]\s)|(?<=\n))(\w+(?:, \w+)*): (?=\S)")
ENDS = re.compile(r"(?<=\.)\s(?=(?:Returns|Raises) )")
CODE = re.compile(r"(?:^ {4}.*\n)+", re.MULTILINE)
# The keywords that **look takes.
LOOK = {"color", "material", "transform", "visible", "casts_shadows", "id", "winding", "clip_planes", "scalars", "cmap", "clim"}
PLUGINS = {
    "pytest_plugin": "pytest",
    "pyvista_plugin": "PyVista",
    "compat.pyrender": "pyrender",
    "compat.mujoco": "MuJoCo",
}


def pages(folder):
    """Returns {name: Markdown} of the pages of the package in this folder."""
    package = griffe.load("rastrum", search_paths=[folder], try_relative_path=False, resolve_aliases=True)
    plugins = "".join(f"## {title}\n\n{source(package[name])[0]}\n\n" for name, title in PLUGINS.items())
    return {
        "rastrum": page(package, "rastrum"),
        "mpi": page(package["mpi"], "rastrum.mpi"),
        "dataset": page(package["dataset"], "rastrum.dataset"),
        "plugins": f"# Plugins and stand-ins\n\nOther packages find these by their names.\n\n{plugins}",
    }


def source(module):
    """Returns (docstring as Markdown, names in __all__), which stubs do not have. Indented lines are Python."""
    tree = ast.parse(module.filepath.with_suffix(".py").read_text(encoding="utf-8"))
    public = [ast.literal_eval(node.value) for node in tree.body
              if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__"]
    about = CODE.sub(lambda code: f"```python\n{textwrap.dedent(code.group())}```\n", ast.get_docstring(tree, clean=False))
    return about, [name for names in public for name in names]


def page(module, name):
    about, public = source(module)
    made = f"# {name}\n\n{about}\n\n```{{py:module}} {name}\n```\n\n"
    things = {exported: final(module[exported]) for exported in public if exported != "mpi"}
    bases = {}
    for thing in things.values():
        for base in shared_bases(thing):
            bases.setdefault(base.name, base)
    classes = [t for t in things.values() if t.is_class]
    errors = [t for t in classes if t.name.endswith(("Error", "Warning"))]
    made += section("Functions", [t for t in things.values() if t.is_function])
    made += section("Classes", [*bases.values(), *(t for t in classes if t not in errors)])
    made += section("Errors", errors)
    return made + section("Values", [t for t in things.values() if t.is_attribute])


def section(title, things):
    return f"## {title}\n\n" + "".join(entry(thing) for thing in things) if things else ""


def final(thing):
    return thing.final_target if thing.is_alias else thing


def shared_bases(thing):
    """Returns the bases without a public name whose docstrings apply to their classes."""
    if not thing.is_class:
        return
    for base in thing.resolved_bases:
        if base.name.startswith("_") and base.docstring and len(base.docstring.lines) > 1:
            yield final(base)


def fenced(depth, directive, argument, body, *options):
    fence = "`" * depth
    return f"{fence}{{{directive}}} {argument}\n" + "".join(f":{option}\n" for option in options) + f"\n{body}\n{fence}\n\n"


def entry(thing):
    about = text(thing.docstring, parameter_names(thing))
    if thing.is_class:
        members = (final(m) for name, m in thing.members.items() if not name.startswith("_"))
        body = [about, *(f"It also has what {{py:class}}`{base.name}` says." for base in shared_bases(thing)),
                *(member(m) for m in members if m.is_function or m.is_attribute)]
        return fenced(7, "py:class", thing.name + arguments(thing), "\n\n".join(body))
    if thing.is_function:
        return fenced(5, "py:function", thing.name + signature(thing), about)
    return fenced(5, "py:data", thing.name, about)


def arguments(thing):
    """Returns a class's arguments; for an error its bases, which also catch it."""
    if thing.name.endswith(("Error", "Warning")):
        return f"({', '.join(str(base) for base in thing.bases)})" if thing.bases else ""
    init = thing.members.get("__init__")
    return signature(final(init)).removesuffix(" -> None") if init is not None and final(init).is_function else ""


def member(thing):
    if thing.is_function:
        options = [f"{label}:" for label in ("staticmethod", "classmethod") if label in thing.labels]
        return fenced(5, "py:method", thing.name + signature(thing), text(thing.docstring, parameter_names(thing)), *options)
    kind = "py:property" if "property" in thing.labels else "py:attribute"
    options = [] if thing.annotation is None else [f"type: {thing.annotation}"]
    return fenced(5, kind, thing.name, text(thing.docstring), *options)


def parameter_names(thing):
    function = thing.members.get("__init__") if thing.is_class else thing
    given = {p.name for p in getattr(function, "parameters", None) or ()}
    return given | LOOK if given & {"look", "frame"} else given


def joined(annotations):
    return " | ".join(dict.fromkeys(str(a) for a in annotations if a is not None))


def signature(function):
    """Returns (name: type = default, …) -> type. Overloads are merged with all their types."""
    overloads = list(getattr(function, "overloads", None) or ()) or [function]
    parameters, star = [], False
    for parameter in overloads[0].parameters:
        kind = parameter.kind.name
        if parameter.name in ("self", "cls"):
            continue
        if kind == "keyword_only" and not star:
            parameters.append("*")
            star = True
        star = star or kind == "var_positional"
        mark = {"var_positional": "*", "var_keyword": "**"}.get(kind, "")
        types = joined(o.parameters[parameter.name].annotation for o in overloads if parameter.name in o.parameters)
        default = "" if parameter.default is None or mark else f" = {parameter.default}" if types else f"={parameter.default}"
        parameters.append(mark + parameter.name + (f": {types}" if types and not mark else "") + default)
    returned = joined(o.returns for o in overloads)
    return f"({', '.join(parameters)})" + (f" -> {returned}" if returned else "")


def text(docstring, parameters=()):
    """Returns a docstring as Markdown, with parameters as items of a list."""
    def item(match):
        names = match.group(1).split(", ")
        if not parameters or not all(name in parameters for name in names):
            return match.group()
        return "\n- **" + ", ".join(names) + "**: "
    if docstring is None:
        return ""
    said = BEGINS.sub(item, docstring.value)
    return said if said == docstring.value else ENDS.sub(r"\n\n", said)
