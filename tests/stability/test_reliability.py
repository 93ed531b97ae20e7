# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything around a run that can fail: a message, the right exit code, the last good state kept, and on from there."""
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli" / "gdesp-run"))
import run_case  # takes the two programs from the command line

FINE = ["--set", "time.output_interval=0.002"]


class Reliability(run_case.RunCase):
    def scene(self, *words, name="a.case"):
        subprocess.run([run_case.make_case, name, *words], cwd=self.folder, check=True)
        return name

    def whole(self, *options):
        self.run_well("a.case", "-o", "whole.run", "-q", *options)

    def last_record(self, out):
        return json.loads(out.splitlines()[-1])

    def test_disk_that_fills_up_in_mid_run(self):
        self.scene("dam", "dp=0.005")
        room = self.folder / "room"
        room.mkdir()
        mounted = os.geteuid() == 0 and subprocess.run(["mount", "-t", "tmpfs", "-o", "size=800k", "none", room], capture_output=True).returncode == 0
        if not mounted:
            self.skipTest("no small disk can be mounted here")
        self.addCleanup(subprocess.run, ["umount", "-l", room])
        run = str(room / "a.run")
        code, out, err = self.run_tool("a.case", "-o", run, "-q", "--checkpoint-every", "0.02", *FINE)
        self.assertEqual(code, 5, err)
        self.assertIn("No space left", err)
        self.assertIn(run, err)
        self.assertEqual(self.last_record(out)["record"], "failed")
        self.assertEqual([p for p in room.rglob("*.part-*")], [], "nothing half-written stays")
        subprocess.run(["mount", "-o", "remount,size=100m", room], check=True)
        self.run_well("a.case", "-o", run, "-q", "--resume", *FINE)
        self.whole(*FINE)
        self.assert_same_run("whole.run", run)

    def test_thread_count_leaves_no_trace_on_water_grains_gate_and_box(self):
        self.scene("mixed", "end=0.15")
        for threads in ("1", "2", "3"):
            self.run_well("a.case", "-o", f"{threads}.run", "-q", "--threads", threads)
        log = self.log("1.run")
        self.assertGreater(log[-1]["largest_grain_speed"], 0.01)
        self.assertGreater(log[-1]["largest_body_speed"], 0.001)
        self.assertTrue([name for name in self.frames("1.run") if name.startswith("bodies_")])
        for threads in ("2", "3"):
            self.assert_same_run("1.run", f"{threads}.run")

    def test_names_in_a_scene_are_no_paths(self):
        """What a scene calls its bodies and slides never becomes a place to write to."""
        self.scene("mixed", "end=0.02")
        self.run_well("a.case", "-o", "plain/a.run", "-q")
        scene = self.folder / "a.case/case.toml"
        text = scene.read_text()
        for name in ("gate", "box", "slide", "stability atlas"):
            self.assertIn(f'"{name}"', text)
            text = text.replace(f'"{name}"', f'"../../../{name}"')
        scene.write_text(text)
        before = sorted(p.name for p in self.folder.iterdir())
        code, _, err = self.run_tool("a.case", "-o", "other/a.run", "-q")
        self.assertIn(code, (0, 3), err)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), sorted([*before, *(["other"] if code == 0 else [])]))
        if code == 0:
            files = lambda run: sorted(str(p.relative_to(self.folder / run)) for p in (self.folder / run).rglob("*"))
            self.assertEqual(files("plain"), files("other"))

    def test_folder_that_vanishes(self):
        self.scene("dam", "dp=0.005")
        process = self.start("a.case", "-o", "a.run", "-q", "--set", "time.output_interval=0.01")
        process.stdout.readline()
        shutil.move(self.folder / "a.run", self.folder / "elsewhere")
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 5, err)
        self.assertIn("a.run", err)

    def test_folder_that_may_not_be_written(self):
        self.scene("dam")
        (self.folder / "locked").mkdir(mode=0o555)
        self.folder.chmod(0o755)
        drop = (lambda: os.setuid(65534)) if os.geteuid() == 0 else None
        try:
            code, out, err = self.run_tool("a.case", "-o", "locked/a.run", "-q", preexec_fn=drop)
        except PermissionError:
            self.skipTest("the program cannot be reached by another user")
        self.assertEqual(code, 5, err)
        self.assertIn("locked/a.run", err)
        self.assertIn("ermission denied", err)

    def test_stopped_while_it_writes(self):
        """Frames every few steps: most moments are inside a write."""
        self.scene("dam", "dp=0.005")
        options = ["--set", "time.output_interval=0.001"]
        stopped = 0
        for after in (0.05, 0.08, 0.11, 0.14, 0.17):
            process = self.start("a.case", "-o", "a.run", "-q", "--resume", *options)
            time.sleep(after)
            process.send_signal(signal.SIGTERM)
            _, err = process.communicate(timeout=60)
            self.assertIn(process.returncode, (0, 130, -signal.SIGTERM), err)
            stopped += process.returncode == 130
            self.assertEqual(list((self.folder / "a.run").rglob("*.part-*")), [])
        self.run_well("a.case", "-o", "a.run", "-q", "--resume", *options)
        self.assertGreater(stopped, 0)
        self.whole(*options)
        self.assert_same_run("whole.run", "a.run")

    def test_too_large_for_the_memory(self):
        if run_case.has_address_sanitizer():
            self.skipTest("the address sanitizer bears no limit on memory")
        self.scene("settle", "dp=0.004")
        code, out, _ = self.run_tool("a.case", "--explain")
        self.assertEqual(code, 0)

        def limit(kind, megabytes):
            return lambda: resource.setrlimit(kind, (megabytes << 20, megabytes << 20))
        code, out, err = self.run_tool("a.case", "-o", "a.run", "-q", "--t-end", "0.002", preexec_fn=limit(resource.RLIMIT_AS, 100))
        self.assertEqual(code, 5, err)
        self.assertRegex(err, r"needs about [\d.]+ MiB of memory, cpu has [\d.]+ .iB free; resolution.dp = [\d.]+ m would fit")
        self.assertFalse((self.folder / "a.run").exists())
        # A limit that no estimate knows: allocation fails, with a word and the right code.
        code, out, err = self.run_tool("a.case", "-o", "a.run", "-q", "--threads", "1", "--t-end", "0.002", preexec_fn=limit(resource.RLIMIT_DATA, 40))
        self.assertEqual(code, 5, err)
        self.assertIn("out of memory", err)

    def test_a_damaged_checkpoint_gives_way_to_the_one_before(self):
        self.scene("dam", "dp=0.005")
        process = self.start("a.case", "-o", "a.run", "-q", "--checkpoint-every", "0.02")
        states = self.folder / "a.run/checkpoints"
        for _ in range(2000):
            if process.poll() is not None or (states.exists() and len(list(states.glob("*.state"))) == 2):
                break
            time.sleep(0.002)
        process.kill()
        process.communicate()
        found = sorted(states.glob("*.state")) if states.exists() else []
        if len(found) < 2:
            self.skipTest("the run was over before its second checkpoint")
        content = bytearray(found[-1].read_bytes())
        content[len(content) // 3] ^= 4
        found[-1].write_bytes(content)
        _, err = self.run_well("a.case", "-o", "a.run", "-q", "--resume")
        self.assertIn("damaged", err)
        self.assertIn("the checkpoint before it is taken", err)
        self.whole()
        self.assert_same_run("whole.run", "a.run")


if __name__ == "__main__":
    run_case.main()
