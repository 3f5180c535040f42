#!/usr/bin/env python3
"""Stops the program in every way that there is, lets it go on, and compares every file with those of a run that was
never stopped.

    reliability.py PROGRAM SOURCE FAULTS [--quick | --write docs/reliability.md] [--only NAME]

FAULTS is the library that lets calls to the system fail or kills in them (faults.cpp). --quick tries a sample.
"""

import argparse
import errno
import filecmp
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

OF_THE_CLOCK = ["started", "threads", "resumed", "wall_seconds", "stepping_seconds", "element_steps_per_second"]
CHECKPOINTS = ["checkpoint_a.bin", "checkpoint_b.bin"]

# Twenty steps with a checkpoint after each: every call to the system comes many times, and a trial takes hundredths of
# a second.
FEW_STEPS = """
[run]
end_time = "12 us"
gravity = ["0 m/s^2", "-9.81 m/s^2"]
[materials.steel]
law = "tresca"
density = "7850 kg/m^3"
young_modulus = "196 GPa"
poisson_ratio = 0.25
yield_stress = "235 MPa"
[bodies.block]
material = "steel"
velocity = ["5 m/s", "-80 m/s"]
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], at = ["-2 cm", "2.001 cm"], element_size = "0.5 cm" }
[bodies.anvil]
material = "steel"
mesh = { shape = "rectangle", size = ["8 cm", "2 cm"], at = ["-4 cm", "0 cm"], element_size = "0.5 cm" }
[contact]
friction = 0.3
[obstacles.floor]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
friction = 0.35
[output]
fields_every = "3 us"
histories_every = "1 us"
checkpoint = "1 us"
"""

# Some seconds, with a checkpoint every few hundredths: to be killed at any moment.
SOME_SECONDS = ["--set", 'bodies.beam.mesh.element_size="5 mm"', "--set", 'output.checkpoint="20 ms"',
                "--set", 'output.fields_every="50 us"']


# AddressSanitizer wants to be loaded first; that ours is does no harm.
PRELOAD = {"ASAN_OPTIONS": "verify_asan_link_order=0"}


class Failure(Exception):
    """What is not as it has to be."""


def need(condition, text):
    if not condition:
        raise Failure(text)


def differences(whole, part):
    """Files of a folder that are not, byte for byte, those of the other one."""
    found = []
    for path in sorted(p for p in whole.rglob("*") if p.is_file()):
        other = part / path.relative_to(whole)
        if path.name == "log.txt":
            continue
        if not other.is_file():
            found.append(f"{other.relative_to(part)} is missing")
        elif path.name == "summary.json":
            a, b = (json.loads(p.read_text()) for p in (path, other))
            for name in OF_THE_CLOCK:
                a.pop(name), b.pop(name)
            if a != b:
                found.append("summary.json differs")
        elif not filecmp.cmp(path, other, shallow=False):
            found.append(f"{other.relative_to(part)} differs")
    known = {p.relative_to(whole) for p in whole.rglob("*")}
    found += [f"{p.relative_to(part)} is left over" for p in part.rglob("*") if p.relative_to(part) not in known]
    return found


class Trials:
    """A folder to try in, and the counts."""

    def __init__(self, program, source, faults, folder, quick):
        self.program, self.source, self.faults = program, source, faults
        self.folder, self.quick = folder, quick
        self.random = random.Random(2025)
        self.counts = {}

    def count(self, name, by=1):
        self.counts[name] = self.counts.get(name, 0) + by

    def start(self, words, fault=None, **more):
        environment = dict(os.environ, **more)
        if fault:
            environment.update(PRELOAD, LD_PRELOAD=str(self.faults), UDAR_FAULT=fault)
        return subprocess.Popen([self.program, *map(str, words)], cwd=self.folder, env=environment,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def call(self, words, codes=(0,), fault=None, **more):
        process = self.start(words, fault, **more)
        out = process.communicate(timeout=120)[0]
        need(process.returncode in codes,
             f"`udar {' '.join(map(str, words))}` with {fault} ended with {process.returncode}: {out[-600:]}")
        need("internal error" not in out, out)
        return process.returncode, out

    def run_words(self, case, part, more=()):
        return ["run", case, "--no-report", "--force", "--output", part, *more]

    def complete(self, case, part, whole, more=()):
        """Goes on with what is there, or from the start where there is no checkpoint, and compares all files."""
        threads = self.random.choice([1, 2, 3])
        words = ["resume", part, "--no-report", "--threads", threads]
        resumed = (self.folder / part).exists() and self.call(words, (0, 2, 8))[0] == 0
        if not resumed:
            self.call(self.run_words(case, part, more))
        found = differences(whole, self.folder / part)
        need(not found, f"after {'resuming' if resumed else 'running anew'}: {found[:5]}")
        return resumed

    # --- the trials

    def kills_at_any_moment(self):
        """kill -9 at random moments, again and again until a run has come to its end."""
        case = self.source / "cases/short-beam/short-beam.toml"
        whole = self.folder / "whole"
        self.call(self.run_words(case, whole, SOME_SECONDS))
        wanted = 10 if self.quick else 200
        while self.counts.get("kills at random moments", 0) < wanted:
            self.one_story_of_kills(case, whole)

    def one_story_of_kills(self, case, whole):
        part = self.folder / "part"
        shutil.rmtree(part, ignore_errors=True)
        words = self.run_words(case, part, SOME_SECONDS)
        for _ in range(self.random.randint(3, 8)):
            process = self.start(words)
            files = [part / name for name in CHECKPOINTS]
            before = [f.stat().st_mtime_ns if f.exists() else 0 for f in files]
            # Not before it has come on: else a slow machine would never reach the end.
            while process.poll() is None and [f.stat().st_mtime_ns if f.exists() else 0 for f in files] == before:
                time.sleep(0.002)
            time.sleep(self.random.uniform(0, 0.15))
            process.kill()
            process.communicate()
            if process.returncode == -signal.SIGKILL:
                self.count("kills at random moments")
            if not any(f.exists() for f in files):
                break
            words = ["resume", part, "--no-report", "--threads", self.random.choice([1, 2, 3])]
        if (part / "summary.json").exists() and not any((part / name).exists() for name in CHECKPOINTS):
            found = differences(whole, part)
            need(not found, found)
        else:
            self.complete(case, part, whole, SOME_SECONDS)
        self.count("runs that came to their end after it")

    def prepare_few_steps(self):
        (self.folder / "few.toml").write_text(FEW_STEPS)
        whole = self.folder / "few"
        counter = self.folder / "calls"
        self.call(self.run_words("few.toml", whole), UDAR_FAULT_COUNT=str(counter), LD_PRELOAD=str(self.faults), **PRELOAD)
        return whole, int(counter.read_text())

    def numbers(self, calls, sample):
        """Every call, or a sample of them."""
        if not self.quick:
            return range(1, calls + 1)
        return sorted(self.random.sample(range(1, calls + 1), min(sample, calls)))

    def kills_in_every_call(self):
        """kill -9 in front of, in the middle of and behind every call that changes a file."""
        whole, calls = self.prepare_few_steps()
        part = self.folder / "part"
        for k in self.numbers(calls, 15):
            for action in ["before", "after"]:
                shutil.rmtree(part, ignore_errors=True)
                code, _ = self.call(self.run_words("few.toml", part), (0, -signal.SIGKILL), fault=f"{k}:{action}")
                if code == 0:
                    continue  # the other thread made fewer calls this time
                self.count("kills in calls to the system")
                if self.complete("few.toml", part, whole):
                    self.count("of these with a checkpoint to go on from")

    def failures_of_every_call(self):
        """Every call that changes a file fails: full disk, broken disk."""
        whole, calls = self.prepare_few_steps()
        part = self.folder / "part"
        for k in self.numbers(calls, 30):
            error = [errno.ENOSPC, errno.EIO][k % 2]
            shutil.rmtree(part, ignore_errors=True)
            code, out = self.call(self.run_words("few.toml", part), (0, 6), fault=f"{k}:{error}")
            self.count("calls that failed")
            if code == 0:
                # Only what was no loss: removing what was not there.
                need(not differences(whole, part), f"call {k} failed, the run did not stop, and files differ")
                self.count("of these without any loss: all files the same")
                continue
            need("error: cannot " in out and os.strerror(error) in out, f"call {k}: the message is `{out[-400:]}`")
            self.count("of these told, with exit code 6")
            self.complete("few.toml", part, whole)

    def damage(self):
        """Checkpoints that were cut off or have a wrong bit are refused, and the older one is used."""
        whole, _ = self.prepare_few_steps()
        stopped = self.folder / "stopped"
        shutil.rmtree(stopped, ignore_errors=True)
        counter = int((self.folder / "calls").read_text())
        self.call(self.run_words("few.toml", stopped), (-signal.SIGKILL,), fault=f"{counter * 3 // 4}:before")
        part = self.folder / "part"
        sizes = [(stopped / name).stat().st_size for name in CHECKPOINTS]
        for trial in range(10 if self.quick else 200):
            shutil.rmtree(part, ignore_errors=True)
            shutil.copytree(stopped, part)
            both = trial % 10 == 9
            for number in [0, 1] if both else [trial % 2]:
                self.spoil(part / CHECKPOINTS[number], sizes[number], trial % 4 < 2)
            words = ["resume", part, "--no-report"]
            _, out = self.call(words, (8,) if both else (0,))
            need("cannot be used" in out, f"nothing is said of the damage: {out}")
            self.count("checkpoints cut off or with a wrong bit")
            if both:
                continue
            found = differences(whole, part)
            need(not found, found)
            self.count("of these with the other one whole: gone on with that")

    def spoil(self, path, size, cut):
        if cut:
            os.truncate(path, self.random.randrange(size))
            return
        with open(path, "r+b") as file:
            at = self.random.randrange(size)
            file.seek(at)
            byte = file.read(1)[0]
            file.seek(at)
            file.write(bytes([byte ^ 1 << self.random.randrange(8)]))

    def signals(self):
        """Ctrl-C, SIGTERM and SIGHUP at random moments: the step is finished, everything saved; a closed pipe is none."""
        case = self.source / "cases/short-beam/short-beam.toml"
        whole = self.folder / "whole-signals"
        more = ["--set", 'bodies.beam.mesh.element_size="5 mm"', "--set", 'output.fields_every="50 us"']
        self.call(self.run_words(case, whole, more))
        part = self.folder / "part"
        slowest = 0
        for trial in range(5 if self.quick else 60):
            shutil.rmtree(part, ignore_errors=True)
            sent = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP][trial % 3]
            process = self.start(self.run_words(case, part, more))
            first = process.stdout.readline()  # it is under way
            time.sleep(self.random.uniform(0, 0.15))
            begin = time.monotonic()
            process.send_signal(sent)
            process.communicate()
            if process.returncode == 0:
                continue  # it was faster
            slowest = max(slowest, time.monotonic() - begin)
            need(process.returncode == 128 + sent, f"{sent!r} after `{first}`: exit code {process.returncode}")
            need((part / "summary.json").exists(), "no summary after a signal")
            need(self.complete(case, part, whole, more), "a run that was interrupted has a checkpoint")
            self.count("signals (SIGINT, SIGTERM, SIGHUP)")
        self.counts["slowest of them, from signal to end, ms"] = round(1000 * slowest)
        self.closed_pipe(case, whole, more)

    def closed_pipe(self, case, whole, more):
        part = self.folder / "part"
        shutil.rmtree(part, ignore_errors=True)
        process = self.start(self.run_words(case, part, more))
        process.stdout.readline()
        process.stdout.close()  # as `head -1` does
        need(process.wait(timeout=120) == 0, f"a closed pipe ended the run with {process.returncode}")
        need(not differences(whole, part), "a closed pipe changed the results")
        self.count("closed pipes (SIGPIPE)")

    def another_thread_count(self):
        """Runs that were interrupted at a random moment go on on another number of threads."""
        case = self.source / "cases/short-beam/short-beam.toml"
        whole = self.folder / "whole"
        if not whole.exists():
            self.call(self.run_words(case, whole, SOME_SECONDS))
        part = self.folder / "part"
        for threads in [1, 2, 4, 7] if self.quick else [1, 2, 3, 4, 7, 8, 16]:
            shutil.rmtree(part, ignore_errors=True)
            process = self.start(self.run_words(case, part, [*SOME_SECONDS, "--threads", 17 - threads]))
            timer = threading.Timer(self.random.uniform(0.1, 0.25), lambda p=process: p.send_signal(signal.SIGINT))
            timer.start()
            process.communicate()
            timer.cancel()
            if process.returncode == 0:
                continue
            if process.returncode == -signal.SIGINT:
                continue  # it had hardly begun
            self.call(["resume", part, "--no-report", "--threads", threads])
            found = differences(whole, part)
            need(not found, found)
            self.count("runs gone on with on another number of threads")

    def planted_faults(self):
        """What is not a number, and elements turned inside out, planted at random places of State in random steps."""
        tests = self.program.parent / "tests/test_simulation"
        words = [str(tests), "--source-file=*/planted_faults_test.cpp", "--success=false"]
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, check=False)
        line = re.search(r"planted faults (\d+) found (\d+) named (\d+) restored (\d+)", done.stdout)
        need(done.returncode == 0 and line, f"planted_faults_test: {done.stdout[-600:]}{done.stderr[-600:]}")
        for name, number in zip(["planted", "found in the same step", "of these with body, element, place and cause named",
                                 "of these with the last good state brought back"], line.groups()):
            self.count(name, int(number))

    trials = {"kills": kills_at_any_moment, "calls": kills_in_every_call, "failures": failures_of_every_call,
              "damage": damage, "signals": signals, "threads": another_thread_count,
              "faults": planted_faults}


def table(counts):
    rows = "".join(f"| {name} | {number} |\n" for name, number in counts.items())
    return "| tried | times |\n|---|---|\n" + rows


def write(path, text):
    """Puts the tables into a page, between its two marks."""
    begin, end = "<!-- made by scripts/reliability -->\n", "<!-- end -->\n"
    page = path.read_text()
    first, last = page.index(begin) + len(begin), page.index(end)
    path.write_text(page[:first] + text + page[last:])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("source", type=Path)
    parser.add_argument("faults", type=Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", choices=Trials.trials)
    parser.add_argument("--write", type=Path)
    arguments = parser.parse_args()
    text = ""
    # In memory, where there is such a folder: thousands of runs that wait for a disk dozens of times each take hours.
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="udar-reliability-", dir=memory) as folder:
        for name, trial in Trials.trials.items():
            if arguments.only not in (None, name):
                continue
            trials = Trials(arguments.program.resolve(), arguments.source.resolve(), arguments.faults.resolve(),
                            Path(folder), arguments.quick)
            begin = time.monotonic()
            try:
                trial(trials)
            except Failure as failure:
                print(f"{name}: FAILED: {failure}", flush=True)
                return 1
            print(f"{name} ({time.monotonic() - begin:.0f} s): {trials.counts}", flush=True)
            text += f"\n**{trial.__doc__.strip()}**\n\n{table(trials.counts)}"
    if arguments.write:
        write(arguments.write, text + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
