"""The tables of cloth in contact in docs/performance.md, from cloth_bench and contact_bench."""
import json
import pathlib
import subprocess

from report import number, table

BEGIN, END = "<!-- cloth measured by bench/run -->", "<!-- end of cloth -->"


def measure(build, pattern, machine, root):
    """Runs the cases that match, keeps the numbers of the others, and writes the table."""
    subprocess.run(["cmake", "--build", build, "--target", "cloth_bench", "contact_bench"], cwd=root, check=True)
    found = []
    for program in ("cloth_bench", "contact_bench"):
        raw = build / f"{program}.json"
        raw.unlink(missing_ok=True)
        subprocess.run([build / "bench" / program, f"--benchmark_filter={pattern}", f"--benchmark_out={raw}",
                        "--benchmark_out_format=json"], check=True)
        if raw.exists() and raw.stat().st_size:
            found += json.loads(raw.read_text())["benchmarks"]
    if not found:
        return False
    kept = pathlib.Path(root) / "bench" / "results" / f"{machine}.cloth.json"
    runs = json.loads(kept.read_text()) if kept.exists() else {}
    for run in found:
        runs[run["name"].replace("/iterations:1", "").replace("/manual_time", "")] = {
            k: v for k, v in run.items() if isinstance(v, float)}
    kept.write_text(json.dumps(runs, indent=1, sort_keys=True) + "\n")
    write(runs, machine, root)
    return True


def text(runs, machine):
    rows, spreads, errors, layers, parts = [], [], [], [], {}
    for name, r in sorted(runs.items()):
        if name.count("/") == 1:
            part, size = name.split("/")
            parts.setdefault(part.replace("_", " "), {})[int(size)] = number(r["cpu_time"])
            continue
        case, effort, threads = name.split("/")
        if threads == "spread":
            spreads.append([case, *(" / ".join(form(r[f"{what}_{k}"]) for k in ("least", "median", "most"))
                                    for what, form in (("stretch", "{:.3f}".format), ("average", number),
                                                       ("worst", number))), number(r["crossings"])])
            continue
        if threads == "accuracy":
            errors.append([case, effort, *(f"{r[f'mm_{k}_median']:.2g}, {r[f'mm_{k}_most']:.2g}"
                                           for k in ("until_folds", "after"))])
            continue
        if case.startswith("layers"):
            layers.append([f"{r['vertices']:.0f}", threads.split(":")[1], number(r["s_a_step"]),
                           f"{number(r['steps'])}, {number(r['missed'])}", f"{number(r['newton'])}, {number(r['linear'])}",
                           number(r["peak_GB"]), number(r["crossings"])])
            continue
        spent = sum(r[k] for k in ("search_ms", "limit_ms", "contact_ms", "assembly_ms", "solve_ms"))
        shares = " / ".join(f"{100 * r[k] / max(spent, 1e-9):.0f}"
                            for k in ("search_ms", "limit_ms", "contact_ms", "assembly_ms", "solve_ms"))
        rows.append([case, effort, threads.split(":")[1], f"{number(r['ms'])} / {number(r['worst_ms'])}",
                     f"{r['steps']:.1f}, {number(r['newton'])}, {number(r['linear'])}", shares,
                     f"{r['stretch']:.3f}", number(r["missed"]), number(r["crossings"])])
    head = ["case", "effort", "threads", "ms a frame, average / worst", "steps, Newton, linear iterations a frame",
            "% search / limiter / contact / assembly / solve", "stretch", "steps missed", "crossings"]
    sizes = sorted({size for part in parts.values() for size in part})
    timed = table(["part", *(f"{n}²" for n in sizes)],
                  [[part, *(times.get(n, "–") for n in sizes)] for part, times in sorted(parts.items())])
    spread = table(["case", "stretch", "ms a frame, average", "worst", "crossings"], spreads)
    error = table(["case", "effort", "until the first folds, 33 ms after the sheet meets the ball [mm]", "33 ms later [mm]"],
                  errors)
    layer = table(["vertices", "threads", "s a step", "steps, missed", "Newton, linear iterations a step", "peak GB",
                   "crossings"], layers)
    return "\n".join([f"On {machine}:", "", *table(head, rows), "",
                      "Root mean square distance to the same with every step solved to 1e-5, median and most of eight starts that are "
                      "micrometres apart:", "", *error, "",
                      "Fifty sheets that fall on each other and on a floor, 12 frames, `normal`:", "", *layer, "",
                      "Eight starts that are micrometres apart, least / median / most:", "", *spread, "",
                      "Parts of contact on one thread, crumpled cloth draped over a ball, milliseconds of processor time:",
                      "", *timed])


def write(runs, machine, root):
    page = pathlib.Path(root) / "docs" / "performance.md"
    head, rest = page.read_text().split(BEGIN)
    page.write_text(head + BEGIN + "\n" + text(runs, machine) + "\n" + END + rest.split(END)[1])
