"""Predicts the time of a run on other numbers of threads, or on the ranks of a network, from the times of blocks in the
report of one process (`ptriangle --report`). Nothing is measured.

Threads. Phases follow one another, and blocks of one phase are independent. List scheduling, the longest first, ends
within 4/3 of the optimum (R. L. Graham, SIAM J. Appl. Math. 17, 1969, theorem 2). Stages that work in shares, and
numbering, are divided among the threads. All other work is sequential.

Ranks. Every rank makes the coarse mesh. Tiles are assigned to ranks, columns first, as in sched/ranks/territory.h.
Block (2 i + 1, 2 j + 1) is tile (i, j); other blocks lie over two or four tiles. The rank that owns the first tile of a
block refines it. Owners of its other tiles lend them and get them back. The time of a phase is the sum of three maxima
over ranks: refining, packing and unpacking, and sending messages. Agreements take latencies in proportion to the
logarithm of the number of ranks. The model ignores shared caches, shared links, and files.

Usage: python3 bench/prediction.py REPORT.json"""
import collections
import dataclasses
import heapq
import itertools
import json
import math
import sys

MOST_SHARES = 64  # TRI_MOST_SHARES of triangle/base/executor.h
Pair = collections.namedtuple("Pair", "bytes seconds swaps")  # for a block and each further rank that owns a part of it


def makespan(seconds, threads):
    """List scheduling: the longest item first, each on the thread that is free first."""
    load = [0.0] * threads
    for s in sorted(seconds, reverse=True):
        heapq.heapreplace(load, load[0] + s)
    return max(load)


def refine_seconds(blocks, threads, first_round=0):
    phases = itertools.groupby(blocks, lambda b: (b["schedule"], b["round"], b["phase"]))
    return sum(makespan([b["seconds"] for b in phase], threads) for key, phase in phases if key[1] >= first_round)


def sequential_seconds(schedule):
    s = schedule["seconds"]
    return max(0, s["total"] - s["refine"] - s["number"] - sum(s["shared"]))


def shared_seconds(schedule, had, threads):
    """Item k of `shared` is work in 2^k shares."""
    return sum(s * min(had, 1 << k) / min(threads, 1 << k) for k, s in enumerate(schedule["seconds"]["shared"]))


def number_seconds(schedule, had, threads):
    return schedule["seconds"]["number"] * min(had, MOST_SHARES) / min(threads, MOST_SHARES)


def on_threads(report):
    schedule, had = report["schedule"], report["threads"]
    sequential = sequential_seconds(schedule)
    for threads in [1 << k for k in range(9)]:
        refine = refine_seconds(schedule["blocks"], threads)
        quality = sequential + refine + shared_seconds(schedule, had, threads)
        yield {"threads": threads, "refine_seconds": refine, "quality_seconds": quality,
               "number_seconds": number_seconds(schedule, had, threads),
               "sequential_share": sequential / quality if quality > 0 else 1}


@dataclasses.dataclass
class How:
    ranks: int
    threads: int = 1  # threads of each rank
    times: int = 1  # the mesh consists of this many copies of the measured one, in each direction
    latency: float = 0  # seconds per message
    bandwidth: float = 1e10  # bytes per second that a rank sends and receives
    lateness: float = 0  # mean delay in seconds until a waiting rank notices an agreement
    pairs: tuple = ()  # one Pair for the first schedule and one for the second


def usual(ranks, threads, times, cell):
    """The network of docs/scaling.md, with Pair values measured on 2, 4 and 9 ranks for 15 million triangles in cells
    of 65,536. In the first schedule these values are proportional to the area of a cell. Seams are as long as a cell,
    and some triangles of the coarse mesh are as wide as the cells."""
    share = cell / 65536
    pairs = Pair(168e3 * share, 0.0045 * share, 3), Pair(14e3, 0.0017, 6)
    return How(ranks, threads, times, 2e-6, 1e10, 2.5e-4, pairs)


class _Replay:
    def __init__(self, report, how):
        self.how, self.schedule, self.had = how, report["schedule"], report["threads"]
        self.old = (self.schedule["columns"] - 1) // 2, (self.schedule["rows"] - 1) // 2  # columns and rows of tiles
        self.columns, self.rows = self.old[0] * how.times, self.old[1] * how.times
        self.sum = collections.Counter()
        self.busy, self.sent = [0.0] * how.ranks, [0.0] * how.ranks
        tiles = self.columns * self.rows
        self.owner = [rank for rank in range(how.ranks)
                      for _ in range(rank * tiles // how.ranks, (rank + 1) * tiles // how.ranks)]

    def _take_blocks(self, which):
        """Seconds by block. Blocks of later rounds are summed for one rank."""
        measured, later, cells = collections.Counter(), 0, self.schedule["columns"] * self.schedule["rows"]
        for b in self.schedule["blocks"]:
            if b["schedule"] == self.schedule["schedule"] + which:
                if b["round"] == 0 and b["block"] < cells:
                    measured[b["block"]] += b["seconds"]
                else:
                    later += b["seconds"]
        self.sum["alone_seconds"] += later
        return measured

    @staticmethod
    def _measured_at(at, old, total):
        """Where copies of a mesh meet, two blocks at borders become one block inside."""
        if at % (2 * old) or at == 0:
            return [at % (2 * old)]
        return [2 * old] if at == 2 * total else [2 * old, 0]

    def _seconds(self, measured, column, row):
        return sum(measured[c * (2 * self.old[1] + 1) + r] for c in self._measured_at(column, self.old[0], self.columns)
                   for r in self._measured_at(row, self.old[1], self.rows))

    def _owners(self, column, row):
        """Each owner once, beginning with the owner of the first tile."""
        columns = range(max(0, (column - 1) // 2), min(column // 2 + 1, self.columns))
        rows = range(max(0, (row - 1) // 2), min(row // 2 + 1, self.rows))
        return list(dict.fromkeys(self.owner[c * self.rows + r] for c in columns for r in rows))

    def _gather(self, size):
        how = self.how
        return 0 if how.ranks == 1 else (math.ceil(math.log2(how.ranks)) * how.latency
                                         + (how.ranks - 1) * size / how.bandwidth + how.lateness)

    def _phase(self, measured, phase, pair):
        how, work, pairs = self.how, collections.defaultdict(list), collections.Counter()
        speak = set()
        for column in range(phase // 2 == 0, 2 * self.columns + 1, 2):
            for row in range(phase % 2 == 0, 2 * self.rows + 1, 2):
                worker, *lenders = self._owners(column, row)
                work[worker].append(self._seconds(measured, column, row))
                pairs.update([worker] * len(lenders) + lenders)
                speak.update((worker, lender) for lender in lenders)
        messages = collections.Counter(rank for two in speak for rank in two)
        self.sum["refine_seconds"] += max(makespan(s, how.threads) for s in work.values())
        for rank, seconds in work.items():
            self.busy[rank] += sum(seconds)
        for rank, n in pairs.items():
            self.busy[rank] += n * pair.seconds / 2
            self.sent[rank] += n * pair.bytes / 2  # the other half is received
        self.sum["merge_seconds"] += max(pairs.values(), default=0) * pair.seconds / 2
        self.sum["bytes"] += sum(pairs.values()) * pair.bytes / 2
        self.sum["messages"] += len(speak) * pair.swaps
        under_way = max((pairs[rank] * pair.bytes / how.bandwidth + n * pair.swaps * how.latency
                         for rank, n in messages.items()), default=0)
        blocks = (2 * self.columns + 1) * (2 * self.rows + 1)
        self.sum["communication_seconds"] += under_way + self._gather(blocks / 8) + 4 * pair.swaps * self._gather(8)

    def play(self):
        s, how, total = self.schedule["seconds"], self.how, self.sum
        last = max(b["schedule"] for b in self.schedule["blocks"])
        for which in range(min(2, max(1, last - self.schedule["schedule"] + 1))):
            measured = self._take_blocks(which)
            for phase in range(4):
                self._phase(measured, phase, how.pairs[which])
        total["alone_seconds"] += (s["prerefine"] + s["partition"]) * how.times ** 2
        share = self.had * (s["find"] + s["number"]) + s["worklist"] + s["room"] + s["merge"]
        share *= how.times ** 2 / how.ranks
        total["hand_out_seconds"] = share / how.threads
        parts = "alone", "refine", "merge", "communication", "hand_out"
        total["seconds"] = sum(total[part + "_seconds"] for part in parts)
        total["processor_seconds_of_busiest"] = total["alone_seconds"] + max(self.busy) + share
        total["most_bytes_of_a_rank"] = max(self.sent)
        return total


def on_ranks(report, how):
    """Predicts the first rounds of the report's own schedule and of the following schedule on the same cells. Later
    rounds count as done by one rank. None: there are no cells."""
    schedule = report["schedule"]
    return _Replay(report, how).play() if schedule and schedule["columns"] > 1 and schedule["rows"] > 1 else None


# Ranks, threads of each, triangles (0: this mesh). The next two: about the largest mesh of the paper's Table 2, and one
# with as many triangles per rank. The last three: 10^10 triangles on 4, 16 and 64 nodes of 64 cores.
ROWS = [(n, 1, 0) for n in (1, 2, 4, 9, 16, 64)] + [(121, 1, 8.7e8), (1024, 1, 7.4e9), (32, 8, 1e10), (128, 8, 1e10),
                                                   (512, 8, 1e10)]


def rows_on_ranks(report):
    schedule, triangles = report["schedule"], report["mesh"]["triangles"]
    cells = (schedule["columns"] - 1) * (schedule["rows"] - 1)
    for ranks, threads, wanted in ROWS:
        times = max(1, round(math.sqrt(wanted / triangles)))
        if cells > 0 and times <= 100:
            found = on_ranks(report, usual(ranks, threads, times, triangles / cells))
            yield {"ranks": ranks, "threads": threads, "triangles": triangles * times ** 2, **found}


def main(path):
    with open(path, encoding="utf-8") as file:
        report = json.load(file)
    if report["schedule"]:
        json.dump({"prediction": list(on_threads(report)), "prediction_on_ranks": list(rows_on_ranks(report))},
                  sys.stdout, indent=1)


if __name__ == "__main__":
    main(sys.argv[1])
