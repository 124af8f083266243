"""Writes the module of massspring that is made of the headers: constants, enums, errors, reports, keyword arguments.

    python3 modules.py INCLUDE OUT [GPU]    writes OUT/_bindings.py and OUT/_header.py, and stubs of modules in OUT; of
                                            the header GPU, OUT/_gpu_bindings.py

SPDX-License-Identifier: MIT
"""
import ast
import keyword
import re
import sys
import textwrap
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from headers import Header, without_preprocessor_branches  # noqa: E402

BEGIN = '''"""Constants, enums, errors, reports and keyword arguments of the library's headers. Made by the build: do not edit.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from enum import IntEnum, IntFlag
from typing import Any, Dict, Literal, NamedTuple, Optional, Tuple, TypedDict, Union

from ._types import Error, Field, Flag

VERSION = "{version}"
'''
# What an error is in Python besides a massspring.Error.
BUILTIN_ERRORS = {"ARGUMENT": "ValueError", "ID": "IndexError", "MEMORY": "MemoryError", "UNSTABLE": "ArithmeticError",
                  "SNAPSHOT": "ValueError", "DUPLICATE": "ValueError", "LIMIT": "ValueError"}
NUMBERS = {"float": "float", "double": "float", "size_t": "int"}
READ_ONLY = 1 << 8  # flags from here on can only be read


def camel(name):
    return "".join(part.capitalize() for part in name.split("_"))


def python_name(name):
    return camel(re.sub(r"^mspring_", "", name))


def in_python(text):
    """A comment of the headers with the names that Python has."""
    text = re.sub(r"\bmspring_network_get_(\w+)\(\)", r"\1", text)  # properties
    text = re.sub(r"\bmspring_(?:network|builder)_(\w+)\(\)", r"\1()", text)
    text = re.sub(r"\bmspring_(\w+)", lambda match: match.group(0) if "(" in match.group(0) else match.group(1), text)
    text = re.sub(r"\bMSPRING_(?!SIMD \()", "", text)  # which is a variable of the environment
    return text.replace("\\", "\\\\").replace('"""', "'''")


def docstring(text, indent="    "):
    return textwrap.fill(f'"""{in_python(text)}"""', 118, initial_indent=indent, subsequent_indent=indent,
                         break_on_hyphens=False, break_long_words=False) + "\n"


def member_names(enum, members):
    """The enumerators without the prefix: that of the enum's name, or what all of them begin with."""
    prefix = re.sub("_flags$", "", enum or "").upper() + "_"
    if not all(member.startswith(prefix) for member in members):
        words = [member.split("_") for member in members]
        count = 0
        while all(len(word) > count + 1 for word in words) and len({word[count] for word in words}) == 1:
            count += 1
        prefix = "_".join(words[0][:count]) + "_"
    return [member[len(prefix):] for member in members]


def columns_class(keywords):
    return re.sub("Keywords$", "Columns", keywords)


def literal(words):
    return f"Literal[{', '.join(map(repr, words))}]"


class Writer:
    def __init__(self, header):
        self.header, self.structs = header, header.structs
        self.inputs = [name for name in header.kinds if self.is_taken(name) and not self.has_functions(name)]
        self.reports = [name for name in header.kinds if
                        re.search(rf"mspring_network_\w+\([^;]*?(?<!const ){name} \*", header.text)]

    def is_taken(self, name):
        """Whether functions take the struct, by itself or in another."""
        return re.search(rf"const {name} \*|^    {name} \w+;", self.header.text, flags=re.M)

    def has_functions(self, name):
        return any(kind == "function" for kind, _ in self.structs[name][1].values())

    def is_hidden(self, field, kind):
        """What Python does not set: reserved fields, functions, and pointers to those or to anything."""
        pointed = re.sub(r"^const | \*$", "", kind)
        return field == "struct_size" or field.startswith("reserved") or kind == "function" or kind.endswith("_fn") or \
            pointed == "void" or ("*" in kind and pointed in self.structs and pointed not in self.inputs)

    def fields(self, struct):
        """name: (type, comment) of what is shown."""
        return {field: (kind, self.about(struct, field)) for field, (kind, _) in self.structs[struct][1].items()
                if not self.is_hidden(field, kind)}

    def about(self, struct, field):
        """The comment of a field, of the struct that it refers to if need be."""
        about = self.structs[struct][1][field][1]
        other = re.match(r"as flags of (\w+)", about)
        if other:
            return self.structs[other.group(1)][1]["flags"][1]
        for other in ("mspring_settings", "mspring_mesh_def", "mspring_spring_def"):
            fields = self.structs[other][1] if other != struct else {}
            if field in fields and (not about or re.search(r"\bas in\b|^from here|^this and", about)):
                return self.about(other, field) if not re.match(r"this and", fields[field][1]) else about
        _, of_property = self.header.enums["mspring_property"][1].get(f"MSPRING_{field.upper()}", (0, ""))
        if of_property and about.startswith("default"):  # what has a property of this name is explained there
            return re.sub(r"\W*\[allocates\]", "", of_property) + ". " + about[0].upper() + about[1:]
        return about

    def flags_of(self, field, about):
        """The enum of a field of flags, which the comment names, or one of its members; or None."""
        named = set(re.findall(r"\bmspring_\w+_flags\b|\bMSPRING_\w+", about)) if field.endswith("flags") else ()
        return next((enum for enum, (_, members) in self.header.enums.items()
                     if enum.endswith("_flags") and not {enum, *members}.isdisjoint(named)), None)

    def flags(self, struct):
        """name: (field, bit, comment) of the flags that may be given: their names are keyword arguments, too."""
        found = {}
        for field, (_, about) in self.fields(struct).items():
            enum = self.flags_of(field, about)
            members = self.header.enums[enum][1] if enum else {}
            own = "" if field == "flags" or enum == "mspring_" + field else field[:-len("flags")]  # as of a disc's centre
            for name, (bit, of_member) in zip(member_names(enum, members), members.values()):
                if bit < READ_ONLY and name != "SELF":  # which every method has
                    found[own + name.lower()] = (field, bit, of_member)
        return found

    def words(self, field):
        """Names of special values: substeps="auto" is MSPRING_SUBSTEPS_AUTO."""
        begin = f"MSPRING_{field.upper()}_"
        return {macro[len(begin):].lower(): value for macro, value in self.header.macros.items() if
                macro.startswith(begin)}

    def annotation(self, field, kind, about):
        """The type of a report's attribute."""
        if field.startswith("is_"):
            return "bool"
        enum = self.flags_of(field, about)
        if enum or kind in self.header.enums or kind in self.structs:
            return python_name(enum or kind)
        if kind.endswith("[]"):
            return f"Tuple[{self.annotation(field, kind[:-2], about)}, ...]"
        number = "Optional[int]" if kind == "mspring_id" else NUMBERS.get(kind, "int")
        words = self.words(field) if number == "int" else ()
        return f"Union[{number}, {literal(words)}]" if words else number

    def argument(self, field, kind):
        """The type of a keyword argument. None is the default."""
        if kind in self.header.enums:
            return f"Union[{python_name(kind)}, {python_name(kind)}Name, None]"
        if "*" in kind:
            return "Any"
        words = self.words(field)
        number = NUMBERS.get(kind, "int")
        return f"Union[{number}, {literal(words)}, None]" if words else f"Optional[{number}]"

    # ---------------------------------------------------------------------------------------------- the module

    def constants(self):
        for name, value in sorted(self.header.constants.items()):
            if not name.startswith("MSPRING_VERSION"):
                yield f"{name[len('MSPRING_'):]} = {value!r}\n"

    def enums(self):
        yield "\nENUMS: Dict[str, Any] = {}\n"
        for name, (about, values) in self.header.enums.items():
            is_flags = name.endswith("_flags")
            names = member_names(name, list(values))
            yield f"\n\nclass {python_name(name)}({'IntFlag' if is_flags else 'IntEnum'}):\n{docstring(about)}\n"
            for member, (value, _) in zip(names, values.values()):
                yield f"    {member} = {value}\n"
            yield f"\n\nENUMS[{name!r}] = {python_name(name)}\n"
            if not is_flags:
                words = ", ".join(repr(member.lower()) for member in names)
                yield f"# A member as text.\n{python_name(name)}Name = Literal[{words}]\n"
        yield f"\nPROPERTY_DEFAULTS: Dict[int, float] = {self.property_defaults()!r}\n"

    def property_defaults(self):
        """Values that properties have if none was given, and that no definition names."""
        found = {}
        for value, about in self.header.enums["mspring_property"][1].values():
            said = re.search(r"(-?\d+), the default|default (\d+|all)\b", about)
            if said:
                found[value] = int((said.group(1) or said.group(2)).replace("all", str(0xFFFFFFFF)))
            elif about.startswith("the same") and value - 1 in found:
                found[value] = found[value - 1]
        return found

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
        yield f"\n\nSTRUCTS: Dict[str, int] = {self.header.kinds!r}\nREPORTS: Dict[str, Any] = {{}}\n"
        for name in self.reports:
            yield f"\n\nclass {python_name(name)}(NamedTuple):\n{docstring(self.structs[name][0])}\n"
            kinds = {}
            for field, (kind, about) in self.fields(name).items():
                if "*" not in kind:
                    yield f"    {field}: {self.annotation(field, kind, about)}  # {in_python(about)}\n"
                    kinds[field] = self.flags_of(field, about) or kind
            yield f"\n\nREPORTS[{name!r}] = {python_name(name)}, {kinds!r}\n"

    def keyword_types(self, name):
        """The keyword arguments that fill a struct, those of structs in it included, and their types."""
        types = {}
        for field, (kind, _) in self.fields(name).items():
            if kind in self.structs:
                types.update(self.keyword_types(kind))
            elif not keyword.iskeyword(field):
                types[field] = self.argument(field, kind)
        for field in [field[:-2] for field in types if field.endswith("_x") and field[:-2] + "_y" in types]:
            types.setdefault(field, "Tuple[float, float]")
        types.update((flag, "bool") for flag in self.flags(name))
        return types

    def keyword_class(self, name):
        return re.sub("Def$", "", python_name(name)) + "Keywords"

    def keywords(self):
        words = {field: self.words(field) for name in self.inputs for field in self.structs[name][1]}
        words = {field: known for field, known in words.items() if known}
        yield f"\n\nWORDS: Dict[str, Dict[str, Any]] = {words!r}\nKEYWORDS: Dict[str, Dict[str, Field]] = {{}}\n"
        yield "FLAGS: Dict[str, Dict[str, Flag]] = {}\n"
        for name in self.inputs:
            yield f"\n\nclass {self.keyword_class(name)}(TypedDict, total=False):\n"
            yield f'    """Keyword arguments that fill a {name}."""\n\n'
            types = self.keyword_types(name)
            yield "".join(f"    {field}: {kind}\n" for field, kind in types.items()) or "    pass\n"
            yield f"\n\n{columns_class(self.keyword_class(name))} = Dict[str, Any]  # the same, each an array\n"
            inside = "".join(f"    {field!r}: Field({kind!r}, {shape_of(kind, about)}, {in_python(about)!r}),\n"
                             for field, (kind, about) in self.fields(name).items())
            yield f"\n\nKEYWORDS[{name!r}] = {{\n{inside}}}\n"
            inside = "".join(f"    {flag!r}: Flag({field!r}, {bit}, {in_python(about)!r}),\n"
                             for flag, (field, bit, about) in self.flags(name).items())
            yield f"FLAGS[{name!r}] = {{\n{inside}}}\n" if inside else f"FLAGS[{name!r}] = {{}}\n"

    def public(self):
        """What the package shows."""
        text = "".join([*self.constants(), *self.enums(), *self.errors(), *self.records()])
        names = [name for name in re.findall(r"^(?:class )?([A-Za-z]\w*)(?: =|\()", text, flags=re.M)]
        lines = textwrap.fill(", ".join(f'"{name}"' for name in names), 118, initial_indent="    ",
                              subsequent_indent="    ")
        yield f"\n\n__all__ = [\n{lines}\n]\n"

    def module(self):
        parts = [BEGIN.format(version=self.header.version)]
        for part in (self.constants, self.enums, self.errors, self.records, self.keywords, self.public):
            parts.extend(part())
        return "".join(parts)


def shape_of(kind, about):
    """The shape of an array that a comment gives, such as [plane_count][4]; () if there is none."""
    found = re.search(r"\[(\w+(?: - \d+)?)\](?:\[(\w+)\])?", about) if "*" in kind else None
    return tuple(filter(None, found.groups())) if found else ()


class Stub(ast.NodeTransformer):
    """A module for type checkers: signatures alone. Keyword arguments that are Unpack[...Keywords], which not all type
    checkers know, are there one by one; those of Unpack[...Columns] are arrays."""

    def __init__(self, writer):
        self.types = {writer.keyword_class(name): writer.keyword_types(name) for name in writer.inputs}
        columns = {columns_class(name): dict.fromkeys(types, "Any") for name, types in self.types.items()}
        self.types.update(columns)

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
        of_header = ast.parse("from typing import Literal, Optional, Tuple, Union\nfrom ._header import *").body
        last = max(index for index, node in enumerate(tree.body) if isinstance(node, (ast.Import, ast.ImportFrom)))
        tree.body[last + 1:last + 1] = of_header
        return ast.unparse(ast.fix_missing_locations(tree)) + "\n"


def write_stubs(writer, package):
    """Stubs of the modules that need them. Python 3.8 cannot write them."""
    for module in sorted(Path(package).glob("*.py")) if hasattr(ast, "unparse") else ():
        if "Unpack[" in module.read_text(encoding="utf-8"):
            module.with_suffix(".pyi").write_text(Stub(writer).text_of(module), encoding="utf-8")


def write_gpu_bindings(ffi, header, gpu, out):
    """What cffi needs of a library that takes networks of this one."""
    import cffi

    text = without_preprocessor_branches(Path(gpu).read_text(encoding="utf-8"))
    gpu_ffi = cffi.FFI()
    gpu_ffi.include(ffi)
    gpu_ffi.set_source("massspring._gpu_bindings", None)
    gpu_ffi.cdef(header.declarations(text))
    gpu_ffi.emit_python_code(str(Path(out) / "_gpu_bindings.py"))


def main(include, out, gpu=None):
    import cffi

    header = Header(include)
    ffi = cffi.FFI()
    ffi.set_source("massspring._bindings", None)
    ffi.cdef(header.declarations())
    ffi.emit_python_code(str(Path(out) / "_bindings.py"))
    if gpu:
        write_gpu_bindings(ffi, header, gpu, out)
    writer = Writer(header)
    (Path(out) / "_header.py").write_text(writer.module(), encoding="utf-8")
    write_stubs(writer, out)


if __name__ == "__main__":
    main(*sys.argv[1:])
