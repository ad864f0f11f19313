"""What docs/python.md shows runs as it stands there, and so does docs/examples/press_curve.py: stiffer bodies push harder.

Usage: example.py PROGRAMS ROOT
"""

import os
import re
import subprocess
import sys
import tempfile
import time

programs, root = sys.argv[1:3]
os.environ["PATH"] = os.path.abspath(programs) + ":" + os.environ["PATH"]
with open(os.path.join(root, "docs/python.md"), encoding="utf-8") as file:
    blocks = re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)
assert len(blocks) >= 4, f"docs/python.md has {len(blocks)} blocks of Python"
scene = os.path.join(root, "config/scenes/ellipsoid_mallet.toml")
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.makedirs("config/scenes")
    os.symlink(os.path.abspath(scene), "config/scenes/ellipsoid_mallet.toml")
    names = {}
    # The page tells of `palpate.run` in its text; the block after it reads what that leaves.
    before = {2: 'palpate.run("config/scenes/ellipsoid_mallet.toml", 1.0, record="run.plr")', 4: "watched = start_a_run()"}

    def start_a_run():
        # A busy machine misses samples, which is the machine's verdict: 21 of 1478 beside a build (2026-11-27).
        run = subprocess.Popen(["palpate", "run", "config/scenes/ellipsoid_mallet.toml", "--device", "loopback",
                                "--duration", "1.5", "--telemetry", "./run.telemetry", "--allow", "stale=100"],
                               stdout=subprocess.DEVNULL)
        while not os.path.exists("run.telemetry"):
            assert run.poll() is None, "palpate run ended before it began"
            time.sleep(0.01)
        return run

    names["start_a_run"] = start_a_run
    for i, block in enumerate(blocks):
        exec(compile(before.get(i, "") + "\n" + block, f"docs/python.md, block {i + 1}", "exec"), names)
    assert names["watched"].wait(60) == 0
    assert len(names["felt_N"]) > 1000, f"{len(names['felt_N'])} ticks of 1.5 s were watched"
    palpate, fallen = names["palpate"], names["fallen"]
    assert fallen.ticks["contact_force_N"].max() > 0.5, "the falling weight met no body"
    assert palpate.Recording("fallen.plr").replay()[0]["identical"]

    curve = [sys.executable, os.path.join(root, "docs/examples/press_curve.py"), "config/scenes/ellipsoid_mallet.toml"]
    said = subprocess.run(curve, capture_output=True, text=True, check=True).stdout
    forces = [float(line.split()[4]) for line in said.splitlines()]
    assert len(forces) == 3 and 0 < forces[0] < forces[1] < forces[2], said
