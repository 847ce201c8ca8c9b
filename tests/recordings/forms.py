"""Small recordings of our own in every form that is read: two people who walk at 1.25 m/s.

The first walks to the east from (0, 0), the second to the north from (4, 1) and comes later;
samples are 0.4 s apart in files that hold a few of them, and a frame apart in those of experiments.
"""

# ruff: noqa: E501 (lines of files are as long as they are)

import gzip
import io
import json
import sqlite3
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

SPEED_MPS = 1.25
SAMPLES = 12


class Form(NamedTuple):
    """A file, and what has to be given with it."""

    name: str
    content: bytes
    sample_s: float = 0.4
    given: dict[str, Any] = {}  # noqa: RUF012 (never written)


def walk(sample_s: float) -> Iterator[tuple[int, int, float, float]]:
    """All samples by time: number of the sample, person, x, y in metres."""
    for n in range(SAMPLES + 3):
        way = round(SPEED_MPS * sample_s * n, 6)
        if n < SAMPLES:
            yield n, 1, way, 0.0
        if n >= 3:
            yield n, 2, 4.0, round(1.0 + way - 3 * SPEED_MPS * sample_s, 6)


def text(rows: Iterable[str], *head: str) -> bytes:
    return "".join(f"{line}\n" for line in (*head, *rows)).encode()


def lines(make: Callable[[int, int, float, float], str], sample_s: float = 0.4) -> list[str]:
    return [make(*sample) for sample in walk(sample_s)]


def excel(make: Callable[[int, int, float, float], str]) -> list[str]:
    return [line.replace(".", ",") for line in lines(make)]


def splines() -> bytes:
    scale = 1 / 0.05
    made = ["2 - the number of splines"]
    for person, x, y, start in ((1, 0.0, 0.0, 0), (2, 4.0, 1.0, 30)):
        made.append("5 - Num of control points")
        for point in range(5):
            way = SPEED_MPS * point * 30 / 25
            east, north = (way, 0.0) if person == 1 else (0.0, way)
            at = f"{(x + east) * scale:.6f} {(y + north) * scale:.6f} {start + 30 * point}"
            made.append(f"{at} 90.0 - (2D point, m_id)")
    return text(made)


def stanford() -> bytes:
    def row(n: int, who: int, x: float, y: float) -> str:
        px, py = round(x / 0.04 + 400), round(400 - y / 0.04)
        return f'{who} {px - 10} {py - 10} {px + 10} {py + 10} {12 * n} 0 0 0 "Pedestrian"'

    return text(
        [*lines(row), '7 1 1 20 20 0 0 0 0 "Biker"', '7 90 1 110 20 12 0 0 0 "Biker"',
         '1 0 0 0 0 900 1 0 0 "Pedestrian"']
    )  # fmt: skip


def jupedsim(fps: float | None = 25.0) -> bytes:
    connection = sqlite3.connect(":memory:")
    connection.execute(
        "CREATE TABLE trajectory_data (frame INTEGER NOT NULL, id INTEGER NOT NULL, pos_x REAL, "
        "pos_y REAL, ori_x REAL, ori_y REAL)"
    )
    connection.execute("CREATE TABLE metadata (key TEXT PRIMARY KEY, value TEXT)")
    connection.execute("CREATE INDEX frame_id_idx ON trajectory_data(frame, id)")
    if fps is not None:
        connection.execute("INSERT INTO metadata VALUES ('fps', ?)", (fps,))
    connection.executemany(
        "INSERT INTO trajectory_data VALUES (?, ?, ?, ?, 1, 0)", list(walk(0.04))
    )
    connection.commit()
    return connection.serialize()


def parquet() -> bytes:
    import pyarrow as pa
    from pyarrow import parquet as files

    n, who, x, y = zip(*walk(0.4), strict=True)
    table = pa.table({"time_s": [0.4 * k for k in n], "person": who, "x_m": x, "y_m": y})
    file = io.BytesIO()
    files.write_table(table, file)
    return file.getvalue()


def plain(n: int, who: int, x: float, y: float) -> str:
    return f"{0.4 * n:.1f},{who},{x:.3f},{y:.3f}"


def semicolons(n: int, who: int, x: float, y: float) -> str:
    return f"{0.4 * n:.1f};{who};{x:.3f};{y:.3f}"


def ndjson(n: int, who: int, x: float, y: float) -> str:
    return json.dumps({"track": {"f": 12 * n, "p": who, "x": x, "y": y}})


def obsmat(n: int, who: int, x: float, y: float) -> str:
    east = SPEED_MPS if who == 1 else 0.0
    return f" {10 * n:e} {who:e} {x:e} 0 {y:e} {east:e} 0 {SPEED_MPS - east:e}"


def as_record(n: int, who: int, x: float, y: float) -> str:
    return json.dumps({"time": round(0.4 * n, 3), "ped": who, "pos": [x, y]})


def pathfinder(sample_s: float = 0.4) -> bytes:
    people: dict[str, dict[str, object]] = {"1": {}, "2": {}}
    for n, who, x, y in walk(sample_s):
        at = {"name": "00001", "isActive": True, "position": {"x": x, "y": y, "z": 0.0}}
        people[str(who)][f"{sample_s * n:.2f}"] = at
    return json.dumps(people, indent=1).encode()


def columns() -> bytes:
    n, who, x, y = zip(*walk(0.04), strict=True)
    return json.dumps({"fps": 25, "frame": n, "id": who, "x": x, "y": y}).encode()


def frames_of_json() -> bytes:
    samples = list(walk(0.4))
    return json.dumps(
        [
            {
                "t": 0.4 * k,
                "agents": [{"id": w, "x": x, "y": y} for n, w, x, y in samples if n == k],
            }
            for k in range(SAMPLES + 3)
        ]
    ).encode()


def xml_of(head: str, frame: str, person: Callable[[int, float, float], str], tail: str) -> bytes:
    made = [head]
    samples = list(walk(0.04))
    for k in range(SAMPLES + 3):
        made.append(frame.format(k))
        made += [person(who, x, y) for n, who, x, y in samples if n == k]
        made.append("</objectlist></frame>" if "objectlist" in frame else "</frame>")
    return "\n".join([*made, tail]).encode()


def jpscore() -> bytes:
    head = '<?xml version="1.0"?><trajectories><header version="0.5.1"><frameRate>25</frameRate></header>'
    person = '<agent ID="{}" x="{}" y="{}" z="0" rA="0.2" rB="0.2"/>'
    return xml_of(head, '<frame ID="{}">', person.format, "</trajectories>")


def boxes() -> bytes:
    def person(who: int, x: float, y: float) -> str:
        return f'<object id="{who}"><box h="90" w="30" xc="{x / 0.04:.2f}" yc="{400 - y / 0.04:.2f}"/></object>'

    return xml_of('<dataset name="ours">', '<frame number="{}"><objectlist>', person, "</dataset>")


def traf() -> bytes:
    samples = list(walk(0.1))
    rows = []
    for k in range(SAMPLES + 3):
        here = [(w, x, y) for n, w, x, y in samples if n == k]
        cells = [f"{x / 0.002:.0f},{4000 - y / 0.002:.0f},20,60,ped{w}" for w, x, y in here]
        rows.append(",".join([str(k), str(len(here) + 1), *cells, "5,5,90,40,car0"]))
    return text(rows)


def feet(x: float, y: float) -> tuple[float, float]:
    """The foot of somebody in a film in which a metre has 25 pixels."""
    return round(x / 0.04 + 400, 2), round(400 - y / 0.04, 2)


def town(n: int, who: int, x: float, y: float) -> str:
    u, v = feet(x, y)
    return f"{who},{n},1,1,{u - 5},{v - 90},{u + 5},{v - 75},{u - 15},{v - 90},{u + 15},{v}"


def challenge(n: int, who: int, x: float, y: float) -> str:
    u, v = feet(x, y)
    return f"{n + 1},{who},{u - 15:.2f},{v - 90:.2f},30,90,1,1,0.9"


CSV = text(lines(plain), "t,id,x,y")
FORMS: dict[str, Form] = {
    "csv": Form("a.csv", CSV),
    "csv by another suffix": Form("a.dat", CSV),
    "csv packed": Form("a.csv.gz", gzip.compress(CSV)),
    "csv with a mark": Form("a.csv", b"\xef\xbb\xbf" + CSV.replace(b"\n", b"\r\n")),
    "csv in UTF-16": Form("a.csv", CSV.decode().encode("utf-16")),
    "csv of a spreadsheet": Form("a.csv", text(excel(semicolons), '"t";"id";"x";"y"')),
    "csv with sep": Form("a.csv", text(excel(semicolons), "sep=;", "T;ID;X;Y")),
    "csv in cm": Form(
        "a.csv",
        text(
            lines(lambda n, who, x, y: f"{who},{400 * n},{100 * y:.1f},{100 * x:.1f}"),
            "# made by hand",
            "personID,t/ms,y/cm,x/cm",
        ),
    ),
    "csv with tabs and an index": Form(
        "a.tsv",
        text(lines(lambda n, who, x, y: f"{n}\t{who}\t{x}\t{y}\tx\t{0.4 * n}"), "\tPed_ID\tPos_X\tPos_Y\tnote\tTime"),
    ),
    "csv with a row of units": Form(
        "a.csv",
        text(
            lines(lambda n, who, x, y: f'{0.4 * n},{who},"{who:05d}",{x},{y},0.1'),
            '"t","id","name","x","y","z"', '"s","","","m","m","m"',
        ),
    ),
    "csv that R writes": Form(
        "a.txt", text(lines(lambda n, who, x, y: f'"{n}" {0.4 * n} {who} {x} {y}'), '"time" "id" "x" "y"')
    ),
    "csv of crowd:it": Form("a.csv", text(lines(plain), "time,pedID,posX,posY")),
    "csv with frames and velocities": Form(
        "a.csv",
        text(
            lines(lambda n, who, x, y: f"{who},{1000 + 10 * n},{x},{y},{1.25 * (who == 1)},{1.25 * (who == 2)}"),
            "ID,Frame,x,y,v_x,v_y",
        ),
    ),
    "viswalk": Form(
        "a.pp",
        text(lines(lambda n, who, x, y: f"{who};{0.4 * n};{x};{y};0"),
             "$VISION", "* File: ours", "$PEDESTRIAN:NO;SIMSEC;COORDCENTX;COORDCENTY;COORDCENTZ"),
    ),
    "vadere": Form(
        "postvis.traj",
        text(lines(lambda n, who, x, y: f"{who} {0.4 * n} {0.4 * n + 0.4} {x} {y} {x} {y} 1"),
             "pedestrianId simTime endTime-PID1 startX-PID1 startY-PID1 endX-PID1 endY-PID1 targetId-PID2"),
    ),
    "petrack": Form(
        "a.txt",
        text(lines(lambda n, who, x, y: f"{who} {94 + n} {100 * x:.3f} {100 * y:.3f} 176", 0.04),
             "# PeTrack project: ours.pet", "# framerate: 25 fps", "# id frame x/cm y/cm z/cm"),
        0.04,
    ),
    "jpsreport": Form(
        "a.txt",
        text(lines(lambda n, who, x, y: f"{who}\t{n}\t{x}\t{y}\t0\t0.2\t0.2\t0\t255", 0.04),
             "#description: ours", "#framerate: 25.00", "#X,Y,Z: the agents coordinates (in metres)",
             "#ID\tFR\tX\tY\tZ\tA\tB\tANGLE\tCOLOR"),
        0.04,
    ),
    "juelich without a header": Form(
        "uo.txt",
        text(lines(lambda n, who, x, y: f"{who} {43 + n} {100 * x:.3f} {100 * y:.3f} 183.02", 0.0625)),
        0.0625,
        {"fps": 16.0},
    ),
    "trajnet": Form("biwi.txt", text(lines(lambda n, who, x, y: f"{780 + 10 * n} {who}.0 {x} {y}"))),
    "social-gan": Form("biwi.txt", text(lines(lambda n, who, x, y: f"{10 * n}.0\t{who}.0\t{x}\t{y}"))),
    "trajnet with commas": Form("b.csv", text(lines(lambda n, who, x, y: f"{10 * n},{who},{x},{y}"))),
    "trajnet++": Form("a.ndjson", text(lines(ndjson), '{"scene": {"id": 0, "p": 1, "s": 0, "e": 9, "fps": 2.5}}')),
    "obsmat": Form("obsmat.txt", text(lines(obsmat))),
    "splines": Form("annotation.vsp", splines(), 0.4, {"scale": 0.05}),
    "stanford": Form("annotations.txt", stanford(), 0.4, {"scale": 0.04}),
    "trajnet to be predicted": Form(
        "biwi.txt", text([*lines(lambda n, who, x, y: f"{10 * n} {who} {x} {y}"), "999 1 ? ?"])
    ),
    "grand central": Form(
        "000001.txt",
        text(str(v) for n in range(SAMPLES) for v in (400 + 10 * n, 100, 10 * n)),
        0.4,
        {"scale": 0.05},
    ),
    "edinburgh": Form(
        "tracks.txt",
        text(
            [
                f"TRACK.R{who}=[" + ";".join(f"[{round(50 * x + 99)} {round(400 - 50 * y)} {n}]"
                for n, w, x, y in walk(1 / 9) if w == who) + "];"
                for who in (1, 2)
            ],
            "% Total number of trajectories in file are 2", "Properties.R1=[53 4471 4523 ];",
        ),
        1 / 9,
        {"scale": 0.02},
    ),
    "citr": Form(
        "p1.csv",
        text(lines(lambda n, who, x, y: f"{101 + n},{who},{x:.9f},{y:.9f},ped", 1001 / 30000),
             "frame,id,x,y,type") + b"101,9,0,0,veh\n",
        1001 / 30000,
    ),
    "json": Form("a.json", json.dumps([json.loads(row) for row in lines(as_record)]).encode()),
    "json in lines": Form("a.jsonl", text(lines(as_record))),
    "json of columns": Form("a.json", columns(), 0.04),
    "json of frames": Form("a.json", frames_of_json()),
    "pathfinder json": Form("pathfinder.json", pathfinder()),
    "jpscore": Form("trajectories.xml", jpscore(), 0.04),
    "boxes": Form("gt.xml", boxes(), 0.04, {"scale": 0.04, "fps": 25.0}),
    "town centre": Form("top.csv", text(lines(town, 0.04)), 0.04, {"scale": 0.04}),
    "motchallenge": Form("gt.txt", text(lines(challenge, 0.04)), 0.04, {"scale": 0.04, "fps": 25.0}),
    "kitti": Form(
        "0000.txt",
        text(
            [*lines(lambda n, who, x, y: f"{n} {who} Pedestrian 0 0 -1.8 297 162 455 292 1.8 0.6 0.6 {x:.6f} 1.9 {y:.6f} -2.1", 0.1),
             "0 -1 DontCare -1 -1 -10 219 188 245 218 -1000 -1000 -1000 -10 -1 -1 -1"]
        ),
        0.1,
    ),
    "traf": Form("TRAF11_gt.txt", traf(), 0.1, {"scale": 0.002}),
    "atc": Form(
        "atc-20121024.csv",
        text(lines(lambda n, who, x, y: f"{1351040428 + 0.4 * n:.3f},{who},{1000 * x:.1f},{1000 * y:.1f},1700.5,1250.0,0.1,0.2")),
    ),
    "cff": Form(
        "al_position.csv",
        text(lines(lambda n, who, x, y: f"2012-09-18T06:25:{int(0.4 * n):02d}:{round(400 * n) % 1000:03d};PIE;{1000 * x:.0f};{1000 * y:.0f};{who}")),
    ),
    "csv below lines about the experiment": Form(
        "a.csv", text(lines(plain), "Experiment,Corridor 3", "Date,2013-06-19", "", "t,id,x,y")
    ),
    "csv with its header repeated": Form("a.csv", text([*lines(plain)[:9], "t,id,x,y", *lines(plain)[9:]], "t,id,x,y")),
    "csv with times of day": Form(
        "a.csv",
        text(lines(lambda n, who, x, y: f"{'23:59:' if n < 5 else '00:00:'}{(58 + 0.4 * n) % 60:06.3f},{who},{x},{y}"), "time,id,x,y"),
    ),
    "csv with milliseconds since 1970": Form(
        "a.csv", text(lines(lambda n, who, x, y: f"{1700000000000 + 400 * n},{who},{x},{y}"), "timestamp,id,x,y")
    ),
    "csv with y up": Form("a.csv", text(lines(lambda n, who, x, y: f"{0.4 * n:.1f},{who},{x},0.0,{y}"), "t,id,x,y,z")),
    "csv with people unseen": Form(
        "a.csv", text([*lines(plain), "9.9,1,,", "9.9,2,NaN,NaN"], "t,id,x,y")
    ),
    "csv as a table of markdown": Form(
        "a.md", text(lines(lambda n, who, x, y: f"| {0.4 * n:.1f} | {who} | {x} | {y} |"), "| t | id | x | y |", "|---|---|---|---|")
    ),
    "csv with a minus of print": Form(
        "a.csv", text(lines(lambda n, who, x, y: f"{0.4 * n:.1f},{who},\N{MINUS SIGN}{x},{y}"), "t,id,x,y")
    ),
    "csv of 25 Hz": Form(
        "a.txt", text(lines(lambda n, who, x, y: f"{n},{who},{x},{y}", 0.04), "# sampling frequency: 25 Hz", "frame,id,x,y"), 0.04
    ),
    "csv in cm with velocities in cm": Form(
        "a.csv",
        text(
            lines(lambda n, who, x, y: f"{n},{who},{100 * x:.2f},{100 * y:.2f},{125 * (who == 1)},{125 * (who == 2)}", 0.04),
            "frame,id,x/cm,y/cm,vx,vy",
        ),
        0.04,
    ),
    "csv with columns named by hand": Form(
        "a.csv",
        text(lines(lambda n, who, x, y: f"{100 * y:.1f};{who};{100 * x:.1f};{400 * n}"), "Hoch;Wer;Rechts;Zeit"),
        0.4,
        {"columns": "t=Zeit/ms,id=Wer,x=Rechts/cm,y=Hoch/cm"},
    ),
    "numbers with columns named by hand": Form(
        "a.txt", text(lines(lambda n, who, x, y: f"7 {y} {x} {who} {n}", 0.04)), 0.04,
        {"columns": ",y,x,id,frame", "fps": 25.0},
    ),
    "rate with a decimal comma": Form(
        "a.txt", text(lines(lambda n, who, x, y: f"{who} {n} {x} {y} 1.7", 0.08), "# framerate: 12,5 fps", "# id frame x/m y/m z/m"), 0.08
    ),
    "rate as a fraction": Form(
        "a.csv", text(lines(lambda n, who, x, y: f"{n},{who},{x},{y}", 1001 / 30000), "# frame rate = 30000/1001", "frame,id,x,y"), 1001 / 30000
    ),
    "rate by an interval of frames": Form(
        "a.csv", text(lines(lambda n, who, x, y: f"{n},{who},{x},{y}", 0.1), "# frame interval: 100 ms", "frame,id,x,y"), 0.1
    ),
    "rate of samples": Form(
        "a.csv", text(lines(lambda n, who, x, y: f"{10 * n},{who},{x},{y}"), "# sampling rate: 2.5 Hz", "frame,id,x,y")
    ),
    "petrack with units apart": Form(
        "a.txt",
        text(lines(lambda n, who, x, y: f"{who} {n} {100 * x:.2f} {100 * y:.2f} 0", 0.04), "# framerate: 25", "# id frame x [cm] y [cm] z [cm]"),
        0.04,
    ),
    "units in a comment of their own": Form(
        "a.txt",
        text(lines(lambda n, who, x, y: f"{who} {n} {10 * x:.3f} {10 * y:.3f} 0", 0.04), "# framerate_hz=25", "# id frame x y z", "# - - dm dm dm"),
        0.04,
    ),
    "header with units apart": Form(
        "a.txt", text(lines(lambda n, who, x, y: f"{0.4 * n:.1f}   {who}   {100 * x:.1f}   {100 * y:.1f}"), "t [s]   id   x [cm]   y [cm]")
    ),
    "header divided otherwise": Form("a.txt", text(lines(lambda n, who, x, y: f"{0.4 * n:.1f} {who} {x} {y}"), "t,id,x,y")),
    "quoted decimal commas": Form(
        "a.csv", text([f'"{line}"'.replace(";", '","') for line in excel(semicolons)], '"t","id","x","y"')
    ),
    "thousands with points": Form(
        "a.csv",
        text(
            lines(lambda n, who, x, y: f"{0.4 * n:.1f};{who};{1000 * x:,.1f};{1000 * y:,.1f}".translate(str.maketrans(",.", ".,"))),
            "t;id;x/mm;y/mm",
        ),
    ),
    "yards": Form("a.csv", text(lines(lambda n, who, x, y: f"{0.4 * n:.1f},{who},{x / 0.9144},{y / 0.9144}"), "t,id,x [yd],y [yd]")),
    "inches": Form("a.csv", text(lines(lambda n, who, x, y: f"{0.4 * n:.1f},{who},{x / 0.0254},{y / 0.0254}"), "t,id,x (in),y (in)")),
    "easting and northing": Form(
        "a.csv", text(lines(lambda n, who, x, y: f"{0.4 * n:.1f},{who},{x + 367000.5},{y + 5620000.25}"), "t,id,easting,northing")
    ),
    "frames from a million": Form("a.txt", text(lines(lambda n, who, x, y: f"{1_000_000 + 10 * n} {who} {x} {y}"))),
    "obsmat with y before z": Form(
        "obsmat.txt", text(lines(lambda n, who, x, y: f"{10 * n} {who} {x} {y} 0 {SPEED_MPS * (who == 1)} {SPEED_MPS * (who == 2)} 0"))
    ),
    "juelich of eight columns": Form(
        "a.txt", text(lines(lambda n, who, x, y: f"{who} {n} {x} {y} 1.7 0.2 0.2 12", 0.04)), 0.04, {"fps": 25.0}
    ),
    "csv in UTF-32": Form("a.csv", CSV.decode().encode("utf-32-le")),
    "json with its unit": Form(
        "a.json",
        json.dumps({"FPS": 25, "units": {"position": "cm"}, "samples": [{"frame": n, "id": w, "x": 100 * x, "y": 100 * y} for n, w, x, y in walk(0.04)]}).encode(),
        0.04,
    ),
    "jpscore in UTF-16": Form("trajectories.xml", jpscore().decode().replace('"1.0"?', '"1.0" encoding="UTF-16"?').encode("utf-16"), 0.04),
    "jupedsim": Form("trajectory.sqlite", jupedsim(), 0.04),
    "jupedsim packed": Form("trajectory.sqlite.gz", gzip.compress(jupedsim()), 0.04),
}  # fmt: skip
