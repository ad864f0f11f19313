"""The five commands of docs/models_elastic.md, from an STL file to the first touch, on a small organ.

usage: organ_from_stl.py PALPATE SCENE FOLDER [TRIANGLES [KEY=VALUE ...]]
PALPATE: the program; SCENE: docs/examples/organ.toml; FOLDER: made anew.
"""
import csv
import math
import pathlib
import shutil
import subprocess
import sys
import time

WIDTH_MM = 140
LIFT_MM = 32.2  # the file stands with its lowest point at y = 0


def place(x, y, z):
    """A point of the unit sphere on the organ, mm: two lobes, a notch between them, domed above and hollow below.

    x, then z, then y can be found back from it, so the surface does not cut itself.
    """
    right = 0.5 * (1 + x)
    thick = 0.28 + 0.14 * right * right * (3 - 2 * right)
    front = z * z * (3 - 2 * z) if z > 0 else 0
    notch = (1 + ((x + 0.25) / 0.3) ** 2) ** 2
    half = WIDTH_MM / 2
    return (half * x, half * (thick * y - 0.3 * (x * x + z * z)) + LIFT_MM, half * 0.62 * z * (1 - 0.2 * front / notch))


def write_stl(path, triangles):
    """Needles about two poles, as no remesher would leave them."""
    rows = max(4, int(math.sqrt(triangles / 4)))
    around = max(6, triangles // (2 * (rows - 1)))

    def point(i, k):
        ring = math.sin(math.pi * i / rows) if 0 < i < rows else 0.0
        turn = 2 * math.pi * (k % around) / around
        return place(math.cos(math.pi * i / rows), ring * math.cos(turn), ring * math.sin(turn))

    with open(path, "w", encoding="ascii") as out:
        out.write("solid organ\n")
        for i in range(rows):
            for k in range(around):
                p, q, r, s = point(i, k), point(i + 1, k), point(i + 1, k + 1), point(i, k + 1)
                for corners in ([(p, q, s)] if i > 0 else []) + ([(q, r, s)] if i < rows - 1 else []):
                    lines = "".join("vertex %.6f %.6f %.6f\n" % c for c in corners)
                    out.write("facet normal 0 0 0\nouter loop\n" + lines + "endloop\nendfacet\n")
        out.write("endsolid organ\n")


def main():
    palpate, scene, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    triangles = int(sys.argv[4]) if len(sys.argv) > 4 else 3000
    settings = [part for setting in sys.argv[5:] for part in ("--set", setting)]
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    write_stl(folder / "organ.stl", triangles)
    shutil.copy(scene, folder / "organ.toml")
    (folder / "touch.csv").write_text("time_s,x_mm,y_mm,z_mm\n0,35,75,0\n1,35,61,0\n2,35,50,0\n2.5,35,50,0\n")
    begin = time.monotonic()
    for arguments in (
        ["mesh", "organ.stl", "--check"],
        ["mesh", "organ.stl", "--edge-mm", "3.5", "-o", "organ.obj"],
        ["bake", "organ.toml", "-o", "organ.pal", "--report", *settings],
        ["press", "organ.pal", "--path", "touch.csv", "--resample", "--out", "forces.csv"],
        ["run", "organ.pal", "--path", "touch.csv", "--virtual-time", "--duration", "2.5", "--quiet", "--record", "first_touch.plr"],
    ):
        subprocess.run([palpate, *arguments], cwd=folder, check=True)
        print("%8.1f s  palpate %s" % (time.monotonic() - begin, " ".join(arguments)), flush=True)
    with open(folder / "forces.csv", newline="", encoding="utf-8") as table:
        rows = list(csv.DictReader(line for line in table if not line.startswith("#")))
    most = max(math.hypot(*(float(row[name]) for name in ("fx_N", "fy_N", "fz_N"))) for row in rows)
    print("largest force %.2f N" % most)
    # 11 mm into the thick lobe: a ball of 8 mm on a half space of this material alone would give 10 N.
    if not 1 < most < 10:
        sys.exit("the organ does not press back as such a body does")


if __name__ == "__main__":
    main()
