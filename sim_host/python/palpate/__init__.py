"""Palpate from Python: bake a scene, press it, tick it, be its device, watch a run, read and replay recordings.

Everything is in SI units and in the scene's world frame; names end in their unit (``_m``, ``_N``, ``_Nm``, ``_s``).
Orientations are unit quaternions in the order w, x, y, z. Results are NumPy structured arrays whose rows are the
controller's own records, bit for bit: ``palpate.TICK_FIELDS`` and ``palpate.REGION_FIELDS`` say what each field means.

>>> import palpate
>>> scene = palpate.Scene("config/scenes/ellipsoid_mallet.toml")
>>> pressed = scene.press()                       # the motion the scene scripts
>>> force_N = pressed.ticks["contact_force_N"]    # (n, 3)
>>> depth_m = pressed.ticks["penetration_m"]      # (n,)
"""

from __future__ import annotations

import shutil
import time
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _core

__all__ = [
    "BUILD", "FAULT_BITS", "MODES", "REGION_DTYPE", "REGION_FIELDS", "STATUS_BITS", "TICK_DTYPE", "TICK_FIELDS",
    "Controller", "Records", "Recording", "Scene", "Telemetry", "bake", "bits", "run",
]

Floats = npt.ArrayLike
FilePath = Union[str, "PathLike[str]"]
DeviceSample = Union[None, Floats, Tuple[Floats, Floats]]
Device = Callable[[float, np.ndarray, np.ndarray], DeviceSample]

BUILD: str = _core.build_id
"""Version, compiler and flags of this build, as recordings keep them."""
TICK_DTYPE: np.dtype = _core.tick_dtype
REGION_DTYPE: np.dtype = _core.region_dtype
TICK_FIELDS: Dict[str, str] = dict(_core.tick_fields)
"""What each field of a tick means."""
REGION_FIELDS: Dict[str, str] = dict(_core.region_fields)
"""What each field of a contact region means."""
STATUS_BITS: Dict[str, Tuple[int, str, str]] = _core.status_bits
"""Name: bit of ``ticks["status"]``, meaning, remedy."""
FAULT_BITS: Dict[str, Tuple[int, str, str]] = _core.fault_bits
"""Name: bit of ``ticks["fault"]``, meaning, remedy."""
MODES: Tuple[str, ...] = ("idle", "force", "hold", "passive", "ramp", "fault")
"""Words of ``ticks["mode"]``."""

_ARM, _STOP = 1, 2
_DRIVES = {"device": 0, "tool": 1, "held": 2}
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def bits(value: int, table: Dict[str, Tuple[int, str, str]] = STATUS_BITS) -> List[str]:
    """Names of the bits that are set in a status (or, with ``FAULT_BITS``, a fault) word."""
    return [name for name, (bit, _, _) in table.items() if int(value) & bit]


class Records(NamedTuple):
    """What ticks left behind."""

    ticks: np.ndarray
    """One row a tick, ``TICK_DTYPE``."""
    regions: np.ndarray
    """One row for each contact region of each tick, ``REGION_DTYPE``; ``sequence`` says of which tick."""


class Scene:
    """A scene (.toml, baked here and now) or a baked image (.pal).

    ``overlay``: files with some of the scene's tables, laid over it. ``settings``: single keys, as
    ``{"body.material.youngs_modulus_Pa": 3e5}``; what is allowed is in docs/scene_format.md.
    Errors name the file, the line and the key.
    """

    def __init__(self, path: FilePath, overlay: Sequence[FilePath] = (),
                 settings: Optional[Dict[str, Any]] = None) -> None:
        words = [f"{key}={_toml(value)}" for key, value in (settings or {}).items()]
        self.path = fspath(path)
        self._core = _core.Scene(self.path, [fspath(file) for file in overlay], words)

    @property
    def name(self) -> str:
        return self._core.name

    @property
    def hash(self) -> int:
        """Checksum of the image: what a recording names as its scene."""
        return self._core.hash

    @property
    def period_s(self) -> float:
        """Length of a tick."""
        return self._core.period_s

    @property
    def params(self) -> Dict[str, Any]:
        """Every parameter of the baked scene by name; ``param_meanings`` has unit and meaning."""
        return self._core.params()

    @property
    def param_meanings(self) -> Dict[str, Tuple[str, str]]:
        return self._core.param_meanings()

    @property
    def vertices_m(self) -> np.ndarray:
        """(n, 3): the body at rest."""
        return self._core.vertices()

    @property
    def triangles(self) -> np.ndarray:
        """(m, 3): vertices of each triangle, counter-clockwise seen from outside."""
        return self._core.triangles()

    @property
    def path_poses(self) -> np.ndarray:
        """(n, 8): the motion the scene scripts, one row a tick: time_s, x, y, z (m), w, x, y, z."""
        return self._core.demo_path()

    def save(self, path: FilePath) -> None:
        """Writes the baked image (.pal)."""
        self._core.save(fspath(path))

    def press(self, position_m: Optional[Floats] = None, orientation: Optional[Floats] = None,
              closing: Optional[Floats] = None, hand_N_per_m: Optional[float] = None) -> Records:
        """Moves the tool through poses, one a tick, and returns what came of it; no device, no coupling.

        ``position_m``: (n, 3); without it the motion that the scene scripts. ``orientation``: (4,) or (n, 4).
        ``closing``: (n,), 0 open to 1 closed, of all fingers or jaws. ``hand_N_per_m``: a hand's spring pulls the tool
        to the poses; 0: the tool is there. By default 0, and the scene's hand with the scripted motion.
        """
        if position_m is None:
            if orientation is not None or closing is not None:
                raise ValueError("orientation and closing go with position_m")
            hand = self._core.demo_hand_N_per_m() if hand_N_per_m is None else hand_N_per_m
            return Records(*self._core.press(np.empty((0, 7)), np.empty(0), hand))
        place = np.atleast_2d(np.asarray(position_m, dtype=float))
        if place.ndim != 2 or place.shape[1] != 3 or len(place) == 0:
            raise ValueError(f"position_m has shape {place.shape}, not (n, 3)")
        turn = np.asarray(_UPRIGHT if orientation is None else orientation, dtype=float)
        if turn.shape not in ((4,), (len(place), 4)):
            raise ValueError(f"orientation has shape {turn.shape}, not (4,) or ({len(place)}, 4)")
        poses = np.hstack([place, np.broadcast_to(turn, (len(place), 4))])
        closed = np.empty(0) if closing is None else np.broadcast_to(np.asarray(closing, dtype=float), (len(place),))
        if not np.isfinite(poses).all() or not np.isfinite(closed).all():
            raise ValueError("poses and closing must be finite")
        return Records(*self._core.press(poses, closed, hand_N_per_m or 0.0))

    def drive(self, device: Device, duration_s: float, record: Optional[FilePath] = None) -> Records:
        """Renders the scene to a device of one's own, in virtual time: as fast as this machine can, the same every time.

        Each period calls ``device(time_s, force_N, torque_Nm)`` with what the device must render since the last one,
        and takes back where its handle is: a position (3,) in m, a pair of position and orientation, or None for a
        sample that got lost. The controller is armed as `palpate run` arms it, and safety is its own: limits, ramps,
        detectors and faults act as on a device. Ends early when a fault is latched. ``record``: a recording to write,
        which `palpate replay` verifies and `palpate view` shows.
        """
        controller = Controller(self, keep=True)
        if record is not None:
            controller.record_to(record)
        force, torque = np.zeros(3), np.zeros(3)
        place, turn = np.zeros(3), np.asarray(_UPRIGHT)
        stale = 0
        for i in range(max(1, round(duration_s / self.period_s))):
            sample = device(i * self.period_s, force, torque)
            stale = 0 if sample is not None else stale + 1
            if isinstance(sample, tuple) and len(sample) == 2:
                place, turn = (np.asarray(part, dtype=float) for part in sample)
            elif sample is not None:
                place = np.asarray(sample, dtype=float)
            arm = controller.mode == "idle" and i % 2 == 1  # an edge, offered until it is taken
            controller.tick(place, turn, drive="device", stale_ticks=stale, commands=_ARM if arm else 0)
            force, torque = controller.device_force_N, controller.device_torque_Nm
            if controller.mode == "fault":
                break
        controller.close()
        return controller.kept()


class Controller:
    """The tick by itself: one scene, one state, one period at a time.

    ``keep``: every tick's records stay in memory, for ``kept()`` (about 700 bytes a tick).
    Use it in a ``with`` statement, or call ``close()``, when a recording is written.
    """

    def __init__(self, scene: Scene, keep: bool = False) -> None:
        self.scene = scene
        self._core = _core.Controller(scene._core, keep)

    def __enter__(self) -> "Controller":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def record_to(self, path: FilePath) -> None:
        """From the first tick on, writes a recording (.plr) that holds the scene's image."""
        self._core.record_to(fspath(path), str(Path(self.scene.path).absolute()))

    def close(self) -> None:
        """Finishes the recording."""
        self._core.finish_recording()

    def reset(self) -> None:
        """Back to the state before the first tick."""
        self._core.reset()

    def tick(self, position_m: Floats, orientation: Floats = _UPRIGHT, drive: str = "tool", stale_ticks: int = 0,
             commands: int = 0, device_fault: int = 0, buttons: int = 0,
             closing: Union[float, Sequence[float]] = 0.0) -> None:
        """Renders one period. ``drive``: "tool" (the pose is the tool's, no coupling), "device" (it is the handle's:
        coupling, limits and arming act) or "held". ``commands``: 1 arm (edge), 2 stop, 4 reset (edge)."""
        pose = [*map(float, position_m), *map(float, orientation)]
        if len(pose) != 7:
            raise ValueError("a pose is a position of 3 and an orientation of 4 numbers")
        fingers = [float(closing)] * 5 if np.ndim(closing) == 0 else [*map(float, closing)]
        self._core.tick(pose, _DRIVES[drive], stale_ticks, commands, device_fault, buttons,
                        (fingers + [0.0] * 5)[:5])

    @property
    def last(self) -> Records:
        """Of the last tick: one row (none before the first), and its regions."""
        return Records(*self._core.last())

    def kept(self) -> Records:
        """Of every tick since the last call; only with ``keep``."""
        return Records(*self._core.kept())

    @property
    def device_force_N(self) -> np.ndarray:
        """(3,): what the device must render, after every limit."""
        return np.array(self._core.device_wrench()[:3])

    @property
    def device_torque_Nm(self) -> np.ndarray:
        """(3,): the same, about the handle's origin."""
        return np.array(self._core.device_wrench()[3:])

    @property
    def mode(self) -> str:
        return MODES[self._core.mode()]

    @property
    def state_hash(self) -> int:
        """Of everything that can influence a later tick."""
        return self._core.state_hash()

    @property
    def surface_m(self) -> np.ndarray:
        """(n, 3): the deformed body's vertices, as pictures and exports evaluate them."""
        return self._core.deformed_surface()


class Recording:
    """A recording (.plr), or what there is so far of one that is being written (.plr.part)."""

    def __init__(self, path: FilePath) -> None:
        self.path = fspath(path)
        header, ticks, regions, lost, damage = _core.read_recording(self.path)
        self.header: Dict[str, Any] = header
        """scene, scene_hash, period_s, build, image_path, first_sequence (1 unless it is a slice)."""
        self.ticks: np.ndarray = ticks
        """One row a tick, ``TICK_DTYPE``."""
        self.regions: np.ndarray = regions
        """One row for each contact region of each tick, ``REGION_DTYPE``."""
        self.lost: int = lost
        """Records that the recorder did not get."""
        self.damage: str = damage
        """Empty when the file is whole; otherwise what is wrong, and where."""

    @property
    def time_s(self) -> np.ndarray:
        """(n,): since the run's first tick."""
        return (self.ticks["sequence"].astype(float) - 1) * self.header["period_s"]

    def regions_of(self, sequence: int) -> np.ndarray:
        """The contact regions of one tick."""
        first, last = np.searchsorted(self.regions["sequence"], [sequence, sequence + 1])
        return self.regions[first:last]

    def replay(self, image: FilePath = "") -> Tuple[Dict[str, Any], Records]:
        """Computes every tick again from its inputs. The first result says whether all are ``identical``, else which
        tick, stage and field differ; the second is what the replay computed. ``image``: of the scene, when the one
        inside is not wanted."""
        said, ticks, regions = _core.replay(self.path, fspath(image))
        return said, Records(ticks, regions)


class Telemetry:
    """What a controller renders, while it runs: every tick's records, as a recording has them.

    ``where``: the path given to ``palpate run --telemetry``, or the process id of a palpate-rt of one's own user. The
    controller's memory is mapped read-only and keeps the last 4,096 ticks: who looks less often than every 4 s at 1 kHz
    loses records, and the controller does not notice. The first ``read()`` begins with the oldest that is there.

    >>> for records in palpate.Telemetry("./run.telemetry").follow():
    ...     print(records.ticks["device_force_N"][-1:])
    """

    def __init__(self, where: Union[int, FilePath]) -> None:
        self.where = str(where) if isinstance(where, int) else fspath(where)
        self._core = _core.Telemetry(self.where)

    @property
    def header(self) -> Dict[str, Any]:
        """scene, scene_hash and image_path of the newest scene; period_s, build, controller (its process id)."""
        return self._core.header()

    @property
    def newest(self) -> Records:
        """The newest tick, one row (none before the first), and its regions; ``read()`` gives it again."""
        return Records(*self._core.newest())

    def read(self, most: int = 4096) -> Records:
        """What was rendered since the last call, at most so many ticks, oldest first; empty when there is nothing."""
        if most < 1:
            raise ValueError(f"most = {most}, not 1 or more")
        return Records(*self._core.read(most))

    @property
    def lost(self) -> int:
        """Ticks that were overwritten before ``read()`` came to them."""
        return self._core.lost

    @property
    def has_ended(self) -> bool:
        """The controller is gone; what it rendered last can still be read."""
        return self._core.has_ended

    def follow(self, every_s: float = 0.05) -> Iterator[Records]:
        """What is new, about every ``every_s`` seconds, until the controller has ended and all of it is read."""
        while True:
            over = self.has_ended  # before the look: what was written until then is seen by it
            while len((records := self.read()).ticks):
                yield records
            if over:
                return
            time.sleep(every_s)


def bake(scene: FilePath, image: FilePath, overlay: Sequence[FilePath] = (),
         settings: Optional[Dict[str, Any]] = None) -> Scene:
    """Bakes a scene (.toml) into an image (.pal) and returns it."""
    baked = Scene(scene, overlay, settings)
    baked.save(image)
    return baked


def run(scene: FilePath, duration_s: float = 10.0, record: FilePath = "", path: FilePath = "",
        programs: FilePath = "", goes_on: Optional[Callable[[], bool]] = None) -> Dict[str, Any]:
    """A whole run in virtual time: the controller's and the simulated device's own programs, wire protocol, loop and
    hand. Returns its summary; read the recording for more.

    ``record``: recording to write. ``path``: CSV of the hand's motion, the scene's own without it. ``programs``: the
    folder of palpate-rt and palpate-device; by default they are looked up in the PATH. ``goes_on``: asked about 20
    times a second of the run; False ends it in order.
    """
    if not programs:
        found = shutil.which("palpate-rt")
        if found is None:
            raise FileNotFoundError("palpate-rt is not in the PATH: install palpate, or name its folder (programs=...)")
        programs = Path(found).parent
    return _core.run(fspath(scene), float(duration_s), fspath(record), fspath(path), fspath(programs), goes_on)


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)
