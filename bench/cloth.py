"""The table of cloth in contact in docs/performance.md, from cloth_bench."""
import json
import pathlib
import subprocess

from report import number, table

BEGIN, END = "<!-- cloth measured by bench/run -->", "<!-- end of cloth -->"


def measure(build, pattern, machine, root):
    """Runs the cases that match, keeps the numbers of the others, and writes the table."""
    subprocess.run(["cmake", "--build", build, "--target", "cloth_bench"], cwd=root, check=True)
    raw = build / "cloth_bench.json"
    raw.unlink(missing_ok=True)
    subprocess.run([build / "bench" / "cloth_bench", f"--benchmark_filter={pattern}", f"--benchmark_out={raw}",
                    "--benchmark_out_format=json"], check=True)
    if not raw.exists() or not raw.stat().st_size:
        return False
    kept = pathlib.Path(root) / "bench" / "results" / f"{machine}.cloth.json"
    runs = json.loads(kept.read_text()) if kept.exists() else {}
    for run in json.loads(raw.read_text())["benchmarks"]:
        runs[run["name"].replace("/iterations:1/manual_time", "")] = {
            k: v for k, v in run.items() if isinstance(v, float)}
    kept.write_text(json.dumps(runs, indent=1, sort_keys=True) + "\n")
    write(runs, machine, root)
    return True


def text(runs, machine):
    rows = []
    for name, r in sorted(runs.items()):
        case, mode, threads = name.split("/")
        spent = sum(r[k] for k in ("search_ms", "limit_ms", "contact_ms", "assembly_ms", "solve_ms"))
        shares = " / ".join(f"{100 * r[k] / max(spent, 1e-9):.0f}"
                            for k in ("search_ms", "limit_ms", "contact_ms", "assembly_ms", "solve_ms"))
        rows.append([case, mode, threads.split(":")[1], f"{number(r['ms'])} / {number(r['worst_ms'])}",
                     f"{number(r['newton'])}, {number(r['linear'])}", shares, f"{r['stretch']:.3f}",
                     f"{r['height']:.4f}", number(r["crossings"])])
    head = ["case", "mode", "threads", "ms a frame, average / worst", "Newton, linear iterations a frame",
            "% search / limiter / contact / assembly / solve", "stretch", "mean height [m]", "crossings"]
    return "\n".join([f"On {machine}:", "", *table(head, rows)])


def write(runs, machine, root):
    page = pathlib.Path(root) / "docs" / "performance.md"
    head, rest = page.read_text().split(BEGIN)
    page.write_text(head + BEGIN + "\n" + text(runs, machine) + "\n" + END + rest.split(END)[1])
