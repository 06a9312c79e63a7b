#!/usr/bin/env python3
"""Runs a program and measures its peak memory: peak.py BYTES COMMAND...

Exit code: that of the program, or 99 with a message on standard error if the program used more memory."""
import os
import sys

bound, command = float(sys.argv[1]), sys.argv[2:]
child = os.fork()
if child == 0:
    os.execvp(command[0], command)
_, status, usage = os.wait4(child, 0)
peak = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
if peak > bound + 1e6:  # tolerance, because the kernel counts in batches
    print(f"peak: {peak / 1e6:.0f} MB, allowed {bound / 1e6:.0f} MB", file=sys.stderr)
    sys.exit(99)
sys.exit(os.waitstatus_to_exitcode(status))
