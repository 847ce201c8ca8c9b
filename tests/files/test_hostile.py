"""Files that are made to fill a memory or to keep a processor busy: each is refused soon.

They are read in a process of their own, which tells its processor time and its greatest memory.
"""

import gzip
import io
import itertools
import json
import resource
import sqlite3
import struct
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.recordings.forms import jupedsim

SOON_S = 4.0
"""Twice what it takes at most, so that a machine half as fast is soon enough."""
MOST_BYTES = 500 * 2**20
KB = 2**10
MB = 2**20


def sqlite(*statements: str) -> bytes:
    connection = sqlite3.connect(":memory:")
    for statement in statements:
        connection.execute(statement)
    connection.commit()
    return connection.serialize()


def computed(table: bytes) -> bytes:
    """A table of samples whose places are computed, a gigabyte for each."""
    made = (
        "CREATE TABLE trajectory_data (frame INTEGER, id INTEGER, pos_y REAL, "
        "pos_x AS (length(zeroblob(900000000))))"
    )
    rows = [f"INSERT INTO trajectory_data (frame, id, pos_y) VALUES ({n}, 1, 0)" for n in range(50)]
    return sqlite(made, *rows) or table


def parquet() -> bytes:
    pa = pytest.importorskip("pyarrow")
    files = pytest.importorskip("pyarrow.parquet")
    column = pa.array([1.0]).take(pa.array(np.zeros(1_000_000, np.int32)))
    table = pa.table(dict.fromkeys(("t", "id", "x", "y"), column))
    whole = pa.concat_tables([table] * 20)
    file = io.BytesIO()
    files.write_table(whole, file, compression="zstd", row_group_size=10_000_000)
    return file.getvalue()


def hdf5() -> bytes:
    h5py = pytest.importorskip("h5py")
    file = io.BytesIO()
    kind = [("id", "i8"), ("frame", "i8"), ("x", "f8"), ("y", "f8")]
    with h5py.File(file, "w") as made:
        made.create_dataset("trajectory", (90_000_000,), kind, chunks=(65_536,))
    return file.getvalue()


def threemf(model: str, packed: bool = True) -> bytes:
    file = io.BytesIO()
    kind = zipfile.ZIP_DEFLATED if packed else zipfile.ZIP_STORED
    with zipfile.ZipFile(file, "w", kind) as archive:
        archive.writestr("3D/3dmodel.model", model)
    return file.getvalue()


def components() -> str:
    """Objects each of which holds the one before ten times."""
    cube = '<mesh><vertices><vertex x="0" y="0" z="0"/></vertices><triangles/></mesh>'
    made = [f'<object id="0">{cube}</object>']
    for k in range(1, 20):
        parts = f'<component objectid="{k - 1}"/>' * 10
        made.append(f'<object id="{k}"><components>{parts}</components></object>')
    build = '<build><item objectid="19"/></build>'
    return f'<model unit="meter"><resources>{"".join(made)}</resources>{build}</model>'


def laughs_of_yaml() -> bytes:
    made = ["a: &a [x,x,x,x,x,x,x,x,x]"]
    for before, name in itertools.pairwise("abcdefghijklmnopqrstuv"):
        made.append(f"{name}: &{name} [{','.join([f'*{before}'] * 9)}]")
    return "\n".join(made).encode()


def gltf(count: int, nodes: int = 1) -> bytes:
    content = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": list(range(nodes))}],
        "nodes": [{"mesh": 0}] * nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [
            {"componentType": 5126, "count": count, "type": "VEC3",
             "sparse": {"count": 0, "indices": {"bufferView": 0, "componentType": 5125},
                        "values": {"bufferView": 0}}}
        ],
    }  # fmt: skip
    return json.dumps(content).encode()


ENTITIES = '<!ENTITY a0 "ha">' + "".join(
    f"<!ENTITY a{k} '" + f"&a{k - 1};" * 10 + "'>" for k in range(1, 12)
)
LAUGHS = (
    '<?xml version="1.0"?><!DOCTYPE lolz [' + ENTITIES + "]>"
    "<{root}><frame number='1'>&a11;</frame></{root}>"
)

RECORDINGS: dict[str, Callable[[], bytes]] = {
    "zeros.csv.gz": lambda: gzip.compress(bytes(140 * MB), 1),
    "lines.csv.gz": lambda: gzip.compress(b"\n" * 5 * MB, 1),
    "digits.txt.gz": lambda: gzip.compress(b"1\n" * 5 * MB, 1),
    "words.txt.gz": lambda: gzip.compress(b"a b\n" * 2_000_000, 1),
    "one_line.txt": lambda: b"1 " * 8 * MB,
    "wide.csv": lambda: b"x," * 60_000 + b"\n" + b"1," * 60_000 + b"\n",
    "long_number.csv": lambda: b"t,id,x,y\n0,1," + b"9" * 60_000 + b",2\n",
    "spaces.vsp": lambda: b"1\n2\n0 0 0 0\n" + b" " * 20_000 + b"0 1 1" + b" " * 60_000 + b"x\n",
    "comments.txt": lambda: (b"# " + b"1." * 5000 + b"\n") * 2000 + b"nothing\n",
    "splines.vsp": lambda: b"100000\n" + b"2\n0 0 0 0\n9 9 9999999 0\n" * 100_000,
    "deep.json": lambda: b"[" * 5 * MB,
    "many.json": lambda: b"[" + b"0," * 5 * MB + b"0]",
    "lists.json": lambda: b"[" + b"[]," * 2 * MB + b"[]]",
    "deep.xml": lambda: b"<a>" * 4 * MB,
    "laughs.xml": lambda: LAUGHS.replace("{root}", "dataset").encode(),
    "empty.xml": lambda: b"<dataset>" + b"<a/>" * MB + b"</dataset>",
    "other.sqlite": lambda: sqlite("CREATE TABLE a (b)", "CREATE VIEW trajectory_data AS SELECT 1"),
    "endless.sqlite": lambda: sqlite(
        "CREATE VIEW trajectory_data AS WITH RECURSIVE r(frame) AS (SELECT 1 UNION ALL SELECT "
        "frame + 1 FROM r) SELECT frame, 1 AS id, 0.0 AS pos_x, 0.0 AS pos_y FROM r"
    ),
    "computed.sqlite": lambda: computed(b""),
    "cut.sqlite": lambda: jupedsim()[:6000],
    "same.parquet": parquet,
    "unwritten.h5": hdf5,
    "people.csv": lambda: b"t,id,x,y\n" + b"".join(b"0,%d,1,2\n" % n for n in range(510_000)),
}  # fmt: skip
MESHES: dict[str, Callable[[], bytes]] = {
    "zeros.3mf": lambda: threemf("<model>" + " " * 20 * MB),
    "nested.3mf": lambda: threemf(components()),
    "laughs.3mf": lambda: threemf(LAUGHS.replace("{root}", "model"), packed=False),
    "lines.obj": lambda: b"\n" * 9 * MB,
    "words.obj": lambda: b"f " + b"1 " * 4 * MB,
    "far.obj": lambda: b"v 0 0 0\nf 1 2 99999999999999999999\n",
    "counts.off": lambda: b"OFF\n999999999 999999999 0\n0 0 0\n",
    "counts.ply": lambda: (
        b"ply\nformat ascii 1.0\nelement vertex 999999999\nproperty float x\n"
        b"property float y\nproperty float z\nend_header\n0 0 0\n"
    ),
    "lists.ply": lambda: (
        b"ply\nformat binary_little_endian 1.0\nelement face 999999999\n"
        b"property list uint int vertex_indices\nend_header\n" + b"\xff" * 64
    ),
    "counts.stl": lambda: bytes(80) + struct.pack("<I", 2**32 - 1) + bytes(50),
    "sparse.gltf": lambda: gltf(2**31),
    "nodes.gltf": lambda: gltf(3_000_000, 1000),
    "deep.gltf": lambda: b'{"asset":' + b"[" * 4 * MB,
    "many.gltf": lambda: b'{"asset":{"version":"2.0"},"nodes":[' + b"0," * 4 * MB + b"0]}",
    "noise.ifc": lambda: b"ISO-10303-21;\n" + b"#1=IFCWALL(" * 100_000,
}
PLANS: dict[str, Callable[[], bytes]] = {
    "deep.wkt": lambda: b"POLYGON " + b"(" * 2 * MB,
    "deep.geojson": lambda: b'{"type":"FeatureCollection","features":' + b"[" * 4 * MB,
    "many.geojson": lambda: b'{"features":[' + b"0," * 4 * MB + b"0]}",
    "laughs.xml": lambda: LAUGHS.replace("{root}", "geometry").encode(),
    "laughs.yaml": laughs_of_yaml,
    "long.yaml": lambda: b"image: a.pgm\n" + b"#" * 8 * MB,
    "noise.dxf": lambda: b"0\nSECTION\n2\nENTITIES\n" + b"0\nLINE\n8\n0\n" * 20_000,
}

READ = """
import resource, signal, sys, time
what, names = sys.argv[1], sys.argv[2:]
from pathlib import Path
if what == "recordings":
    import scipy.interpolate
    from esplanade.recordings import RecordingError as Fault, read_crowd as read
elif what == "meshes":
    from esplanade.planning.scene.mesh_file import MeshError as Fault, read_mesh as read
else:
    from esplanade.commandline.errors import UsageError as Fault
    from esplanade.scenery.plans.reading import read_plan as read
for library in "pyarrow.parquet pyarrow.csv h5py shapely ezdxf yaml ifcopenshell".split():
    try:
        __import__(library)
    except ImportError:
        pass
class Hangs(BaseException):
    pass
def hang(*_):
    raise Hangs
signal.signal(signal.SIGPROF, hang)
for name in names:
    signal.setitimer(signal.ITIMER_PROF, 10.0)
    Path("/proc/self/clear_refs").write_text("5")
    began = time.process_time()
    try:
        read(Path(name))
        said = "READ"
    except Fault as fault:
        said = str(fault)
    except Hangs:
        said = "READ"
    took_s = time.process_time() - began
    status = Path("/proc/self/status").read_text()
    peak = int(status.split("VmHWM:")[1].split()[0]) * 1024
    print(f"{took_s:.3f}\\t{peak}\\t{name}\\t{said[:300]!r}", flush=True)
"""


@pytest.mark.skipif(not Path("/proc/self/clear_refs").exists(), reason="needs Linux's /proc")
@pytest.mark.parametrize(
    ("what", "files"),
    [("recordings", RECORDINGS), ("meshes", MESHES), ("plans", PLANS)],
    ids=["recordings", "meshes", "plans"],
)
def test_hostile_files_are_refused_soon(
    tmp_path: Path, what: str, files: dict[str, Callable[[], bytes]]
) -> None:
    paths = []
    for name, make in files.items():
        path = tmp_path / name
        path.write_bytes(make())
        paths.append(str(path))
    done = subprocess.run(
        [sys.executable, "-c", READ, what, *paths],
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (240, 240)),
    )
    rows = [line.split("\t") for line in done.stdout.splitlines()]
    assert len(rows) == len(paths), done.stderr[-3000:]
    wrong = [
        row
        for row in rows
        if float(row[0]) > SOON_S or int(row[1]) > MOST_BYTES or row[3] == "'READ'"
    ]
    assert not wrong
