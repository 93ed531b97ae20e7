#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
import unittest

from tree import TreeTest


class CheckIncludes(TreeTest):
    script = "check_includes"

    def setUp(self):
        super().setUp()
        self.write("lib/core/vec3.hpp", "#pragma once\n#include <cmath>\n")
        self.write("lib/scene/scene.hpp", '#include "core/vec3.hpp"\n')
        self.write("lib/exec/cuda/launch.cuh", "#include <cub/cub.cuh>\n")
        self.write("lib/sph/tait.hpp", '// @eq sph.eos.tait\nGDESP_HD float p();\n#include "core/vec3.hpp"\n')
        self.write("lib/sph/momentum.cpp", '#include "sph/tait.hpp"\n')
        self.write("lib/dem/contact.hpp", '#include "core/vec3.hpp"\n')
        self.write("lib/coupling/drag.cpp", '#include "sph/tait.hpp"\n#include "dem/contact.hpp"\n')
        self.write("tools/gdesp-run/main.cpp", '#include "coupling/x.hpp"\n#include "options.hpp"\n')

    def test_clean_tree(self):
        self.assert_clean()

    def test_empty_tree_is_no_success(self):
        for path in self.root.rglob("*.*"):
            path.unlink()
        self.assertEqual(self.run_check()[0], 2)

    def test_physics_including_input(self):
        self.write("lib/sph/momentum.cpp", '\n#include "scene/scene.hpp"\n')
        self.assert_finds("lib/sph/momentum.cpp:2: sph may not include scene")

    def test_dem_and_sph_meet_only_in_coupling(self):
        self.write("lib/dem/contact.hpp", '#include "sph/tait.hpp"\n')
        self.assert_finds("dem may not include sph")

    def test_include_in_a_comment_is_none(self):
        self.write("lib/dem/contact.hpp", '// #include "sph/tait.hpp"\n/*\n#include "sph/tait.hpp"\n*/\n')
        self.assert_clean()

    def test_relative_path_hides_nothing(self):
        self.write("lib/dem/contact.hpp", '#include "../sph/tait.hpp"\n')
        self.assert_finds("dem may not include sph")

    def test_law_header_reaches_core_only(self):
        self.write("lib/exec/array.hpp", "")
        self.write("lib/sph/tait.hpp", '// @eq sph.eos.tait\nGDESP_HD float p();\n#include "exec/array.hpp"\n')
        self.assert_finds("a law header")

    def test_a_sum_over_particles_is_no_law_header(self):
        self.write("lib/exec/array.hpp", "")
        self.write("lib/sph/tait.hpp", '// @eq sph.eos.tait\n#include "exec/array.hpp"\n')
        self.assert_clean()

    def test_law_header_through_a_neighbour(self):
        self.write("lib/exec/array.hpp", "")
        self.write("lib/sph/kinds.hpp", '#include "core/vec3.hpp"\n')
        self.write("lib/sph/tait.hpp", '// @eq sph.eos.tait\nGDESP_HD float p();\n#include "sph/kinds.hpp"\n')
        self.assert_clean()
        self.write("lib/sph/kinds.hpp", '#include "exec/array.hpp"\n')
        self.assert_finds("a law header")

    def test_device_and_threads_stay_in_exec(self):
        self.write("lib/sph/momentum.cpp", "#include <cuda_runtime.h>\n")
        self.assert_finds("<cuda_runtime.h> belongs in lib/exec")
        self.write("lib/sph/momentum.cpp", "#pragma omp simd\n#pragma omp parallel for\n")
        self.assert_finds("momentum.cpp:2: OpenMP threads")

    def test_solver_needs_no_third_party(self):
        self.write("lib/sph/momentum.cpp", "#include <boost/array.hpp>\n")
        self.assert_finds("no third party")

    def test_heavy_header_leaves_its_module(self):
        self.write("lib/geometry/surface.hpp", "#include <CGAL/Surface_mesh.h>\n")
        self.write("lib/geometry/surface.cpp", '#include "geometry/surface.hpp"\n')
        self.assert_clean()
        self.write("tools/mesh2particles/main.cpp", '#include "geometry/surface.hpp"\n')
        self.assert_finds("<CGAL/Surface_mesh.h> in a header that tools/mesh2particles/main.cpp includes")

    def test_tools_keep_apart(self):
        self.write("tools/surge-analyze/main.cpp", '#include "sph/tait.hpp"\n')
        self.assert_finds("surge-analyze may not include sph")
        self.write("tools/surge-analyze/main.cpp", '#include "../gdesp-run/options.hpp"\n')
        self.assert_finds("a tool includes lib and itself")

    def test_unknown_module(self):
        self.write("lib/utilities/all.hpp", "")
        self.assert_finds("lib/utilities: a module")

    def test_the_rules_have_no_cycle(self):
        rules, done = dict(self.check.MAY_INCLUDE), set()
        while rules:
            free = [module for module, below in rules.items() if below <= done]
            self.assertTrue(free, f"a cycle among {sorted(rules)}")
            done.update(free)
            for module in free:
                del rules[module]


if __name__ == "__main__":
    unittest.main()
