#!/usr/bin/env python3
"""Writes docs/models/ from the model files, one page per model and the index, and docs/model-sanity.md from what
`searchlight check --grid` measures.

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
SANITY = ROOT / "docs/model-sanity.md"
EXACT = ROOT / "tests/data/half_space_refractive.csv"
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


def exact_totals():
    """(eta, albedo) -> diffuse reflectance per flux that has entered."""
    rows = [line.split(",") for line in EXACT.read_text().splitlines() if line[:1].isdigit()]
    return {(float(eta), float(albedo)): float(diffuse) / (1 - float(specular)) for eta, albedo, specular, diffuse in rows}


def percent(part):
    text = f"{100 * part:+.0f}" if abs(part) >= 0.1 else f"{100 * part:+.1f}"
    return ("0" if float(text) == 0 else text.replace("-", "−")) + " %"


def energy_text(grid):
    if not grid["above"]:
        return "nowhere"
    parts = []
    for eta in sorted({point["eta"] for point in grid["above"]}):
        points = [point for point in grid["above"] if point["eta"] == eta]
        albedos = [point["albedo"] for point in points]
        angles = sorted({point["angle_deg"] for point in points})
        at = "" if angles[0] == 0 else f" from {angles[0]:g}°"
        parts.append(f"IOR {eta:g}: α′ {min(albedos):.4g} to {max(albedos):.4g}{at}")
    return "; ".join(parts)


def most_text(grid):
    most = grid["most"]
    return f"{most['total']:.4f} (IOR {most['eta']:g}, α′ {most['albedo']:.4g}, g {most['g']:.2g}, {most['angle_deg']:g}°)"


def digits(value):
    """Rounding differs between machines; its order of magnitude does not matter."""
    return "exact" if value < 1e-9 else f"{value:.2g}"


def sanity(searchlight, models):
    """Totals beside the exact ones, and what must not be: energy made, negative values, broken laws."""
    grids = {model["id"]: json.loads(run(searchlight, "check", model["id"], "--grid", "--json")) for model in models}
    of_medium = [model["id"] for model in models if grids[model["id"]]["scaling"]]
    exact = exact_totals()
    page = ("# What models return\n\nMeasured over a grid of 144 media: reduced albedo α′ from 0.02 to 0.9999, IOR 0.77, 1, "
            "1.3 and 1.5, g 0, 0.5 and 0.9, reduced extinction 1/mm; parameters at their defaults. `searchlight check MODEL --grid` "
            "measures one model, and tools/model_pages writes this page.\n\n## Totals\n\n"
            "Light that leaves per light that has entered, under a normal beam: exact (isotropic scattering, "
            "adding-doubling, `tests/data`), and the relative error of each model there. A model marked * leaves single "
            "scattering out. `multipole` and `two_layers` are a slab and two layers at their default sizes, so theirs is another "
            "problem. What a model makes of g is the error of its similarity: the totals of most depend on α′ alone, "
            "the true ones do not.\n")
    for eta in (1, 1.3, 1.5):
        rows = []
        for albedo in sorted(albedo for index, albedo in exact if index == eta):
            row = [f"{albedo:g}", f"{exact[eta, albedo]:.5f}"]
            for name in of_medium:
                total = next(point["total"] for point in grids[name]["totals"]
                             if point["eta"] == eta and point["g"] == 0 and abs(point["albedo"] - albedo) < 1e-9)
                row.append(percent(total / exact[eta, albedo] - 1))
            rows.append(row)
        marks = ["" if "single_scattering" in grids[name]["attributes"] else " *" for name in of_medium]
        page += f"\n### IOR {eta:g}\n\n" + table(
            ["α′", "exact"] + [f"`{name}`{mark}" for name, mark in zip(of_medium, marks)], rows)
    page += ("\n## Laws\n\nMost: the largest total at 0, 45 or 80° of incidence (0° alone for a model that does not read the "
             "direction). Energy made: where the total exceeds 1. Negative: the least r² R_d over the largest at that medium. "
             "Reciprocity: the largest change when both ends are exchanged, relative to the largest value at that distance; "
             "it need hold only where it is claimed. Scaling: error of R_d(r; σ) = k² R_d(k r; σ/k). Exact: within 1e-9.\n\n")
    rows = []
    for model in models:
        grid = grids[model["id"]]
        claimed = "reciprocal" in grid["attributes"]
        negative = grid["negative"]
        rows.append([f"`{model['id']}`", most_text(grid), energy_text(grid),
                     "nowhere" if negative["share"] > -1e-9 else f"{negative['share']:.2g} at {negative['where']}",
                     digits(grid["reciprocal"]["difference"]) + ("" if claimed else ", not claimed"),
                     digits(grid["scaling"]["error"]) if grid["scaling"] else "does not read the medium"])
    return page + table(["model", "most", "energy made", "negative", "reciprocity", "scaling"], rows)


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
        if not SANITY.exists() or SANITY.read_text() != sanity(arguments.searchlight, models):
            stale.append(f"../{SANITY.name}")
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
    SANITY.write_text(sanity(arguments.searchlight, models))


if __name__ == "__main__":
    main()
