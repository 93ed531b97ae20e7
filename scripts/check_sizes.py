#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes that keep the sources readable: warnings past the wished limit, a failure past the hard one.

usage: check_sizes.py [--strict] [repository root]

  file               500 lines wished, 700 at most; a law header (with `@eq tag`) 150 wished
  function           60 lines wished, and 9 of 10 at most 30
  parameters         6 wished (else a struct)
  macro functions    none outside tests (hard)
  __CUDACC__         in at most 3 files
  headers of a module  10 wished
--strict makes every warning a failure. Functions are found by their braces, not by a compiler: good to a line or two.
Exit status: 0, 1 when a hard limit is passed, 2 when there is nothing to check.
"""
import pathlib
import re
import sys

FILE_WISH, FILE_HARD, LAW_WISH, FUNCTION_WISH, MOST_FUNCTIONS = 500, 700, 150, 60, 30
PARAMETER_WISH, CUDACC_FILES, HEADERS_WISH = 6, 3, 10
SOURCES = {".hpp", ".cpp", ".cuh", ".cu", ".h"}
FOLDERS = ("lib", "tools", "tests", "bench")
NOT_FUNCTIONS = {"if", "for", "while", "switch", "catch", "return", "sizeof", "alignas", "decltype", "else", "do"}
LITERAL = re.compile(r'R"([^(\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])\'', re.S)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)\(", re.M)


def bare(text):
    """Code alone: strings, comments and preprocessor lines blanked, line breaks kept."""
    blank = lambda match: "\n" * match.group().count("\n")
    both = re.compile(f"(?:{LITERAL.pattern})|{COMMENT.pattern}", re.S)
    text = both.sub(lambda match: '""' + blank(match) if match.group()[0] in "\"'R" else blank(match), text)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", blank, text, flags=re.M)


def split_parameters(text):
    """Number of parameters of a parameter list: commas outside (), <>, {}, []."""
    depth, count = 0, 1
    for character in text.replace("->", "").replace(">=", "").replace("<=", ""):
        depth += (character in "(<{[") - (character in ")>}]")
        count += character == "," and depth == 0
    return count if text.strip() not in ("", "void") else 0


def function_head(head):
    """(name, parameters) when the text before a brace heads a function, else None."""
    head = re.sub(r"\[\[[^\]]*\]\]|__launch_bounds__\([^()]*\)", "", head).strip()
    head = re.sub(r"^(?:[A-Z][A-Z0-9_]+\([^()]*\)\s*)+(?=\w)", "", head)
    if re.match(r"(namespace|class|struct|union|enum|extern)\b", re.sub(r"^template\s*<[^{}]*?>\s*(?=\w)", "", head)):
        return None
    match = re.match(r"(?s)(?:.*?[\s*&>:~])??(operator\s*\(\)|operator\s*[^\s\w(]+|~?\w+)\s*\(", head)
    if not match or match.group(1) in NOT_FUNCTIONS or "=" in head[:match.start(1)].replace("operator=", ""):
        return None
    depth, start = 0, match.end() - 1
    for position in range(start, len(head)):
        depth += (head[position] == "(") - (head[position] == ")")
        if depth == 0:
            return match.group(1), split_parameters(head[start + 1:position])
    return None


def functions(text):
    """[(name, first line, lines, parameters)] of the outermost function bodies."""
    code, found, stack, inside, start = bare(text), [], [], None, 0
    for position, character in enumerate(code):
        if character == "{":
            head = code[start:position]
            if inside is None and (function := function_head(head)):
                first = code.count("\n", 0, start + len(head) - len(head.lstrip())) + 1
                inside = (len(stack), function, first)
            stack.append(position)
        elif character == "}" and stack:
            stack.pop()
            if inside and len(stack) == inside[0]:
                last = code.count("\n", 0, position) + 1
                found.append((inside[1][0], inside[2], last - inside[2] + 1, inside[1][1]))
                inside = None
        if character in "{};" or (character == ":" and re.search(r"(public|private|protected)\s*$", code[start:position])):
            start = position + 1
    return found


class Sizes:
    def __init__(self, root):
        self.root, self.warnings, self.failures, self.files = root, [], [], 0
        self.lengths, self.cudacc = [], []

    def check_file(self, path):
        name, text = path.relative_to(self.root).as_posix(), path.read_text(encoding="utf-8", errors="replace")
        lines = text.count("\n")
        is_law = name.startswith("lib/") and path.suffix == ".hpp" and "@eq " in text
        wish = LAW_WISH if is_law else FILE_WISH
        if lines > FILE_HARD:
            self.failures.append(f"{name}: {lines} lines, at most {FILE_HARD}")
        elif lines > wish:
            self.warnings.append(f"{name}: {lines} lines, wished at most {wish}")
        for function, first, length, parameters in functions(text):
            self.lengths.append(length)
            if length > FUNCTION_WISH:
                self.warnings.append(f"{name}:{first}: {function}() has {length} lines, wished at most {FUNCTION_WISH}")
            if parameters > PARAMETER_WISH:
                self.warnings.append(f"{name}:{first}: {function}() has {parameters} parameters, wished at most {PARAMETER_WISH}")
        code = COMMENT.sub(lambda match: "\n" * match.group().count("\n"), text)
        if not name.startswith("tests/"):
            self.failures += [f"{name}:{code.count(chr(10), 0, match.start()) + 1}: macro function {match.group(1)}()"
                              for match in MACRO.finditer(code)]
            if "__CUDACC__" in code:
                self.cudacc.append(name)

    def run(self):
        for folder in FOLDERS:
            for path in sorted((self.root / folder).rglob("*")):
                if path.suffix in SOURCES:
                    self.files += 1
                    self.check_file(path)
        if len(self.cudacc) > CUDACC_FILES:
            self.warnings.append(f"__CUDACC__ in {len(self.cudacc)} files, wished at most {CUDACC_FILES}: {' '.join(self.cudacc)}")
        for module in sorted((self.root / "lib").glob("*/")):
            headers = len(list(module.glob("*.hpp")))
            if headers > HEADERS_WISH:
                self.warnings.append(f"lib/{module.name}: {headers} headers, wished at most {HEADERS_WISH}")
        short = sum(length <= MOST_FUNCTIONS for length in self.lengths)
        if self.lengths and short < 0.9 * len(self.lengths):
            self.warnings.append(f"{100 * short // len(self.lengths)} % of the functions have at most {MOST_FUNCTIONS} lines, wished 90 %")


def main(arguments):
    strict = "--strict" in arguments
    places = [argument for argument in arguments if argument != "--strict"]
    sizes = Sizes(pathlib.Path(places[0] if places else pathlib.Path(__file__).parent.parent).resolve())
    sizes.run()
    if not sizes.files:
        print(f"check_sizes.py: no source file under {sizes.root}", file=sys.stderr)
        return 2
    for warning in sizes.warnings:
        print(f"warning: {warning}")
    for failure in sizes.failures:
        print(f"error: {failure}")
    print(f"{sizes.files} files, {len(sizes.lengths)} functions, {len(sizes.warnings)} warnings, {len(sizes.failures)} errors")
    return 1 if sizes.failures or (strict and sizes.warnings) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
