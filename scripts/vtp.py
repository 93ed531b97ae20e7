# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the VTP files that gdesp-run writes (inline binary, not compressed), with nothing but Python."""
import array
import base64
import math
import re

TYPES = {"Float32": "f", "Float64": "d", "Int32": "i", "UInt32": "I", "Int64": "q", "UInt8": "B"}
ARRAY = re.compile(rb"<DataArray([^>]*?)>\s*([A-Za-z0-9+/=\s]*)</DataArray>")
ATTRIBUTE = re.compile(rb'(\w+)="([^"]*)"')


def read_arrays(path):
    """name -> array of numbers, components side by side; the points are "Points"."""
    arrays = {}
    with open(path, "rb") as file:
        content = file.read()
    for match in ARRAY.finditer(content):
        about = {key.decode(): value.decode() for key, value in ATTRIBUTE.findall(match.group(1))}
        if about.get("format") != "binary" or about.get("type") not in TYPES:
            continue
        values = array.array(TYPES[about["type"]])
        values.frombytes(base64.b64decode(b"".join(match.group(2).split()))[8:])  # a UInt64 byte count comes first
        arrays[about.get("Name", "Points")] = values
    return arrays


def all_finite(values):
    return values.typecode not in "fd" or all(map(math.isfinite, values))


def vectors(values):
    """Triples of an array of three components."""
    return list(zip(values[0::3], values[1::3], values[2::3]))
