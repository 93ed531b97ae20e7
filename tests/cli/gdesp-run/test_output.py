# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames, records, log, what the run says about itself."""
import json
import os

import run_case


class Output(run_case.RunCase):
    def test_a_dam_break_from_start_to_end(self):
        records, err = self.run_well(self.case(), "-o", "d.run", "--threads", "1")
        frames, done = records[:-1], records[-1]
        self.assertEqual([r["record"] for r in frames], ["frame"] * 5)
        self.assertEqual([round(r["t"], 12) for r in frames], [0, 0.05, 0.1, 0.15, 0.2])
        for r in frames:
            self.assertTrue(os.path.isabs(r["path"]) and os.path.getsize(r["path"]) > 0)
            self.assertEqual(r["path"], r["fluid"])
            self.assertNotIn("grains", r)
            self.assertEqual(r["case"], str(self.folder / "c.case"))
        self.assertEqual(done["record"], "done")
        self.assertEqual((done["particles"], done["t"], done["lost"], done["device"]), (200, 0.2, 0, "cpu"))
        self.assertAlmostEqual(done["score"], 200 * 0.2 / done["wall_seconds"], delta=0.2 * done["score"])
        self.assertIn("sound speed", err)
        self.assertEqual(self.frames("d.run"), [f"fluid_0000{k}.vtp" for k in range(5)])
        self.assertEqual((self.folder / "d.run/case.link").read_text().strip(), str(self.folder / "c.case"))

    def test_log_and_run_json(self):
        self.run_well(self.case(), "-o", "d.run", "--set", "numerics.artificial_viscosity=0.1", "-q")
        log = self.log("d.run")
        steps = [line["step"] for line in log]
        self.assertEqual(steps, sorted(set(steps)))
        self.assertIn(100, steps)
        self.assertEqual(log[0]["t"], 0)
        self.assertEqual({line["fluid_particles"] for line in log}, {200})
        self.assertEqual(len({line["fluid_mass"] for line in log}), 1)
        total = [line["fluid_kinetic"] + line["fluid_potential"] + line["fluid_elastic"] for line in log]
        self.assertLess(total[-1], total[0] * 1.001)
        self.assertGreater(log[-1]["fluid_kinetic"], 0.2 * log[0]["fluid_potential"])
        self.assertTrue(all(0 <= line["mach"] < 0.2 for line in log))
        about = json.loads((self.folder / "d.run/run.json").read_text())
        self.assertEqual((about["status"], about["steps"], about["device"]), ("done", steps[-1], "cpu"))
        self.assertEqual(about["overrides"], ["numerics.artificial_viscosity=0.1"])
        self.assertEqual(about["scene"]["fluid_particles"], 200)
        self.assertFalse(about["scene"]["models"]["grains"]["on"])

    def test_grains_and_gate(self):
        records, _ = self.run_well(self.case("grains", "gate", "3d", dp="0.02"), "-o", "d.run", "-q")
        self.assertTrue(all({"fluid", "grains", "bodies"} <= r.keys() for r in records if r["record"] == "frame"))
        self.assertEqual(records[-1]["particles"], 2080 + 250)
        log = self.log("d.run")
        self.assertGreater(log[-1]["grain_mass"], 0.6)
        self.assertGreater(log[-1]["grain_substeps"], log[-1]["step"])

    def test_thread_count_leaves_no_trace(self):
        case = self.case("grains", "gate", "3d", dp="0.02")
        self.run_well(case, "-o", "one.run", "--threads", "1", "-q")
        for threads in ("2", "3"):
            self.run_well(case, "-o", f"{threads}.run", "--threads", threads, "-q")
            self.assert_same_run("one.run", f"{threads}.run")

    def test_threads_are_what_the_environment_says_unless_told(self):
        threads = lambda run: json.loads((self.folder / run / "run.json").read_text())["threads"]
        case = self.case()
        for told, environment, expected in (([], {"OMP_NUM_THREADS": "3"}, 3), (["--threads", "2"], {"OMP_NUM_THREADS": "3"}, 2),
                                            ([], {}, len(os.sched_getaffinity(0)))):
            bare = {name: value for name, value in run_case.environment.items() if not name.startswith("OMP_")}
            self.run_well(case, "-o", "a.run", "--force", "--t-end", "0.001", "-q", *told, env={**bare, **environment})
            self.assertEqual(threads("a.run"), expected, (told, environment))

    def test_end_and_interval_from_the_command_line(self):
        records, _ = self.run_well(self.case(), "--t-end", "0.03", "--set", "time.output_interval=0.02", "-q")
        self.assertEqual([r["t"] for r in records], [0, 0.02, 0.03, 0.03])
        self.assertEqual(records[-1]["run"], str(self.folder / "c.run"))

    def test_lines_of_the_log(self):
        log = lambda: [r for r in map(json.loads, (self.folder / "c.run/log.ndjson").read_text().splitlines()) if "step" in r]
        case = self.case()
        self.run_well(case, "--t-end", "0.03", "-q")
        seldom = log()
        self.run_well(case, "--t-end", "0.03", "--log-every", "5", "--force", "-q")
        often = log()
        self.assertEqual([r for r in often if r in seldom], seldom)
        steps = [r["step"] for r in often]
        self.assertLessEqual(max(b - a for a, b in zip(steps, steps[1:])), 5)

    def test_preset(self):
        self.run_well(self.case(), "--preset", "paper", "--t-end", "0.01", "-q")
        scene = json.loads((self.folder / "c.run/run.json").read_text())["scene"]
        self.assertEqual((scene["preset"], scene["time_scheme"]), ("paper", "verlet"))
        self.assertAlmostEqual(scene["h"], 0.013)

    def test_explain_writes_nothing(self):
        case = self.case("grains", "3d", dp="0.02")
        code, out, _ = self.run_tool(case, "--explain")
        self.assertEqual(code, 0)
        for word in ("250 particles", "2 080 grains", "sound speed", "expected", "memory", "coupling          on"):
            self.assertIn(word, out)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), [case])

    def test_memory_is_estimated_before(self):
        for kinds in (["3d"], ["3d", "grains"]):
            self.run_well(self.case(*kinds, dp="0.005"), "-q", "--t-end", "0.002", "--force")
            about = json.loads((self.folder / "c.run/run.json").read_text())
            estimate, taken = about["scene"]["memory_estimate"] - 2e7, about["memory"]
            self.assertGreater(estimate, taken)
            self.assertLess(estimate, 3 * taken)

    def test_profile(self):
        _, err = self.run_well(self.case(), "--profile", "--t-end", "0.02")
        self.assertRegex(err, r"sph::momentum +\d")
        self.assertIn("sph::momentum", json.loads((self.folder / "c.run/run.json").read_text())["profile"])


if __name__ == "__main__":
    run_case.main()
