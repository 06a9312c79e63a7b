"""Tests bench/prediction.py: list scheduling of measured blocks, the shares that result, and the same on ranks.

Usage: python3 tests/prediction.py SOURCE"""
import sys
import unittest

sys.path.insert(0, sys.argv.pop(1) + "/bench")
import prediction  # noqa: E402

SIDE, SWAPS = 5, 3  # the first: a mesh of 2 x 2 tiles, in blocks


def block(schedule, turn, phase, number, seconds):
    return {"schedule": schedule, "round": turn, "phase": phase, "block": number, "seconds": seconds}


def four_tiles(schedule=0):
    """Seconds: 1 in tiles, 1/4 in blocks over two tiles, half of that at the border, 1/16 in the middle."""
    side = [0.125, 1, 0.25, 1, 0.125]
    return [block(schedule, 0, 2 * (c % 2 == 0) + (r % 2 == 0), c * SIDE + r, side[c] * side[r])
            for c in range(SIDE) for r in range(SIDE)]


def replayed(ranks, times=1, blocks=None, schedule=0):
    zero = {"find": 0, "worklist": 0, "room": 0, "merge": 0, "partition": 0}
    report = {"threads": 1, "schedule": {"columns": SIDE, "rows": SIDE, "schedule": schedule,
                                         "blocks": blocks or four_tiles(),
                                         "seconds": {"prerefine": 0.5, "number": 2, **zero}}}
    pairs = prediction.Pair(1000, 0.5, SWAPS), prediction.Pair(100, 0.25, 2 * SWAPS)
    return prediction.on_ranks(report, prediction.How(ranks, times=times, bandwidth=1e9, pairs=pairs))


class Threads(unittest.TestCase):
    def test_largest_first(self):
        """3 3 2 2 2 on two threads: scheduling the largest first ends at 7, one above the optimum."""
        for threads, seconds in ((1, 12), (2, 7), (3, 5), (4, 4), (256, 3)):
            self.assertAlmostEqual(prediction.makespan([2, 3, 2, 3, 2], threads), seconds)

    def test_phases_follow_each_other(self):
        """The same when the next schedule begins with the same round and phase."""
        blocks = [block(0, 0, 0, 0, 1), block(0, 0, 0, 1, 1), block(1, 0, 0, 2, 4), block(1, 0, 0, 5, 1),
                  block(1, 0, 1, 6, 2), block(1, 1, 0, 7, 8), block(1, 1, 0, 9, 8)]
        for threads, first, seconds in ((1, 0, 25), (2, 0, 1 + 4 + 2 + 8), (2, 1, 8), (2, 2, 0)):
            self.assertAlmostEqual(prediction.refine_seconds(blocks, threads, first), seconds)

    def test_shares(self):
        schedule = {"seconds": {"total": 12, "refine": 8.5, "number": 2, "shared": [0.0625, 0, 0, 0.1875]}}
        self.assertAlmostEqual(prediction.sequential_seconds(schedule), 1.25)
        for threads, seconds in ((1, 4), (8, 0.5), (256, 4 / prediction.MOST_SHARES)):
            self.assertAlmostEqual(prediction.number_seconds(schedule, 2, threads), seconds)
        for threads, seconds in ((1, 0.4375), (4, 0.15625), (64, 0.109375)):
            self.assertAlmostEqual(prediction.shared_seconds(schedule, 2, threads), seconds)


class Ranks(unittest.TestCase):
    def assert_near(self, found, **wanted):
        for key, value in wanted.items():
            self.assertAlmostEqual(found[key], value, msg=key)

    def test_one_rank_does_all(self):
        self.assert_near(replayed(1), refine_seconds=6.25, alone_seconds=0.5, hand_out_seconds=2, merge_seconds=0,
                         bytes=0, messages=0, seconds=8.75)
        self.assert_near(replayed(1, 3), refine_seconds=9 * 6.25, alone_seconds=9 * 0.5, hand_out_seconds=9 * 2)

    def test_two_ranks_meet_along_a_column(self):
        """Each rank has a column. Five blocks lie between them: one rank lends its part, and the other refines it."""
        refine = 2.5 + 2.5 * (0.125 + 0.25)
        self.assert_near(replayed(2), refine_seconds=refine, bytes=5 * 1000, most_bytes_of_a_rank=5 * 500,
                         messages=2 * SWAPS, merge_seconds=5 * 0.25, hand_out_seconds=1,
                         processor_seconds_of_busiest=0.5 + refine + 5 * 0.25 + 1)

    def test_four_ranks_meet_at_a_corner(self):
        """Each rank has a tile. Three ranks lend to the first for the block in the middle. Of 100 ranks, some have no
        tile."""
        for ranks in 4, 100:
            self.assert_near(replayed(ranks), refine_seconds=1 + 0.375 + 0.375 + 0.375 * 0.375,
                             bytes=(2 + 2 + 7) * 1000, messages=(2 + 2 + 5) * SWAPS)

    def test_a_second_schedule_is_shared(self):
        """Messages that take a tenth of the time and half the packing, with a coarse mesh before and a round after
        them."""
        one = replayed(2)
        two = replayed(2, 1, [block(0, 0, 0, 6, 100), *four_tiles(1), *four_tiles(2), block(2, 1, 0, 6, 4)], 1)
        self.assert_near(two, alone_seconds=one["alone_seconds"] + 4, hand_out_seconds=one["hand_out_seconds"],
                         refine_seconds=2 * one["refine_seconds"], merge_seconds=1.5 * one["merge_seconds"],
                         bytes=1.1 * one["bytes"], messages=3 * one["messages"])


if __name__ == "__main__":
    unittest.main()
