"""outside.py DOCUMENT STEPS: what it costs to read all bodies and to put a force on each at every step through numpy, beside
a run without, in turns; ms of the processor. PYTHONPATH=python"""
import sys
import time

import nsd

runs = [nsd.Run.from_document(sys.argv[1]) for _ in range(2)]
steps, seconds = int(sys.argv[2]), [0.0, 0.0]
for k in range(2 * steps):
    which = (k ^ k >> 1) & 1  # 0 1 1 0: neither is always the first
    run, begin = runs[which], time.process_time()
    if which:
        run.force = -1e-9 * run.velocity + 1e-30 * run.position
    run.step()
    seconds[which] += time.process_time() - begin
print(f"without {1e3 * seconds[0] / steps:.3f} ms, with {1e3 * seconds[1] / steps:.3f} ms a step: "
      f"{100 * (seconds[1] / seconds[0] - 1):+.2f} %")
