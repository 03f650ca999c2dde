"""The numbers of one run of the benchmarks on one machine: what is kept of them, and what is looked up."""
import re

FORMAT = 2  # of the files in bench/results
KEPT = re.compile(r"ms$|_s$|_GB$|_ns$|_newton$|_linear$|^(name|error|residual|energy|newton|linear|vertices|voxels|"
                  r"triangles|compressed|bytes_per_vertex|iteration_bytes|stiffness_number|bytes_per_second|"
                  r"error_message)$|^iterations_")
# If methods end in different minima, the same residual (in multiples of gravity) stands for the same error.
RESIDUAL = {1e-3: 1, 1e-6: 1e-3}
ERROR_GOAL = {1e-3: "error1e-3", 1e-6: "error1e-6"}
RESIDUAL_GOAL = {1e-3: "residual1e-0", 1e-6: "residual1e-3"}


def kept(data, before):
    """The content of a results file; benchmarks that were not run now come from `before`, the last file."""
    runs = {}
    for run in data["benchmarks"]:
        name = run["name"].replace("/iterations:1/manual_time", "")
        runs[name] = {k: v for k, v in run.items() if KEPT.search(k)} | {"name": name}
    old = {r["name"]: r for r in before["benchmarks"]} if before.get("format") == FORMAT else {}
    return {"format": FORMAT, "date": data["date"], "benchmarks": list((old | runs).values())}


class Results:
    def __init__(self, data):
        self.date = data["date"]
        self.runs = {r["name"]: r for r in data["benchmarks"] if "error_message" not in r}
        self.failed = [r for r in data["benchmarks"] if "error_message" in r]
        self.cases = list(dict.fromkeys(n.split("/")[0] for n in self.runs if "/muslin/" in n))

    def get(self, name):
        return self.runs.get(name, {})

    def steps(self, case, threads=1):
        return [r for n, r in self.runs.items() if n.startswith(f"{case}/muslin/threads:{threads}/")]

    def by_residual(self, case):
        """True where the methods end in different minima, so that errors cannot be compared."""
        runs = [self.get(f"{case}/{method}") for method in ("textbook", "textbook_inexact")]
        return case.startswith("long") or any(r and r["residual"] <= 1e-3 and r["error"] > 1e-5 for r in runs)

    def accurate(self, case, threads, error):
        if self.by_residual(case):
            return [r for r in self.steps(case, threads) if r["residual"] <= RESIDUAL[error]]
        return [r for r in self.steps(case, threads) if r["error"] <= error]

    def best(self, case, error):
        """muslin's quickest run on one thread that is accurate enough."""
        return min(self.accurate(case, 1, error), key=lambda r: r["ms"], default={})

    def on_two(self, case):
        """The quickest run on two threads that is accurate to 1e-6, and the same run on one."""
        two = min(self.accurate(case, 2, 1e-6), key=lambda r: r["wall_ms"], default={})
        return two, self.get(two["name"].replace("threads:2", "threads:1")) if two else {}

    def textbook(self, case, method, error):
        """Milliseconds, and whether they were enough."""
        run = self.get(f"{case}/{method}")
        goal = (RESIDUAL_GOAL if self.by_residual(case) else ERROR_GOAL)[error]
        if f"{goal}_ms" in run:
            return run[f"{goal}_ms"], True
        return run.get("spent_ms"), False
