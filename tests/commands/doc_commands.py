#!/usr/bin/env python3
"""What README.md and docs/*.md say to type works: every line of their fenced blocks that is a command is run, in a temporary
copy of what it names, but for the exceptions below; and every `palpate COMMAND --option` in blocks and text, run or not,
names a command and options that its help has. Usage: doc_commands.py PALPATE ROOT"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

palpate, root = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
sys.argv = sys.argv[:1]

# Not run here, and why. The first that fits; their options are checked all the same.
EXCEPTIONS = [
    (r"(can|usb):", "needs a device on a bus, or a kernel with vcan; the laboratory has both"),
    (r"^\./run ", "builds, tests or boots all of it; the suite itself is one of these"),
    (r"^cmake |^cd build|^apt-get |^PYTHONPATH=", "builds or installs: tests install.*, python.* and ./run packages"),
    (r"^palpate view .*--screenshot|^xvfb-run", "needs a screen of sorts: tests/view/smoke.sh"),
    (r"functions/hid|> idVendor", "needs a kernel with a USB device port; the laboratory has one"),
    (r"^palpate view ", "a window until somebody closes it"),
]
PAGES_OF_OTHERS = {"tutorial.md": "tests/commands/newcomer.py types it"}
# Real time is asked for: a machine that stands still ends it with a verdict, a broken rule or a fault.
REAL_TIME, MACHINE_DID = re.compile(r"loopback:"), (0, 1, 4, 5)
COMMAND = re.compile(r"^(palpate|palpate-rt|palpate-device|cmake|cd|apt-get|cc|xvfb-run|echo|docs/examples/\S+|\./run|PYTHONPATH=\S+) ")
LIMIT_S = 200
problems = 0
sys.dont_write_bytecode = True
helps = {}


def wrong(what):
    global problems
    problems += 1
    print(what, flush=True)


def blocks(page):
    """(line, text) of each fenced block without a language, or of sh."""
    inside, text, start = None, [], 0
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if line.lstrip().startswith("```"):
            if inside is None:
                inside, text, start = line.strip()[3:], [], number
            else:
                if inside in ("", "sh"):
                    yield start, text
                inside = None
        elif inside is not None:
            text.append(line)


def commands(lines):
    """Whole commands of a block: lines that go on behind a backslash, or within quotes, are one."""
    lines = list(lines)
    while lines:
        command = lines.pop(0)
        while lines and (command.endswith("\\") or command.count("'") % 2 == 1):
            command = command.removesuffix("\\") + ("" if command.endswith("\\") else "\n") + lines.pop(0)
        if COMMAND.match(command):
            yield re.sub(r"\s+# .*$", "", command)


def help_of(command):
    if command not in helps:
        done = subprocess.run([palpate, command, "--help"], capture_output=True, text=True, check=False)
        helps[command] = done.stdout if done.returncode == 0 else None
    return helps[command]


def check_options(where, text):
    for found in re.finditer(r"\bpalpate ([a-z][a-z-]*)((?: [^|&;]+)?)", text):
        name, rest = found[1], found[2]
        said = help_of(name)
        if said is None:
            if name not in ("mesh", "view"):  # programs of their own, which need not be built
                wrong(f"{where}: `palpate {name}`: no such command")
            continue
        for option in re.findall(r"(?<=\s)(--[a-z][a-z-]*)", rest):
            if not re.search(re.escape(option) + r"(?![a-z-])", said):
                wrong(f"{where}: `palpate {name}` has no {option}")


def prepare(folder):
    """What the pages' commands name. Elastic bodies with few modes: it is the commands that are tried."""
    shutil.copytree(root / "config", folder / "config")
    shutil.copytree(root / "docs", folder / "docs")
    shutil.copytree(root / "hal/firmware", folder / "hal/firmware")
    for scene in (folder / "config/scenes").glob("*.toml"):
        text = scene.read_text(encoding="utf-8")
        text = re.sub(r"^soft_modes = \d+", "soft_modes = 2", text, flags=re.MULTILINE)
        scene.write_text(re.sub(r"^linear_modes = \d+", "linear_modes = 4", text, flags=re.MULTILINE), encoding="utf-8")
    springs = "config/scenes/ellipsoid_mallet_springs.toml"
    shutil.copy(folder / springs, folder / "scene.toml")
    shutil.copy(folder / "config/devices/sim-6dof.toml", folder / "arm.toml")
    path = "time_s,x_mm,y_mm,z_mm\n" + "".join(f"{0.001 * i},-10,{85 - 0.02 * i},0\n" for i in range(500))
    for name in ("poses.csv", "press.csv"):
        (folder / name).write_text(path, encoding="utf-8")
    for arguments in (["bake", springs, "-o", "scene.pal"], ["bake", springs, "-o", "mallet.pal"],
                      ["run", springs, "--duration", "2s", "--record", "run.plr", "--image", "run.pal"]):
        subprocess.run([palpate, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    tutorial = (root / "docs/tutorial.md").read_text(encoding="utf-8")
    (folder / "organ.toml").write_text(re.search(r"<<'END'\n(.*?)^END$", tutorial, re.M | re.S)[1], encoding="utf-8")
    sys.path.insert(0, str(root / "tests/mesh"))
    import organ_from_stl
    organ_from_stl.write_stl(folder / "organ.stl", 3000)
    tools = folder / "tools"
    tools.mkdir()
    # On a machine where others run palpate too: of all that run, the one that this test has started.
    (tools / "pgrep").write_text(f"#!/bin/sh\ncat {folder}/run.pid\n", encoding="utf-8")
    (tools / "pgrep").chmod(0o755)


def run(command, folder):
    own = re.sub(r"(loopback:|\b(?:device\.py|device) )(arm|mine|x)\b", rf"\g<1>\g<2>{os.getpid()}", command)
    env = {**os.environ, "PATH": f"{folder}/tools:{os.path.dirname(palpate)}:{os.environ['PATH']}",
           "PYTHONPATH": str(root / "sim_host/python")}  # as the line before it on its page exports
    with subprocess.Popen(["bash", "-c", own], cwd=folder, env=env, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True) as shell:
        try:
            output = shell.communicate(timeout=LIMIT_S)[0]
        except subprocess.TimeoutExpired:
            output = f"did not end within {LIMIT_S} s"
        finally:
            try:
                os.killpg(shell.pid, signal.SIGKILL)  # a device in the background goes with it
            except ProcessLookupError:
                pass
        return shell.returncode, output


def run_that_goes_on(folder):
    """Of which pgrep tells, once it listens."""
    going = subprocess.Popen([palpate, "run", "scene.pal", "--duration", "1h", "--pace", "--virtual-time", "--no-record"],
                             cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    (folder / "run.pid").write_text(str(going.pid), encoding="utf-8")
    for _ in range(300):
        if subprocess.run([palpate, "set", str(going.pid)], capture_output=True, check=False).returncode == 0:
            break
        time.sleep(0.1)
    return going


def run_block(where, lines, made):
    """In a copy of its own, in order. A command in the background and the next one are one."""
    kept = []
    for command in commands(lines):
        check_options(where, command)
        reason = next((why for pattern, why in EXCEPTIONS if re.search(pattern, command)), None)
        if reason:
            continue
        if kept and kept[-1].endswith("&"):
            kept[-1] += " " + command
        else:
            kept.append(command)
    if not kept:
        return 0
    with tempfile.TemporaryDirectory(prefix="palpate-docs-") as name:
        folder = pathlib.Path(name) / "copy"
        shutil.copytree(made, folder, symlinks=True)
        (folder / "tools/pgrep").write_text(f"#!/bin/sh\ncat {folder}/run.pid\n", encoding="utf-8")
        going = run_that_goes_on(folder) if any("pgrep" in command for command in kept) else None
        for command in kept:
            status, output = run(command, folder)
            if status != 0 and not (REAL_TIME.search(command) and status in MACHINE_DID):
                wrong(f"{where}: exit code {status}: {command}\n{output[-1500:]}")
        if going:
            going.terminate()
            going.wait(30)
    return len(kept)


def main():
    count = 0
    with tempfile.TemporaryDirectory(prefix="palpate-docs-made-") as name:
        made = pathlib.Path(name) / "made"
        made.mkdir()
        prepare(made)
        for page in [root / "README.md", *sorted((root / "docs").glob("*.md"))]:
            text = page.read_text(encoding="utf-8")
            for span in re.findall(r"`(palpate [^`\n]+)`", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)):
                check_options(page.name, span)
            for line, lines in blocks(page) if page.name not in PAGES_OF_OTHERS else ():
                count += run_block(f"{page.name}:{line}", lines, made)
    if count < 15:
        wrong(f"only {count} commands found: the pages' blocks are not read as they are written")
    print(f"doc commands: {count} run, {problems} problems")
    return 1 if problems else 0


sys.exit(main())
