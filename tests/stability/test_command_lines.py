#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_command_lines.py PROGRAM... [--count N] [--first N]: command lines and standard inputs that nobody would write.

Each program is started with words drawn from its own --help and with values that lie, are empty, huge or no text at all, and is
fed damaged records. Whatever comes: it ends within a minute, with one of its documented exit codes, an error with a message, and
without having written outside the folder it works in. The words are a function of the number of the attempt alone.
"""
import argparse
import collections
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

EXIT_CODES = {0, 2, 3, 4, 5}
COMMANDS = {"surge-analyze": ["runup", "front", "profile", "gauge", "slide", "energy", "surface", "map", "compare", "converge", "tradeoff",
                              "report", "render"]}
VALUES = [b"", b"-", b"--", b"-1", b"0", b"1", b"0.5", b"1e999", b"-1e-400", b"nan", b"inf", b"9" * 40, b"2147483648", b"2147483647", b"100000", b"x", b"\xff\xfe", b"\xc3\xa9",
          b"a=b", b"=", b"=1", b"numerics.cfl=", b"numerics.cfl=x", b"numerics.cfl=[1", b"title='a'", b"resolution.dp=-1", b"1,2", b"1,2,3,4", b",,",
          b"../out", b"/", b"/dev/null", b"/proc/self/mem", b".", b"junk.toml", b"junk.csv", b"junk.case", b"empty", b"cpu", b"cuda:99999999999", b"cuda:-1",
          b"json", b"text", b"accurate", b"%s%n", b"a\nb", b"5%", b"10min", b"-5%", b"1e30h", b"A" * 5000]
RECORDS = [b'{"record":"case","path":"junk.case"}', b'{"record":"case","path":7}', b'{"record":"case"}', b'{"record":"frame","t":0,"run":"junk.case"}',
           b'{"record":"frame","t":"x","fluid":{"path":"junk.csv"}}', b'{"record":"failed","reason":[]}', b'{"record":null}', b'[1,2]', b'7', b'null',
           b'"a"', b'{"record":"done"}', b'{"record":"frame","t":1e400}', b'{' * 3000, b'[' * 3000, b'\x00', b'\xff\xff', b'{"record":"case","path":"../../etc"}',
           b'{"a":"\\ud800"}', b'']


def damaged(chance, text, share):
    """`text` as it is, or, in this share of all cases, with a byte changed, cut or doubled."""
    if chance.random() >= share or not text:
        return text
    at = chance.randrange(len(text))
    return text[:at] + ([bytes([chance.randrange(256)]), b"", text[at:at + 1] * 2][chance.randrange(3)]) + text[at + 1:]


def words_of(program):
    """The options of a program and of its commands, as their --help lists them."""
    name = os.path.basename(program)
    words = {}
    for command in COMMANDS.get(name, [None]):
        text = subprocess.run([program, *([command] if command else []), "--help"], capture_output=True, text=True, timeout=60).stdout
        words[command] = sorted(set(re.findall(r"(?<!\w)--?[a-z][\w-]*", text)))
        if not words[command]:
            sys.exit(f"{name} {command}: --help names no options")
    return words


def attempt(program, words, number):
    """Words and standard input of one attempt."""
    chance = random.Random(f"{os.path.basename(program)} {number}")
    command = chance.choice(list(words))
    line = [command.encode()] if command and chance.random() < 0.95 else []
    for _ in range(chance.randrange(5)):
        if chance.random() < 0.7:
            line.append(damaged(chance, chance.choice(words[command]).encode(), 0.1))
        if chance.random() < 0.8:
            line.append(damaged(chance, chance.choice(VALUES), 0.2))
    records = b"\n".join(damaged(chance, chance.choice(RECORDS), 0.4) for _ in range(chance.randrange(6)))
    return [word.replace(b"\0", b"") for word in line], records


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--count", type=int, default=40, help="attempts for each program (default 40)")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    options = parser.parse_args()
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="gdesp-words-") as outside:
        folder = pathlib.Path(outside) / "a/b"
        folder.mkdir(parents=True)
        (folder / "junk.toml").write_bytes(b"title = 'x'\n[resolution]\ndp = 'thin'\n")
        (folder / "junk.csv").write_bytes(b"t,x\n0,1\n\xff,,\n")
        (folder / "empty").write_bytes(b"")
        (folder / "junk.case").mkdir()
        (folder / "junk.case/case.json").write_bytes(b"{")
        before = sorted(pathlib.Path(outside).iterdir()), sorted((pathlib.Path(outside) / "a").iterdir())
        for program in map(os.path.abspath, options.programs):
            words, codes = words_of(program), collections.Counter()
            for number in range(options.first, options.first + options.count):
                line, records = attempt(program, words, number)
                try:
                    done = subprocess.run([program.encode(), *line], input=records, cwd=folder, capture_output=True, timeout=60)
                except subprocess.TimeoutExpired:
                    done = subprocess.CompletedProcess([], "no end within a minute", b"", b"")
                codes[done.returncode] += 1
                said = b"error: " in done.stderr or b'"level":"error"' in done.stderr or (done.returncode == 3 and done.stdout)  # --check reports there
                silent = done.returncode != 0 and not said
                if done.returncode not in EXIT_CODES or silent or b"unexpected: " in done.stderr:
                    wrong += 1
                    print(f"{os.path.basename(program)}, attempt {number}: {done.returncode}: {line} <<< {records[:300]}\n{done.stderr[-600:]}", file=sys.stderr)
            print(f"{os.path.basename(program)}: {options.count} command lines; exit codes " +
                  ", ".join(f"{code}: {count}" for code, count in sorted(codes.items(), key=str)))
        after = sorted(pathlib.Path(outside).iterdir()), sorted((pathlib.Path(outside) / "a").iterdir())
        if before != after:
            wrong += 1
            print(f"written outside the working folder: {after}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
