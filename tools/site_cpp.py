# SPDX-License-Identifier: BSD-3-Clause
"""The pages of the C++ interface, one per public header, from Doxygen's XML, in the order of the header."""
import re
import xml.etree.ElementTree as ElementTree

# Namespaces that users do not write.
INTERNAL = re.compile(r"\b\w+_detail\b")
SPECIAL = re.compile(r"([\\`*_\[\]<>|#~^$])")
LONGEST_VALUE = 60
# A comment between blank lines, which describes what follows.
REMARK = re.compile(r"(?<=\n\n)(?:// ?[^\n]*\n)+(?=\n)")


class Interface:
    """All that Doxygen found."""

    def __init__(self, folder):
        self.compounds = {}
        for file in sorted(folder.glob("*.xml")):
            for compound in ElementTree.parse(file).getroot().iter("compounddef"):
                self.compounds[compound.get("id")] = compound
        self.nested = {inner.get("refid") for compound in self.compounds.values() if compound.get("kind") in ("struct", "class")
                       for inner in compound.iter("innerclass")}

    def page(self, path, text):
        """Returns Markdown of the header's declarations."""
        domain = "c" if path.endswith(".h") else "cpp"
        entries = [(line_of(thing), entry) for thing in self.declared(path) if (entry := self.entry(thing, domain, 7))]
        entries += [(1 + text.count("\n", 0, remark.start()), remark_of(remark.group())) for remark in REMARK.finditer(text)]
        scope = "```{cpp:namespace} rastrum\n```\n\n" if domain == "cpp" else ""
        return scope + "".join(entry for _, entry in sorted(entries, key=lambda placed: placed[0]))

    def declared(self, path):
        """Returns the outermost things of this file. Doxygen lists a thing of a namespace both by file and by namespace."""
        found = {}
        for compound in self.compounds.values():
            kind = compound.get("kind")
            if kind in ("file", "namespace"):
                for member in compound.iter("memberdef"):
                    if place(member) == path:
                        found[member.get("id")] = member
            elif kind in ("struct", "class", "concept", "union") and place(compound) == path and compound.get("id") not in self.nested:
                found[compound.get("id")] = compound
        return [thing for thing in found.values() if not INTERNAL.search(name_of(thing).rpartition("::")[0])]

    def entry(self, thing, domain, depth):
        """Returns a directive for the thing, or "" if users do not call it."""
        kind, name = thing.get("kind"), name_of(thing)
        if thing.get("prot") == "private" or kind == "friend" or INTERNAL.search(name):
            return ""
        about = text_of(thing)
        if thing.tag == "compounddef":
            return self.compound(thing, domain, depth, about)
        short = unqualified(thing)
        if kind == "enum":
            return enumeration(thing, domain, depth, about, short)
        if kind == "define":
            given = [parameter.findtext("defname", "") for parameter in thing.iter("param")]
            return directive("c:macro", name + (f"({', '.join(given)})" if given else ""), about, depth)
        if kind == "function":
            return function(thing, domain, depth, about, short)
        if kind == "typedef":
            return alias(thing, domain, depth, about, short)
        value = plain(thing.find("initializer"))
        shown = f" {value}" if value.startswith("=") and len(value) <= LONGEST_VALUE and "{" not in value else ""
        declared = declaration(thing, short) + plain(thing.find("argsstring")) + (shown if domain == "cpp" else "")
        return directive(f"{domain}:{'member' if domain == 'c' else 'var'}", declared, about, depth)

    def compound(self, thing, domain, depth, about):
        kind, name = thing.get("kind"), relative(thing.findtext("compoundname"))
        if kind == "concept":
            made = plain(thing.find("initializer"))
            template = re.match(r"template\s*<.*?>", made)
            return directive("cpp:concept", f"{template.group() if template else 'template<class T>'} {name}", about, depth)
        name = name if depth == 7 else name.rpartition("::")[2]
        inside = [(line_of(member), self.entry(member, domain, depth - 2)) for member in thing.iter("memberdef")]
        inside += [(line_of(inner), self.entry(inner, domain, depth - 2)) for ref in thing.iter("innerclass")
                   if ref.get("prot") != "private" and (inner := self.compounds.get(ref.get("refid"))) is not None]
        body = about + "\n\n" + "".join(entry for _, entry in sorted(inside, key=lambda placed: placed[0]))
        bases = ", ".join(relative(base.text) for base in thing.findall("basecompoundref") if base.get("prot") == "public")
        head = template_of(thing) + name + (f" : public {bases}" if bases else "")
        return directive(f"{domain}:{'struct' if domain == 'c' else kind}", head, body, depth)


def function(thing, domain, depth, about, short):
    arguments = plain(thing.find("argsstring"))
    if re.search(r"= ?delete$", arguments) or re.search(r"= ?default$", arguments) and not about:
        return ""
    requires = plain(thing.find("requiresclause"))
    if requires.startswith("requires"):  # Sphinx cannot read that
        requires = ""
    template = template_of(thing) + (f"requires {requires} " if requires else "")
    declared = declaration(thing, short)
    if thing.get("explicit") == "yes" and "explicit" not in declared:
        declared = f"explicit {declared}"
    return directive(f"{domain}:function", template + declared + re.sub(r" ?= ?(default|0)$", r" = \1", arguments), about, depth)


def alias(thing, domain, depth, about, short):
    definition = plain(thing.find("definition"))
    if domain == "c":
        # `typedef struct X X` is a handle. Others show their type.
        return directive("c:type", short if definition.startswith("typedef struct") else definition.removeprefix("typedef "), about, depth)
    to = definition.partition("= ")[2].removeprefix("typedef ")
    shown = f" = {to}" if to and "decltype" not in to else ""  # Sphinx cannot read that
    return directive("cpp:type", template_of(thing) + short + shown, about, depth)


def enumeration(thing, domain, depth, about, short):
    values = "".join(
        directive(f"{domain}:enumerator", value.findtext("name") + (f" {plain(value.find('initializer'))}" if domain == "c" else ""),
                  text_of(value), depth - 2)
        for value in thing.findall("enumvalue"))
    kind = "enum-class" if thing.get("strong") == "yes" else "enum"
    number = plain(thing.find("type"))
    name = short if thing.findtext("name") else f"@{thing.get('id')[-8:]}"
    head = name + (f" : {number}" if number and domain == "cpp" else "")
    return directive(f"{domain}:{kind}", head, f"{about}\n\n{values}", depth)


def directive(name, argument, body, depth):
    fence = "`" * depth
    return f"{fence}{{{name}}} {' '.join(argument.split())}\n\n{body.strip()}\n{fence}\n\n"


def place(thing):
    location = thing.find("location")
    return location.get("file") if location is not None else ""


def line_of(thing):
    return int(thing.find("location").get("line"))


def relative(name):
    return name.removeprefix("rastrum::")


def name_of(thing):
    if thing.tag == "compounddef":
        return relative(thing.findtext("compoundname"))
    return relative(thing.findtext("qualifiedname") or thing.findtext("name"))


def unqualified(thing):
    """Returns the name as a directive inside of its class has it; at the outermost level, the name after rastrum::."""
    name = name_of(thing)
    return name.rpartition("::")[2] if thing.get("id").startswith(("struct", "class")) and "operator" not in name else (
        thing.findtext("name") if thing.get("id").startswith(("struct", "class")) else name)


def declaration(thing, short):
    """Returns what precedes the arguments, with the name as written."""
    words = [word for word, attribute in (("static", "static"), ("virtual", "virt"), ("constexpr", "constexpr"))
             if thing.get(attribute) in ("yes", "virtual", "pure-virtual")]
    kind = re.sub(r"\b(?:static|virtual|constexpr|inline|friend)\b ?", "", plain(thing.find("type")))
    return " ".join([*words, kind, short]).strip()


def template_of(thing):
    parameters = thing.find("templateparamlist")
    if parameters is None:
        return ""
    written = []
    for parameter in parameters.findall("param"):
        kind, name, default = (plain(parameter.find(tag)) for tag in ("type", "declname", "defval"))
        written.append(kind + (f" {name}" if name else "") + (f" = {default}" if default else ""))
    return f"template<{', '.join(written)}> "


def plain(element):
    """Returns the text of code."""
    return "" if element is None else " ".join("".join(element.itertext()).split())


def text_of(thing):
    """Returns the comments as Markdown."""
    paragraphs = [markdown(block) for part in ("briefdescription", "detaileddescription") if (found := thing.find(part)) is not None
                  for block in found]
    return "\n\n".join(paragraph for paragraph in paragraphs if paragraph)


def markdown(element):
    made = [SPECIAL.sub(r"\\\1", element.text or "")]
    for child in element:
        inside = "".join(child.itertext())
        if child.tag == "computeroutput":
            made.append(f"`{inside}`")
        elif child.tag == "blockquote":
            # Doxygen reads a line that begins with > as a quotation. Here it is a comparison.
            made.append("\\> " + "".join(markdown(block) for block in child))
        elif child.tag == "listitem":
            made.append("\n1. " + "".join(markdown(block) for block in child))
        elif child.tag not in ("zwj", "linebreak"):
            made.append(markdown(child))
        made.append(SPECIAL.sub(r"\\\1", child.tail or ""))
    return "".join(made).strip() if element.tag == "para" else "".join(made)


def remark_of(comment):
    """Returns a heading if the comment has few words, else a paragraph."""
    text = " ".join(line.lstrip("/ ") for line in comment.splitlines())
    return f"## {text.rstrip('.')}\n\n" if len(text) < 70 and text.count(". ") == 0 else f"{text}\n\n"
