# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong input, failing output, pipes: the right exit code, one clear message, nothing left behind."""
import json
import os
import resource
import subprocess

import run_case


class Errors(run_case.RunCase):
    def refused(self, code, *arguments, says, input=None, leaves=()):
        found, out, err = self.run_tool(*arguments, input=input)
        self.assertEqual(found, code, err)
        for text in says:
            self.assertIn(text, err)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), sorted(leaves))
        return out

    def test_command_line(self):
        self.refused(2, says=["no case given"])
        self.refused(2, "c.case", "--treads", "2", says=["unknown option", "did you mean --threads?"])
        self.refused(2, "c.case", "--t-end", "-1", says=["--t-end -1", "above 0"])
        self.refused(2, "c.case", "--threads", "-2", says=["--threads -2"])
        self.refused(2, "c.case", "--log-every", "0", says=["--log-every 0", "1 to 100"])
        self.refused(2, "c.case", "--device", "gpu", says=["device 'gpu'", "cuda:N"])
        self.refused(2, "c.case", "--resume", "--force", says=["contradict"])
        self.refused(2, "c.case", "--set", "cfl", says=["KEY=VALUE"])
        self.refused(2, self.case(), "--threads", "1000000", says=["1000000 threads", "at most 1024"], leaves=["c.case"])

    def test_case(self):
        self.refused(3, "missing.case", says=["missing.case", "no such case folder"])
        (self.folder / "empty.case").mkdir()
        self.refused(3, "empty.case", says=["case.toml"], leaves=["empty.case"])

    def test_overrides(self):
        case = self.case()
        self.refused(3, case, "--set", "resolution.dp=0.1", says=["resolution.dp", "mesh2particles"], leaves=[case])
        self.refused(3, case, "--set", "numerics.clf=0.1", says=["clf", "cfl"], leaves=[case])
        self.refused(3, case, "--set", "numerics.shifting=2", "--set", "numerics.time_scheme=verlet",
                     says=["numerics.time_scheme", "shifting", "split"], leaves=[case])

    def test_existing_output(self):
        case = self.case()
        self.run_well(case, "--t-end", "0.01", "-q")
        code, out, err = self.run_tool(case)
        self.assertEqual((code, out), (2, ""))
        self.assertIn("--force replaces it", err)
        self.run_well(case, "--t-end", "0.02", "-q", "--force")
        (self.folder / "mine").mkdir()
        (self.folder / "mine/letter.txt").write_text("dear")
        self.assertEqual(self.run_tool(case, "-o", "mine", "--force")[0], 2)
        self.assertEqual([p.name for p in (self.folder / "mine").iterdir()], ["letter.txt"])

    def test_numerical_failure(self):
        case = self.case("exploding")
        code, out, err = self.run_tool(case)
        records = [json.loads(line) for line in out.splitlines()]
        self.assertEqual(code, 4)
        self.assertEqual([r["record"] for r in records], ["frame", "failed"])
        for text in ("no finite state", "water particle", "3 tries", "What to change"):
            self.assertIn(text, records[-1]["reason"])
            self.assertIn(text, err)
        self.assertEqual(self.frames("c.run"), ["fluid_00000.vtp"])
        self.assertEqual(json.loads((self.folder / "c.run/run.json").read_text())["status"], "failed")

    def test_the_guard_ends_a_run_that_means_nothing(self):
        code, out, err = self.run_tool(self.case(), "--set", "numerics.time_step=0.01", "-q")
        self.assertEqual(code, 4)
        self.assertIn("Mach", err)
        self.assertIn("numerics.time_step", err)
        self.assertEqual(json.loads(out.splitlines()[-1])["record"], "failed")

    def test_the_guard_warns(self):
        records, err = self.run_well(self.case(), "--set", "numerics.sound_speed=7", "-q")
        self.assertEqual(err.count("Mach"), 1, err)
        self.assertEqual(records[-1]["record"], "done")

    def test_output_that_cannot_be_written(self):
        case = self.case()
        (self.folder / "file").write_text("")
        code, _, err = self.run_tool(case, "-o", "file/x.run", "-q")
        self.assertIn(code, (2, 5))
        self.assertIn("file/x.run", err)
        if os.geteuid() != 0:
            (self.folder / "locked").mkdir(mode=0o555)
            code, _, err = self.run_tool(case, "-o", "locked/x.run", "-q")
            self.assertEqual(code, 5)
            self.assertIn("locked/x.run", err)

    def test_full_disk(self):
        def little_space():
            resource.setrlimit(resource.RLIMIT_FSIZE, (30000, 30000))
        case = self.case(dp="0.005")
        code, out, err = self.run_tool(case, "-o", "d.run", preexec_fn=little_space)
        self.assertEqual(code, 5, err)
        self.assertIn("fluid_00000.vtp", err)
        self.assertEqual(json.loads(out.splitlines()[-1])["record"], "failed")
        self.assertEqual(self.frames("d.run"), [])

    def test_reader_that_leaves(self):
        process = self.start(self.case(), "--set", "time.output_interval=0.01", "--t-end", "3")
        self.assertIn("frame", process.stdout.readline())
        process.stdout.close()
        err = process.stderr.read()
        self.assertEqual(process.wait(timeout=60), 0)
        process.stderr.close()
        self.assertNotIn("error", err)
        self.assertEqual(json.loads((self.folder / "c.run/run.json").read_text())["status"], "interrupted")
        records, _ = self.run_well("-o", "c.run", "--resume", "-q")
        self.run_well("c.case", "-o", "whole.run", "--set", "time.output_interval=0.01", "--t-end", "3", "-q")
        self.assertEqual(records[-1]["t"], 3)
        self.assert_same_run("whole.run", "c.run")

    def test_device_that_is_not_there(self):
        if "device cuda:" in self.run_tool("--version")[1]:
            self.skipTest("there is one")
        case = self.case()
        self.refused(5, case, "--device", "cuda", says=["CUDA"], leaves=[case])

    def test_records_on_standard_input(self):
        case = self.case()
        known = json.dumps({"record": "case", "path": str(self.folder / case)})
        other = '{"record":"note","text":"unharmed \\u00e9","list":[1,2.5,null]}'
        records, _ = self.run_well("-", "--t-end", "0.01", "-q", input=other + "\n\n" + known + "\n")
        self.assertEqual(records[0], json.loads(other))
        self.assertEqual([r["record"] for r in records[1:]][0::len(records) - 2], ["frame", "done"])
        self.assertTrue((self.folder / "c.run/fluid.pvd").exists())

    def test_standard_input_without_a_case(self):
        self.refused(3, "-", says=["without a case record"], input="")
        out = self.refused(3, "-", says=["without a case record"], input='{"record":"failed"}\n')
        self.assertEqual(out.strip(), '{"record":"failed"}')
        self.refused(3, "-", says=["line 2", "expected a record"], input='{"record":"note"}\nnonsense\n')
        self.refused(3, "-", says=['without "path"'], input='{"record":"case"}\n')
        self.refused(3, "-", says=["no such case folder"], input='{"record":"case","path":"nowhere.case"}\n')

    def test_help_and_version(self):
        code, out, _ = self.run_tool("--help")
        self.assertEqual(code, 0)
        for word in ("--checkpoint-every", "--resume", "Examples:"):
            self.assertIn(word, out)
        code, out, _ = self.run_tool("--version")
        self.assertEqual(code, 0)
        self.assertRegex(out, r"back ends: cpu \(OpenMP\)")
        self.assertIn("device", out)


if __name__ == "__main__":
    run_case.main()
