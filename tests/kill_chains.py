#!/usr/bin/env python3
"""Ranks that are killed at random moments, and gone on with by others: kill_chains.py PROGRAM MPIRUN DATA SEED COUNT.

A chain makes one mesh: a number of ranks, drawn anew for each run, goes on from the checkpoint of those before, until
none is killed. After each kill all ranks must end, with a failure, and no file may have its name; in the end the files
are those of one process, and neither a checkpoint nor a temporary file is left. PROGRAM is one of a build with tests,
for the environment variable that makes blocks small. Exit code: 0 where all chains are good."""
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
    ("square_random1000", "pq20a0.0000009", "", "110M"),
    ("square_random1000", "pq33a0.000001", "", "110M"),
]
RECORD = 'echo $$ >"pid.${OMPI_COMM_WORLD_RANK:-$PMI_RANK}"; exec "$0" "$@"'


def environment(block):
    names = "OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMPI_MCA_rmaps_base_oversubscribe " \
            "OMPI_MCA_mpi_yield_when_idle OMP_NUM_THREADS"
    own = dict(os.environ, OMPI_MCA_btl="self,vader,tcp", PTRIANGLE_TEST_BLOCK=block)
    return dict(own, **{name: "1" for name in names.split()})


def digest(base):
    """Of the files of a mesh, but for comments and what names a file."""
    sums = []
    for name in sorted(n for n in os.listdir(".") if n.startswith(base + ".") and not n.endswith(".xdmf")):
        with open(name, "rb") as file:
            data = file.read()
        if not name.endswith(".h5"):
            data = b"\n".join(line for line in data.split(b"\n") if not line.startswith(b"#"))
        sums.append((name[len(base):], hashlib.md5(data).hexdigest()))
    return sums


def pids():
    found = {}
    for name in os.listdir("."):
        if name.startswith("pid."):
            with open(name, encoding="ascii") as file:
                text = file.read().strip()
            if text:
                found[name] = int(text)
    return found


def kill(victim, launcher):
    """One rank, or the launcher; it may have ended by itself."""
    there = pids()
    pid = launcher.pid if victim == "launcher" or not there else random.choice(sorted(there.values()))
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def end_of(launcher, errors):
    """Its exit code once it, and all ranks, have ended; None: they hang."""
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
    return code


def is_there(pid):
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def run_once(command, block, seconds, errors):
    """Kills somebody after so many seconds, unless they are None. Returns the exit code."""
    for name in list(os.listdir(".")):
        if name.startswith("pid."):
            os.remove(name)
    with open("log", "ab") as log:
        launcher = subprocess.Popen(command, env=environment(block), stdout=log, stderr=log, stdin=subprocess.DEVNULL)
    if seconds is not None:
        time.sleep(seconds)
        kill(random.choice(["rank", "rank", "rank", "launcher"]), launcher)
    return end_of(launcher, errors)


def chain(program, mpirun, source, number):
    """Returns what is wrong with it, and how it went."""
    name, switches, block, memory = random.choice(INPUTS)
    shutil.copy(os.path.join(source, name + ".poly"), "in.poly")
    output = random.choice([["one", "two"], ["one.h5", "two.h5"]])
    began = time.time()
    words = [program, "-Q" + switches, "in", "--output"]
    subprocess.run(words + [output[0]], env=environment(block), check=True, stdin=subprocess.DEVNULL, timeout=HANG)
    alone = time.time() - began
    kept = ["--checkpoint", "state", "--resume", "state", "--every", random.choice(["0", "0", "0.3"])]
    errors, story, kills = [], [], random.randint(1, 4)
    for attempt in range(kills + 1):
        n = random.randint(2, 9)
        bound = ["--memory", memory] if memory and random.random() < 0.8 else []
        seconds = random.random() * (alone + 1.5) * (1 + n / 4) if attempt < kills else None
        command = [mpirun, "-n", str(n), "sh", "-c", RECORD] + words + [output[1]] + kept + bound
        code = run_once(command, block, seconds, errors)
        story.append(f"{n}{'m' if bound else ''}:{code}{'s' if os.path.exists('state/state-0') else ''}")
        done = any(file.startswith("two.") for file in os.listdir("."))
        if code == 0 or errors:
            break
        if done and seconds is not None and code is not None:
            story.append("killed at the end")
            break
        if seconds is None:
            with open("log", "rb") as log:
                errors.append("the last run fails: " + log.read()[-400:].decode(errors="replace"))
    if not errors and digest("one") != digest("two"):
        errors.append("other bytes")
    if not errors and code == 0 and os.path.exists("state"):
        errors.append("a checkpoint is left")
    print(f"{number}: {name} -{switches} {memory or ''} {output[1]}: {' '.join(story)} {' '.join(errors) or 'good'}",
          flush=True)
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
