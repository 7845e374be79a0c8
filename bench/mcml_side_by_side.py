#!/usr/bin/env python3
"""Figures of merit of the half-space walks beside MCML's, in turns, on one core each, from one run.

    bench/mcml_side_by_side.py --mcml PATH/TO/mcml [--searchlight build/release/bin/searchlight] [--seconds 10]

MCML is not part of this project: build it from its authors' sources, with -O3 -march=native and, as docs/benchmarks.md
explains, a random generator better than its own. Figure of merit: 1 / (relative variance x CPU seconds) of the bins
[r, r + 0.1] reduced mean free paths; the relative variance is the mean over that bin and two neighbours on either side,
since MCML's is known from the scatter of its runs alone.
"""

import argparse
import json
import math
import os
import resource
import subprocess
import tempfile

RADII = [0.5, 1, 2, 5]
BINS = 53
RUNS = 64  # of MCML: their scatter is its variance. Its last bin holds all beyond, so it has one more than are read

# name, sigma_a, sigma_s (1/mm), g, eta; MCML's photons per second, roughly, to share out the time
CASES = [
    ("marble, red", 0.0021, 2.19, 0, 1.5, 34e3),
    ("skin1, red", 0.032, 0.74, 0, 1.3, 330e3),
    ("ketchup, blue", 1.45, 0.03, 0, 1.3, 6.6e6),
    ("whole milk, green", 0.0024, 3.21, 0, 1.3, 40e3),
    ("g = 0.9", 0.01, 10, 0.9, 1.4, 15e3),
]


def cpu_seconds(command, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    out = subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return out.stdout, (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)


def mcml(program, case, seconds, folder):
    _, sigma_a, sigma_s, g, eta, rate = case
    step_cm = 0.01 / (sigma_a + sigma_s * (1 - g))
    photons = max(1000, int(rate * seconds / RUNS))
    lines = ["1.0", str(RUNS)]
    for i in range(RUNS):
        lines += [f"run{i}.mco A", str(photons), f"1e8 {step_cm!r}", f"1 {BINS + 1} 1", "1", "1.0",
                  f"{eta} {10 * sigma_a!r} {10 * sigma_s!r} {g} 1e8", "1.0"]
    with open(os.path.join(folder, "bench.mci"), "w", encoding="ascii") as file:
        file.write("\n".join(lines) + "\n")
    _, spent = cpu_seconds([program, "bench.mci"], folder)
    runs = [radial_block(os.path.join(folder, f"run{i}.mco")) for i in range(RUNS)]
    merits = []
    for r in RADII:
        relative = []
        for i in neighbours(r):
            values = [run[i] for run in runs]
            mean = sum(values) / RUNS
            relative.append(sum((v - mean) ** 2 for v in values) / (RUNS - 1) / RUNS / mean**2 if mean else math.inf)
        merits.append(len(relative) / sum(relative) / spent)
    return RUNS * photons / spent, merits


def neighbours(r):
    middle = round(10 * r)
    return range(middle - 2, middle + 3)


def radial_block(path):
    with open(path, encoding="ascii", errors="replace") as file:
        lines = file.read().split("\n")
    first = next(i for i, line in enumerate(lines) if line.startswith("Rd_r")) + 1
    return [float(line) for line in lines[first:first + BINS]]


def searchlight(program, case, estimator, seconds, folder):
    _, sigma_a, sigma_s, g, eta, _ = case
    reach = 0.1 * BINS / (sigma_a + sigma_s * (1 - g))
    command = [os.path.abspath(program), "reference", "halfspace", "--sigma-a", repr(sigma_a), "--sigma-s",
               repr(sigma_s), "--g", repr(g), "--eta", repr(eta), "--radii-max", repr(reach), "--bins", str(BINS),
               "--estimator", estimator, "--threads", "1", "--json", "--walks"]
    _, once = cpu_seconds(command + ["100000"], folder)
    text, spent = cpu_seconds(command + [str(int(max(2e5, 1e5 * seconds / once)))], folder)
    document = json.loads(text)
    profile = document["profile"]
    merits = []
    for r in RADII:
        pairs = [(profile["Rd"][0][i], profile["stderr"][0][i]) for i in neighbours(r)]
        merits.append(len(pairs) / sum((e / m) ** 2 if m else math.inf for m, e in pairs) / spent)
    return document["walks"] / spent, merits


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mcml", required=True)
    parser.add_argument("--searchlight", default="build/release/bin/searchlight")
    parser.add_argument("--seconds", type=float, default=10, help="CPU time of each program on each case")
    options = parser.parse_args()
    print(f"{'':20} {'':10} {'walks/s':>10} {'ratio':>7}  " + "  ".join(f"{'r = ' + str(r):>20}" for r in RADII))
    with tempfile.TemporaryDirectory() as folder:
        for case in CASES:
            rate, base = mcml(os.path.abspath(options.mcml), case, options.seconds, folder)
            print(f"{case[0]:20} {'MCML':10} {rate:10.3g} {'':>7}  " + "  ".join(f"{m:20.3g}" for m in base))
            for estimator in ("analogue", "best"):
                speed, merits = searchlight(options.searchlight, case, estimator, options.seconds, folder)
                cells = [f"{m:10.3g} {f'({m / b:.3g} x)':>9}" for m, b in zip(merits, base)]
                print(f"{'':20} {estimator:10} {speed:10.3g} {speed / rate:6.0f}x  " + "  ".join(cells), flush=True)


if __name__ == "__main__":
    main()
