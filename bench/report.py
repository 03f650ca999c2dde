"""The tables and the plot of docs/performance.md."""
import math
import re

# One linearly implicit step of Vega FEM 4.0 (mass-spring, dt = 1/240 s, one thread) on a two-core Xeon [ms].
VEGA = {"flag_10x6": 0.185, "flag_100x60": 24, "flag_400x240": 545}
METHODS = ("textbook", "textbook_inexact")


def number(value):
    if value is None:
        return "–"
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def bounded(time):
    return ("" if time[1] or time[0] is None else "> ") + number(time[0])


def ratio(slow, run):
    """The ratio of a textbook's time to that of a run of muslin."""
    if slow[0] is None or "ms" not in run:
        return "–"
    return ("" if slow[1] else "> ") + f"{slow[0] / run['ms']:.1f}"


def gain(one, two):
    return f"{one['wall_ms'] / two['wall_ms']:.2f}" if one and two else "–"


def table(head, rows):
    return [f"| {' | '.join(row)} |" for row in [head, ["---"] * len(head), *rows]]


def triad(results):
    rates = [(n, results.get(f"triad/threads:{n}").get("bytes_per_second")) for n in (1, 2)]
    return ["STREAM triad: " + ", ".join(f"{rate / 1e9:.1f} GB/s on {n} thread{'s' * (n > 1)}"
                                         for n, rate in rates if rate) + "."]


def steps(results):
    rows = []
    for case in results.cases:
        some, m3, m6 = results.steps(case)[0], results.best(case, 1e-3), results.best(case, 1e-6)
        two, one = results.on_two(case)
        times = {m: [results.textbook(case, m, error) for error in (1e-3, 1e-6)] for m in METHODS}
        rows.append([case + (" (by residual)" if results.by_residual(case) else ""), number(some["voxels"]),
                     number(some["stiffness_number"]), *(" / ".join(map(bounded, times[m])) for m in METHODS),
                     f"{number(m3.get('ms'))} / {number(m6.get('ms'))}", *(ratio(times[m][1], m6) for m in METHODS),
                     f"{m6['newton']:.0f}, {m6['linear']:.0f}" if m6 else "–", number(two.get("wall_ms")),
                     gain(one, two), number(m6.get("bytes_per_vertex"))])
    head = ["case", "voxels", "k dt²/m", "textbook", "inexact", "muslin", "ratio", "to inexact", "iterations",
            "two threads", "gain", "B/vertex"]
    return ["Milliseconds a step, to a relative error of 1e-3 / 1e-6 (by residual: to 1 / 1e-3 of gravity); at 1e-6 "
            "the ratio of either textbook's time to muslin's, muslin's Newton and conjugate gradient iterations, its time "
            "and gain on two threads, and its memory.", "", *table(head, rows), *energies(results), *exponent(results)]


def energies(results):
    def energy(case, method):
        run = results.get(f"{case}/{method}")
        return f"{run['energy']:.1e}" if run and run["residual"] <= 1e-3 else "–"
    rows = [[case, *(energy(case, m) for m in METHODS)] for case in results.cases if results.by_residual(case)]
    return ["", "Energy where the textbook's step ends above where muslin's does, in parts of what the step releases:",
            "", *table(["case", "textbook", "inexact"], rows)] if rows else []


def exponent(results):
    small, large = results.best("falling_200x120", 1e-6), results.best("falling_1000x600", 1e-6)
    if not small or not large:
        return []
    value = math.log(large["ms"] / small["ms"]) / math.log(large["voxels"] / small["voxels"])
    return ["", f"Cost exponent from 24 000 to 600 000 voxels at 1e-6, falling: {value:.2f}."]


def linear(results):
    rows = []
    for case, vega in VEGA.items():
        one, two = (results.get(f"{case}/muslin_linear/threads:{n}") for n in (1, 2))
        textbook = (results.get(f"{case}/textbook_linear").get("ms"), True)
        if one:
            rows.append([case, number(vega), bounded(textbook), number(one["ms"]), ratio((vega, True), one),
                         ratio(textbook, one), f"{one['linear']:.0f}", number(two.get("wall_ms")), gain(one, two)])
    head = ["case", "Vega", "textbook", "muslin", "Vega / muslin", "textbook / muslin", "iterations", "two threads",
            "gain"]
    return ["Milliseconds for one linearly implicit step, conjugate gradients to 1e-6. Vega FEM 4.0 as measured on "
            "another two-core Xeon, ± 50 %.", "", *table(head, rows)]


def systems(results):
    """Iterations as bodies are cut finer, with the coarse space and without."""
    goals = ("1e-1", "1e-3", "1e-5")
    rows = []
    for name, run in results.runs.items():
        if not name.startswith("system/") or not name.endswith("/with"):
            continue
        _, case, length, _ = name.split("/")
        without = results.get(name + "out")
        rows.append([case, "1/24" if length == "long" else "1/240", number(run["stiffness_number"]),
                     *(" / ".join(f"{r.get('iterations_' + g, math.nan):.0f}" for g in goals) for r in (without, run)),
                     *(number(r.get("system_1e-3_ms")) for r in (without, run))])
    head = ["case", "step [s]", "k dt²/m", "without", "with", "ms without", "ms with"]
    lines = ["Iterations of a first linear system to 1e-1 / 1e-3 / 1e-5, without the coarse space and with it (which joins only "
             "where a solve takes long), and milliseconds to 1e-3:", "", *table(head, rows)]
    rows = []
    for n in (50, 100, 200):
        run, without = results.get(f"cloth/{n}/with"), results.get(f"cloth/{n}/without")
        if run and without:
            rows.append([f"{n}²", *(f"{r['newton']:.1f}, {r['linear']:.1f}" for r in (without, run)),
                         *(number(r["steps_ms"]) for r in (without, run)), number(run["bytes_per_vertex"])])
    head = ["squares", "without", "with", "ms without", "ms with", "B/vertex"]
    return lines + ["", "Cloth that begins to hang, Newton and linear iterations a step of 1/240 s to 0.1 m/s²:", "",
                    *table(head, rows)]


def parts(results):
    found = {n.split("/")[0]: r for n, r in results.runs.items() if n.endswith("/parts")}
    names = {"energy_ns": "energy", "gradient_ns": "gradient", "linearise_ns": "linearise and factor",
             "iteration_ns": "an iteration of conjugate gradients",
             "iteration_bytes": "bytes of such an iteration, counted"}
    rows = [[label, *(number(r.get(key)) for r in found.values())] for key, label in names.items()]
    rate = results.get("triad/threads:1").get("bytes_per_second", math.inf)
    # Smaller lattices live in the caches, about which the triad says nothing.
    rows.append(["share of the triad", *(f"{1e11 * r['iteration_bytes'] / r['iteration_ns'] / rate:.0f} %"
                                         if r["vertices"] > 5e5 else "–" for r in found.values())])
    return ["What a step is made of, nanoseconds per vertex and call on one thread:", "", *table(["", *found], rows)]


def building(results):
    run = results.get("build/ball")
    stages = sorted(key[:-2] for key in run if re.match(r"\d .*_s$", key))
    rows = [[s[2:], f"{run[s + '_s']:.2f}", f"{run[s + '_GB']:.2f}"] for s in stages]
    ready = next(i for i, s in enumerate(stages) if s.endswith("skin"))
    rows.insert(ready, ["**ready to step**", f"**{run['ready_s']:.2f}**", f"**{run['ready_GB']:.2f}**"])
    return [f"Building a ball of {run['triangles']:,.0f} triangles and {run['voxels']:,.0f} voxels on one thread; "
            "memory is the most the process had so far:", "", *table(["stage", "seconds", "GB"], rows)]


def text(results):
    lines = []
    for section, needed in ((triad, "triad"), (steps, "/muslin/"), (linear, "/muslin_linear"), (systems, "system/"),
                            (parts, "/parts"),
                            (building, "build/")):
        if any(needed in name for name in results.runs):
            lines += ["", *section(results)]
    if results.failed:
        lines += ["", "Failed:", "", *(f"- {r['name']}: {r['error_message']}" for r in results.failed)]
    return "\n".join(lines)


def plot(results):
    """SVG: time per step to 1e-6 of the flag (falling where finest) against its voxels, on logarithmic axes."""
    width, height, margin, (x0, x1), (y0, y1) = 640, 400, 60, (1.5, 6), (-2, 5)

    def place(voxels, milliseconds):
        return (margin + (math.log10(voxels) - x0) / (x1 - x0) * (width - 2 * margin),
                height - margin - (math.log10(milliseconds) - y0) / (y1 - y0) * (height - 2 * margin))
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
           'font-size="12">', f'<rect width="{width}" height="{height}" fill="white"/>']
    for decade in range(y0, y1 + 1):
        x, y = place(10 ** x0, 10.0 ** decade)
        svg.append(f'<line x1="{x:.0f}" x2="{width - margin}" y1="{y:.0f}" y2="{y:.0f}" stroke="#ddd"/>'
                   f'<text x="{x - 8:.0f}" y="{y + 4:.0f}" text-anchor="end">{10.0 ** decade:g}</text>')
    for decade in range(2, x1 + 1):
        x, y = place(10 ** decade, 10 ** y0)
        svg.append(f'<text x="{x:.0f}" y="{y + 18:.0f}" text-anchor="middle">{10 ** decade:,}</text>')
    curves = {"textbook": lambda case: results.textbook(case, "textbook", 1e-6),
              "inexact": lambda case: results.textbook(case, "textbook_inexact", 1e-6),
              "muslin": lambda case: (results.best(case, 1e-6).get("ms"), True)}
    for (name, time_of), colour in zip(curves.items(), ("#b04040", "#c09030", "#2060a0")):
        times = [(results.steps(c)[0]["voxels"], time_of(c)) for c in results.cases
                 if c.startswith("flag") or c == "falling_1000x600"]
        points = [place(v, time) for v, (time, reached) in sorted(times) if time and reached]
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        svg.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        svg += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
        if points:
            x, y = points[-1]
            svg.append(f'<text x="{x:.0f}" y="{y - 8:.0f}" fill="{colour}" text-anchor="end">{name}</text>')
    svg.append(f'<text x="{width / 2}" y="{height - 15}" text-anchor="middle">voxels of the flag (hanging; the finest falling)</text>')
    svg.append(f'<text x="{margin}" y="30">milliseconds a step to 1e-6, dt = 1/240 s, one thread</text></svg>')
    return "\n".join(svg) + "\n"
