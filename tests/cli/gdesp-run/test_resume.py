# SPDX-License-Identifier: GPL-3.0-or-later
"""Interrupted in any way, a run goes on and ends as if it had not been."""
import json
import random
import signal
import time

import run_case


class Resume(run_case.RunCase):
    def begin(self, *kinds, dp):
        """A case, its unbroken run, and how long that took."""
        self.name = self.case(*kinds, dp=dp)
        start = time.monotonic()
        self.run_well(self.name, "-o", "whole.run", "-q", "--threads", "1")
        return time.monotonic() - start

    def strike(self, number, after, *arguments):
        """Starts or goes on with broken.run and sends it a signal after some seconds; its exit code and records."""
        process = self.start(self.name, "-o", "broken.run", "-q", "--threads", "1", *arguments)
        time.sleep(after)
        process.send_signal(number)
        out, err = process.communicate(timeout=100)
        return process.returncode, [json.loads(line) for line in out.splitlines() if line.endswith("}")], err

    def first_checkpoint(self):
        """Interrupts a fresh run while it runs, whatever the machine's speed; its records."""
        for after in (0.15, 0.3, 0.6, 0.05, 1.2, 0.02):
            code, records, err = self.strike(signal.SIGTERM, after, "--force")
            if code == 130 and records and records[-1]["record"] == "interrupted" and records[-1]["steps"] > 1:
                return records
        self.skipTest("the run was never met while it ran")

    def test_sigterm_then_resume(self):
        self.begin("grains", "gate", "3d", dp="0.02")
        records = self.first_checkpoint()
        self.assertGreater(records[-1]["steps"], 0)
        self.assertTrue(records[-1]["checkpoint"].endswith(".state"))
        self.assertEqual(json.loads((self.folder / "broken.run/run.json").read_text())["status"], "interrupted")
        again, err = self.run_well("-o", "broken.run", "--resume")
        self.assertIn("goes on at", err)
        self.assertEqual([r["t"] for r in again if r["record"] == "frame"][0], 0, "earlier frames are told too")
        self.assertEqual(again[-1]["record"], "done")
        self.assert_same_run("whole.run", "broken.run")

    def test_killed_again_and_again(self):
        seconds = self.begin("grains", "gate", "3d", dp="0.02")
        chance = random.Random(7)
        for _ in range(6):
            code, _, err = self.strike(signal.SIGKILL, chance.uniform(0.1, 0.6) * seconds, "--resume", "--checkpoint-every", "0.05")
            self.assertIn(code, (0, -signal.SIGKILL), err)
        self.run_well(self.name, "-o", "broken.run", "--resume", "-q")
        self.assert_same_run("whole.run", "broken.run")
        left = [p for p in (self.folder / "broken.run").rglob("*.part-*")]
        self.assertEqual(left, [])

    def test_damaged_checkpoints_are_known(self):
        self.begin(dp="0.005")
        self.first_checkpoint()
        states = lambda: sorted((self.folder / "broken.run/checkpoints").iterdir())
        for _ in range(20):  # until there are two
            if len(states()) > 1:
                break
            self.strike(signal.SIGTERM, 0.06, "--resume", "--checkpoint-every", "0.005")
        if len(states()) < 2:
            self.skipTest("the run ended before its second checkpoint")
        newest = states()[-1]
        content = bytearray(newest.read_bytes())
        for damaged in (content[:len(content) // 2], content[:-1], b"", content[:3000] + bytes([content[3000] ^ 1]) + content[3001:]):
            newest.write_bytes(damaged)
            _, err = self.run_well(self.name, "-o", "broken.run", "--resume", "-q")
            self.assertIn("the checkpoint before it is taken", err)
            self.assert_same_run("whole.run", "broken.run")

    def test_back_at_the_start_its_frame_stays(self):
        """A checkpoint may hold the start itself, gone back to with a higher sound speed; its frame was put out before that."""
        told = ["--set", "numerics.sound_speed=2"]
        self.name = self.case(dp="0.01")
        _, err = self.run_well(self.name, "-o", "whole.run", *told)
        self.assertIn("going back to t = 0 s", err)
        states = lambda: sorted((self.folder / "broken.run/checkpoints").glob("*.state"))
        start = self.folder / "broken.run/checkpoints/step_000000000000.state"
        for _ in range(30):  # until it is killed with that checkpoint there
            process = self.start(self.name, "-o", "broken.run", "-q", "--threads", "1", "--force", "--checkpoint-every", "1e-6", *told)
            while process.poll() is None and not start.exists():
                time.sleep(0.0002)
            process.kill()
            process.communicate(timeout=100)
            if start.exists():
                break
        else:
            self.skipTest("the checkpoint of the start was never met")
        for newer in states()[1:]:
            newer.unlink()
        self.run_well("-o", "broken.run", "--resume", "-q")
        self.assert_same_run("whole.run", "broken.run")

    def test_another_case_is_refused(self):
        self.begin(dp="0.01")
        self.first_checkpoint()
        for change in (["--set", "numerics.cfl=0.3"], ["--preset", "paper"]):
            code, out, err = self.run_tool(self.name, "-o", "broken.run", "--resume", *change)
            self.assertEqual((code, out), (3, ""))
            self.assertIn("other parameters", err)

    def test_what_the_first_run_was_told_is_taken_over(self):
        self.name = self.case(dp="0.005")
        told = ["--t-end", "0.3", "--set", "numerics.cfl=0.3", "--set", "time.output_interval=0.1", "--log-every", "7"]
        self.run_well(self.name, "-o", "whole.run", "-q", *told)
        for after in (0.2, 0.4, 0.1, 0.05):
            if self.strike(signal.SIGINT, after, "--force", *told)[0] == 130:
                break
        else:
            self.skipTest("the run was never met while it ran")
        self.run_well("-o", "broken.run", "--resume", "-q")
        self.assert_same_run("whole.run", "broken.run")

    def test_resume_before_the_first_checkpoint_starts_anew(self):
        self.begin(dp="0.01")
        _, err = self.run_well(self.name, "-o", "broken.run", "--resume")
        self.assertIn("no checkpoint yet", err)
        self.assert_same_run("whole.run", "broken.run")


if __name__ == "__main__":
    run_case.main()
