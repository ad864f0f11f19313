#!/usr/bin/env python3
"""A newcomer: an installed Palpate, a surface of their own in an STL file, and the commands of docs/tutorial.md as they
stand there, in their order; at most ten, to a live run of that body on a device that is no part of Palpate. What is checked
is that they work, that the runs ended without a fault and that force was felt, never time. A machine that stands still
brings faults into real time: what asks for that may be typed five times. Usage: newcomer.py CMAKE BUILD_DIR ROOT"""
import importlib.util
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
cmake, build, root = sys.argv[1], os.path.abspath(sys.argv[2]), os.path.abspath(sys.argv[3])
MOST_COMMANDS = 10
MACHINE_DID = (1, 5)  # a verdict or a fault, which a busy machine can bring about where real time is asked for
TRIES = 5
REAL_TIME = ("palpate device-test", "palpate run organ.pal --device")


def organ_of_their_own(path):
    sys.argv = [sys.argv[0]]
    spec = importlib.util.spec_from_file_location("organ_from_stl", os.path.join(root, "tests/mesh/organ_from_stl.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.write_stl(path, 3000)


def commands():
    """What the blocks of the tutorial say to type, a here-document with its command."""
    page = pathlib.Path(root, "docs/tutorial.md").read_text(encoding="utf-8")
    found = []
    for block in re.findall(r"^```sh\n(.*?)^```$", page, re.MULTILINE | re.DOTALL):
        lines = block.splitlines()
        while lines:
            command = lines.pop(0)
            if mark := re.search(r"<<'(\w+)'", command):
                end = lines.index(mark[1]) + 1
                command, lines = "\n".join([command, *lines[:end]]), lines[end:]
            found.append(command)
    return found


def run(command, folder, environment):
    """In a session of its own, so that a device left behind goes with it."""
    with subprocess.Popen(["bash", "-c", command], cwd=folder, env=environment, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, start_new_session=True) as shell:
        try:
            output = shell.communicate(timeout=120)[0]
        finally:
            try:
                os.killpg(shell.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        return shell.returncode, output


def felt(recording, prefix, work, environment):
    shown = subprocess.run([f"{prefix}/bin/palpate", "latency", "--recording", recording, "--json"], cwd=work,
                           env=environment, capture_output=True, text=True, check=False)
    return json.loads(shown.stdout)["run"]


def type_in(command, name, prefix, work, environment):
    """Types it; in real time again, as long as the machine has made a fault of it. What the device-test says of a busy
    machine's device is a verdict on the machine: it has to be said, not to be good."""
    real_time = any(text in command for text in REAL_TIME)
    for attempt in range(TRIES):
        own = re.sub(r"\bmine\b(?!\.)", f"{name}.{attempt}", command)
        status, output = run(own, work, environment)
        print(f"{status}  {command.splitlines()[0]}", flush=True)
        if status != 0 and not (real_time and status in MACHINE_DID):
            sys.exit(f"{output}\nexit code {status}")
        if status == 0 or "--record mine.plr" not in command:
            return
        told = felt("mine.plr", prefix, work, environment)
        if not told["faults"] and told["ticks"] >= 500:
            return
        print(f"   faults {told['faults']} after {told['ticks']} ticks")
    sys.exit(f"{output}\n{TRIES} times the live run ended with a fault")


def main():
    typed = commands()
    if not 5 <= len(typed) <= MOST_COMMANDS:
        sys.exit(f"the tutorial has {len(typed)} commands, not 5 to {MOST_COMMANDS}")
    with tempfile.TemporaryDirectory(prefix="palpate-newcomer-") as folder:
        prefix, work = os.path.join(folder, "prefix"), os.path.join(folder, "work")
        os.mkdir(work)
        subprocess.run([cmake, "--install", build, "--component", "programs", "--prefix", prefix], check=True,
                       stdout=subprocess.DEVNULL)
        organ_of_their_own(os.path.join(work, "organ.stl"))
        # Two tests at once must not meet on one address.
        name = f"mine{os.getpid()}"
        environment = {**os.environ, "PATH": f"{prefix}/bin:{os.environ['PATH']}"}
        said = subprocess.run([f"{prefix}/bin/palpate"], cwd=work, capture_output=True, text=True, check=True).stdout
        begin = re.findall(r"^  palpate \w+ (\S+\.toml)", said, re.MULTILINE)
        if len(begin) != 3 or not all(os.path.exists(os.path.join(work, scene)) for scene in begin):
            sys.exit(f"what `palpate` alone says to begin with is not there: {said}")
        for command in typed:
            type_in(command, name, prefix, work, environment)
        for file in ("mended.png", "press.png", "press.svg", "forces.csv", "first_touch.plr", "mine.plr"):
            if not os.path.getsize(os.path.join(work, file)):
                sys.exit(f"{file} is empty")
        for recording in ("first_touch.plr", "mine.plr"):
            told = felt(recording, prefix, work, environment)
            print(f"{recording}: {told['ticks']} ticks, {told['contact_force_max_N']:.2f} N, faults {told['faults']}")
            # A ball of 8 mm some millimetres into a body of 20 kPa: Hertz says 0.5 N at 3 mm, 1.8 N at 7 mm.
            if told["faults"] or told["ticks"] < 500 or not 0.05 < told["contact_force_max_N"] < 10:
                sys.exit(f"{recording}: the organ was not felt as such a body feels")
    print(f"newcomer: {len(typed)} commands, no problem")


main()
