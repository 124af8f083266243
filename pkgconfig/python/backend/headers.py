"""Reads the public headers: declarations for cffi, and what Python says about enums, structs and constants.

Nothing here names a function, a struct or a field. So a changed header changes the package, and nothing is forgotten.

SPDX-License-Identifier: MIT
"""
import re
from pathlib import Path

NOT_READ = {"export.h"}  # macros that the text below does without


class Header:
    """All public headers of a folder, in the order in which they include each other."""

    def __init__(self, folder):
        texts = {path.name: path.read_text(encoding="utf-8") for path in sorted(Path(folder).glob("*.h"))}
        if not texts:
            raise FileNotFoundError(f"there are no headers in {folder}")
        self.text = "".join(without_preprocessor_branches(texts[name]) for name in in_order(texts))
        self.macros = constants(self.text)
        self.enums, self.enumerators = enums(self.text)
        self.constants = {**self.macros, **self.enumerators}
        self.structs = structs(self.text)
        kinds = re.findall(r"^MSPRING_DEFAULT\((\w+), (\w+)\);", self.text, flags=re.M)
        self.kinds = {name: self.enumerators[kind] for name, kind in kinds}  # what mspring_init() makes
        numbers = [self.constants["MSPRING_VERSION_" + part] for part in ("MAJOR", "MINOR", "PATCH")]
        self.version = ".".join(map(str, numbers))
        self.constants["MSPRING_VERSION"] = numbers[0] * 1000000 + numbers[1] * 1000 + numbers[2]

    def declarations(self, text=None):
        """The headers, or a text that includes them, as cffi reads them: without comments, macros and the preprocessor's
        lines."""
        text = re.sub(r"//[^\n]*|/\*.*?\*/", "", self.text if text is None else text, flags=re.S)
        text = re.sub(r"^[ \t]*#(?:\\\n|[^\n])*$", "", text, flags=re.M)
        text = re.sub(r"^MSPRING_DEFAULT\(.*\);$", "", text, flags=re.M)  # as with MSPRING_NO_INLINE
        text = re.sub(r"\bMSPRING_(API|CALL|NODISCARD)\b", "", text)
        text = text.replace("MSPRING_ENUM_INT", str(-0x7FFFFFFF - 1))
        text = re.sub(r"\[(MSPRING_\w+)\]", lambda size: f"[{self.constants[size.group(1)]}]", text)
        return re.sub(r"\n\s*\n+", "\n", text)


def in_order(texts):
    """Names of headers, each after those that it includes."""
    order = []

    def add(name):
        if name in order or name in NOT_READ or name not in texts:
            return
        for included in re.findall(r'^#include "(.*?)"', texts[name], flags=re.M):
            add(included)
        order.append(name)

    for name in texts:
        add(name)
    return order


def without_preprocessor_branches(text):
    """Leave out what is for C++ alone, and inline functions."""
    return re.sub(r"^#(ifdef __cplusplus|if !defined\(MSPRING_NO_INLINE\))\n.*?^#endif\n", "", text, flags=re.S | re.M)


def value_of(expression, known):
    """A C constant as a Python number, or None."""
    expression = re.sub(r"\b(0x[0-9a-fA-F]+|\d+)[uUlL]+\b", r"\1", expression)
    expression = re.sub(r"(\d\.?\d*(?:e[+-]?\d+)?)f\b", r"\1", expression)
    try:
        return eval(expression, {"__builtins__": {}}, dict(known))  # numbers and names of numbers
    except (NameError, SyntaxError, TypeError):
        return None


def constants(text):
    """The macros that are numbers."""
    found = {}
    for name, expression in re.findall(r"^#define (MSPRING_\w+) +([^\n/]+)", text, flags=re.M):
        value = value_of(expression.strip(), found)
        if value is not None:
            found[name] = value
    return found


def comment_of(text):
    """A comment of several lines as one text."""
    return " ".join(" ".join(line.strip().lstrip("/").lstrip("<").strip() for line in text.splitlines()).split())


def members(body):
    """Pairs of a declaration, up to its comma or semicolon, and its comment, which precedes or follows it."""
    found, before = [], ""
    for line in body.splitlines():
        code, slashes, comment = line.partition("//")
        code, comment = code.strip(), comment_of(slashes + comment) if slashes else ""
        if not code:
            if before or not found or not line.strip().startswith("///<"):
                before = f"{before} {comment}".strip() if comment else before
            if line.strip().startswith("///<") and found:
                found[-1][1] = f"{found[-1][1]} {comment}".strip()
            continue
        if found and found[-1][0][-1] not in ",;":  # the line before goes on
            found[-1][0] += " " + code
            found[-1][1] = f"{found[-1][1]} {comment}".strip()
        else:
            found.append([code, f"{before} {comment}".strip()])
        before = ""
    return found


def enums(text):
    """The named enums, as name: (comment, {member: (value, comment)}), and all enumerators with their values."""
    named, every = {}, {}
    pattern = r"((?:^///[^\n]*\n)*)^(?:typedef )?enum ?(\w*) \{\n(.*?)^\}"
    for comment, name, body in re.findall(pattern, text, flags=re.S | re.M):
        values = {}
        for declaration, about in members(body):
            for part in filter(None, (part.strip() for part in declaration.split(","))):
                member, _, expression = (piece.strip() for piece in part.partition("="))
                value = value_of(expression, every)
                if value is None:
                    if expression != "MSPRING_ENUM_INT":
                        raise ValueError(f"the enumerator {member} has no value that can be read: {expression}")
                    continue
                values[member], every[member] = (value, about), value
        if name:
            named[name] = (comment_of(comment), values)
    return named, every


def structs(text):
    """The public structs, as name: (comment, {field: (type, comment)})."""
    found = {}
    pattern = r"((?:^///[^\n]*\n)*)^typedef struct (\w+) \{\n(.*?)^\} \2;"
    for comment, name, body in re.findall(pattern, text, flags=re.S | re.M):
        fields = {}
        for declarations, about in members(body):
            if "(" in declarations:
                field = re.search(r"\((?:\w+ )?\*(\w+)\)", declarations)
                fields[field.group(1)] = ("function", about)
                continue
            for declaration in filter(None, (part.strip() for part in declarations.split(";"))):
                first, *others = declaration.split(",")
                kind, field = re.match(r"(.*?)(\w+(?:\[\w+\])?)$", first.strip()).groups()
                for item in [field] + others:
                    is_array = "[" in item
                    bare = re.sub(r"\[.*|[\s*]", "", item)
                    fields[bare] = (kind.strip() + ("[]" if is_array else ""), about)
        found[name] = (comment_of(comment), fields)
    return found
