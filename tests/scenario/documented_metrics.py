"""Metrics of a run, each of which must have an entry in the reference.

usage: documented_metrics.py PATROL FOLDER NUMBER    checks the results of every `patrol test` below the folder, which are NUMBER
"""
import functools
import json
import pathlib
import re
import subprocess
import sys


def paths_of(value, path=""):
    """Paths of the metrics, entries of lists by name or index, as in `expect:`."""
    if isinstance(value, dict):
        items = [(key, child) for key, child in value.items() if not (key == "name" and path)]
    elif isinstance(value, list):
        items = [(child.get("name", str(i)) if isinstance(child, dict) else str(i), child) for i, child in enumerate(value)]
    else:
        return [path]
    return [found for key, child in items for found in paths_of(child, f"{path}.{key}" if path else key)]


@functools.cache
def documented(patrol):
    """Patterns of the paths with an entry."""
    entries = json.loads(subprocess.run([patrol, "list", "metrics", "--json"], check=True, capture_output=True, text=True).stdout)["metrics"]
    return [re.compile(re.escape(entry["name"]).replace(r"\*", ".+")) for entry in entries]


def undocumented(patrol, metrics):
    """Paths without an entry."""
    return [path for path in paths_of(metrics) if not any(pattern.fullmatch(path) for pattern in documented(patrol))]


def load_metrics(patrol, folder):
    """metrics.json of a run directory."""
    metrics = json.loads((pathlib.Path(folder) / "metrics.json").read_text())
    missing = undocumented(patrol, metrics)
    assert not missing, f"no entry in `patrol list metrics`: {missing}"
    return metrics


def main():
    patrol, folder, number = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3])
    results = [json.loads(file.read_text()) for file in sorted(folder.glob("*/runs/*.json"))]
    assert len(results) == number, f"{folder}: {len(results)} results, expected {number}"
    missing = sorted({path for result in results for path in undocumented(patrol, result["metrics"])})
    print(f"{len(results)} results, metrics without an entry: {missing or 'none'}")
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
