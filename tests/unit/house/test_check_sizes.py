#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
import unittest

from tree import TreeTest

CODE = '''
MODULE_INIT(something) namespace gdesp {
struct Grid {
  Grid(int nx, int ny) : nx_(nx), ny_{ny} {}
  bool operator()(const Pair<int, int>& pair) const { return pair.first < nx_; }
 private:
  int nx_, ny_;
};
// void commented(int a) {
template <class Exec>
__global__ void __launch_bounds__(128) sort_pairs(const Exec& exec, std::vector<std::pair<int, int>> pairs,
                                                  int count = max(1, 2)) {
  const char* text = "} { not code";
  if (count > 0) {
    for (int i = 0; i < count; ++i) { auto f = [&](int a, int b) { return a + b; }; f(i, i); }
  }
}
int table[] = {1, 2, 3};
enum class Kind { one, two };
}  // namespace gdesp
'''


class CheckSizes(TreeTest):
    script = "check_sizes"

    def test_functions_found(self):
        self.assertEqual(self.check.functions(CODE), [
            ("Grid", 4, 1, 2), ("operator()", 5, 1, 1), ("sort_pairs", 10, 8, 3)])

    def test_clean(self):
        self.write("lib/core/a.hpp", CODE)
        self.assert_clean("--strict")

    def test_long_file(self):
        self.write("lib/core/a.cpp", "int a;\n" * 501)
        self.assert_clean()
        self.assert_finds("501 lines, wished at most 500", "--strict")
        self.write("lib/core/a.cpp", "int a;\n" * 701)
        self.assert_finds("701 lines, at most 700")

    def test_long_law_header(self):
        self.write("lib/sph/law.hpp", "// @eq sph.law\n" + "int a;\n" * 150)
        self.assert_finds("wished at most 150", "--strict")

    def test_long_function_and_long_list(self):
        self.write("lib/core/a.cpp", "void f(int a, int b, int c, int d, int e, int f, int g) {\n" + "  ++a;\n" * 60 + "}\n")
        status, text = self.run_check()
        self.assertEqual(status, 0)
        self.assertIn("lib/core/a.cpp:1: f() has 62 lines", text)
        self.assertIn("f() has 7 parameters", text)

    def test_macro_function(self):
        self.write("lib/core/a.hpp", "#define MAX_GRAINS (100)\n// #define OLD(a) a\n")
        self.assert_clean("--strict")
        self.write("lib/core/a.hpp", "\n#define MAX(a, b) a\n")
        self.assert_finds("lib/core/a.hpp:2: macro function MAX()")

    def test_macro_function_in_tests(self):
        self.write("tests/unit/a.cpp", "#define EXPECT_SAME(a, b) a\n")
        self.assert_clean("--strict")

    def test_nothing_to_check_is_no_success(self):
        self.assertEqual(self.run_check()[0], 2)


if __name__ == "__main__":
    unittest.main()
