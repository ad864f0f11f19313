"""Force against depth of a scene, for one stiffness after another: a table, and a picture where matplotlib is installed.

Usage: press_curve.py SCENE.toml [PICTURE.png]
"""

import sys

import numpy as np

import palpate

scene, picture = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
curves = []
for modulus_Pa in (1e6, 3e6, 1e7):
    body = palpate.Scene(scene, settings={"body.material.youngs_modulus_Pa": modulus_Pa})
    # Straight down from 20 mm above the deepest place of the scene's own motion, 1 mm in 20 ticks.
    deepest = body.path_poses[np.argmin(body.path_poses[:, 2])]
    height_m = np.arange(deepest[2] + 0.020, deepest[2], -5e-5)
    poses = np.column_stack([np.full_like(height_m, deepest[1]), height_m, np.full_like(height_m, deepest[3])])
    ticks = body.press(poses, orientation=deepest[4:8]).ticks
    touching = ticks["contacts"] > 0
    depth_mm, force_N = 1e3 * ticks["penetration_m"][touching], np.linalg.norm(ticks["contact_force_N"][touching], axis=1)
    curves.append((modulus_Pa, depth_mm, force_N))
    print(f"E = {modulus_Pa:.0e} Pa: {force_N.max():.3g} N at {depth_mm[np.argmax(force_N)]:.3g} mm")

if picture:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    for modulus_Pa, depth_mm, force_N in curves:
        pyplot.plot(depth_mm, force_N, label=f"E = {modulus_Pa / 1e6:g} MPa")
    pyplot.xlabel("depth, mm")
    pyplot.ylabel("force, N")
    pyplot.legend()
    pyplot.savefig(picture, dpi=120)
