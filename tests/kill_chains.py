#!/usr/bin/env python3
"""Kills ranks at random moments and resumes with others: kill_chains.py PROGRAM MPIRUN DATA SEED COUNT.

A chain makes one mesh. Each run has a random number of ranks and resumes from the checkpoint of the run before, until a
run is not killed. A kill hits one rank, several, all by SIGTERM, or the launcher. It happens at any moment, or while
all ranks write files. After each kill all ranks must end with a failure, and files that have their final names must be
correct. Finally the files must equal those of one process, and neither a checkpoint nor a temporary file may be left.
PROGRAM must come from a build with tests, because an environment variable makes blocks small. Exit code: 0 if all
chains succeed."""
import hashlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HANG = 600  # seconds
INPUTS = [  # name, switches, triangles of a block, bound on memory or None
    ("letter", "pq30a0.0005", "500", None),
    ("letter", "pq33a0.001", "500", None),
    ("section", "pq30a0.002", "300", None),
    ("coast/norway_sea", "pq30a4000000", "1000", None),
    ("coast/norway_sea", "pq33a8000000", "1000", None),
    ("square_random1000", "pq33a0.000006", "2000", "400M"),
    ("square_random1000", "pq20a0.0000009", "", "130M"),
    ("square_random1000", "pq33a0.000001", "", "130M"),
]
OUTPUTS = [["{}"], ["{}.h5"], ["{}", "{}.h5"]]  # files that all ranks write: .node, .ele and .poly; HDF5; both
RANKS = [2, 2, 3, 3, 4, 5, 6, 9]
RECORD = 'echo $$ >"pid.${OMPI_COMM_WORLD_RANK:-$PMI_RANK}"; exec "$0" "$@"'


def environment(block):
    names = "OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMPI_MCA_rmaps_base_oversubscribe " \
            "OMPI_MCA_mpi_yield_when_idle OMP_NUM_THREADS"
    own = dict(os.environ, OMPI_MCA_btl="self,vader,tcp", PTRIANGLE_TEST_BLOCK=block)
    return dict(own, **{name: "1" for name in names.split()})


def digests(base):
    """Contents of the files of a mesh, by suffix, without comments and file names."""
    sums = {}
    for name in (n for n in os.listdir(".") if n.startswith(base + ".") and not n.endswith(".xdmf")):
        with open(name, "rb") as file:
            data = file.read()
        if not name.endswith(".h5"):
            data = b"\n".join(line for line in data.split(b"\n") if not line.startswith(b"#"))
        sums[name[len(base):]] = hashlib.md5(data).hexdigest()
    return sums


def words_of(outputs, base):
    return [word for output in outputs for word in ("--output", output.format(base))]


def temporaries():
    return [name for folder in (".", "scratch") for name in os.listdir(folder) if name.startswith(".tri-")]


def pids():
    found = {}
    for name in os.listdir("."):
        if name.startswith("pid."):
            with open(name, encoding="ascii") as file:
                text = file.read().strip()
            if text:
                found[name] = int(text)
    return found


def send(pid, what):
    """Kills a process. It may have ended by itself."""
    try:
        os.kill(pid, what)
    except ProcessLookupError:
        pass


def kill(how, launcher):
    there = sorted(pids().values())
    if how == "launcher" or not there:
        send(launcher.pid, signal.SIGKILL)
    elif how == "term":
        for pid in there:
            send(pid, signal.SIGTERM)
    else:
        for pid in random.sample(there, 1 if how == "rank" else random.randint(1, len(there))):
            send(pid, signal.SIGKILL)


def wait_for_writing(launcher):
    """Waits until the files of all ranks grow, or the run has ended."""
    def written():
        size = 0
        for name in temporaries():
            try:
                size += os.stat(name).st_size
            except FileNotFoundError:
                pass
        return size
    while launcher.poll() is None and written() == 0:
        time.sleep(0.002)


def end_of(launcher, errors):
    """Returns the exit code once the run and all its ranks have ended, or None if they hang."""
    began = time.time()
    try:
        code = launcher.wait(HANG)
    except subprocess.TimeoutExpired:
        launcher.kill()
        errors.append("the launcher hangs")
        return None
    while any(is_there(pid) for pid in pids().values()):
        if time.time() - began > HANG:
            errors.append("a rank hangs")
            return None
        time.sleep(0.05)
    wait_for_numbers()
    return code


def wait_for_numbers():
    """Waits, for a limited time, until the process numbers of ended ranks are free. The process that inherits children
    of a dead launcher may reap them late. Until then, their temporary files are mistaken for files in use."""
    began = time.time()
    while any(os.path.exists(f"/proc/{pid}") for pid in pids().values()) and time.time() - began < 20:
        time.sleep(0.05)


def is_there(pid):
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def run_once(command, block, seconds, while_written, errors):
    """Kills ranks or the launcher after the given seconds, counted from the beginning or from the start of writing.
    None: no kill. Returns the exit code and a description of what was killed."""
    for name in list(os.listdir(".")):
        if name.startswith("pid."):
            os.remove(name)
    how = ""
    with open("log", "ab") as log:
        launcher = subprocess.Popen(command, env=environment(block), stdout=log, stderr=log, stdin=subprocess.DEVNULL)
    if seconds is not None:
        if while_written:
            wait_for_writing(launcher)
        time.sleep(seconds)
        how = random.choice(["rank", "rank", "some", "term", "launcher"])
        if launcher.poll() is not None:
            how = "late"
        kill(how if how != "late" else "term", launcher)
    return end_of(launcher, errors), how


def chain(program, mpirun, source, number):
    """Runs one chain. Returns its fault, if any, and its history."""
    name, switches, block, memory = random.choice(INPUTS)
    shutil.copy(os.path.join(source, name + ".poly"), "in.poly")
    os.mkdir("scratch")
    outputs = random.choice(OUTPUTS)
    began = time.time()
    words = [program, "-Q" + switches, "in", "--scratch", "scratch"]
    subprocess.run(words + words_of(outputs, "one"), env=environment(block), check=True, stdin=subprocess.DEVNULL,
                   timeout=HANG)
    alone = time.time() - began
    good = digests("one")
    kept = ["--checkpoint", "state", "--resume", "state", "--every", random.choice(["0", "0", "0.3"])]
    errors, story, kills = [], [], random.randint(1, 4)
    for attempt in range(kills + 1):
        n = random.choice(RANKS)
        bound = ["--memory", memory] if memory and random.random() < 0.8 else []
        while_written = random.random() < 0.5
        seconds = None
        if attempt < kills:
            seconds = random.random() * (0.15 * alone if while_written else 0.3 + 1.5 * alone)
        command = [mpirun, "-n", str(n), "sh", "-c", RECORD] + words + words_of(outputs, "two") + kept + bound
        code, how = run_once(command, block, seconds, while_written, errors)
        found = digests("two")
        story.append(f"{n}{'m' if bound else ''}{how}{'w' if how and while_written else ''}:{code}"
                     f"{'s' if os.path.exists('state/state-0') else ''}{'f' if found else ''}")
        if any(good.get(suffix) != found[suffix] for suffix in found):
            errors.append("a file with its final name has wrong bytes")
        if code == 0 and how in ("rank", "some", "term") and not found:
            errors.append("exit code 0, but no file")
        if code == 0 or errors:
            break
        if seconds is None:
            with open("log", "rb") as log:
                errors.append("the last run fails: " + log.read()[-400:].decode(errors="replace"))
    if not errors and good != digests("two"):
        errors.append("wrong bytes in the final files")
    if not errors and os.path.exists("state"):
        errors.append("a checkpoint is left")
    if not errors and temporaries():
        errors.append("temporary files are left: " + " ".join(temporaries()))
    print(f"{number}: {name} -{switches} {memory or ''} {' '.join(outputs)}: {' '.join(story)} "
          f"{' '.join(errors) or 'good'}", flush=True)
    return not errors


def main():
    program, mpirun, source, seed, count = sys.argv[1:6]
    program, source = os.path.abspath(program), os.path.abspath(source)
    bad = 0
    for k in range(int(seed), int(seed) + int(count)):
        random.seed(k)
        folder = tempfile.mkdtemp(prefix="kill_chain_")
        here = os.getcwd()
        os.chdir(folder)
        good = chain(program, mpirun, source, k)
        os.chdir(here)
        bad += not good
        if good:
            shutil.rmtree(folder)
        else:
            print(f"kept: {folder}", flush=True)
    return 1 if bad else 0


sys.exit(main())
