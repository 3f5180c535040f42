#!/usr/bin/env python3
"""Writes the checkpoints with which the fuzzer of checkpoints begins anew, and those that once broke something: after a
change of State or of what recorders carry the old ones would only be refused.

usage: fuzz/checkpoint_seeds.py [BUILD_FOLDER]     (a release build; build/release if left out)
"""

import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "fuzz/corpus/checkpoint"
FIRST_LINE = b"udar checkpoint 1\n"
NO_FRAMES = 48  # bytes that a frame writer carries which has written nothing; the fuzzer has none


def without_frames(whole):
    """The same checkpoint as a run without a folder would write it; the fuzzer sets the checksums right."""
    assert whole.startswith(FIRST_LINE)
    out, rest = FIRST_LINE, whole[len(FIRST_LINE):]
    while rest:
        name_length, checksum, length = struct.unpack("<IIQ", rest[:16])
        name, part = rest[16:16 + name_length], rest[16 + name_length:16 + name_length + length]
        rest = rest[16 + name_length + length:]
        if name == b"recorders":
            part = part[:-NO_FRAMES]
        out += struct.pack("<IIQ", name_length, checksum, len(part)) + name + part
    return out


def without_end(checkpoint):
    """The next step ends at a time of which no integer counts the intervals between two rows."""
    next_step = checkpoint.index(b"state/clock") + len(b"state/clock") + 6 * 8
    return checkpoint[:next_step] + struct.pack("<d", 1.4798596857787188e60) + checkpoint[next_step + 8:]


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release").resolve()
    case = re.search(r'R"\((.*?)\)";', (ROOT / "fuzz/checkpoint.cpp").read_text(), re.DOTALL).group(1)
    for old in OUT.glob("*"):
        old.unlink()
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "a.toml").write_text(case)
        for call in [1200, 1680, 2080, 2560, 3040, 3600]:
            # Killed in that call: two checkpoints are left, of two steps that follow each other.
            environment = dict(os.environ, LD_PRELOAD=str(build / "tests/libfaults.so"), UDAR_FAULT=f"{call}:before")
            subprocess.run([build / "udar", "run", "a.toml", "--no-report", "--output", "r", "--force", "--set", 'run.end_time="60 us"',
                            "--set", 'output.checkpoint="1 us"'], cwd=folder, env=environment, capture_output=True, check=False)
            for name in "ab":
                bytes_of = (pathlib.Path(folder) / f"r/checkpoint_{name}.bin").read_bytes()
                (OUT / f"seed-{call}{name}").write_bytes(without_frames(bytes_of))
    (OUT / "found-time-without-end").write_bytes(without_end((OUT / "seed-2560a").read_bytes()))


if __name__ == "__main__":
    main()
