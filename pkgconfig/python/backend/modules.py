"""Writes the module of massspring that is made of the headers: constants, enums, errors, records, keyword arguments.

    python3 modules.py INCLUDE OUT    writes OUT/_bindings.py and OUT/_header.py, and stubs of modules in OUT

SPDX-License-Identifier: MIT
"""
import ast
import keyword
import re
import sys
import textwrap
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from headers import Header  # noqa: E402

BEGIN = '''"""Constants, enums, errors, records and keyword arguments of the library's headers. Made by the build: do not edit.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from enum import IntEnum
from typing import Any, Dict, Literal, Optional, Tuple, TypedDict, Union

from ._types import Error, Record

VERSION = "{version}"
'''
# What an error is in Python besides a massspring.Error.
BUILTIN_ERRORS = {"ARGUMENT": "ValueError", "ID": "IndexError", "MEMORY": "MemoryError", "UNSTABLE": "ArithmeticError",
                  "SNAPSHOT": "ValueError", "DUPLICATE": "ValueError", "LIMIT": "ValueError"}
NUMBERS = {"float": "float", "double": "float", "size_t": "int"}


def camel(name):
    return "".join(part.capitalize() for part in name.split("_"))


def python_name(name):
    return camel(re.sub(r"^mspring_", "", name))


def in_python(text):
    """A comment of the headers with the names that Python has."""
    text = re.sub(r"\bmspring_(?:network|builder)_(\w+)\(\)", r"\1()", text)
    text = re.sub(r"\bmspring_(\w+)", lambda match: match.group(0) if "(" in match.group(0) else match.group(1), text)
    text = re.sub(r"\bMSPRING_(?!SIMD \()", "", text)  # which is a variable of the environment
    return text.replace("\\", "\\\\").replace('"""', "'''")


def docstring(text, indent="    "):
    return textwrap.fill(f'"""{in_python(text)}"""', 118, initial_indent=indent, subsequent_indent=indent,
                         break_on_hyphens=False, break_long_words=False) + "\n"


def common_prefix(names):
    words = [name.split("_") for name in names]
    count = 0
    while all(len(word) > count + 1 for word in words) and len({word[count] for word in words}) == 1:
        count += 1
    return "_".join(words[0][:count]) + "_"


def is_hidden(field, kind):
    return field == "struct_size" or field.startswith("reserved") or "*" in kind or kind == "function"


class Writer:
    def __init__(self, header):
        self.header = header

    def annotation(self, kind):
        if kind in self.header.enums:
            return python_name(kind)
        if kind.endswith("[]"):
            return f"Tuple[{self.annotation(kind[:-2])}, ...]"
        return "Optional[int]" if kind == "mspring_id" else NUMBERS.get(kind, "int")

    def about(self, struct, field):
        """The comment of a field, of the struct that it refers to if need be."""
        about = self.header.structs[struct][1][field][1]
        for other in ("mspring_settings", "mspring_solver_def", "mspring_mesh_def", "mspring_spring_def"):
            fields = self.header.structs[other][1] if other != struct else {}
            if field in fields and (not about or re.search(r"\bas in\b|^from here|^this and", about)):
                return fields[field][1] if not re.match(r"this and", fields[field][1]) else about
        return about

    def constants(self):
        for name, value in sorted(self.header.constants.items()):
            if name.startswith("MSPRING_VERSION") or name in self.header.enums:
                continue
            yield f"{name[len('MSPRING_'):]} = {value!r}\n"

    def enums(self):
        yield "\nENUMS: Dict[str, Any] = {}\n"
        for name, (about, values) in self.header.enums.items():
            prefix = common_prefix(list(values))
            yield f"\n\nclass {python_name(name)}(IntEnum):\n{docstring(about)}\n"
            for member, (value, _) in values.items():
                yield f"    {member[len(prefix):]} = {value}\n"
            yield f"\n\nENUMS[{name!r}] = {python_name(name)}\n"
        of_particles = [value for value, about in self.header.enums["mspring_property"][1].values()
                        if about.startswith("Of a particle")]
        yield f"\nPARTICLE_PROPERTIES = {tuple(of_particles)}\n"
        members = list(self.header.enums["mspring_property"][1])
        names = ", ".join(repr(member[len(common_prefix(members)):].lower()) for member in members)
        yield f"\n# A member of Property as text.\nPropertyName = Literal[{names}]\n"

    def errors(self):
        yield "\n\nERRORS: Dict[int, type] = {}\n"
        for member, (value, about) in self.header.enums["mspring_result"][1].items():
            if value >= 0:
                continue
            bare = member[len("MSPRING_ERROR_"):]
            name = ("OutOfMemory" if bare == "MEMORY" else camel(bare.lower())) + "Error"
            bases = ", ".join(filter(None, ("Error", BUILTIN_ERRORS.get(bare))))
            yield f"\n\nclass {name}({bases}):\n{docstring(about[0].upper() + about[1:] + '.')}\n\n"
            yield f"ERRORS[{value}] = {name}\n"

    def records(self):
        """What functions fill."""
        for name, (about, fields) in self.header.structs.items():
            if not re.search(rf"(?<!const ){name} \*\w+(?!, size_t)[,)]", self.header.text):
                continue
            shown = {field: kind for field, (kind, _) in fields.items() if not is_hidden(field, kind)}
            yield f"\n\nclass {python_name(name)}(Record):\n{docstring(about)}\n"
            kinds = {}
            for field, kind in shown.items():
                yield f"    {field}: {self.annotation(kind)}  # {in_python(self.about(name, field))}\n"
                kinds[field] = kind if kind == "mspring_id" else ""
            enums = {field: kind for field, kind in shown.items() if kind in self.header.enums}
            inside = ", ".join(f"{field!r}: " + (python_name(enums[field]) if field in enums else repr(kinds[field]))
                               for field in shown)
            yield f"    _fields = {{{inside}}}\n"

    def keyword_types(self, name):
        """The keyword arguments that fill a struct, and their types."""
        types = {}
        for field, (kind, _) in self.header.structs[name][1].items():
            if not is_hidden(field, kind) and not keyword.iskeyword(field):
                kind = self.annotation(kind)
                kind = f"Union[{kind}, str, int]" if kind[0].isupper() and kind != "Optional[int]" else kind
                types[field] = kind.replace("Optional[int]", "int")
        for field in [field[:-2] for field in types if field.endswith("_x") and field[:-2] + "_y" in types]:
            types[field] = "Tuple[float, float]"
        if "particle_flags" in types or name == "mspring_particle_def":
            types["pinned"] = "bool"
        return types

    def keyword_class(self, name):
        return re.sub("Def$", "", python_name(name)) + "Keywords"

    def keywords(self):
        yield "\n\nABOUT: Dict[str, Dict[str, str]] = {}\n"
        for name, (_, fields) in self.header.structs.items():
            if not re.search(rf"\b{re.sub('_def$', '', name)}(_def)?_init\(", self.header.text):
                continue
            yield f"\n\nclass {self.keyword_class(name)}(TypedDict, total=False):\n"
            yield f'    """Keyword arguments that fill a {name}."""\n\n'
            types = self.keyword_types(name)
            yield "".join(f"    {field}: {kind}\n" for field, kind in types.items()) or "    pass\n"
            names = [field for field, (kind, _) in fields.items() if not is_hidden(field, kind)]
            inside = "".join(f"    {field!r}: {in_python(self.about(name, field))!r},\n" for field in names)
            yield f"\n\nABOUT[{name!r}] = {{\n{inside}}}\n"

    def public(self):
        """What the package shows. Views and events are numpy's arrays there."""
        text = "".join([*self.constants(), *self.enums(), *self.errors(), *self.records()])
        names = re.findall(r"^(?:class )?([A-Za-z]\w*)(?: =|\()", text, flags=re.M)
        shown = [name for name in names if name not in ("PARTICLE_PROPERTIES", "View", "MutableView", "Event")]
        lines = textwrap.fill(", ".join(f'"{name}"' for name in shown), 118, initial_indent="    ",
                              subsequent_indent="    ")
        yield f"\n\n__all__ = [\n{lines}\n]\n"

    def module(self):
        parts = [BEGIN.format(version=self.header.version)]
        for part in (self.constants, self.enums, self.errors, self.records, self.keywords, self.public):
            parts.extend(part())
        return "".join(parts)


class Stub(ast.NodeTransformer):
    """A module for type checkers: signatures alone. Keyword arguments that are Unpack[...Keywords], which not all type
    checkers know, are there one by one."""

    def __init__(self, writer):
        self.types = {writer.keyword_class(name): writer.keyword_types(name) for name in writer.header.structs}

    def visit_FunctionDef(self, function):
        arguments = function.args
        kind = getattr(arguments.kwarg, "annotation", None)
        if isinstance(kind, ast.Subscript) and getattr(kind.value, "id", "") == "Unpack":
            taken = {argument.arg for argument in arguments.args + arguments.kwonlyargs}
            for name, annotation in self.types[kind.slice.id].items():
                if name not in taken:
                    arguments.kwonlyargs.append(ast.arg(name, ast.parse(annotation, mode="eval").body))
                    arguments.kw_defaults.append(ast.Constant(...))
            arguments.kwarg = None
        documented = ast.get_docstring(function) is not None
        function.body = function.body[:documented] + [ast.Expr(ast.Constant(...))]
        function.decorator_list = [one for one in function.decorator_list if not isinstance(one, ast.Call)]
        return function

    def text_of(self, module):
        tree = self.visit(ast.parse(module.read_text(encoding="utf-8")))
        of_header = ast.parse("from typing import Optional, Tuple, Union\nfrom ._header import *").body
        last = max(index for index, node in enumerate(tree.body) if isinstance(node, (ast.Import, ast.ImportFrom)))
        tree.body[last + 1:last + 1] = of_header
        return ast.unparse(ast.fix_missing_locations(tree)) + "\n"


def write_stubs(writer, package):
    """Stubs of the modules that need them. Python 3.8 cannot write them."""
    for module in sorted(Path(package).glob("*.py")) if hasattr(ast, "unparse") else ():
        if "Unpack[" in module.read_text(encoding="utf-8"):
            module.with_suffix(".pyi").write_text(Stub(writer).text_of(module), encoding="utf-8")


def main(include, out):
    import cffi

    header = Header(include)
    ffi = cffi.FFI()
    ffi.set_source("massspring._bindings", None)
    ffi.cdef(header.declarations())
    ffi.emit_python_code(str(Path(out) / "_bindings.py"))
    writer = Writer(header)
    (Path(out) / "_header.py").write_text(writer.module(), encoding="utf-8")
    write_stubs(writer, out)


if __name__ == "__main__":
    main(*sys.argv[1:])
