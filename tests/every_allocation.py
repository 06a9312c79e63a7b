"""For each k, the k-th allocation of a program fails. The program must then end with exit code 1 and one line on
standard error, and change no file. If the allocation was optional, it must write the same files as a normal run.

Usage: every_allocation.py BIN_FOLDER DATA_FOLDER SHIM WORK_FOLDER few | all | NUMBER...
Runs a few small cases, all cases, or the cases with these numbers. failing_malloc.c describes the shim.
"""

import os
import shutil
import subprocess
import sys

# program, arguments, inputs in data/
FEW = [
    ("triangle", "-pq30a0.5e letter", ["letter.poly"]),
    ("ptriangle", "-pq letter --threads 2 --report report.json", ["letter.poly"]),
    ("ptriangle", "-pq30a0.3 section --threads 2 --dry-run", ["section.poly"]),
    ("ptriangle", "-pA section --output x.vtu --output x.msh --output x.2dm --output fort.14", ["section.poly"]),
    ("triangle", "-p letter --size mesh.msh --size-near 1:0.5", ["letter.poly", "lengths:mesh.msh"]),
    ("ptriangle", "-p letter --size raster.asc --size h.npy@0,0,14,14 --threads 2",
     ["letter.poly", "lengths:raster.asc", "lengths:h.npy"]),
    ("trianglecheck", "square.1 --poly square.poly --quiet", ["square.poly", "mesh:square -pq"]),
]
ALL = FEW + [
    ("triangle", "-p letter --min-edge 0.5", ["letter.poly"]),
    ("trianglecheck", "square.1 --poly square.poly --quiet --size 0.3", ["square.poly", "mesh:square -pq"]),
    ("triangle", "letter.node", ["letter.poly", "mesh:letter -p", "rename:letter.1.node:letter.node"]),
    ("triangle", "-pqaAenvgo2 section", ["section.poly"]),
    ("triangle", "-pqDjC letter", ["letter.poly"]),
    ("triangle", "-pqYV gear", ["gear.poly"]),
    ("triangle", "-rpqa0.2 letter.1", ["letter.poly", "mesh:letter -pq"]),
    ("triangle", "-ra letter.1", ["letter.poly", "mesh:letter -pqa1", "areas:letter.1"]),
    ("triangle", "-pc crossing_random", ["nasty/crossing_random.poly"]),
    ("triangle", "-pq36 overlap", ["nasty/overlap.poly"]),
    ("triangle", "duplicates", ["nasty/duplicates.node"]),
    ("ptriangle", "-pq33a0.0005 letter --threads 3 --report report.json --blocks b", ["letter.poly"]),
    ("ptriangle", "-pqa0.0005A section --threads 2 --numbering blocks", ["section.poly"]),
    ("ptriangle", "-pqA borders --max-area 3e9 --threads 3", ["coast/borders.poly"]),
    ("ptriangle", "-rpqa0.0005 letter.1 --threads 2", ["letter.poly", "mesh:letter -pq"]),
    ("trianglecheck", "section.1 --poly section.poly --quiet --min-angle 20", ["section.poly", "mesh:section -pqaA"]),
    ("meshplot", "square.1 -o square.svg", ["square.poly", "mesh:square -pq"]),
] + [("trianglecheck", f"{name} --poly section.poly --quiet", ["section.poly", f"export:section -pqA {name}"])
     for name in ("x.vtu", "x.msh", "x.2dm", "fort.14")] + [
    ("meshplot", "x.vtu -c region -o x.svg", ["section.poly", "export:section -pqA x.vtu"]),
]

LONGEST = 60  # time limit of one run in seconds
MOST, MOST_OF_FEW = 80, 60  # maximum number of runs per case in each mode


LENGTHS = {  # files for --size
    "raster.asc": b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 7\n1 2\n3 1\n",
    "h.npy": b"\x93NUMPY\x01\0\x3f\0" +
             b"{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2), }".ljust(62) + b"\n\1\2\2\1",
    "mesh.msh": b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                b"$Nodes\n3\n7 0 0 0\n9 30 0 0\n2 0 30 0\n$EndNodes\n$Elements\n1\n"
                b"1 2 0 7 9 2\n$EndElements\n$NodeData\n1\n\"h\"\n0\n3\n0\n1\n3\n7 1\n9 2\n2 3\n$EndNodeData\n",
}


def prepare(folder, inputs, bin_folder, data):
    """Makes a fresh folder with the inputs of a case."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for item in inputs:
        kind, _, rest = item.partition(":")
        if kind == "mesh":
            stem, switches = rest.split()
            subprocess.run([f"{bin_folder}/triangle", switches + "Q", stem], cwd=folder, check=True)
        elif kind == "export":
            stem, switches, name = rest.split()
            subprocess.run([f"{bin_folder}/ptriangle", switches + "Q", stem, "--output", name], cwd=folder, check=True)
        elif kind == "lengths":
            with open(f"{folder}/{rest}", "wb") as file:
                file.write(LENGTHS[rest])
        elif kind == "rename":
            old, new = rest.split(":")
            os.rename(f"{folder}/{old}", f"{folder}/{new}")
        elif kind == "areas":
            with open(f"{folder}/{rest}.ele", encoding="ascii") as file:
                n = int(file.readline().split()[0])
            with open(f"{folder}/{rest}.area", "w", encoding="ascii") as file:
                file.write(f"{n}\n" + "".join(f"{i + 1} 0.3\n" for i in range(n)))
        else:
            shutil.copy(f"{data}/{item}", folder)


def contents(folder):
    """Contents of the files. Reports contain times, so only their presence is compared."""
    found = {}
    for name in sorted(os.listdir(folder)):
        with open(f"{folder}/{name}", "rb") as file:
            found[name] = b"" if name.endswith(".json") else file.read()
    return found


def restore(folder, before):
    """Restores the folder to its former contents."""
    for name in os.listdir(folder):
        if name not in before:
            os.remove(f"{folder}/{name}")
    for name, text in before.items():
        with open(f"{folder}/{name}", "rb+") as file:
            if file.read() != text:
                file.seek(0)
                file.truncate()
                file.write(text)


def chosen(n, most):
    """The numbers 1 to n. If n is very large: the first ones, then the same number again, evenly spaced."""
    if n <= most:
        return range(1, n + 1)
    half = most // 2
    return [*range(1, half + 1), *(half + 1 + i * (n - half - 1) // half for i in range(half + 1))]


def run(program, words, folder, variables):
    """Runs the program once. Returns the exit code and both streams."""
    environment = {**os.environ, **variables}
    done = subprocess.run([program, *words], cwd=folder, env=environment, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=LONGEST, check=False)
    return done.returncode, done.stdout, done.stderr.decode(errors="replace")


def judge(code, failure, error, before, after, whole):
    """Describes the fault of a run during which memory was short. An empty text means no fault."""
    if code == 0:
        return "" if after == whole else f"exit code 0, but files differ: {sorted(after)} for {sorted(whole)}"
    if code != failure:
        return f"exit code {code}: {error[-300:]}"
    if after != before:
        return f"exit code {code}, but files were changed: {sorted(set(after) ^ set(before))}"
    lines = [line for line in error.splitlines() if "memory" in line or "annot" in line]
    return "" if len(lines) == 1 and error.count("\n") == 1 else f"no one line: {error!r}"


def needs_memory(program):
    """Does the program use libraries that crash or hang when one of their own allocations fails?"""
    libraries = subprocess.run(["ldd", program], stdout=subprocess.PIPE, check=True).stdout
    return b"libomp" in libraries or b"libcairo" in libraries  # LLVM's OpenMP; cairo for drawing


def try_case(case, most, bin_folder, data, shim, work):
    """Returns the faults found, as texts, and the number of runs."""
    program, words, inputs = case[0], case[1].split(), case[2]
    folder, count = f"{work}/case", f"{work}/count"
    path = f"{bin_folder}/{program}"
    own = {"PTRIANGLE_FAIL_OWN": "1"} if needs_memory(path) else {}
    failure = 2 if program == "trianglecheck" else 1
    prepare(folder, inputs, bin_folder, data)
    before = contents(folder)
    code, _, error = run(path, words, folder, {"LD_PRELOAD": shim, "PTRIANGLE_COUNT": count, **own})
    if code != 0:
        return [f"{program} {case[1]}: does not run: {error}"], 1
    whole = contents(folder)
    with open(count, encoding="ascii") as file:
        n = int(file.read())
    faults, runs = [], 0
    for after in ("0", "1"):
        for k in chosen(n, most):
            restore(folder, before)
            code, _, error = run(path, words, folder, {
                "LD_PRELOAD": shim, "PTRIANGLE_FAIL_AT": str(k), "PTRIANGLE_FAIL_AFTER": after, **own})
            fault = judge(code, failure, error, before, contents(folder), whole)
            runs += 1
            if fault:
                faults.append(f"{program} {case[1]}: allocation {k}{' and all later' if after == '1' else ''}: {fault}")
    return faults, runs


def main():
    bin_folder, data, shim, work = sys.argv[1:5]
    os.makedirs(work, exist_ok=True)
    shutil.copy(shim, f"{work}/failing.so")
    shim = "../failing.so"  # relative to the folder of a case, because LD_PRELOAD splits paths at blanks
    named = {"few": FEW, "all": ALL}
    cases = named.get(sys.argv[5]) or [ALL[int(i)] for i in sys.argv[5:]]
    most = MOST_OF_FEW if cases is FEW else MOST
    faults, runs = [], 0
    for case in cases:
        if os.path.exists(f"{bin_folder}/{case[0]}"):
            found, n = try_case(case, most, bin_folder, data, shim, work)
            print(f"{case[0]} {case[1]}: {n} runs, {len(found)} faults", flush=True)
            faults += found
            runs += n
    for fault in faults[:40]:
        print(fault)
    print(f"every allocation: {runs} runs, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
