"""Files made to do harm: what strangers may send as cases and as files of a run."""

import struct
import zlib

MATERIAL = '[materials.a]\nlaw = "elastic"\ndensity = "7850 kg/m^3"\nyoung_modulus = "200 GPa"\npoisson_ratio = 0.3\n'
RUN = '[run]\nend_time = "20 us"\n'
CASE = RUN + MATERIAL + """
[bodies.block]
material = "a"
velocity = ["0 m/s", "-10 m/s"]
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], element_size = "1 cm" }
[obstacles.stop]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
[output]
fields_every = "10 us"
"""


def body(name="block", size="1 cm", mesh=None, at="0 m"):
    mesh = mesh or f'shape = "rectangle", size = ["4 cm", "2 cm"], at = ["{at}", "0 m"], element_size = "{size}"'
    return f'[bodies.{name}]\nmaterial = "a"\nmesh = {{ {mesh} }}\n'


def with_mesh(shape, size, more=""):
    """A case of one body whose mesh has elements of this size."""
    return RUN + MATERIAL + body(mesh=f'shape = {shape}, element_size = "{size}"{more}')


SQUARE = '"rectangle", size = ["1 m", "1 m"]'
SHORT_OF_MEMORY = "of memory at least"


def vtu(points, cells, arrays, data=b"", appended="_"):
    """A frame whose header says what it likes."""
    text = ('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64" '
            'compressor="vtkZLibDataCompressor">\n<UnstructuredGrid>\n'
            f'<Piece NumberOfPoints="{points}" NumberOfCells="{cells}">\n{arrays}</Piece></UnstructuredGrid>\n'
            f'<AppendedData encoding="raw">{appended}')
    return text.encode() + data


def array(name, kind="Float64", offset=0, components=3):
    return f'<DataArray Name="{name}" type="{kind}" NumberOfComponents="{components}" format="appended" offset="{offset}"/>\n'


def points(offset=0):
    return "<Points>\n" + array("Points", offset=offset) + "</Points>\n"


def blocks(*sizes, block=1 << 15, last=0, packed=b""):
    return struct.pack(f"<{3 + len(sizes)}Q", len(sizes), block, last, *sizes) + packed


def pvd(*entries):
    return ('<?xml version="1.0"?>\n<VTKFile type="Collection"><Collection>\n' +
            "".join(f'<DataSet timestep="{time}" part="0" file="{name}"/>\n' for time, name in entries) +
            "</Collection></VTKFile>\n").encode()


bomb = zlib.compress(bytes(1 << 29), 9)

# What a case file may try. The words are a part of the message that must come.
CASES = {
    "nanometre elements": (with_mesh('"rectangle", size = ["4 cm", "2 cm"]', "1 nm"), "far too many elements"),
    "a billion elements": (with_mesh(SQUARE, "33 um"), SHORT_OF_MEMORY),
    "a billion in a disc": (with_mesh('"disc", radius = "1 m"', "60 um"), SHORT_OF_MEMORY),
    "a billion in a ring": (with_mesh('"ring", outer_radius = "2 m", inner_radius = "1 m"', "0.15 mm"), SHORT_OF_MEMORY),
    "a long thin ring": (with_mesh('"ring", outer_radius = "100000.001 km", inner_radius = "100000 km"', "1 m"),
                         SHORT_OF_MEMORY),
    "fine along a side": (with_mesh(SQUARE, "10 cm", ', finest_size = "0.1 um", finest_side = "top"'), SHORT_OF_MEMORY),
    "fine in a wide place": (with_mesh(SQUARE, "10 cm", ', finest_size = "40 um", finest_at = ["0.5 m", "0.5 m"], '
                                                        'finest_within = "1 m"'), SHORT_OF_MEMORY),
    "many bodies": (RUN + MATERIAL + "".join(body(f"b{k}", size="0.05 mm", at=f"{k} m") for k in range(30)),
                    SHORT_OF_MEMORY),
    "many obstacles": (with_mesh('"rectangle", size = ["1 m", "20 um"]', "20 um") +
                       "".join(f'[obstacles.o{k}]\nshape = "circle"\ncentre = ["0 m", "-9 m"]\nradius = "1 m"\n'
                               for k in range(9000)), SHORT_OF_MEMORY),
    "infinite time": (CASE.replace('"20 us"', '"1e400 s"'), "too large"),
    "nan": (CASE.replace('"20 us"', '"nan s"'), "unreadable"),
    "nested lists": ("a = " + "[" * 400000 + "]" * 400000, "nested"),
    "nested tables": ("a = " + "{a=" * 200000 + "1" + "}" * 200000, "nested"),
    "a key of many parts": (".".join("a" * 400000) + " = 1", "too many parts"),
    "a long line": ('a = "' + "x" * 1000000 + '"', "unknown key"),
    "a long name": (f'[bodies.{"a" * 900000}]\n', "impossible name"),
    "a list of a million": ("[output]\nfields_at = [" + "1," * 500000 + "]\n", ""),
    "too large": ("#" * (1 << 21), "too large"),
    "a hundred thousand keys": ("".join(f"k{k} = 1\n" for k in range(90000)), "unknown key"),
    "ten thousand bodies": (RUN + MATERIAL + "".join(f"[bodies.b{k}]\n" for k in range(30000)), "missing"),
    "many supports of rigid bodies": (RUN + MATERIAL + "".join(
        f'[bodies.b{k}]\nrigid = true\n[supports.s{k}]\nbody = "b{k}"\n' for k in range(12000)), "missing"),
    "the same key again": ("[run]\n" * 100000, "given twice"),
    "zero bytes": (CASE.encode()[:300] + b"\0" + CASE.encode()[300:], "binary"),
    "broken UTF-8": (CASE.encode() + b'x = "\xff\xfe\xc0\xaf"\n', "UTF-8"),
    "UTF-16": (CASE.encode("utf-16"), "UTF-16"),
    "signs that turn text": (CASE + 'x\u202e = "\u202e"\n', ""),
    "terminal commands": (CASE + '"\\u001b[2J" = 1\n', "unknown key"),
    "nothing": ("", "missing"),
}

# What the files of a run may try: the file, its content, the command that reads it.
FRAME = "fields/bodies_000000.vtu"
PICTURE = ["picture", "run", "--output", "x.svg"]
REPORT = ["report", "run"]
DIFF = ["diff", "run", "whole"]
FILES = {
    "more points than bytes": (FRAME, vtu(10**18, 1, points()), PICTURE),
    "points that overflow": (FRAME, vtu(2**64 - 1, 1, points()), PICTURE),
    "points times nine": (FRAME, vtu(2**61, 0, array("x", components=9)), PICTURE),
    "a bomb": (FRAME, vtu(2**24, 0, points(), blocks(len(bomb), block=1 << 29, packed=bomb)), PICTURE),
    "arrays that share a bomb": (FRAME, vtu(2**20, 0, points() + "<PointData>\n" + array("f") * 200 + "</PointData>\n",
                                            blocks(len(bomb), block=1 << 29, packed=bomb)), REPORT),
    "empty blocks without end": (FRAME, vtu(0, 0, points() + "<PointData>\n" + array("x") * 200 + "</PointData>\n",
                                            blocks(*[8] * 50000, block=0, packed=zlib.compress(b"") * 50000)), REPORT),
    "a block that ends beyond the file": (FRAME, vtu(1, 0, points(), blocks(2**63, block=24)), PICTURE),
    "an offset beyond the file": (FRAME, vtu(1, 0, points(2**63)), PICTURE),
    "a header without end": (FRAME, b"<VTKFile " + b'a="' * 300000, PICTURE),
    "a million tags": (FRAME, b"<a>" * 300000, REPORT),
    "an index that leads out": ("fields.pvd", pvd((0, "../../../../etc/passwd")), PICTURE),
    "an index of absolute paths": ("fields.pvd", pvd((0, "/etc/passwd")), PICTURE),
    "an index of no times": ("fields.pvd", pvd(("nan", FRAME), ("inf", FRAME)), PICTURE),
    "an index that names a folder": ("fields.pvd", pvd((0, "fields")), PICTURE),
    "the same frame many times": ("fields.pvd", pvd(*((k * 1e-9, FRAME) for k in range(15000))), PICTURE),
    "an index that is no text": ("fields.pvd", bytes(range(256)) * 4000, PICTURE),
    "a summary of brackets": ("summary.json", b"[" * 1000000, REPORT),
    "a summary of huge numbers": ("summary.json",
                                  b'{"schema": 1, "elements": 1e308, "steps": -1e400, "threads": 1e99}', REPORT),
    "a summary of wrong kinds": ("summary.json", b'{"schema": 1, "bodies": {"a": [1]}, "contacts": [[[]]]}', DIFF),
    "a history of columns": ("histories/block.csv", b"," * 1000000 + b"\n", DIFF),
    "a history of long lines": ("histories/block.csv", b"time [s],x\n" + b"1" * 1000000 + b",2\n", DIFF),
    "a history of not-a-numbers": ("histories/block.csv", b"time [s],velocity_y [m/s]\n" + b"nan,nan\n" * 1000, DIFF),
    "a log without end": ("log.txt", b"case " * 200000, REPORT),
    "a resolved case that is none": ("resolved.toml", b"[" * 1000000, PICTURE + ["--follow", "block"]),
}
