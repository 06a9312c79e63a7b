#!/usr/bin/env python3
"""Runs a program and says how much memory it had at most: peak.py BYTES COMMAND...

Exit code: that of the program; 99: it took more than that, which is said on standard error."""
import os
import sys

bound, command = float(sys.argv[1]), sys.argv[2:]
child = os.fork()
if child == 0:
    os.execvp(command[0], command)
_, status, usage = os.wait4(child, 0)
peak = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
if peak > bound + 1e6:  # what the kernel counts in batches
    print(f"peak: {peak / 1e6:.0f} MB, allowed {bound / 1e6:.0f} MB", file=sys.stderr)
    sys.exit(99)
sys.exit(os.waitstatus_to_exitcode(status))
