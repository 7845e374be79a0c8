#!/usr/bin/env python3
"""How long whole commands take from a cold start: bench/cold_start.py build/release/bin/searchlight

Shader caches are off. Prints the median and the extremes of the wall time in seconds.
"""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
RUNS = 11


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    environment = dict(os.environ, MESA_SHADER_CACHE_DISABLE="1")
    with tempfile.TemporaryDirectory() as folder:
        edited = pathlib.Path(folder) / "edited.bssrdf"
        edited.write_text((ROOT / "models/directional_dipole.bssrdf").read_text() + "\n# edited\n")
        commands = {
            "plot, all shipped models, native": "plot pencil --models all -o a.svg",
            "plot, all shipped models, OpenGL": "plot pencil --models all --backend gl -o a.svg",
            "plot, a model file that was just edited": "plot pencil --models ./edited.bssrdf -o a.svg",
            "plot, as PNG": "plot pencil --models all -o a.png",
            "profile, one radius": "profile --model dipole --radii 1",
        }
        for name, command in commands.items():
            seconds = []
            for _ in range(RUNS):
                start = time.perf_counter()
                subprocess.run([program, *command.split()], cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
                seconds.append(time.perf_counter() - start)
            print(f"{name:42} {statistics.median(seconds):.3f}  ({min(seconds):.3f} to {max(seconds):.3f})")


if __name__ == "__main__":
    main()
