#!/usr/bin/env python3
"""Every command that `palpate --help` names tells its results as one JSON object when asked to (--json): nothing else on
standard output, the process's own exit code in it, no key that docs/json.md does not name, and nothing at all when the
command fails before it has results. Usage: json_output.py PALPATE ROOT"""
import json
import os
import re
import subprocess
import sys
import tempfile

palpate, root = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
scenes = os.path.join(root, "config/scenes")
mallet = os.path.join(scenes, "ellipsoid_mallet_springs.toml")  # bakes in a tenth of a second
layer = os.path.join(scenes, "tools_on_layer.toml")  # its law knows Young's modulus
grasp = os.path.join(scenes, "grasp_cylinder_2.toml")
TETRAHEDRON = "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"

# Of each command: arguments whose files exist when it is their turn, and keys that must hold these values.
CALLS = [
    ("bake", [mallet, "-o", "mallet.pal"], {"image": "mallet.pal", "warnings": list}),
    ("bake", ["--dump", "mallet.pal"], {"parameters": dict, "arrays": list}),
    ("mesh", ["solid.obj", "-o", "mended.obj", "--edge-mm", "10"], {"output": "mended.obj", "repairs": list}),
    ("mesh", ["solid.obj", "--check"], {"sound": True}),
    ("explain", ["mallet.pal"], {"stages": list, "tick_instructions": float}),
    ("certify", ["mallet.pal", "--ticks", "1000", "-o", "certified.pal"], {"image": "certified.pal"}),
    ("press", [mallet], {"files": ["forces.csv"], "force_max_N": float}),
    ("press", [mallet, "--allow", "unconverged=0", "--path", "one.csv", "--out", "one.forces.csv"], {"poses": 1}),
    ("run", [mallet, "--duration", "1.5s", "--record", "run.plr", "--no-black-box"], {"record": "run.plr", "missed_ticks": 0}),
    ("press", ["mallet.pal", "--out", "image.csv"], {"poses": 10001}),  # an image holds no motion
    ("run", ["mallet.pal", "--duration", "4s", "--no-record"], {"missed_ticks": 0, "device_force_max_N": float}),
    ("replay", ["run.plr"], {"identical": True, "identical_ticks": int}),
    ("replay", ["run.plr", "--state", "5"], {"state": dict}),
    ("recover", ["cut.plr.part"], {"record": "cut.plr", "ticks": int}),
    ("latency", ["--recording", "run.plr"], {"run": dict}),
    ("latency", ["--duration", "0.05s", "--priority", "0"], {"bare_loop": True}),
    ("picture", ["run.plr", "--width", "200", "--height", "150"], {"files": ["picture.png"]}),
    ("movie", ["run.plr", "--fps", "2", "--width", "200", "--height", "150"], {"files": ["movie.png"], "frames": int}),
    ("grasp", [grasp], {"grasps": list}),
    ("feel", [mallet, "--manoeuvre", "press"], {"runs": list}),
    ("compare", ["forces.csv", "forces.csv"], {"within_tolerance": True}),
    ("press", [layer, "--out", "layer.csv"], {"files": ["layer.csv"]}),
    ("fit", ["layer.csv", layer], {"parameters": dict}),
    ("report", [os.path.join(root, "tests/accuracy/block.toml"), "--model", "points_hertz", "--quick"], {"cases": list}),
    ("doctor", [], {"items": list}),
]
# What the test cannot give: a device, a run of somebody else's, a screen. Their objects are told by the same writer.
NOT_CALLED = {
    "set": "needs a run that goes on: called beside one below",
    "switch": "likewise",
    "view": "needs a screen: tests/view/smoke.sh",
    "device-test": "needs a device that answers: called beside a simulated one below",
}
problems = 0


def wrong(what):
    global problems
    problems += 1
    print(what)


def documented_keys():
    """Of each command: the words in backquotes in its row of docs/json.md; those of all rows together for `every command`."""
    keys = {}
    with open(os.path.join(root, "docs/json.md"), encoding="utf-8") as page:
        for line in page:
            row = re.match(r"\| (`[a-z-]+`|every command) \|(.*)\|", line)
            if row:
                keys[row[1].strip("`")] = set(re.findall(r"`([A-Za-z0-9_]+)`", row[2]))
    return keys


def check(command, done, expected, keys):
    try:
        told = json.loads(done.stdout)
    except ValueError as error:
        wrong(f"{command}: not one JSON object on standard output ({error}): {done.stdout[:200]!r} {done.stderr[-300:]!r}")
        return
    if told.get("command") != command or told.get("exit_code") != done.returncode:
        wrong(f"{command}: says it is {told.get('command')} with exit code {told.get('exit_code')}, ended with {done.returncode}")
    for key in told:
        if key not in keys.get(command, set()) | keys["every command"]:
            wrong(f"{command}: docs/json.md does not name the key '{key}'")
    for key, value in expected.items():
        fits = isinstance(told.get(key), value) if isinstance(value, type) else told.get(key) == value
        if not fits:
            wrong(f"{command}: '{key}' is {told.get(key)!r}, not {value}; {done.stderr[-300:]}")


def call(*arguments):
    return subprocess.run([palpate, *arguments], capture_output=True, text=True, timeout=120, check=False)


def check_going_run(keys):
    """A run that is paced to the clock takes settings and another scene while it goes on."""
    with subprocess.Popen(
        [palpate, "run", "mallet.pal", "--path", "still.csv", "--duration", "60s", "--pace", "--virtual-time", "--no-record"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        for _ in range(200):  # until it listens
            done = call("set", str(run.pid), "stiffness=0.5", "--json")
            if done.returncode == 0 or run.poll() is not None:
                break
        check("set", done, {"stiffness": 0.5}, keys)
        for _ in range(200):  # until its first tick: before, it says to ask again (seen twice on a busy machine)
            done = call("switch", str(run.pid), "mallet.pal", "--json")
            if "ask again" not in done.stderr:
                break
        check("switch", done, {"image": os.path.abspath("mallet.pal")}, keys)
        run.terminate()
        run.wait(30)


def check_device_test(keys):
    """Which rules hold depends on the machine's load; the object does not."""
    name = f"loopback:json{os.getpid()}"
    with subprocess.Popen([os.path.join(os.path.dirname(palpate), "palpate-device"), "--device", name],
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as device:
        check("device-test", call("device-test", name, "--json"), {"items": list, "device": name}, keys)
        device.terminate()
        device.wait(30)


def main():
    keys = documented_keys()
    commands = re.findall(r"^  ([a-z][a-z-]*)   ", call("--help").stdout, re.MULTILINE)
    if len(commands) < 18:
        wrong(f"the help names too few commands: {commands}")
    for command in commands:
        if command not in keys:
            wrong(f"docs/json.md has no row for {command}")
        if command not in NOT_CALLED and command not in [name for name, _, _ in CALLS]:
            wrong(f"{command}: nothing here calls it with --json")
    with tempfile.TemporaryDirectory(prefix="palpate-json-") as folder:
        os.chdir(folder)
        with open("solid.obj", "w", encoding="utf-8") as file:
            file.write(TETRAHEDRON)
        with open("one.csv", "w", encoding="utf-8") as file:
            file.write("x_mm,y_mm,z_mm\n0,90,0\n")
        with open("still.csv", "w", encoding="utf-8") as file:
            file.write("time_s,x_mm,y_mm,z_mm\n0,0,90,0\n60,0,90,0\n")
        for command, arguments, expected in CALLS:
            if command == "mesh" and not os.path.exists(os.path.join(os.path.dirname(palpate), "palpate-mesh")):
                continue  # built where CGAL is
            if command == "recover":  # as a host leaves it that was killed
                with open("run.plr", "rb") as whole, open("cut.plr.part", "wb") as part:
                    part.write(whole.read()[:-1000])
            check(command, call(command, *arguments, "--json"), expected, keys)
        check_going_run(keys)
        check_device_test(keys)
        for command in ("press", "run", "explain", "replay"):  # errors: as without --json
            done = call(command, "nowhere.toml", "--json")
            if done.stdout or done.returncode == 0 or "nowhere.toml" not in done.stderr:
                wrong(f"{command} nowhere.toml --json: exit {done.returncode}, {done.stdout!r}, {done.stderr!r}")
        os.chdir(root)
    print(f"json output: {len(commands)} commands, {problems} problems")
    return 1 if problems else 0


sys.exit(main())
