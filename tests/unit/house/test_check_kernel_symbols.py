#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(sys.argv.pop(1)).resolve()))
from check_kernel_symbols import strong_symbols  # noqa: E402

LISTING = """
lib.a:kernel.cpp.o:0000000000000000 T gdesp::twice(gdesp::Input const&)
lib.a:kernel.cpp.o:0000000000000010 W gdesp::System<gdesp::exec::OpenMP>::step(double)
lib.a:kernel.cu.o:0000000000000000 T gdesp::twice(gdesp::Input const&)
lib.a:plain.cpp.o:0000000000000000 T gdesp::once()
"""


class CheckKernelSymbols(unittest.TestCase):
    def test_strong_symbols_of_kernel_sources_only(self):
        found, seen = strong_symbols(LISTING, {"kernel.cpp.o", "absent.cpp.o"})
        self.assertEqual(found, [("kernel.cpp.o", "gdesp::twice(gdesp::Input const&)")])
        self.assertEqual(seen, {"kernel.cpp.o"})


if __name__ == "__main__":
    unittest.main()
