#!/usr/bin/env python3
"""What `palpate replay` writes for other programs, read by their own readers: --npz by numpy.load, --vtu as XML; every number is the
one that --dump and --dump-regions have, to the bit. Usage: exports.py PALPATE SCENE.toml..."""
import base64
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import numpy as np

palpate = os.path.abspath(sys.argv[1])
EVERY = 97
NUMPY = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "UInt32": "<u4", "UInt8": "u1"}


def run(*words):
    subprocess.run([palpate, *map(str, words)], check=True, stdout=subprocess.DEVNULL, cwd=work)


def columns(path):
    with open(path, encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    return {name: [row[name] for row in rows] for name in (rows[0] if rows else [])}, len(rows)


def compare(array, table, rows, skip=()):
    """Every field of the array is in the table under its own name and nothing else is; equal bits."""
    assert array.shape == (rows,), f"{array.shape} instead of {rows} rows"
    left = set(table) - set(skip)
    for name in array.dtype.names:
        flat = array[name].reshape(rows, -1)
        count, parts = flat.shape[1], {3: "xyz", 4: "wxyz"}
        for i in range(count):
            column = name if count == 1 else f"{name}_{parts[count][i] if count in parts else i}"
            left.discard(column)
            expected = np.array(table[column], dtype=flat.dtype.base if flat.dtype.kind == "f" else object)
            if flat.dtype.kind != "f":
                expected = np.array([int(x) for x in table[column]], dtype=flat.dtype)
            bits = f"u{flat.dtype.itemsize}"
            assert np.array_equal(expected.view(bits), np.ascontiguousarray(flat[:, i]).view(bits)), column
    assert not left, f"not in the arrays: {sorted(left)}"


def arrays(path):
    """The named arrays of a .vtu file, components along the second axis."""
    said = {}
    for element in xml.parse(path).iter("DataArray"):
        data = base64.b64decode(element.text)
        assert int.from_bytes(data[:4], "little") == len(data) - 4, path
        values = np.frombuffer(data[4:], NUMPY[element.get("type")])
        width = int(element.get("NumberOfComponents"))
        said[element.get("Name")] = values.reshape(-1, width) if width > 1 else values
    return said


def check_vtu(folder, ticks, regions):
    series = [(float(e.get("timestep")), e.get("file")) for e in xml.parse(folder / "regions.pvd").iter("DataSet")]
    assert len(series) == (len(ticks["tick"]) + EVERY - 1) // EVERY
    of_tick, forces = {}, 0
    for i, tick in enumerate(regions["tick"]):
        of_tick.setdefault(tick, []).append(i)
    for number, (time_s, name) in enumerate(series):
        tick = ticks["tick"][number * EVERY]
        assert abs(time_s - 1e-3 * int(tick)) < 1e-9, name
        rows, read = of_tick.get(tick, []), arrays(folder / name)
        for field, column in (("Points", "centre_w"), ("force_N", "force_w"), ("normal", "normal_w")):
            expected = np.array([[float(regions[f"{column}_{axis}"][i]) for axis in "xyz"] for i in rows]).reshape(-1, 3)
            assert expected.tobytes() == read[field].reshape(-1, 3).tobytes(), f"{name}: {field}"
        for field in ("depth_equivalent_m", "id", "friction"):
            assert [float(regions[field][i]) for i in rows] == [float(x) for x in read[field]], f"{name}: {field}"
        forces += len(rows)
        surface = arrays(folder / name.replace("regions", "surface"))
        assert len(surface["Points"]) == len(surface["displacement_m"]) > 100 and np.isfinite(surface["displacement_m"]).all()
    assert forces > 5, "the run must touch"


for scene in map(os.path.abspath, sys.argv[2:]):
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        run("run", scene, "--virtual-time", "--duration", "4.5", "--image", "scene.pal", "--record", "run.plr", "--quiet", "--no-black-box")
        run("replay", "run.plr", "--npz", "run.npz", "--dump", "ticks.csv", "--dump-regions", "regions.csv", "--vtu", "vtu", "--every", EVERY)
        (ticks, n_ticks), (regions, n_regions) = columns(folder / "ticks.csv"), columns(folder / "regions.csv")
        with np.load(folder / "run.npz") as file:
            assert sorted(file) == ["period_ns", "regions", "ticks"]
            assert file["period_ns"].tolist() == [1_000_000]
            compare(file["ticks"], ticks, n_ticks)
            compare(file["regions"], regions, n_regions)
        assert n_ticks > 2000 and n_regions > 200
        check_vtu(folder / "vtu", ticks, regions)
        first = (folder / "run.npz").read_bytes()
        run("replay", "run.plr", "--npz", "again.npz")
        assert (folder / "again.npz").read_bytes() == first, "the same recording makes the same file"
        print(f"{os.path.basename(scene)}: {n_ticks} ticks, {n_regions} regions")
