#!/usr/bin/env python3
"""Files between voronaut and other programs, both ways: vertices, triangles, labelled edges and labels are counted on both sides.

Set up: `python3 -m venv io && io/bin/pip install meshio gmsh mmgpy`, and bamg from Debian's freefem++ (`ffbamg`). Programs that
are not there are passed over, and said so.

    io/bin/python scripts/interoperate.py [--voronaut target/release/voronaut] [--mmg DIR_OF_mmg2d_O3] [--bamg ffbamg]

"ours" rows: `voronaut convert` writes a file, the other program reads it. "theirs" rows: the other program writes one, `voronaut
convert` makes a .mesh of it. Counts are of vertices, triangles, edges, and of labels as a table of how many elements have each; a
label that a format or a reader has no place for is left out of both sides. A row ends with `same` or with what differs. Exit 1 if
anything does.
"""

import argparse
import collections
import contextlib
import io
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What each format keeps, as other programs read it: labels of triangles, edges, labels of edges.
KEEPS = {"mesh": (1, 1, 1), "meshb": (1, 1, 1), "msh": (1, 1, 1), "vtu": (1, 1, 1), "vtp": (1, 1, 1), "obj": (0, 0, 0),
         "off": (0, 0, 0), "ply": (0, 0, 0), "stl": (0, 0, 0)}
failed = 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--voronaut", default=str(ROOT / "target/release/voronaut"))
    parser.add_argument("--mmg", default=Path(shutil.which("mmg2d_O3") or "").parent, type=Path)
    parser.add_argument("--bamg", default=shutil.which("ffbamg") or shutil.which("bamg"))
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as directory:
        place = Path(directory)
        inputs = make_inputs(args, place)
        for name, mesh in inputs.items():
            with_meshio(args, place, name, mesh)
            with_gmsh(args, place, name, mesh)
            with_mmg(args, place, name, mesh)
        from_gmsh(args, place)
        curved(args, place)
        from_bamg(args, place)
    sys.exit(1 if failed else 0)


def make_inputs(args, place):
    """A planar mesh with two regions and four boundary labels, and a surface with sixteen patches."""
    (place / "two.poly").write_text(
        "6 2 0 1\n1 0 0 1\n2 1 0 0\n3 2 0 2\n4 2 1 3\n5 1 1 0\n6 0 1 4\n7 1\n1 1 2 1\n2 2 3 1\n3 3 4 2\n4 4 5 3\n5 5 6 3\n"
        "6 6 1 4\n7 2 5 9\n0\n2\n1 0.5 0.5 5\n2 1.5 0.5 6\n")
    run(args.voronaut, "mesh", place / "two.poly", "--metric", "uniform", "-n", "300", "-o", place / "plane.mesh", "-q")
    part = ROOT / "data/parts/bracket_cad.mesh"
    run(args.voronaut, "mesh", part, "--metric", "uniform", "-n", "800", "-o", place / "part.mesh", "-q")
    return {name: place / f"{name}.mesh" for name in ("plane", "part")}


def counts_of_mesh(file):
    """Vertices, and label by label the triangles and edges of a Medit text."""
    words = iter(Path(file).read_text().split())
    found = {"vertices": 0, "triangles": collections.Counter(), "edges": collections.Counter()}
    dimension = 3
    for word in words:
        if word == "Dimension":
            dimension = int(next(words))
        elif word in ("Vertices", "Triangles", "Edges"):
            width = {"Vertices": dimension, "Triangles": 3, "Edges": 2}[word]
            for _ in range(int(next(words))):
                row = [next(words) for _ in range(width + 1)]
                if word == "Vertices":
                    found["vertices"] += 1
                else:
                    found[word.lower()][int(row[-1])] += 1
    return found


def counts_of_meshio(file):
    import meshio
    with contextlib.redirect_stdout(io.StringIO()):
        mesh = meshio.read(file)
    found = {"vertices": len(mesh.points), "triangles": collections.Counter(), "edges": collections.Counter()}
    names = [name for name in ("medit:ref", "gmsh:physical", "label") if name in mesh.cell_data]
    for i, block in enumerate(mesh.cells):
        kind = {"triangle": "triangles", "line": "edges"}.get(block.type)
        if kind:
            labels = mesh.cell_data[names[0]][i] if names else [0] * len(block.data)
            found[kind].update(int(label) for label in labels)
    return found


def counts_of_gmsh(file):
    import gmsh
    gmsh.clear()
    gmsh.open(str(file))
    found = {"vertices": len(gmsh.model.mesh.getNodes()[0])}
    for dimension, kind, key in ((2, 2, "triangles"), (1, 1, "edges")):
        found[key] = collections.Counter()
        for _, tag in gmsh.model.getEntities(dimension):
            types, elements, _ = gmsh.model.mesh.getElements(dimension, tag)
            number = sum(len(e) for t, e in zip(types, elements) if t == kind)
            physical = gmsh.model.getPhysicalGroupsForEntity(dimension, tag)
            found[key][int(physical[0]) if len(physical) else tag] += number
    return found


def compare(title, expected, found, keeps):
    """A row: counts, and of labels how many elements have how many; names of labels may differ between programs."""
    global failed
    labels, edges, edge_labels = keeps
    wrong = []
    if expected["vertices"] != found["vertices"]:
        wrong.append(f"vertices {expected['vertices']} {found['vertices']}")
    for key, kept, labelled in (("triangles", 1, labels), ("edges", edges, edge_labels)):
        if kept and expected[key].total() != found[key].total():
            wrong.append(f"{key} {expected[key].total()} {found[key].total()}")
        # Formats that do not keep 0 or negative labels number such elements in their own way: compare how many have each label.
        named = all(isinstance(label, int) and label > 0 for label in [*expected[key], *found[key]])
        same = expected[key] == found[key] if named else sorted(expected[key].values()) == sorted(found[key].values())
        if labelled and not same:
            wrong.append(f"labels of {key} {dict(expected[key])} {dict(found[key])}")
    failed += bool(wrong)
    line = [found["vertices"], found["triangles"].total(), len(found["triangles"]), found["edges"].total(), len(found["edges"])]
    print(title.ljust(44), *(str(x).rjust(6) for x in line), " ", "; ".join(wrong) or "same", flush=True)


def with_meshio(args, place, name, mesh):
    try:
        import meshio
    except ImportError:
        return print("meshio is not there")
    truth = counts_of_mesh(mesh)
    for ending in ("mesh", "meshb", "msh", "vtu", "obj", "off", "ply", "stl"):
        ours = convert(args, mesh, place / f"{name}_ours.{ending}")
        keeps = (1, 0, 0) if ending == "obj" else KEEPS[ending]
        found = counts_of_meshio(ours)
        if ending == "obj":
            found["triangles"] = groups_of_obj(ours)
        compare(f"{name}: ours -> meshio .{ending}", truth, found, keeps)
    with contextlib.redirect_stdout(io.StringIO()):
        held = meshio.read(convert(args, mesh, place / f"{name}_ours.vtu"))
    labels = held.cell_data["label"]
    held.point_data = {}
    forms = [("mesh", "medit", {}), ("meshb", "medit", {}), ("msh", "gmsh22", {"binary": False}), ("msh", "gmsh22", {"binary": True}),
             ("msh", "gmsh", {"binary": False}), ("msh", "gmsh", {"binary": True}), ("vtu", "vtu", {"binary": False}),
             ("vtu", "vtu", {"binary": True, "compression": "zlib"}), ("vtu", "vtu", {"binary": True, "compression": None}),
             ("obj", "obj", {}), ("off", "off", {}), ("ply", "ply", {"binary": False}), ("ply", "ply", {"binary": True}),
             ("stl", "stl", {"binary": False}), ("stl", "stl", {"binary": True})]
    for ending, form, options in forms:
        file = place / f"{name}_meshio.{ending}"
        # meshio cannot write other data of numpy 2 as text in .msh.
        names = {"medit": ["medit:ref"], "gmsh": ["gmsh:physical", "gmsh:geometrical"], "gmsh22": ["gmsh:physical", "gmsh:geometrical"]}
        held.cell_data = {name: labels for name in names.get(form, ["label"])}
        cells = held if KEEPS[ending][1] else meshio.Mesh(held.points, [c for c in held.cells if c.type == "triangle"])
        words = " ".join(f"{key}={value}" for key, value in options.items())
        title = f"{name}: meshio {form} {words} -> ours"
        try:
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                meshio.write(file, cells, file_format=form, **options)
        except Exception as error:
            print(title, "meshio cannot:", error)
            continue
        compare(title, truth, taken(args, file), KEEPS[ending])


def groups_of_obj(file):
    """meshio keeps a block of cells for each group, but no names."""
    found, group = collections.Counter(), None
    for line in Path(file).read_text().splitlines():
        if line.startswith("g "):
            group = line[2:]
        found[group] += line.startswith("f ")
    return collections.Counter({name: count for name, count in found.items() if count})


def with_gmsh(args, place, name, mesh):
    try:
        import gmsh
    except (ImportError, OSError) as error:
        return print("gmsh is not there:", error)
    if not gmsh.isInitialized():
        gmsh.initialize()
        gmsh.option.setNumber("General.Verbosity", 0)
    truth = counts_of_mesh(mesh)
    for ending in ("mesh", "msh", "obj", "off", "stl"):
        ours = convert(args, mesh, place / f"{name}_ours.{ending}")
        compare(f"{name}: ours -> gmsh .{ending}", truth, counts_of_gmsh(ours), KEEPS[ending])
    gmsh.clear()
    gmsh.open(str(convert(args, mesh, place / f"{name}_ours.msh")))
    for version in (2.2, 4.1):
        for binary in (0, 1):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            file = place / f"{name}_gmsh.msh"
            gmsh.write(str(file))
            compare(f"{name}: gmsh {version} binary={binary} -> ours", truth, taken(args, file), KEEPS["msh"])


def from_gmsh(args, place):
    """A plate with a hole, two regions and named groups, meshed by gmsh itself."""
    try:
        import gmsh
    except (ImportError, OSError):
        return
    gmsh.clear()
    model = gmsh.model
    plate = model.occ.addRectangle(0, 0, 0, 2, 1)
    disk = model.occ.addDisk(0.5, 0.5, 0, 0.2, 0.2)
    model.occ.fragment([(2, plate)], [(2, disk)])
    model.occ.synchronize()
    for i, (_, tag) in enumerate(model.getEntities(2)):
        model.addPhysicalGroup(2, [tag], 20 + i, name=f"region {i}")
    for i, (_, tag) in enumerate(model.getEntities(1)):
        model.addPhysicalGroup(1, [tag], 10 + i)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.1)
    model.mesh.generate(2)
    for ending in ("msh 2.2 0", "msh 2.2 1", "msh 4.1 0", "msh 4.1 1", "mesh", "stl"):
        ending, version, binary = (ending.split() + ["4.1", "0"])[:3]
        gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
        gmsh.option.setNumber("Mesh.Binary", int(binary))
        file = place / f"plate.{ending}"
        gmsh.write(str(file))
        truth = counts_of_gmsh_model()
        compare(f"plate: gmsh .{ending} {version} binary={binary} -> ours", truth, taken(args, file), KEEPS[ending])


def counts_of_gmsh_model():
    """Of the elements in the open model, by physical group."""
    import gmsh
    found = {"triangles": collections.Counter(), "edges": collections.Counter()}
    nodes = set()
    for dimension, key in ((2, "triangles"), (1, "edges")):
        for _, tag in gmsh.model.getEntities(dimension):
            _, elements, of_nodes = gmsh.model.mesh.getElements(dimension, tag)
            physical = gmsh.model.getPhysicalGroupsForEntity(dimension, tag)
            found[key][int(physical[0])] += sum(len(e) for e in elements)
            nodes.update(int(n) for some in of_nodes for n in some)
    return {"vertices": len(nodes), **found}


def with_mmg(args, place, name, mesh):
    program = args.mmg / ("mmg2d_O3" if name == "plane" else "mmgs_O3")
    if not program.is_file():
        return print(f"{program.name} is not there")
    for ending in ("mesh", "meshb", "msh"):
        # mmg 5.8 reads version 2.2 only.
        ours = convert(args, mesh, place / f"{name}_ours.{ending}", *(["--msh-version", "2.2"] if ending == "msh" else []))
        said = run(program, "-v", "5", ours, "-out", place / f"{name}_mmg.{ending}")
        lines = [line for line in said.splitlines() if "NUMBER OF" in line][:3]
        numbers = {words[2].lower(): int(words[3]) for words in map(str.split, lines) if words[3].isdigit()}
        truth = counts_of_mesh(mesh)
        read = {"vertices": numbers.get("vertices", -1),
                "triangles": collections.Counter({0: numbers.get("triangles", -1)}), "edges": collections.Counter()}
        compare(f"{name}: ours -> {program.name} .{ending}", truth, read, (0, 0, 0))
        written = place / f"{name}_mmg.{ending}"
        numbers = [line.split() for line in said.splitlines() if "NUMBER OF" in line][-4:]
        numbers = {words[2].lower(): int(words[3]) for words in numbers if words[3].isdigit()}
        truth = {"vertices": numbers["vertices"], "triangles": collections.Counter({0: numbers["triangles"]}),
                 "edges": collections.Counter({0: numbers.get("edges", 0)})}
        compare(f"{name}: {program.name} .{ending} -> ours", truth, taken(args, written), (0, 0, 0))
        values = written.with_suffix(".sol")
        if values.is_file():
            run(args.voronaut, "convert", values, place / "again.solb", "-q")


def curved(args, place):
    """Disks of order 2 and 3, by gmsh: what voronaut makes of them is read back with the same nodes in the same order."""
    try:
        import gmsh
    except (ImportError, OSError):
        return
    for order in (2, 3):
        gmsh.clear()
        gmsh.model.occ.addDisk(0, 0, 0, 2, 1)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        truth = nodes_of_gmsh()
        for name, version, binary in [(f"{v} binary={b}", v, b) for v in (2.2, 4.1) for b in (0, 1)] + [("mesh", 4.1, 0)]:
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            file = place / ("curved.mesh" if name == "mesh" else f"curved{version}{binary}.msh")
            gmsh.write(str(file))
            through(args, place, f"order {order}: gmsh {name}", file, truth)


def through(args, place, title, file, truth):
    """Converts a file to every format with curves, and compares what others read there; a row with how often that was the same."""
    compared, wrong = 0, failed
    for ending, options in [("msh", ()), ("msh", ("--binary",)), ("msh", ("--msh-version", "2.2")),
                            ("msh", ("--msh-version", "2.2", "--binary")), ("mesh", ()), ("meshb", ()), ("vtu", ())]:
        out = place / f"curved_ours.{ending}"
        run(args.voronaut, "convert", file, out, "-q", *options)
        again = place / "curved_again.msh"
        run(args.voronaut, "convert", out, again, "-q")
        words = " ".join([ending, *options])
        compared += compare_nodes(f"{title} -> ours .{words} -> gmsh", truth, again, nodes_in_gmsh)
        for program, read, endings in [("gmsh", nodes_in_gmsh, ("msh", "mesh")), ("meshio", nodes_in_meshio, ("msh", "vtu")),
                                       ("VTK", nodes_in_vtk, ("vtu",))]:
            if ending in endings:
                compared += compare_nodes(f"{title} -> {program} .{words}", truth, out, read)
    print(title.ljust(44), {kind: len(elements) for kind, elements in truth.items()}, f"{compared - failed + wrong} of {compared} same", flush=True)


def compare_nodes(title, truth, file, read):
    """Elements by the places of their nodes, in order; text of some programs is rounded."""
    global failed
    try:
        found = read(file)
    except ImportError:
        return 0
    kinds = {kind: len(elements) for kind, elements in found.items()}
    off = max((abs(x - y) for kind in truth for a, b in zip(truth[kind], found.get(kind, [])) for p, q in zip(a, b)
               for x, y in zip(p, q)), default=0)
    same = kinds == {kind: len(elements) for kind, elements in truth.items()} and off < 1e-10
    failed += not same
    if not same:
        print(title.ljust(64), kinds, f"nodes differ by {off:.3g}", flush=True)
    return 1


def in_order(elements):
    """Of each kind, by how many nodes there are, the elements in the order of their places."""
    found = collections.defaultdict(list)
    for element in elements:
        found[len(element)].append([tuple(map(float, p)) for p in element])
    # Places of the corners differ by more than rounding.
    return {kind: sorted(all, key=lambda e: [[round(x, 6) + 0.0 for x in p] for p in e]) for kind, all in found.items()}


def nodes_in_gmsh(file):
    import gmsh
    own = gmsh.model.getCurrent()
    gmsh.model.add("read")
    gmsh.merge(str(file))
    found = nodes_of_gmsh()
    gmsh.model.remove()
    gmsh.model.setCurrent(own)
    return found


def nodes_of_gmsh():
    """Of the open model, lines and triangles of any order."""
    import gmsh
    tags, places, _ = gmsh.model.mesh.getNodes()
    at = dict(zip(tags.tolist(), places.reshape(-1, 3).tolist()))
    elements = []
    for dimension in (1, 2):
        for kind, _, nodes in zip(*gmsh.model.mesh.getElements(dimension)):
            count = gmsh.model.mesh.getElementProperties(kind)[3]
            elements += [[at[node] for node in element] for element in nodes.reshape(-1, count).tolist()]
    return in_order(elements)


def nodes_in_meshio(file):
    import meshio
    with contextlib.redirect_stdout(io.StringIO()):
        mesh = meshio.read(file)
    kinds = {"line3", "triangle6", "line4", "triangle10", "VTK_LAGRANGE_CURVE", "VTK_LAGRANGE_TRIANGLE"}
    cells = [block for block in mesh.cells if block.type in kinds]
    places = [[*p, 0.0][:3] for p in mesh.points.tolist()]
    return in_order([places[node] for node in element] for block in cells for element in block.data.tolist())


def nodes_in_vtk(file):
    import vtk
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    kinds = {21, 22, 68, 69}
    elements = []
    for i in range(grid.GetNumberOfCells()):
        if grid.GetCellType(i) in kinds:
            cell = grid.GetCell(i)
            elements.append([grid.GetPoint(cell.GetPointId(k)) for k in range(cell.GetNumberOfPoints())])
    return in_order(elements)


def from_bamg(args, place):
    if not args.bamg:
        return print("bamg is not there")
    (place / "bamg_in.mesh").write_text(
        "MeshVersionFormatted 0\nDimension 2\nVertices 4\n0 0 1\n1 0 2\n1 1 3\n0 1 4\nEdges 4\n1 2 1\n2 3 2\n3 4 3\n4 1 4\n")
    run(args.bamg, "-g", place / "bamg_in.mesh", "-o", place / "bamg.mesh", "-hmax", "0.1")
    truth = counts_of_mesh(place / "bamg.mesh")
    compare("square: bamg .mesh -> ours", truth, taken(args, place / "bamg.mesh"), KEEPS["mesh"])


def convert(args, mesh, out, *options):
    if out.suffix == ".mesh":
        shutil.copy(mesh, out)
    else:
        run(args.voronaut, "convert", mesh, out, "-q", *options)
    return out


def taken(args, file):
    """What voronaut reads of a file, by way of a .mesh."""
    out = file.with_name("taken.mesh")
    out.unlink(missing_ok=True)
    run(args.voronaut, "convert", file, out, "-q")
    return counts_of_mesh(out)


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode:
        print(*words, "failed:", done.stderr or done.stdout, file=sys.stderr)
        sys.exit(1)
    return done.stdout


if __name__ == "__main__":
    main()
