#!/usr/bin/env python3
"""Writes docs/models/ from the model files: one page per model and the index.

    tools/model_pages/model_pages.py build/release/bin/searchlight           # write pages and plots
    tools/model_pages/model_pages.py build/release/bin/searchlight --stale   # exit 1 when a page needs writing

Needs nothing but Python's standard library, and no network. The plots and the verdicts of `searchlight check` are made
when pages are written; --stale compares what follows from the model files.
"""
import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = ROOT / "docs/models"
PLOT_SEED = 1
PLOT_WALKS = 2_000_000

ATTRIBUTES = {
    "analytic": "a formula",
    "radial": "depends on the distance of the two points alone",
    "no_wi": "does not depend on the direction of incidence",
    "no_wo": "does not depend on the direction of exit",
    "normals": "reads the surface normals at both points",
    "single_scattering": "single scattering is included",
    "reciprocal": "light may be followed backwards: S(xi, wi; xo, wo) = S(xo, wo; xi, wi)",
    "energy_violation": "known to return more light than enters, for some media",
    "grosjean": "its diffuse mean free path is that of Grosjean's diffusion coefficient",
}

SECTIONS = [
    ("initializer", "Once per medium"),
    ("diffuseReflectance", "Total diffuse reflectance"),
    ("shader", "Profile"),
]


def run(searchlight, *arguments):
    # From the root, so that no picture carries a path of this machine.
    done = subprocess.run([searchlight, *arguments], capture_output=True, text=True, cwd=ROOT)
    # 1 is the verdict of a check that failed; the page says so.
    if done.returncode not in (0, 1):
        sys.exit(f"searchlight {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |\n" for line in lines)


def section(text, name):
    found = re.search(rf"^::\s*begin\s+{name}\s*\n(.*?)^::\s*end\s+{name}", text, re.M | re.S)
    return found.group(1).rstrip() if found else None


def value_text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return ", ".join(f"{part:g}" for part in value)
    return f"{value:g}" if isinstance(value, (int, float)) else value


def range_text(param):
    if "choices" in param:
        return ", ".join(param["choices"])
    unit = f" {param['unit']}" if "unit" in param else ""
    if param["type"] == "bool" or param.get("max", 0) >= 1e30:
        return unit.strip()
    return f"{param['min']:g} to {param['max']:g}{unit}" if "max" in param else unit.strip()


def described(model):
    """What follows from the model's file."""
    text = (ROOT / f"models/{model['id']}.bssrdf").read_text()
    page = f"# {model['title']}\n\n"
    page += f"`{model['id']}`, from [models/{model['id']}.bssrdf](../../models/{model['id']}.bssrdf)\n\n"
    page += f"> {model['citation']}\n\n"
    page += f"![{model['title']} beside Monte Carlo]({model['id']}.svg)\n\n"
    page += f"Skin1 of Jensen et al. 2001, {PLOT_WALKS:,} walks, seed {PLOT_SEED}.\n\n"
    if model["validity"]:
        page += f"**Valid for** {model['validity']}.\n\n"
    if model.get("notes"):
        page += model["notes"].strip() + "\n\n"
    page += "## What it claims\n\n"
    page += table(["attribute", "meaning"], [[f"`{name}`", ATTRIBUTES[name]] for name in model["attributes"]])
    page += "\n## Parameters\n\n"
    if model["parameters"]:
        rows = [[f"`{p['name']}`", p["type"], range_text(p), value_text(p["default"]), p.get("doc", "")]
                for p in model["parameters"]]
        page += table(["name", "type", "range", "default", ""], rows)
        page += f"\nSet one with `--set {model['parameters'][0]['name']}=...`.\n"
    else:
        page += "None but those of the medium.\n"
    page += ("\n## Formulas\n\nThe medium stands in `SigmaA`, `SigmaS`, `G` (per channel) and `IOR`; functions that "
             "are not defined here are those of [physics/](../../physics). The value is R_d, in 1/mm² per unit flux that has "
             "entered ([conventions](../conventions.md)).\n")
    for name, heading in SECTIONS:
        if (glsl := section(text, name)) is not None:
            page += f"\n### {heading}\n\n```glsl\n{glsl}\n```\n"
    return page


def checks(searchlight, model):
    return json.loads(run(searchlight, "check", model["id"], "--json"))["checks"]


def checked(searchlight, model):
    """The verdicts of the lint on the machine that writes the pages."""
    rows = [[check["name"], check["outcome"], check["detail"]] for check in checks(searchlight, model)]
    return f"\n## Checks\n\n`searchlight check {model['id']}` says:\n\n" + table(["check", "verdict", "found"], rows)


def plot(searchlight, model):
    run(searchlight, "plot", "pencil", "--material", "skin1", "--models", model["id"], "--x-scale", "sqrt",
        "--reference-walks", str(PLOT_WALKS), "--seed", str(PLOT_SEED), "-o", str((PAGES / f"{model['id']}.svg").relative_to(ROOT)))


def index(models):
    page = "# Models\n\nWhat ships, in the order of the menus. [Write your own](../write-a-model.md) in ten minutes.\n\n"
    rows = [[f"[`{m['id']}`]({m['id']}.md)", m["title"], m["citation"]] for m in models]
    page += table(["model", "", "published in"], rows)
    return page + "\nThese pages are written by [tools/model_pages](../../tools/model_pages/model_pages.py).\n"


def questions(searchlight, model):
    rows = [[check["name"], check["asks"]] for check in checks(searchlight, model)]
    return ("\n## What check looks at\n\nThe page of each model ends with what `searchlight check` says about it.\n\n"
            + table(["check", "asks"], rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("searchlight", type=lambda path: str(Path(path).resolve()), help="the program")
    parser.add_argument("--stale", action="store_true", help="write nothing; exit 1 when a page needs writing")
    arguments = parser.parse_args()
    models = json.loads(run(arguments.searchlight, "models", "--json"))["models"]

    pages = {"README.md": index(models)} | {f"{model['id']}.md": described(model) for model in models}
    if arguments.stale:
        stale = [name for name, text in pages.items()
                 if not (PAGES / name).exists() or not (PAGES / name).read_text().startswith(text)]
        stale += [path.name for path in PAGES.glob("*.md") if path.name not in pages]
        if stale:
            sys.exit(f"docs/models: to be written again: {', '.join(stale)}\n"
                     f"{Path(__file__).resolve()} {arguments.searchlight}")
        return
    pages["README.md"] += questions(arguments.searchlight, models[0])
    for model in models:
        pages[f"{model['id']}.md"] += checked(arguments.searchlight, model)
        plot(arguments.searchlight, model)
    for name, text in pages.items():
        (PAGES / name).write_text(text)


if __name__ == "__main__":
    main()
