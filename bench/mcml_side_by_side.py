#!/usr/bin/env python3
"""Figures of merit of the half-space and slab walks beside MCML's, in turns, on one core each, from one run.

    bench/mcml_side_by_side.py --mcml PATH/TO/mcml [--searchlight build/release/bin/searchlight] [--seconds 10]

MCML is not part of this project: build it from its authors' sources, with -O3 -march=native and, as docs/benchmarks.md
explains, a random generator better than its own, whose seed is the environment variable MCSEED. Figure of merit:
1 / (relative variance x user seconds), of totals and of the bins [r, r + 0.1] reduced mean free paths (slabs: mm); the
relative variance of a bin is the mean over it and two neighbours on either side. Programs take turns in rounds, each
with a seed of its own; behind a ratio stands the standard error of the logarithms' mean over rounds, in per cent.

MCML knows normal incidence alone. For --oblique build a copy whose mcmlgo.c reads the angle in air, in degrees, from the
environment variable MCANGLE; its annuli stay about the entry point:
- before Rspecular(), `static double Angle(void) { char* a = getenv("MCANGLE"); return a ? atof(a) * PI / 180 : 0; }`
  and the prototype of RFresnel();
- first in Rspecular(), `double t; if (Angle() > 0) return RFresnel(Layerspecs_Ptr[0].n, Layerspecs_Ptr[1].n,
  cos(Angle()), &t);`
- in LaunchPhoton(), `static double s = -1; if (s < 0) s = sin(Angle()) * Layerspecs_Ptr[0].n / Layerspecs_Ptr[1].n;`,
  then ux = s, uy = 0, uz = sqrt(1 - s * s) for (0, 0, 1).
The total behind the ratios tells such a build from a wrong one: |z| is the difference of both programs' reflectances over
its standard error.
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
RUNS = 64  # of MCML in a round: their scatter is its variance. Its last bin holds all beyond: one more than are read
INFINITE = "infinite"

# name; layers of (n, sigma_a, sigma_s in 1/mm, g, mm); MCML's photons per second, roughly, to share out the time
CASES = [
    ("marble, red", [(1.5, 0.0021, 2.19, 0, INFINITE)], 34e3),
    ("skin1, red", [(1.3, 0.032, 0.74, 0, INFINITE)], 330e3),
    ("ketchup, blue", [(1.3, 1.45, 0.03, 0, INFINITE)], 6.6e6),
    ("whole milk, green", [(1.3, 0.0024, 3.21, 0, INFINITE)], 40e3),
    ("g = 0.9", [(1.4, 0.01, 10, 0.9, INFINITE)], 15e3),
    ("marble, red, 10 mm", [(1.5, 0.0021, 2.19, 0, 10)], 40e3),
    ("MCML's three layers", [(1.37, 0.1, 10, 0.9, 1), (1.37, 0.1, 1, 0, 1), (1.37, 0.2, 10, 0.7, 2)], 330e3),
    ("skin1 on skin2, red", [(1.3, 0.032, 0.74, 0, 2), (1.4, 0.013, 1.09, 0, 8)], 150e3),
]


# MCML with an angle of incidence, in degrees, behind its rate
OBLIQUE = [
    ("marble, red, 60 degrees", [(1.5, 0.0021, 2.19, 0, INFINITE)], 34e3, 60),
    ("skin1, red, 60 degrees", [(1.3, 0.032, 0.74, 0, INFINITE)], 330e3, 60),
    ("whole milk, green, 60 degrees", [(1.3, 0.0024, 3.21, 0, INFINITE)], 40e3, 60),
    ("g = 0.6, 60 degrees", [(1.4, 0.01, 2.5, 0.6, INFINITE)], 60e3, 60),
    ("g = 0.9, 30 degrees", [(1.4, 0.01, 10, 0.9, INFINITE)], 15e3, 30),
    ("g = 0.9, 60 degrees", [(1.4, 0.01, 10, 0.9, INFINITE)], 15e3, 60),
    ("albedo 0.3, 75 degrees", [(1.3, 0.7, 0.3, 0, INFINITE)], 3e6, 75),
]


def angle_of(case):
    return case[3] if len(case) > 3 else 0


def is_half_space(case):
    return case[1][0][4] == INFINITE


def step_mm(case):
    _, sigma_a, sigma_s, g, _ = case[1][0]
    return 0.1 / (sigma_a + sigma_s * (1 - g)) if is_half_space(case) else 0.1


def user_seconds(command, folder, seed, angle=0):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    out = subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                         env={**os.environ, "MCSEED": str(seed), "MCANGLE": str(angle)})
    return out.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def mean(values):
    return sum(values) / len(values)


def relative_variances(profiles, totals):
    """Of lists of (value, standard error): one for each radius of each profile, and for each total."""
    relative = lambda pair: (pair[1] / pair[0]) ** 2 if pair[0] else math.inf
    result = []
    for profile in profiles:
        for r in RADII:
            middle = round(10 * r)
            result.append(mean([relative(pair) for pair in profile[middle - 2:middle + 3]]))
    return result + [relative(pair) for pair in totals]


def scatter(runs):
    """Of lists that belong together: (mean, its standard error) for each place."""
    pairs = []
    for values in zip(*runs):
        m = mean(values)
        pairs.append((m, math.sqrt(sum((v - m) ** 2 for v in values) / (len(values) - 1) / len(values))))
    return pairs


def mcml(program, case, seconds, folder, seed):
    layers, rate = case[1:3]
    photons = max(100, int(rate * seconds / RUNS))
    lines = ["1.0", str(RUNS)]
    for i in range(RUNS):
        lines += [f"run{i}.mco A", str(photons), f"1e8 {0.1 * step_mm(case)!r}", f"1 {BINS + 1} 1", str(len(layers)), "1.0"]
        for n, sigma_a, sigma_s, g, thickness in layers:
            depth = "1e8" if thickness == INFINITE else repr(0.1 * thickness)
            lines.append(f"{n} {10 * sigma_a!r} {10 * sigma_s!r} {g} {depth}")
        lines.append("1.0")
    with open(os.path.join(folder, "bench.mci"), "w", encoding="ascii") as file:
        file.write("\n".join(lines) + "\n")
    _, spent = user_seconds([program, "bench.mci"], folder, seed, angle_of(case))
    found = []
    for i in range(RUNS):
        with open(os.path.join(folder, f"run{i}.mco"), encoding="ascii", errors="replace") as file:
            found.append(file.read().split("\n"))

    def block(name, first, count):
        at = [next(i for i, line in enumerate(lines) if line.startswith(name)) + first for lines in found]
        return scatter([[float(line.split()[0]) for line in lines[i:i + count]] for i, lines in zip(at, found)])

    _, reflected, _, transmitted = block("RAT", 1, 4)
    if is_half_space(case):
        return RUNS * photons, spent, relative_variances([block("Rd_r", 1, BINS)], [reflected]), reflected
    return (RUNS * photons, spent, relative_variances([block("Rd_r", 1, BINS), block("Tt_r", 1, BINS)],
                                                      [reflected, transmitted]), reflected)


def searchlight(program, case, estimator, walks, folder, seed):
    layers = case[1]
    command = [program, "reference"]
    if is_half_space(case):
        n, sigma_a, sigma_s, g, _ = layers[0]
        command += ["halfspace", "--angle-deg", repr(angle_of(case)), "--sigma-a", repr(sigma_a),
                    "--sigma-s", repr(sigma_s), "--g", repr(g), "--eta", repr(n)]
    else:
        document = {"format": "searchlight-layers/1", "n_above": 1, "n_below": 1, "layers": [
            {"n": n, "sigma_a": a, "sigma_s": s, "g": g, "thickness_mm": t} for n, a, s, g, t in layers]}
        with open(os.path.join(folder, "layers.json"), "w", encoding="ascii") as file:
            json.dump(document, file)
        command += ["slab", "--layers", "layers.json", "--angles", "1", "--depths", "40"]
    command += ["--radii-max", repr(BINS * step_mm(case)), "--bins", str(BINS), "--estimator", estimator, "--threads", "1",
                "--seed", str(seed), "--json", "--walks", str(int(walks))]
    text, spent = user_seconds(command, folder, seed)
    document = json.loads(text)
    if is_half_space(case):
        profiles = [list(zip(document["profile"]["Rd"][0], document["profile"]["stderr"][0]))]
        totals = [(document["diffuse"]["mean"][0], document["diffuse"]["stderr"][0])]
    else:
        profiles = [list(zip(document[name]["mean"], document[name]["stderr"])) for name in ("R_r", "T_r")]
        totals = [(document[name]["mean"], document[name]["stderr"]) for name in ("R", "T")]
    return document["walks"], spent, relative_variances(profiles, totals), totals[0]


class Rounds:
    """What one program found, round by round."""

    def __init__(self):
        self.walks, self.seconds, self.variances, self.totals = [], [], [], []

    def add(self, walks, seconds, variances, total):
        self.totals.append(total)
        self.walks.append(walks)
        self.seconds.append(seconds)
        self.variances.append(variances)

    def z(self, base):
        """|difference of the reflectances| over its standard error."""
        (mine, my_variance), (theirs, their_variance) = [
            (mean([value for value, _ in rounds.totals]), mean([e * e for _, e in rounds.totals]) / len(rounds.totals))
            for rounds in (self, base)]
        return abs(mine - theirs) / math.sqrt(my_variance + their_variance)

    def speed(self):
        return sum(self.walks) / sum(self.seconds)

    def merits(self):
        return [1 / (mean(values) * mean(self.seconds)) for values in zip(*self.variances)]

    def ratios(self, base):
        """Merits over those of base, with relative standard errors."""
        result = []
        for k, (mine, theirs) in enumerate(zip(self.merits(), base.merits())):
            logs = [math.log(b[k] * t / (a[k] * s)) if math.isfinite(a[k]) and math.isfinite(b[k]) else math.nan
                    for a, s, b, t in zip(self.variances, self.seconds, base.variances, base.seconds)]
            spread = scatter([[value] for value in logs])[0][1] if len(logs) > 1 else math.nan
            result.append((mine / theirs if theirs else math.inf, spread))
        return result


def measure(case, options, folder):
    programs = {"MCML": Rounds(), "analogue": Rounds(), "best": Rounds()}
    seconds = options.seconds / options.rounds
    ours = os.path.abspath(options.searchlight)
    walks = {}
    for estimator in ("analogue", "best"):
        walks[estimator] = 1e5
        # Twice: a short run says little of the speed of a long one.
        for _ in range(2):
            count, spent, _, _ = searchlight(ours, case, estimator, walks[estimator], folder, 1)
            walks[estimator] = max(1e5, count * seconds / max(spent, 0.01))
    for seed in range(1, options.rounds + 1):
        programs["MCML"].add(*mcml(os.path.abspath(options.mcml), case, seconds, folder, seed))
        for estimator in ("analogue", "best"):
            programs[estimator].add(*searchlight(ours, case, estimator, walks[estimator], folder, seed))
    return programs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mcml", required=True)
    parser.add_argument("--searchlight", default="build/release/bin/searchlight")
    parser.add_argument("--seconds", type=float, default=10, help="CPU time of each program on each case")
    parser.add_argument("--rounds", type=int, default=8)
    parser.add_argument("--only", default="", help="the cases whose name holds this")
    parser.add_argument("--oblique", action="store_true", help="oblique cases, with an MCML that reads MCANGLE")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for case in OBLIQUE if options.oblique else CASES:
            if options.only not in case[0]:
                continue
            programs = measure(case, options, folder)
            names = [f"R({r:g})" for r in RADII] + ["R"]
            if not is_half_space(case):
                names = names[:-1] + [f"T({r:g})" for r in RADII] + ["R", "T"]
            print(f"{case[0]:29} {'':8} {'walks/s':>8} {'ratio':>5} " + " ".join(f"{name:>22}" for name in names))
            base = programs["MCML"]
            for name, rounds in programs.items():
                cells = [f"{merit:9.3g} {f'{ratio:.3g}x' if rounds is not base else '':>7} "
                         f"{f'{100 * error:3.0f}%' if rounds is not base else '':>4}"
                         for merit, (ratio, error) in zip(rounds.merits(), rounds.ratios(base))]
                print(f"{'':29} {name:8} {rounds.speed():8.3g} {rounds.speed() / base.speed():5.0f} " + " ".join(cells)
                      + (f"  |z| {rounds.z(base):.1f}" if rounds is not base else ""), flush=True)


if __name__ == "__main__":
    main()
