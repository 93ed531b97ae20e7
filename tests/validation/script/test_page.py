# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/validate reckons from its rows: orders of convergence, budgets, the comparison of the presets, the merge."""
import math
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools
import validation_budgets as budgets
import validation_page as page


def row(case="a", preset="accurate", dp="0.02", metric="m", error="0.1", accepted="yes"):
    return dict.fromkeys(page.COLUMNS, "") | {"case": case, "preset": preset, "dp": dp, "metric": metric, "error": error, "accepted": accepted}


def line(kinetic, potential, elastic=0.0, lost=0, momentum=(0.0, 0.0, 0.0), speed=2.0):
    return {"fluid_kinetic": kinetic, "fluid_potential": potential, "fluid_elastic": elastic, "lost_fluid": lost, "lost_grains": 0,
            "fluid_mass": 3.0, "grain_mass": 1.0, "fluid_momentum": momentum, "grain_momentum": (0.0, 0.0, 0.0), "largest_speed": speed,
            "largest_grain_speed": 0.0}


class Orders(unittest.TestCase):
    def test_second_order_values_and_errors(self):
        spacings = [0.04, 0.02, 0.01]
        values = [1.0 + 3.0 * h ** 2 for h in spacings]
        order, bar = page.observed_order(spacings, values)
        self.assertAlmostEqual(order, 2.0, places=6)
        self.assertAlmostEqual(bar, 1.25 * (values[2] - 1.0), places=9)
        self.assertAlmostEqual(page.order_of_error(spacings, [-3.0 * h ** 1.5 for h in spacings]), 1.5, places=9)

    def test_no_order_without_monotone_convergence_or_with_an_exact_value(self):
        self.assertIsNone(page.observed_order([0.04, 0.02, 0.01], [1.0, 1.2, 1.1]))
        self.assertIsNone(page.order_of_error([0.04, 0.02, 0.01], [0.1, 0.0, 0.1]))


class Crest(unittest.TestCase):
    def test_crest_of_a_noisy_wave(self):
        curve = [(0.01 * k, math.cosh(2.0 * (0.01 * k - 1.203)) ** -2 + 0.02 * (-1) ** k) for k in range(300)]
        time, height = tools.crest(curve)
        self.assertAlmostEqual(time, 1.203, delta=0.003)
        self.assertAlmostEqual(height, 1.0, delta=0.006)
        self.assertGreater(max(z for _, z in curve), 1.015)


class Table(unittest.TestCase):
    def test_new_rows_replace_those_of_the_same_run_and_order_is_stable(self):
        old = [row(dp="0.02", error="1"), row(dp="0.04"), row(case="b"), row(case="gone"), row(case="b/gone")]
        merged = page.merge(old, [row(dp="0.02", error="2"), row(case="a", preset="paper", dp="0.04")], {"a", "b"})
        self.assertEqual([(r["case"], r["dp"], r["preset"], r["error"]) for r in merged],
                         [("a", "0.04", "accurate", "0.1"), ("a", "0.04", "paper", "0.1"), ("a", "0.02", "accurate", "2"), ("b", "0.02", "accurate", "0.1")])
        self.assertEqual(page.merge(merged, [], {"a", "b"}), merged)

    def test_runs_of_other_commits_are_named(self):
        rows = [row(dp=dp) | {"made by": "commit abc, today"} for dp in ("0.04", "0.02")] + [row(case="b") | {"made by": "commit old with changes, then"}]
        self.assertEqual(page.commits_text(rows), "Of 3 runs 2 are of commit abc; of others (dp in metres) old with changes: b accurate 0.02.\n\n")
        self.assertEqual(page.commits_text(rows[:2]), "Of 2 runs 2 are of commit abc.\n\n")

    def test_accurate_is_compared_with_paper_at_half_the_spacing(self):
        rows = [row(dp="0.04", error="-0.2"), row(dp="0.02", error="0.1"), row(preset="paper", dp="0.02", error="0.3"),
                row(preset="paper", dp="0.01", metric="run ends", error="nan", accepted="no")]
        self.assertEqual([(a["dp"], p and p["dp"]) for a, p in page.halved_pairs(rows)], [("0.04", "0.02"), ("0.02", None)])
        self.assertIn("2 of 2 metrics", page.halved_text(rows))
        self.assertIn("1 of 2 metrics", page.halved_text([r | {"error": "0.15"} if r["preset"] == "paper" else r for r in rows]))


class Budgets(unittest.TestCase):
    def test_energy_created_counts_rises_above_the_least_before(self):
        # 4 kg fall: potential 10 -> 4 J frees 6 J; half is lost, then 1 J comes from nowhere. g dp = 0.25 m2/s2.
        lines = [line(0.0, 10.0), line(3.0, 4.0), line(4.0, 4.0), line(2.0, 5.0)]
        self.assertAlmostEqual(budgets.energy_created(lines, 0.25), 1.0 / (6.0 + 4.0 * 0.25))
        self.assertEqual(budgets.energy_created([line(0.0, 10.0), line(6.0, 4.0), line(1.0, 4.0)], 0.25), 0.0)

    def test_particles_that_leave_take_their_energy(self):
        self.assertEqual(budgets.energy_created([line(0.0, -5.0), line(0.0, -1.0, lost=1), line(0.0, -1.0, lost=1)], 0.25), 0.0)

    def test_momentum_over_mass_and_speed(self):
        self.assertAlmostEqual(budgets.momentum_gained([line(0, 0, momentum=(1, 0, 0)), line(0, 0, momentum=(1, 0, 0.4))]), 0.05)

    def test_which_scenes_have_budgets(self):
        free = {"gravity": [0.0, 0.0, 0.0]}
        self.assertTrue(budgets.is_closed(free) and not budgets.is_worked_on(free))
        self.assertFalse(budgets.is_closed(free | {"wall": [{}]}))
        self.assertTrue(budgets.is_worked_on(free | {"piston": [{}]}))
        self.assertTrue(budgets.is_worked_on({"gravity": [1.0, 0.0, 0.0], "domain": {"periodic": ["x"]}}))


if __name__ == "__main__":
    unittest.main()
