# SPDX-License-Identifier: GPL-3.0-or-later
"""The guard of gdesp-run: it recovers, it stops with a word, and it leaves a sound run alone."""
import json
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli" / "gdesp-run"))
import run_case  # takes the two programs from the command line

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import vtp


class Guard(run_case.RunCase):
    def scene(self, *settings, name="a.case"):
        run_case.subprocess.run([run_case.make_case, name, *settings], cwd=self.folder, check=True)
        return name

    def events(self, run):
        return [line for line in self.log(run) if "event" in line]

    def assert_finite(self, run):
        """No file of the run holds a number that is none."""
        files = list((self.folder / run).rglob("*.vtp"))
        self.assertTrue(files)
        for path in files:
            for name, values in vtp.read_arrays(path).items():
                self.assertTrue(vtp.all_finite(values), f"{path}: {name}")
        for path in (self.folder / run).rglob("*json"):
            self.assertNotRegex(path.read_text(), r"\b(nan|inf|NaN|Infinity)\b", path)

    def test_a_step_too_long_is_halved_until_it_holds(self):
        case = self.scene("dam")
        records, err = self.run_well(case, "-o", "a.run", "-q", "--set", "numerics.time_step=2e-3", "--threads", "1")
        self.assertEqual(records[-1]["record"], "done")
        events = self.events("a.run")
        self.assertGreater(len(events), 0, "this step is too long by far")
        self.assertLess(events[-1]["step_factor"], 1.0)
        self.assertIn("going back to t = ", err)
        self.assertRegex(err, r"water particle \d+ at \(")
        self.assertEqual(json.loads((self.folder / "a.run/run.json").read_text())["recoveries"], events)
        steps = [line["step"] for line in self.log("a.run")]
        self.assertEqual(steps, sorted(steps), "what was abandoned is not in the log")
        self.assert_finite("a.run")
        self.run_well(case, "-o", "b.run", "-q", "--set", "numerics.time_step=2e-3", "--threads", "2")
        self.assert_same_run("a.run", "b.run")

    def test_water_that_outruns_its_sound_gets_more_of_it(self):
        records, err = self.run_well(self.scene("dam", "speed=8"), "-o", "a.run", "-q", "--set", "numerics.sound_speed=6")
        events = self.events("a.run")
        self.assertGreater(events[0]["sound_speed"], 6.0)
        self.assertIn("Mach", events[0]["cause"])
        self.assertLess(self.log("a.run")[-1]["mach"], 1.0)
        self.assert_finite("a.run")

    def test_what_cannot_be_mended_ends_with_a_word(self):
        case = self.scene("dam", "speed=3000")
        code, out, err = self.run_tool(case, "-o", "a.run", "-q", "--set", "numerics.sound_speed=20")
        self.assertEqual(code, 4, err)
        message = json.loads(out.splitlines()[-1])["reason"]
        for text in ("step ", "t = ", "Mach", "water particle", " at (", "What to change", "numerics.sound_speed", "a.run/failure"):
            self.assertIn(text, message)
        report = json.loads((self.folder / "a.run/failure/failure.json").read_text())
        self.assertEqual(report["message"], message)
        self.assertTrue(os.path.getsize(report["offending"]["fluid"]["path"]) > 0)
        self.assert_finite("a.run")

    def test_the_last_good_state_is_kept(self):
        case = self.scene("dam")
        code, out, err = self.run_tool(case, "-o", "a.run", "-q", "--set", "numerics.time_step=0.05")
        self.assertEqual(code, 4, err)
        self.assertIn("3 tries", err)
        report = json.loads((self.folder / "a.run/failure/failure.json").read_text())
        self.assertTrue(os.path.getsize(report["good"]["fluid"]["path"]) > 0)
        self.assertTrue(os.path.getsize(report["good"]["checkpoint"]) > 0)
        self.assertEqual([event["try"] for event in self.events("a.run")], [1, 2, 3])
        self.assert_finite("a.run")

    def test_grains_too_soft_for_their_load(self):
        case = self.scene("heap", "drop=1")
        code, out, err = self.run_tool(case, "-o", "a.run", "-q", "--set", "contact.law=linear", "--set", "contact.stiffness=1e5")
        self.assertEqual(code, 4, err)
        for text in ("overlap", "contact.stiffness", "grain "):
            self.assertIn(text, err)
        self.assert_finite("a.run")

    def test_a_sound_run_is_left_alone(self):
        self.run_well(self.scene("wet"), "-o", "a.run", "-q")
        self.assertEqual(self.events("a.run"), [])
        self.assertFalse((self.folder / "a.run/failure").exists())


if __name__ == "__main__":
    run_case.main()
